//! Distance bricks: the distances of a solid in voxels near its surface.
//!
//! A grid of *cells* covers the solid, each of 2³ bricks, each of 7³ voxels. Texels of four words hold, one after the
//! other:
//!
//! | texels | hold |
//! |---|---|
//! | one per four cells | the place of each cell's entries, in cells with entries; or for all of its bricks [`NO_ENTRIES`], [`INSIDE`] or [`COARSER`] |
//! | two per cell with entries | an entry for each of its bricks, x fastest |
//! | 32 per brick | its 8³ samples as bytes, x fastest, then y, then z: neighbors share those on their common face |
//!
//! | bits of an entry | hold |
//! |---|---|
//! | 31 | the brick has samples |
//! | 30 | it has none and lies inside, farther than [`BAND`] from the surface |
//! | 29 | it has none because those of the next coarser level tell as much, see `detail` |
//! | 0–23 | the number of a brick with samples |
//!
//! The *surface* is where the trilinear interpolation of the samples is 0; see `levels` for the field.

mod bake;
mod codec;
mod decode;
mod detail;
mod digest;
mod encode;
mod error;
mod grid;
mod levels;
mod looks;
mod placeholder;

pub use bake::{BakeProgress, BakedField, bake, bake_levels};
pub use codec::{CODEC_MAGIC, CodecError, from_bytes, to_bytes};
pub use detail::DETAIL;
pub use digest::{ContentHash, ContentKey};
pub use encode::{BrickContent, BrickSource, encode};
pub use error::BrickError;
pub use grid::BrickGrid;
pub use levels::{BrickLevels, LOOK_LEVEL, MAX_LEVELS, in_levels};
pub use looks::{LOOK_HEADER, LookSum, Looks, VoxelLook, linear_from_srgb, surface_samples};
pub use placeholder::placeholder;

use std::sync::Arc;

use glam::DVec3;
use isolith_geometry::Aabb;

/// Voxels of a brick along each axis.
pub const BRICK_VOXELS: u32 = 7;
/// Samples of a brick along each axis.
pub const BRICK_SAMPLES: usize = 8;
/// Samples of a brick.
pub const BRICK_VOLUME: usize = BRICK_SAMPLES * BRICK_SAMPLES * BRICK_SAMPLES;
/// Texels of a brick.
pub const BRICK_TEXELS: usize = BRICK_VOLUME / 16;
/// Bricks of a cell along each axis.
pub const CELL_BRICKS: u32 = 2;
/// Voxels of a cell along each axis.
pub const CELL_VOXELS: u32 = CELL_BRICKS * BRICK_VOXELS;
/// Steps of a sample per voxel of distance; 128 is the surface.
pub const SAMPLE_STEPS: f64 = 32.0;
/// The greatest distance that samples hold, in voxels: 127 steps.
pub const SAMPLE_REACH: f64 = 127.0 / SAMPLE_STEPS;
/// A brick that is at least this far from the surface needs no samples, in voxels: there the next level counts alone.
pub const BAND: f64 = FADE_END;
/// Marks a cell without entries, outside of the solid.
pub const NO_ENTRIES: u32 = u32::MAX;
/// Marks a cell without entries, inside.
pub const INSIDE: u32 = u32::MAX - 1;
/// Marks a cell without entries, of which the next coarser level tells as much.
pub const COARSER: u32 = u32::MAX - 2;
/// The bit of an entry whose brick has samples.
pub(crate) const HAS_SAMPLES: u32 = 1 << 31;
/// The bit of an entry whose brick has none, inside.
pub const BRICK_INSIDE: u32 = 1 << 30;
/// The bit of an entry whose brick has none, because the next coarser level tells as much.
pub const BRICK_COARSER: u32 = 1 << 29;
/// The size of a voxel in voxels of the next finer level.
pub const LEVEL_RATIO: f64 = 2.0;
/// From this distance on a level fades into the next, in voxels.
pub const FADE_START: f64 = 1.5;
/// From here on the next level counts alone, in voxels. Samples reach farther by a voxel, so that what they are cut off
/// at does not show before.
pub const FADE_END: f64 = 3.0;
/// Most texels of all bricks of a scene together: 256 MiB, and what 32-bit floats count exactly.
pub const MAX_BRICK_TEXELS: usize = 1 << 24;
/// Fewest and most voxels along the longest side.
pub const RESOLUTIONS: [u32; 2] = [16, 1024];

/// The distances of a solid, see the module.
#[derive(Clone, PartialEq)]
pub struct Bricks {
    /// Where the grid lies.
    pub grid: BrickGrid,
    /// A box around the surface, within the grid.
    pub bounds: Aabb,
    /// The first texel of the samples.
    pub first_brick: u32,
    /// The texels.
    pub texels: Vec<[u32; 4]>,
    /// The looks of the surface.
    pub looks: Option<Looks>,
    /// The next level, in voxels twice as large; it tells what bricks that are left out here would.
    pub coarser: Option<Arc<Bricks>>,
}

impl std::fmt::Debug for Bricks {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Bricks").field("grid", &self.grid).field("bricks", &self.count()).finish_non_exhaustive()
    }
}

impl Bricks {
    /// The number of bricks with samples.
    pub fn count(&self) -> usize {
        (self.texels.len() - self.first_brick as usize) / BRICK_TEXELS
    }

    /// This level and all coarser ones, the finest first.
    pub fn levels(self: &Arc<Self>) -> impl Iterator<Item = Arc<Self>> {
        std::iter::successors(Some(self.clone()), |level| level.coarser.clone())
    }

    /// Bytes of the texels of distances.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.texels)
    }

    /// The size of a voxel, in meters.
    pub fn voxel(&self) -> f64 {
        self.grid.voxel
    }

    /// The place of the first sample.
    pub fn origin(&self) -> DVec3 {
        self.grid.origin
    }
}

#[cfg(test)]
mod tests;
