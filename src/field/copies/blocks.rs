//! Blocks of slabs that masks leave empty: a walk passes them whole. Counterpart of `shaders/copy/blocks.wgsl`.

use glam::DVec3;

use super::instancer::FlatInstancer;
use super::masks::copy_masks_most;

/// Slabs of the first block that is tried.
const BLOCK_SLABS: i32 = 16;
/// Slabs of the one after it if that is not empty; an empty block is followed by one that is so many times as long.
const BLOCK_LEAST: i32 = 4;
/// Slabs of the largest block.
const BLOCK_MOST: i32 = 4096;
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

/// Whether masks let no copy stand in a box of places.
pub(super) fn block_is_empty(instancer: &FlatInstancer, low: DVec3, high: DVec3) -> bool {
    let center = 0.5 * (low + high);
    let half = 0.5 * (high - low) + BLOCK_SLACK * (center.abs() + 1.0);
    copy_masks_most(instancer, center, half) <= 0.0
}
