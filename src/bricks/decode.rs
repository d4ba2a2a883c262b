//! Texels as distances again.

use glam::DVec3;

use super::{
    BRICK_SAMPLES, BRICK_TEXELS, BRICK_VOLUME, BRICK_VOXELS, BrickContent, Bricks, CELL_BRICKS, INSIDE, SAMPLE_STEPS,
};

impl Bricks {
    /// What is known of a brick; `None` in a cell without entries, and outside of the grid. The slope is that of the
    /// entry.
    pub fn content(&self, brick: [u32; 3]) -> Option<BrickContent> {
        let entry = self.entry(brick)?;
        if entry >> 31 == 0 {
            let voxels = f64::from(entry & 0xff_ffff) / 16.0;
            return Some(BrickContent::Far(if entry >> 30 & 1 == 1 { -voxels } else { voxels }));
        }
        let slope = 1.0 + f64::from(entry >> 24 & 0x7f) / 64.0;
        let mut samples = Box::new([0; BRICK_VOLUME]);
        let bytes =
            self.brick_texels((entry & 0xff_ffff) as usize)?.iter().flatten().flat_map(|word| word.to_le_bytes());
        samples.iter_mut().zip(bytes).for_each(|(sample, byte)| *sample = byte);
        Some(BrickContent::Near { samples, slope })
    }

    /// The distance between the samples around a point, in meters; `None` where there are none.
    pub fn interpolated(&self, p: DVec3) -> Option<f64> {
        let (brick, [x, y, z], part) = self.voxel_around(p)?;
        let texels = self.brick_texels(brick)?;
        let value = |i: usize| {
            let index = x + (i & 1) + BRICK_SAMPLES * (y + (i >> 1 & 1) + BRICK_SAMPLES * (z + (i >> 2)));
            let byte = texels[index / 16][index / 4 % 4].to_le_bytes()[index % 4];
            (f64::from(byte) - 128.0) / SAMPLE_STEPS
        };
        let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
        let along = |i: usize| mix(value(i), value(i + 1), part.x);
        let flat = |i: usize| mix(along(i), along(i + 2), part.y);
        Some(mix(flat(0), flat(4), part.z) * self.grid.voxel)
    }

    /// The voxel around a point: the number of its brick, its place in the brick, and the place of the point in it, from 0
    /// to 1; `None` where there are no samples.
    pub(super) fn voxel_around(&self, p: DVec3) -> Option<(usize, [usize; 3], DVec3)> {
        let at = (p - self.grid.origin) / self.grid.voxel;
        let last = DVec3::from(self.grid.bricks().map(|n| f64::from(n * BRICK_VOXELS))) - 1.0;
        // Also refuses what is not a number.
        if !(at.cmpge(DVec3::ZERO).all() && at.cmple(last + 1.0).all()) {
            return None;
        }
        let corner = at.floor().min(last);
        let voxel = corner.to_array().map(|v| v as u32);
        let entry = self.entry(voxel.map(|n| n / BRICK_VOXELS)).filter(|entry| entry >> 31 == 1)?;
        Some(((entry & 0xff_ffff) as usize, voxel.map(|n| (n % BRICK_VOXELS) as usize), at - corner))
    }

    /// Whether a cell without entries is inside; `None` for one with entries, and outside of the grid.
    pub fn side(&self, cell: [u32; 3]) -> Option<bool> {
        let cell = self.cell_index(cell)?;
        let place = self.texels.get(cell / 4)?[cell % 4];
        (place >= INSIDE).then_some(place == INSIDE)
    }

    fn cell_index(&self, cell: [u32; 3]) -> Option<usize> {
        let [nx, ny, _] = self.grid.cells.map(|n| n as usize);
        let is_there = (0..3).all(|i| cell[i] < self.grid.cells[i]);
        is_there.then(|| cell[0] as usize + nx * (cell[1] as usize + ny * cell[2] as usize))
    }

    fn entry(&self, brick: [u32; 3]) -> Option<u32> {
        let cell = self.cell_index(brick.map(|n| n / CELL_BRICKS))?;
        let place = self.texels.get(cell / 4)?[cell % 4];
        if place >= INSIDE {
            return None;
        }
        let [x, y, z] = brick.map(|n| (n % CELL_BRICKS) as usize);
        let own = x + 2 * (y + 2 * z);
        let first = self.grid.cell_count().div_ceil(4) + 2 * place as usize;
        Some(self.texels.get(first + own / 4)?[own % 4])
    }

    fn brick_texels(&self, brick: usize) -> Option<&[[u32; 4]]> {
        let first = self.first_brick as usize + brick * BRICK_TEXELS;
        self.texels.get(first..first + BRICK_TEXELS)
    }
}
