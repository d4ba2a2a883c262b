//! Blocks of slabs that masks leave empty: a walk passes them whole. Counterpart of `shaders/copy/blocks.wgsl`.

use glam::{DVec2, DVec3};

use super::instancer::{FlatInstancer, FlatMask};
use super::noise::{Coordinate, copy_noise_2};
use isolith_scene::MaskKind;

/// Slabs of the first block that is tried.
const BLOCK_SLABS: i32 = 16;
/// Slabs of the one after it if that is not empty; an empty block is followed by one that is so many times as long.
const BLOCK_LEAST: i32 = 4;
/// Slabs of the largest block.
const BLOCK_MOST: i32 = 4096;
/// Upper bound of the slope of noise along an axis, per lattice point: that of t³ (6 t² − 15 t + 10).
const BLOCK_NOISE_SLOPE: f64 = 1.875;
/// Rounding of a share on the GPU.
const BLOCK_ROUNDING: f64 = 1e-3;
/// Rounding of places on the GPU, in relation to their coordinates.
const BLOCK_SLACK: f64 = 1e-5;

/// Which blocks a walk tries.
#[derive(Clone, Copy, Debug)]
pub(super) struct BlockWalk {
    /// Slabs of the next one.
    size: i32,
    /// Slabs until one is tried again.
    pause: i32,
}

impl BlockWalk {
    /// For an instancer; walks of those without masks try none.
    pub fn new() -> Self {
        Self { size: BLOCK_SLABS, pause: 0 }
    }

    /// The slabs of the block to try, of `left` ones; `None` to walk through the next slab.
    pub fn next(&mut self, left: i32) -> Option<i32> {
        if self.pause == 0 && left >= BLOCK_LEAST {
            return Some(self.size.min(left));
        }
        self.pause = (self.pause - 1).max(0);
        None
    }

    /// Learns whether the block was empty.
    pub fn learn(&mut self, is_empty: bool) {
        if is_empty {
            self.size = (self.size * BLOCK_LEAST).min(BLOCK_MOST);
        } else if self.size > BLOCK_LEAST {
            self.size = BLOCK_LEAST;
        } else {
            *self = Self { size: BLOCK_SLABS, pause: BLOCK_LEAST };
        }
    }
}

/// The least and the most that the share of a mask may be in a box of places.
fn mask_range(mask: &FlatMask, center: DVec3, half: DVec3) -> [f64; 2] {
    let [a, b, c, _] = mask.params;
    let range = match mask.kind {
        MaskKind::Noise => {
            let off = BLOCK_NOISE_SLOPE * c * (half.x + half.z);
            let noise = copy_noise_2(mask.key, [center.x, center.z].map(|v| Coordinate::new(v * c)));
            [noise - off, noise + off].map(|noise| (noise - a) / b + 0.5)
        }
        MaskKind::Height => {
            let [low, high] = [center.y - half.y, center.y + half.y];
            let share = |y: f64| (y / c).clamp(0.0, 1.0);
            [share(low - a) * share(b - high), share(high - a) * share(b - low)]
        }
        MaskKind::Radius => {
            let [away, half] = [DVec2::new(center.x, center.z).abs(), DVec2::new(half.x, half.z)];
            let [far, near] = [(away + half).length(), (away - half).max(DVec2::ZERO).length()];
            [far, near].map(|distance| (b - distance) / (b - a))
        }
        // It depends on the ground, of which a lattice has none.
        MaskKind::Slope => [0.0, 1.0],
    };
    let [least, most] = [range[0] - BLOCK_ROUNDING, range[1] + BLOCK_ROUNDING].map(|share: f64| share.clamp(0.0, 1.0));
    if mask.inverted { [1.0 - most, 1.0 - least] } else { [least, most] }
}

/// Whether masks let no copy stand in a box of places.
pub(super) fn block_is_empty(instancer: &FlatInstancer, low: DVec3, high: DVec3) -> bool {
    let center = 0.5 * (low + high);
    let half = 0.5 * (high - low) + BLOCK_SLACK * (center.abs() + 1.0);
    instancer.masks.iter().any(|mask| mask_range(mask, center, half)[1] <= BLOCK_ROUNDING)
}
