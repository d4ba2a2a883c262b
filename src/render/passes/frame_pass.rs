//! The interface of a pass of the frame: how it is built, what it binds, and how it is recorded.

use std::ops::Range;

use crate::pipelines::field::FieldLayouts;
use crate::renderer::recorder::Recorder;
use crate::renderer::resources::Bound;
use crate::resources::layouts::Layouts;
use isolith_wgsl::ShaderError;

/// Inputs for the construction of passes.
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
    /// Builds the parts that depend on no frame.
    ///
    /// # Errors
    /// A shader file is missing.
    fn new(building: Building<'_>) -> Result<Self, ShaderError>;

    /// Its own bind groups for the targets of a picture. The frame rebuilds them when a buffer is replaced or resized.
    fn bind(&self, _device: &wgpu::Device, _bound: &Bound<'_>) -> Vec<wgpu::BindGroup> {
        Vec::new()
    }

    /// Records these dispatches of the frame, all of which belong to this pass. A pass over the finished picture has
    /// none.
    fn record(&self, recorder: &mut Recorder<'_>, dispatches: Range<usize>);
}
