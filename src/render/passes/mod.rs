//! The passes, each with its shader of the same name. [`super::recipe`] defines their order.

pub mod debug_view;
pub mod display;
pub mod field;
pub mod frame_pass;
pub mod hiz;
pub mod lights;
pub mod mesh;
mod mesh_copies;
mod mesh_instance;
mod mesh_textures;
pub mod overlay;
pub mod overlay_settings;
pub mod resolution;
pub mod shade;
pub mod shade_features;
pub mod shadow;

use std::ops::Range;

use super::recipe::{Pass, recipe};
use super::renderer::recorder::Recorder;
use super::renderer::resources::Bound;
use debug_view::DebugViewPass;
use display::DisplayPass;
use field::{ConePass, SurfacePass, TracePass};
use frame_pass::{Building, FramePass};
use hiz::HizPass;
use isolith_wgsl::ShaderError;
use lights::LightsPass;
use mesh::MeshPass;
use overlay::OverlayPass;
use resolution::ResolutionPass;
use shade::ShadePass;
use shadow::ShadowPass;

/// Declares [`Passes`] from the recipe.
macro_rules! passes {
    ($($(#[$doc:meta])* $pass:ident: $field:ident = $type:ident, $file:literal, over $extent:ident;)*) => {
        /// All passes of the recipe.
        #[derive(Debug)]
        pub struct Passes {
            $($(#[$doc])* pub $field: $type,)*
        }

        impl Passes {
            /// Builds all passes.
            ///
            /// # Errors
            /// A shader file is missing.
            pub fn new(building: Building<'_>) -> Result<Self, ShaderError> {
                Ok(Self { $($field: $type::new(building)?,)* })
            }

            /// The bind groups of all passes, in the order of the frame.
            pub fn bind(&self, device: &wgpu::Device, bound: &Bound<'_>) -> Vec<Vec<wgpu::BindGroup>> {
                vec![$(self.$field.bind(device, bound)),*]
            }

            /// Records these dispatches by the pass that they all belong to.
            pub fn record(&self, pass: Pass, recorder: &mut Recorder<'_>, dispatches: Range<usize>) {
                let _span = tracing::debug_span!("pass", name = pass.label(), dispatches = dispatches.len()).entered();
                recorder.begin(pass);
                match pass {
                    $(Pass::$pass => self.$field.record(recorder, dispatches),)*
                }
            }
        }
    };
}
recipe!(passes);
