//! The passes, each with its shader of the same name. In which order they come stands in [`super::recipe`].

pub mod debug_view;
pub mod field;
pub mod hiz;
pub mod mesh;
pub mod overlay;
pub mod shade;

use std::ops::Range;

use super::recipe::{Pass, recipe};
use super::renderer::recorder::Recorder;
use super::renderer::resources::FrameResources;
use crate::resources::layouts::Layouts;
use crate::resources::targets::Targets;
use debug_view::DebugViewPass;
use field::{ConePass, FieldLayouts, SurfacePass, TracePass};
use hiz::HizPass;
use isolith_wgsl::ShaderError;
use mesh::MeshPass;
use overlay::OverlayPass;
use shade::ShadePass;

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

/// What passes bind.
#[derive(Clone, Debug)]
pub struct Bound<'a> {
    /// The textures of the picture.
    pub targets: &'a Targets,
    /// The buffers that passes work on.
    pub resources: &'a FrameResources,
    /// The materials of the scene.
    pub materials: wgpu::BindingResource<'a>,
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

/// Declares [`Passes`] by the recipe.
macro_rules! passes {
    ($($(#[$doc:meta])* $stage:ident: $field:ident = $type:ident, $file:literal, over $extent:ident;)*) => {
        /// All passes of the recipe.
        #[derive(Debug)]
        pub struct Passes {
            $($(#[$doc])* pub $field: $type,)*
        }

        impl Passes {
            /// Builds all of them.
            ///
            /// # Errors
            /// A shader file is missing.
            pub fn new(building: Building<'_>) -> Result<Self, ShaderError> {
                Ok(Self { $($field: $type::new(building)?,)* })
            }

            /// The own bind groups of all of them, in the order of the frame.
            pub fn bind(&self, device: &wgpu::Device, bound: &Bound<'_>) -> Vec<Vec<wgpu::BindGroup>> {
                vec![$(self.$field.bind(device, bound)),*]
            }

            /// Has a pass write these dispatches down, all of which are its own.
            pub fn record(&self, stage: Pass, recorder: &mut Recorder<'_>, dispatches: Range<usize>) {
                recorder.begin(stage);
                match stage {
                    $(Pass::$stage => self.$field.record(recorder, dispatches),)*
                }
            }
        }
    };
}
recipe!(passes);
