//! Bricks of one solid in voxels of several sizes.
//!
//! Samples reach only as far as four voxels. Farther from the surface coarser bricks take over, each level with voxels
//! four times as large. Together they are one continuous field, a lower bound of the distance to the surface of the
//! finest:
//!
//! - of the finest, the interpolated distance, exact in sign and zeros;
//! - of the others, the interpolated distance less [`BrickLevels::error`];
//! - each over its greatest slope anywhere, so that the slope of the field is at most 1;
//! - the greatest of these.
//!
//! A level whose samples do not reach their end is greater than all coarser ones, so these need no look.

use std::sync::Arc;

use super::{BrickError, Bricks};

/// Most levels: at four times the size each, the last reaches 256 voxels of the first.
pub const MAX_LEVELS: usize = 4;
/// The size of a voxel in voxels of the next finer level.
pub const LEVEL_RATIO: f64 = 4.0;

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

    /// How much the interpolated distance of a level after the first may exceed the distance to the surface of the
    /// finest, in meters: half a diagonal of a voxel, since distances have slopes of at most 1; half a step of its
    /// samples; and how far the surface of the finest is from that of the solid, at most a voxel.
    pub fn error(&self, level: usize) -> f64 {
        let voxel = self.all[level].grid.voxel;
        (0.75_f64.sqrt() + 0.5 / super::SAMPLE_STEPS + 0.1) * voxel + self.finest().grid.voxel
    }

    /// Texels of all levels.
    pub fn texels(&self) -> usize {
        self.all.iter().map(|bricks| bricks.texels.len()).sum()
    }
}
