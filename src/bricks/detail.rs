//! Where a level tells no more than the next coarser one, it has no bricks: detail is kept where it is.
//!
//! Samples of the coarser level are some of those of this one, and its interpolation is linear along the edges of these
//! voxels, too. Bricks beside one that is left out have on their common face what the coarser level tells there, so that
//! the field is continuous but for the rounding of samples, 1/64 of a voxel.

use glam::DVec3;

use super::decode::BrickKind;
use super::encode::cells;
use super::{BRICK_SAMPLES, BRICK_TEXELS, BRICK_VOXELS, BrickContent, Bricks, FADE_END, LEVEL_RATIO};

/// How far what a coarser level tells may be off where it stands in, in voxels of the finest level: coarser levels are
/// held to the same error, because they stand in for the finest, too.
pub const DETAIL: f64 = 1.0 / 20.0;
/// Distances beyond this need not agree, in voxels: no voxel reaches from here to where this level counts.
const DETAIL_REACH: f64 = FADE_END + 1.75;

impl Bricks {
    /// Whether samples around a point tell that this is its distance, in meters, closely enough to stand in for bricks
    /// with voxels half as large. `finest` is the size of the voxels of the finest level.
    pub fn tells(&self, p: DVec3, distance: f64, finest: f64) -> bool {
        let told = self.value(p);
        let reach = DETAIL_REACH / LEVEL_RATIO * self.voxel();
        let is_far = told.abs().min(distance.abs()) >= reach && (told < 0.0) == (distance < 0.0);
        is_far || (told - distance).abs() <= DETAIL * finest
    }

    /// Gives bricks beside those that are left out what the coarser level tells on their common face.
    pub(super) fn meet_coarser(&mut self, order: &[[u32; 3]]) {
        let Some(coarser) = self.coarser.clone() else { return };
        for (number, brick) in order.iter().enumerate() {
            for side in cells([3; 3]) {
                let neighbor = [0, 1, 2].map(|i| (brick[i] + side[i]).wrapping_sub(1));
                if self.content_kind(neighbor) != Some(BrickKind::Coarser) {
                    continue;
                }
                let run = |axis: usize| match side[axis] {
                    0 => 0..1,
                    1 => 0..BRICK_SAMPLES as u32,
                    _ => BRICK_VOXELS..BRICK_VOXELS + 1,
                };
                for (z, y) in run(2).flat_map(|z| run(1).map(move |y| (z, y))) {
                    for x in run(0) {
                        let p = self.grid.sample([0, 1, 2].map(|i| brick[i] * BRICK_VOXELS + [x, y, z][i]));
                        let byte = BrickContent::sample_byte(coarser.value(p) / self.voxel());
                        let index = x as usize + BRICK_SAMPLES * (y as usize + BRICK_SAMPLES * z as usize);
                        let texel = self.first_brick as usize + BRICK_TEXELS * number + index / 16;
                        let word = &mut self.texels[texel][index / 4 % 4];
                        let mut bytes = word.to_le_bytes();
                        bytes[index % 4] = byte;
                        *word = u32::from_le_bytes(bytes);
                    }
                }
            }
        }
    }
}
