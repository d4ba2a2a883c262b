//! The picture, with wgpu; nothing else in the program names it but the window.
//!
//! | lives as long as | types |
//! |---|---|
//! | the device | [`Gpu`], `Layouts`, the passes' pipelines (rebuilt when a scene uses more shapes) |
//! | the scene | `Mirror` buffers: nodes, numbers, materials; meshes by their own life |
//! | the picture's size | `Targets` |
//! | the frame | [`Frame`]: the pieces of work that are still to be done; view, components, lights |
//!
//! The frame, in order: mesh (clears, then triangles), trace (each component, front to back), surface,
//! shade, overlay. See `schedule` for how it is cut into dispatches.

mod buffers;
pub mod driver;
mod gpu;
mod layouts;
mod passes;
pub mod probe;
mod readback;
mod renderer;
pub mod schedule;
pub mod shader;
mod targets;
pub mod uniforms;

pub use gpu::{Gpu, GpuError, device_descriptor, instance_descriptor};
pub use passes::mesh::Instance;
pub use passes::overlay::{Overlay, OverlaySettings};
pub use renderer::{Frame, RenderError, Renderer, Slot};
pub use targets::BACKGROUND;
