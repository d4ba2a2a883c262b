//! Bricks of one solid in voxels of several sizes.
//!
//! Samples reach only as far as four voxels. Farther from the surface coarser bricks take over, each level with voxels
//! twice as large. From two voxels to the end of its samples, the distance by one level fades into that by the next, so
//! that the field is continuous, and times [`BrickLevels::scale`] it is a lower bound of the distance to the surface of
//! the finest, exact in sign and zeros.

use std::sync::Arc;

use super::{BrickError, Bricks};

/// Most levels: at twice the size each, the last reaches 512 voxels of the first.
pub const MAX_LEVELS: usize = 8;
/// The size of a voxel in voxels of the next finer level.
pub const LEVEL_RATIO: f64 = 2.0;
/// From this distance on a level fades into the next, in voxels.
pub const FADE_START: f64 = 2.0;
/// How much steeper the fading may make the field, over its scale: the difference of two levels, about a third of a voxel
/// at most where both are known, over the two voxels of the fading.
const FADE_SLOPE: f64 = 0.2;

/// Bricks in voxels of several sizes, the finest first; never empty.
#[derive(Clone, Debug, PartialEq)]
pub struct BrickLevels {
    all: Vec<Arc<Bricks>>,
}

impl BrickLevels {
    /// These levels, the finest first; `None` if there are none.
    pub fn new(all: Vec<Arc<Bricks>>) -> Option<Self> {
        (!all.is_empty() && all.len() <= MAX_LEVELS).then_some(Self { all })
    }

    /// The levels that `make` makes for each size of voxels.
    ///
    /// # Errors
    /// `make` returns one.
    pub fn made(voxel: f64, make: &mut dyn FnMut(f64) -> Result<Bricks, BrickError>) -> Result<Self, BrickError> {
        let mut all = vec![Arc::new(make(voxel)?)];
        while let Some(next) = Self::coarser(&all[all.len() - 1], all.len()) {
            all.push(Arc::new(make(next)?));
        }
        Ok(Self { all })
    }

    /// The size of the voxels of the level after `levels` levels, whose last one is this; `None` if none is needed.
    pub fn coarser(last: &Bricks, levels: usize) -> Option<f64> {
        let is_small = last.grid.cells.iter().all(|n| *n <= 1);
        (levels < MAX_LEVELS && !is_small).then_some(last.grid.voxel * LEVEL_RATIO)
    }

    /// All of them, the finest first.
    pub fn all(&self) -> &[Arc<Bricks>] {
        &self.all
    }

    /// The finest.
    pub fn finest(&self) -> &Bricks {
        &self.all[0]
    }

    /// The factor on interpolated distances. Two reasons bound it. The interpolation of samples of a function with slopes
    /// of at most 1 is off by at most half a diagonal of a voxel, and half a step of the samples; a level after the first
    /// counts where the distance is at least one of its voxels. And the slope of the field is at most 1.
    pub fn scale(&self) -> f64 {
        let off = 0.75_f64.sqrt() + 0.5 / super::SAMPLE_STEPS;
        let steepest = self.all.iter().fold(1.0_f64, |most, bricks| most.max(bricks.slope()));
        let nearest = FADE_START / LEVEL_RATIO + 0.5;
        (nearest / (nearest + off)).max(1.0 / (1.0 + 0.5 * off)).min(1.0 / (steepest + FADE_SLOPE))
    }

    /// Texels of all levels.
    pub fn texels(&self) -> usize {
        self.all.iter().map(|bricks| bricks.texels.len()).sum()
    }
}
