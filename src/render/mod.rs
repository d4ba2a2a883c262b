//! The picture, with wgpu; nothing else in the program names it but the window.
//!
//! | lives as long as | types |
//! |---|---|
//! | the device | [`Gpu`], `Layouts`, the pipelines of passes without fields |
//! | a structure or form | [`Kernels`]: the interpreter, and specialised kernels as they become ready |
//! | the scene | `Mirror` buffers: nodes, numbers, materials; meshes by their own life |
//! | the picture's size | `Targets` |
//! | the frame | [`Frame`]: the pieces of work that are still to be done; view, components, lights |
//!
//! The frame, in order: mesh (clears, then triangles), farthest (only with meshes), cone and
//! trace (each component, front to back), surface, shade, inspect (only where a look is asked for), overlay. See `schedule` for how it is cut into dispatches.

mod adapter;
mod buffers;
pub mod driver;
mod gpu;
pub mod kernel;
mod kernels;
mod keys;
mod layouts;
mod list_texture;
mod pace;
mod passes;
pub mod probe;
mod readback;
mod renderer;
pub mod schedule;
pub mod standpoint;
mod targets;
pub mod uniforms;
mod warm;

pub use adapter::{AdapterChoice, AdapterSummary, adapters};
pub use gpu::{Gpu, GpuError, device_descriptor, instance_descriptor};
pub use kernels::{Kernels, Method};
pub use pace::coarse_size;
pub use passes::inspect::Inspect;
pub use passes::mesh::Instance;
pub use passes::overlay::{Overlay, OverlaySettings};
pub use renderer::{Counts, Frame, PixelCounts, RenderError, Renderer, Slot, Spread, Took};
pub use targets::BACKGROUND;
