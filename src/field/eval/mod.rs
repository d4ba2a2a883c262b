//! The CPU evaluator: the field of the flat scene in f64, with the same parameters and formulas as the GPU. It visits
//! every node and skips nothing, so the renderer is tested against it.
//!
//! | file | content | GPU counterpart |
//! |---|---|---|
//! | `real` | number types: f64, and dual numbers that carry their gradient | – |
//! | `sdf` and its folder, `ellipsoid`, `tube`, `profile`, `heightfield`, `brick_field` | the shapes | `shaders/sdf/<shape>.wgsl` |
//! | `op` | the operators | `shaders/sdf/op.wgsl` |
//! | `modifier` | the modifiers | `shaders/mod/<modifier>.wgsl` |
//! | `component` | the fold over the subtree-extent array | `shaders/field/*.wgsl` |

mod brick_field;
mod component;
mod ellipsoid;
mod heightfield;
mod modifier;
mod op;
mod profile;
mod real;
mod sdf;
mod tube;

pub use crate::mixture::{
    MIXED, Mixture, SurfaceMaterial, mixture_add, mixture_decoded, mixture_joined, mixture_material, mixture_of,
};
pub use brick_field::sdf_mesh_field;
pub use component::{
    SurfacePoint, TIE, content_point, entry_field, entry_gradient, field, gradient, modified_field, partial_field,
    surface,
};
pub use ellipsoid::sdf_ellipsoid;
pub use heightfield::{
    heightmap_height, ocean_height, sdf_heightmap, sdf_heights, sdf_ocean, sdf_terrain, terrain_height,
};
pub use modifier::*;
pub use op::{
    BlendParams, BlendResult, op_difference, op_engrave, op_groove, op_intersection, op_join, op_paint, op_pipe,
    op_union, op_xor,
};
pub use profile::{sdf_extrusion, sdf_profile, sdf_revolution, sdf_text};
pub use real::{Dual, Real};
pub use sdf::*;
pub use tube::sdf_tube;
