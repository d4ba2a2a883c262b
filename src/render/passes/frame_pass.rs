//! What a pass of the frame is: how it is built, what it binds, and how it is written down.

use std::ops::Range;

use crate::pipelines::field::FieldLayouts;
use crate::renderer::recorder::Recorder;
use crate::renderer::resources::Bound;
use crate::resources::layouts::Layouts;
use isolith_wgsl::ShaderError;

/// What passes are built of.
#[derive(Clone, Copy, Debug)]
pub struct Building<'a> {
    /// The device.
    pub device: &'a wgpu::Device,
    /// Layouts that several passes share.
    pub layouts: &'a Layouts,
    /// Layouts of the targets of passes that evaluate fields.
    pub field: &'a FieldLayouts,
}

/// A pass of the frame.
pub trait FramePass: Sized {
    /// Builds what depends on no frame.
    ///
    /// # Errors
    /// A shader file is missing.
    fn new(building: Building<'_>) -> Result<Self, ShaderError>;

    /// Its own bind groups for the targets of a picture; made anew when a buffer or the size is another one.
    fn bind(&self, _device: &wgpu::Device, _bound: &Bound<'_>) -> Vec<wgpu::BindGroup> {
        Vec::new()
    }

    /// Writes these dispatches of the frame down, all of which are its own. A pass over the finished picture has none.
    fn record(&self, recorder: &mut Recorder<'_>, dispatches: Range<usize>);
}
