//! Texels as distances again.

use glam::DVec3;
use rayon::prelude::*;

use super::{
    BRICK_COARSER, BRICK_INSIDE, BRICK_SAMPLES, BRICK_TEXELS, BRICK_VOLUME, BRICK_VOXELS, BrickContent, Bricks,
    CELL_BRICKS, COARSER, HAS_SAMPLES, INSIDE, NO_ENTRIES, SAMPLE_REACH, SAMPLE_STEPS,
};

/// What there is of a brick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BrickKind {
    Empty { is_inside: bool },
    Samples(usize),
    Coarser,
}

/// The samples of a brick.
pub(super) fn samples(texels: &[[u32; 4]]) -> Box<[u8; BRICK_VOLUME]> {
    let mut samples = Box::new([0; BRICK_VOLUME]);
    let bytes = texels.iter().flatten().flat_map(|word| word.to_le_bytes());
    samples.iter_mut().zip(bytes).for_each(|(sample, byte)| *sample = byte);
    samples
}

impl Bricks {
    /// What is known of a brick; `None` outside of the grid.
    pub fn content(&self, brick: [u32; 3]) -> Option<BrickContent> {
        Some(match self.content_kind(brick)? {
            BrickKind::Samples(number) => BrickContent::Samples(samples(self.brick_texels(number)?)),
            BrickKind::Empty { is_inside } => BrickContent::Empty { is_inside },
            BrickKind::Coarser => BrickContent::Coarser,
        })
    }

    /// The greatest slope of the interpolation of its samples anywhere; at least 1.
    pub fn slope(&self) -> f64 {
        let bricks = self.texels[self.first_brick as usize..].par_chunks_exact(BRICK_TEXELS);
        bricks.map(|texels| BrickContent::slope(&samples(texels))).reduce(|| 1.0, f64::max)
    }

    /// The distance between the samples around a point, in meters, of the first level that has some there; `None` where
    /// none has.
    pub fn interpolated(&self, p: DVec3) -> Option<f64> {
        let (kind, [x, y, z], part) = self.voxel_around(p)?;
        let texels = match kind {
            BrickKind::Samples(number) => self.brick_texels(number)?,
            BrickKind::Coarser => return self.coarser.as_ref()?.interpolated(p),
            BrickKind::Empty { .. } => return None,
        };
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

    /// The same, and without samples the distance that they reach, with the sign of the side.
    pub(super) fn value(&self, p: DVec3) -> f64 {
        self.interpolated(p).unwrap_or_else(|| {
            let reach = SAMPLE_REACH * self.voxel();
            match self.voxel_around(p) {
                Some((BrickKind::Empty { is_inside: true }, ..)) => -reach,
                Some((BrickKind::Coarser, ..)) => self.coarser.as_ref().map_or(reach, |coarser| coarser.value(p)),
                _ => reach,
            }
        })
    }

    /// What there is of a brick; `None` outside of the grid.
    pub(super) fn content_kind(&self, brick: [u32; 3]) -> Option<BrickKind> {
        Some(match self.entry(brick)? {
            entry if entry & HAS_SAMPLES != 0 => BrickKind::Samples((entry & 0xff_ffff) as usize),
            BRICK_COARSER => BrickKind::Coarser,
            entry => BrickKind::Empty { is_inside: entry & BRICK_INSIDE != 0 },
        })
    }

    /// The voxel around a point: what there is of its brick, its place in the brick, and the place of the point in it,
    /// from 0 to 1; `None` outside of the grid.
    pub(super) fn voxel_around(&self, p: DVec3) -> Option<(BrickKind, [usize; 3], DVec3)> {
        let at = (p - self.grid.origin) / self.grid.voxel;
        let last = DVec3::from(self.grid.bricks().map(|n| f64::from(n * BRICK_VOXELS))) - 1.0;
        // Also refuses what is not a number.
        if !(at.cmpge(DVec3::ZERO).all() && at.cmple(last + 1.0).all()) {
            return None;
        }
        let corner = at.floor().min(last);
        let voxel = corner.to_array().map(|v| v as u32);
        let kind = self.content_kind(voxel.map(|n| n / BRICK_VOXELS))?;
        Some((kind, voxel.map(|n| (n % BRICK_VOXELS) as usize), at - corner))
    }

    fn cell_index(&self, cell: [u32; 3]) -> Option<usize> {
        let [nx, ny, _] = self.grid.cells.map(|n| n as usize);
        let is_there = (0..3).all(|i| cell[i] < self.grid.cells[i]);
        is_there.then(|| cell[0] as usize + nx * (cell[1] as usize + ny * cell[2] as usize))
    }

    /// The entry of a brick; `None` outside of the grid.
    pub(super) fn entry(&self, brick: [u32; 3]) -> Option<u32> {
        let cell = self.cell_index(brick.map(|n| n / CELL_BRICKS))?;
        let place = match self.texels.get(cell / 4)?[cell % 4] {
            NO_ENTRIES => return Some(0),
            INSIDE => return Some(BRICK_INSIDE),
            COARSER => return Some(BRICK_COARSER),
            place => place,
        };
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
