//! Where voxels lie.

use glam::DVec3;

use super::{BRICK_VOXELS, BrickError, CELL_BRICKS, CELL_VOXELS, MAX_BRICK_TEXELS, RESOLUTIONS};
use isolith_geometry::Aabb;

/// A grid of cells, bricks and voxels along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BrickGrid {
    /// The place of the first sample.
    pub origin: DVec3,
    /// The size of a voxel, in meters.
    pub voxel: f64,
    /// Cells along each axis; at least 1.
    pub cells: [u32; 3],
}

impl BrickGrid {
    /// The grid for a surface within `bounds`, which are finite. On each side is a margin of two voxels and more. Samples
    /// lie at multiples of `voxel`, so that those of voxels twice as large are some of them.
    pub fn around(bounds: &Aabb, voxel: f64) -> Self {
        // Two voxels on each side, one for rounding, and one for the way to a multiple.
        let margin = 6.0;
        let count = |size: f64| ((size / voxel + margin) / f64::from(CELL_VOXELS)).ceil().max(1.0) as u32;
        let cells = (2.0 * bounds.half()).to_array().map(count);
        let size = DVec3::from(cells.map(f64::from)) * f64::from(CELL_VOXELS);
        Self { origin: (bounds.center() / voxel - 0.5 * size).round() * voxel, voxel, cells }
    }

    /// The same, if there can be bricks of it: the size of voxels is one, the bounds hold something, and neither has too
    /// many voxels.
    ///
    /// # Errors
    /// What is wrong.
    pub fn checked(bounds: &Aabb, voxel: f64) -> Result<Self, BrickError> {
        if !(voxel > 0.0 && voxel.is_finite()) {
            return Err(BrickError::Voxel);
        }
        if bounds.is_empty() {
            return Err(BrickError::Empty);
        }
        if !bounds.is_finite() {
            return Err(BrickError::Endless);
        }
        let across = (2.0 * bounds.half()).max_element() / voxel;
        // A little more than the limit, for sizes that were rounded.
        if across > f64::from(RESOLUTIONS[1]) * 1.001 {
            return Err(BrickError::TooFine { voxels: across.min(1e18) as u64 });
        }
        let grid = Self::around(bounds, voxel);
        let least = grid.cell_count().div_ceil(4);
        if least > MAX_BRICK_TEXELS { Err(BrickError::TooLarge { texels: least }) } else { Ok(grid) }
    }

    /// Bricks along each axis.
    pub fn bricks(&self) -> [u32; 3] {
        self.cells.map(|n| n * CELL_BRICKS)
    }

    /// The number of cells.
    pub fn cell_count(&self) -> usize {
        self.cells.iter().map(|n| *n as usize).product()
    }

    /// The place of a sample, by its indices over the whole grid.
    pub fn sample(&self, index: [u32; 3]) -> DVec3 {
        self.origin + DVec3::from(index.map(f64::from)) * self.voxel
    }

    /// The place of a corner of cells.
    pub fn corner(&self, index: [u32; 3]) -> DVec3 {
        self.sample(index.map(|n| n * CELL_VOXELS))
    }

    /// The middle of a brick.
    pub fn middle(&self, brick: [u32; 3]) -> DVec3 {
        self.sample(brick.map(|n| n * BRICK_VOXELS)) + DVec3::splat(0.5 * f64::from(BRICK_VOXELS) * self.voxel)
    }

    /// All of it.
    pub fn bounds(&self) -> Aabb {
        Aabb::new(self.origin, self.corner(self.cells))
    }
}
