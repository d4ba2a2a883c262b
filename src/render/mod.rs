//! The picture, with wgpu; nothing else in the program names it but the window.
//!
//! | lives as long as | types |
//! |---|---|
//! | the device | [`Gpu`], `Layouts`, the pipelines of passes without fields |
//! | a structure or template | [`PipelineCache`]: the interpreter, and specialized pipelines as they become ready |
//! | the scene | `SyncedBuffer` buffers: nodes, numbers, materials; meshes by their own life |
//! | the picture's size | `Targets` |
//! | the frame | [`Frame`]: the dispatches that are still to be done; view, components, lights |
//!
//! The frame, in order: mesh (clears, then triangles), hiz (only with meshes), cone and
//! trace (each component, front to back), surface, shade, debug_view (only where a view mode is asked for), overlay. See `frame::plan` for how it is cut into dispatches.

mod evaluators;
mod frame;
mod gpu;
mod passes;
mod pipelines;
mod renderer;
mod resources;
pub mod wgsl;

pub use evaluators::{EvaluatorUse, evaluators_of};
pub use frame::cost_model::coarse_size;
pub use frame::{plan, standpoint};
pub use gpu::{AdapterChoice, AdapterSummary, adapters};
pub use gpu::{Gpu, GpuError, device_descriptor, instance_descriptor};
pub use gpu::{driver, probe};
pub use passes::debug_view::DebugView;
pub use passes::mesh::Instance;
pub use passes::overlay::{Overlay, OverlaySettings};
pub use pipelines::cache::{EvalStrategy, PipelineCache};
pub use renderer::{Counts, Distribution, Frame, PixelCounts, RenderError, Renderer, Slot, TraceCounts};
pub use resources::targets::BACKGROUND;
pub use resources::uniforms;
