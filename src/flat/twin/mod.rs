//! The CPU twin: the field of the flat scene in f64, from the same numbers and by the same formulas as
//! the GPU. It visits every node and skips nothing, so it is the truth that the renderer is held to.
//!
//! | file | what it holds | its twin on the GPU |
//! |---|---|---|
//! | `real` | numbers: f64, and dual numbers that carry their gradient | – |
//! | `sdf` and its folder, `ellipsoid`, `tube`, `outline`, `relief` | the shapes | `shaders/sdf/<shape>.wgsl` |
//! | `op` | the operators | `shaders/sdf/op.wgsl` |
//! | `modifier` | the modifiers | `shaders/mod/<modifier>.wgsl` |
//! | `eval` | the fold over the subtree-extent array | `shaders/field/*.wgsl` |

mod ellipsoid;
mod eval;
mod modifier;
mod op;
mod outline;
mod real;
mod relief;
mod sdf;
mod tube;

pub use ellipsoid::sdf_ellipsoid;
pub use eval::{SurfaceMaterial, SurfacePoint, TIE, entry_field, field, gradient, modified_field, surface};
pub use modifier::*;
pub use op::{
    Joined, Joint, op_difference, op_engrave, op_groove, op_intersection, op_join, op_paint, op_pipe, op_union, op_xor,
};
pub use outline::{sdf_extrusion, sdf_outline, sdf_revolution, sdf_text};
pub use real::{Dual, Real};
pub use relief::{heightmap_height, ocean_height, sdf_heightmap, sdf_heights, sdf_ocean, sdf_terrain, terrain_height};
pub use sdf::*;
pub use tube::sdf_tube;
