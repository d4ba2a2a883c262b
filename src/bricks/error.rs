//! Why there are no bricks.

use super::{MAX_BRICK_TEXELS, RESOLUTIONS};

/// Why distances cannot be bricks.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum BrickError {
    /// Too many.
    #[error(
        "needs {texels} texels of 16 bytes, and at most {MAX_BRICK_TEXELS} are available: choose a lower resolution"
    )]
    TooLarge {
        /// How many texels it would take.
        texels: usize,
    },
    /// The voxels are too small for what they measure.
    #[error("takes {voxels} voxels along its longest side, and at most {} are possible: choose larger voxels", RESOLUTIONS[1])]
    TooFine {
        /// How many it would take.
        voxels: u64,
    },
    /// There is nothing to measure.
    #[error("has nothing to measure: no triangle with an area, no solid")]
    Empty,
    /// It reaches without end.
    #[error("has no end, so that no number of voxels holds it")]
    Endless,
    /// It cannot be measured, for this reason.
    #[error("{0}")]
    Refused(String),
    /// The size of the voxels is not one.
    #[error("needs voxels whose size is a positive number")]
    Voxel,
    /// The maker stopped.
    #[error("was canceled")]
    Canceled,
}
