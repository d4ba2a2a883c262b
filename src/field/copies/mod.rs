//! Copies of instancers: where they stand, how they differ, how they move, and the field of all of them.
//!
//! A copy is never stored: its place, its type and its motion follow from the seed, its cell and the time. A type is a
//! component of the flat scene in the space of a copy, see [`crate::InstanceType`].

mod blocks;
pub(crate) mod build;
mod dynamics;
mod eval;
mod gpu;
pub(crate) mod ground;
mod hash;
mod in_view;
pub(crate) mod instancer;
pub(crate) mod list;
mod look;
mod mask_curve;
mod masks;
mod mesh_copies;
pub(crate) mod moved_scene;
mod noise;
#[cfg(test)]
mod tests;
mod trace;
mod variation;
mod walk;

pub use dynamics::{CopyMotion, Envelope, copy_basis, copy_envelope, copy_motion};
pub use eval::{
    NearestCopy, copy_from_world, nearest_copy, world_field, world_from_copy, world_gradient, world_surface,
};
pub use gpu::{GpuCopyDynamic, GpuCopyMask, GpuInstancer, gpu_instancer, gpu_places};
pub use hash::{Channel, copy_hash, copy_random, copy_randoms};
pub use in_view::{COUNT_LIMITS, CopiesInView, ViewLimits, copies_in_view};
pub use instancer::{
    FlatDynamic, FlatInstancer, FlatLattice, FlatMask, FlatMaskImage, MAX_PLACES, Place, PlaceList, Placement,
};
pub use look::{look_at, look_color, look_mixture, look_varied};
pub use mask_curve::FlatCurve;
pub use masks::{copy_mask, copy_masks};
pub use mesh_copies::{
    MESH_COPY_LIMITS, MeshCopies, MeshCopy, mesh_copies_along, mesh_copies_bounds, mesh_copies_in_view,
};
pub use noise::{Coordinate, copy_curl, copy_noise_1, copy_noise_2};
pub use trace::{CopyRay, copy_ray, visit_copies};
pub use variation::{Copy, CopyMaterial, copy_material, copy_of_cell, copy_of_place};
pub use walk::{
    CopyCone, CopyVisit, MAX_SLABS, WalkCounts, copies_along, copies_along_every_cell, copy_sphere, walk_axis,
};
