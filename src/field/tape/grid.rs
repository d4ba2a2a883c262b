//! The grid of a space's top cells.

use glam::DVec3;

use super::cell_encoding::{BRANCHES, HEADER_WORDS};
use crate::ModifierDomain;
use isolith_geometry::Aabb;

/// The margin of the grid around the component's bounds on each side, as a fraction of their largest extent.
pub const MARGIN_SHARE: f64 = 0.05;
/// The slack for rounding in f32, relative to the size of coordinates.
pub(super) const SIZE_SLACK: f64 = 1e-6;

/// The grid of a space's top cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// The lower corner, in meters.
    pub low: DVec3,
    /// The edge of a top cell (a cube), in meters.
    pub side: f64,
    /// Top cells along each axis, 1 to [`BRANCHES`].
    pub counts: [u32; 3],
    /// The least distance from outside of the grid to the surface, in meters.
    pub clear: f64,
}

impl Grid {
    /// A space without a grid: one infinite cell in which all entries matter.
    pub const ONE_CELL: Self = Self { low: DVec3::splat(-1e18), side: 2e18, counts: [1; 3], clear: 0.0 };

    /// The distance from `p` in meters, 0 inside.
    pub(super) fn distance(&self, p: DVec3) -> f64 {
        let high = self.low + self.side * DVec3::from(self.counts.map(f64::from));
        (self.low - p).max(p - high).max(DVec3::ZERO).length()
    }

    /// The grid around the content of a domain whose field must be exact up to `exact` meters; one cell for an
    /// infinite content.
    pub(super) fn around(content: &ModifierDomain, exact: f64) -> Self {
        let bounds = match content.bound_slope {
            _ if exact == 0.0 => content.bounds,
            bound_slope if bound_slope > 0.0 => content.bounds.union(&content.cull_box.expanded(exact / bound_slope)),
            _ => Aabb::EVERYTHING,
        };
        let largest = 2.0 * bounds.half().max_element();
        if !bounds.is_finite() || bounds.is_empty() || largest <= 0.0 || largest > Self::ONE_CELL.side {
            return Self::ONE_CELL;
        }
        let margin = MARGIN_SHARE * largest;
        let side = (largest + 2.0 * margin) / f64::from(BRANCHES);
        // The cells divide the largest extent exactly, whatever the rounding.
        let counts = (2.0 * (bounds.half() + margin) / side).to_array().map(|n| (n.ceil() as u32).clamp(1, BRANCHES));
        Self { low: bounds.min - margin, side, counts, clear: exact + margin }
    }

    pub(super) fn cells(&self) -> usize {
        self.counts.iter().product::<u32>() as usize
    }

    pub(super) fn cube(&self, index: usize) -> Cube {
        let [nx, ny, _] = self.counts.map(|n| n as usize);
        let at = DVec3::new((index % nx) as f64, (index / nx % ny) as f64, (index / nx / ny) as f64);
        Cube { low: self.low + at * self.side, side: self.side }
    }

    /// The GPU's form of the grid: its values as bits of f32, and the offset of its top cells.
    pub(super) fn header(&self, at: u32) -> [[u32; 2]; HEADER_WORDS] {
        let [x, y, z] = self.low.as_vec3().to_array().map(f32::to_bits);
        let [nx, ny, nz] = self.counts;
        // Slightly less, as slack for rounding in f32.
        let clear = (self.clear * (1.0 - 1e-4)) as f32;
        [[x, y], [z, (self.side as f32).to_bits()], [nx | ny << 8 | nz << 16, at], [clear.to_bits(), 0]]
    }
}

/// A cube: its lower corner and its edge, in meters.
#[derive(Clone, Copy)]
pub(super) struct Cube {
    pub low: DVec3,
    pub side: f64,
}

impl Cube {
    pub fn center(&self) -> DVec3 {
        self.low + 0.5 * self.side
    }

    /// The piece at `index` (x fastest) of the cube after cutting each edge into `pieces`.
    pub fn piece(&self, index: usize, pieces: u32) -> Self {
        let (side, n) = (self.side / f64::from(pieces), pieces as usize);
        let at = DVec3::new((index % n) as f64, (index / n % n) as f64, (index / n / n) as f64);
        Self { low: self.low + at * side, side }
    }
}
