//! The cells of one component with their tapes, and the lookup of a point's cell.

use glam::DVec3;

use super::cell_encoding::{BRANCHES, CELL_REFINED, CELL_SHIFT, CELL_TAPE, OFFSET_MASK};
use super::grid::Grid;
use super::top_cell::TapeStats;

/// The cells of one component with their tapes.
#[derive(Clone, Debug, PartialEq)]
pub struct CellTree {
    /// The grid of the component's own space, relative to its origin; then those of its modifiers' contents, each in
    /// its own space, in the order of [`Component::modifier_domains`](crate::Component::modifier_domains).
    pub grids: Vec<Grid>,
    /// A header of [`HEADER_WORDS`](super::HEADER_WORDS) for each modifier content, the last one first: lower corner
    /// (3 floats), side of a top cell, counts (8 bits each), offset of its top cells, [`Grid::clear`]. Then for each
    /// grid the top cells (x fastest), blocks of children, and tape entries. Offsets count from the end of the
    /// headers.
    pub words: Vec<[u32; 2]>,
    /// The index of the word that offsets count from: the component's first top cell.
    pub start: usize,
    pub(super) starts: Vec<u32>,
    pub(super) lengths: Lengths,
}

/// The number of tape entries that an evaluation processes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Lengths {
    mean: f64,
    longest: u32,
}

impl Lengths {
    /// Adds the entries of a space that is evaluated up to `copies` times.
    pub fn add(&mut self, stats: &TapeStats, copies: u32) {
        let mean = if stats.faces > 0.0 { stats.sum / stats.faces } else { 0.0 };
        self.mean += mean * f64::from(copies).sqrt();
        self.longest = self.longest.saturating_add(stats.longest.saturating_mul(copies));
    }
}

/// The result of looking up a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cell<'a> {
    /// The point is outside of the grid.
    Outside,
    /// No surface is near: a step of `bound` meters from here reaches none. Negative inside.
    Empty {
        /// Its absolute value never exceeds that of the field.
        bound: f64,
    },
    /// These tape entries have the value of the whole component here.
    Tape(&'a [[u32; 2]]),
}

impl CellTree {
    /// The mean number of tape entries for a point in a cell with a tape, weighted by the area that the cells expose
    /// to rays.
    pub fn mean_length(&self) -> f64 {
        self.lengths.mean
    }

    /// The largest number of tape entries for a point.
    pub fn longest(&self) -> u32 {
        self.lengths.longest
    }

    /// Looks up `p` in the space of a grid: 0 for the component's own, relative to its origin.
    pub fn tape_at(&self, number: usize, p: DVec3) -> Cell<'_> {
        let grid = &self.grids[number];
        if grid.distance(p) > 0.0 {
            return Cell::Outside;
        }
        let words = &self.words[self.start..];
        let counts = DVec3::from(grid.counts.map(f64::from));
        let (mut low, mut side) = (grid.low, grid.side);
        let mut at = ((p - low) / side).floor().clamp(DVec3::ZERO, counts - 1.0);
        let mut word = words[self.starts[number] as usize + (at.x + counts.x * (at.y + counts.y * at.z)) as usize];
        loop {
            low += at * side;
            let offset = (word[0] & OFFSET_MASK) as usize;
            match word[0] >> CELL_SHIFT {
                CELL_TAPE => return Cell::Tape(&words[offset..offset + word[1] as usize]),
                CELL_REFINED => {
                    let branches = f64::from(BRANCHES);
                    side /= branches;
                    at = ((p - low) / side).floor().clamp(DVec3::ZERO, DVec3::splat(branches - 1.0));
                    word = words[offset + (at.x + branches * (at.y + branches * at.z)) as usize];
                }
                _ => {
                    let bound = f64::from(f32::from_bits(word[1]));
                    let way = p.distance(low + 0.5 * side);
                    return Cell::Empty { bound: bound - way * bound.signum() };
                }
            }
        }
    }
}
