//! The renderer, on wgpu. Apart from it, only the window names wgpu.
//!
//! | lives as long as | types |
//! |---|---|
//! | the device | [`Gpu`], `Layouts`, `Passes` with the pipelines of passes without fields |
//! | a structure or template | [`PipelineCache`]: the interpreter, and specialized pipelines as they become ready |
//! | the scene | `SceneResources`: nodes, rows, materials, tapes; meshes have their own lifetime |
//! | the picture's size | `Targets`, one set for each [`Slot`] |
//! | the frame | `FrameResources`: view, lights, dispatches; [`Frame`]: the remaining work |
//!
//! `recipe` defines the order of the passes, `frame::plan` cuts the frame into dispatches.
//!
//! # Example
//!
//! `examples/embed.rs` renders on a device that another program owns. On a device of its own:
//!
//! ```
//! use isolith_render::{Gpu, Renderer};
//!
//! let flat = isolith_field::flatten(&isolith_scene::Scene::new(), 0.0)?;
//! let camera = flat.default_camera(&[], 1.0);
//! let mut renderer = Renderer::new(&Gpu::headless()?)?;
//! let (buffers, warnings) = renderer.render(&flat, &[], &camera, [32, 32], &mut |_| true)?;
//! assert_eq!((buffers.depth.len(), warnings.len()), (32 * 32, 0));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod frame;
mod gpu;
mod passes;
mod pipelines;
mod recipe;
mod renderer;
mod resources;

pub use frame::cost_model::coarse_size;
pub use frame::plan;
pub use frame::plan::TracedParts;
pub use gpu::{AdapterChoice, AdapterSummary, adapters};
pub use gpu::{Gpu, GpuError, device_descriptor, instance_descriptor};
pub use gpu::{brdf_probe, copy_probe, driver, mesh_ray_probe, probe, scene_probe};
pub use passes::debug_view::DebugView;
pub use passes::mesh::Instance;
pub use passes::overlay::Overlay;
pub use passes::overlay_settings::{GridPlane, OverlaySettings};
pub use pipelines::cache::PipelineCache;
pub use pipelines::evaluators::{EvaluatorUse, evaluators_of};
pub use pipelines::strategy::EvalStrategy;
pub use renderer::{
    Counts, Distribution, Film, Frame, PassTime, PixelCounts, RenderError, Renderer, SampleMoment, Slot, StillWatch,
    TraceCounts,
};
pub use resources::hierarchy::{GpuHierarchyNode, SceneLimits};
pub use resources::mesh_rays::{MAX_MESH_VISITS, MeshRayBuffer, RayMesh};
pub use resources::shadows::ShadowSettings;
pub use resources::targets::BACKGROUND;
pub use resources::uniforms;
