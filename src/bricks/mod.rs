//! Distance bricks: the distances of a solid in voxels near its surface.
//!
//! A grid of *cells* covers the solid, each of 2³ bricks, each of 7³ voxels. Texels of four words hold, one after the
//! other:
//!
//! | texels | hold |
//! |---|---|
//! | one per four cells | the place of each cell's entries, in cells with entries; far from the surface [`NO_ENTRIES`], or [`INSIDE`] |
//! | two per cell with entries | an entry for each of its bricks, x fastest |
//! | 32 per brick | its 8³ samples as bytes, x fastest, then y, then z: neighbors share those on their common face |
//!
//! | bits of an entry | near the surface | elsewhere |
//! |---|---|---|
//! | 31 | 1 | 0 |
//! | 24–30 | the greatest slope of the samples here and in the neighbors, less 1, in 1/64, rounded up | 30: inside |
//! | 0–23 | the number of the brick | the distance to the surface is at least this, in 1/16 of a voxel |
//!
//! The *surface* is where the trilinear interpolation of the samples is 0; see `levels` for the field.

mod bake;
mod codec;
mod decode;
mod digest;
mod encode;
mod grid;
mod levels;
mod looks;
mod placeholder;

pub use bake::{BakeProgress, BakedField, bake, bake_field};
pub use codec::{CODEC_MAGIC, CodecError, from_bytes, to_bytes};
pub use digest::{ContentHash, ContentKey};
pub use encode::{BrickContent, BrickError, encode};
pub use grid::BrickGrid;
pub use levels::{BrickLevels, FADE_START, LEVEL_RATIO, MAX_LEVELS};
pub use looks::{LOOK_HEADER, Looks, VoxelLook, linear_from_srgb, surface_samples};
pub use placeholder::placeholder;

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
/// A brick that is at least this far from the surface needs no samples, in voxels.
pub const BAND: f64 = 4.0;
/// Marks a cell without entries, outside of the solid.
pub const NO_ENTRIES: u32 = u32::MAX;
/// Marks a cell without entries, inside.
pub const INSIDE: u32 = u32::MAX - 1;
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

    /// The greatest slope of the interpolation of its samples anywhere; at least 1.
    pub fn slope(&self) -> f64 {
        let entries = &self.texels[self.grid.cell_count().div_ceil(4)..self.first_brick as usize];
        let slope = |entry: &u32| if entry >> 31 == 1 { entry >> 24 & 0x7f } else { 0 };
        1.0 + f64::from(entries.iter().flatten().map(slope).max().unwrap_or(0)) / 64.0
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
