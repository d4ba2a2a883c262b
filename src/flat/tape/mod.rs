//! Tapes: where in space which entries of a large component matter.
//!
//! Space is cut into cells, and each cell keeps only the entries that can matter in it. All fields are
//! 1-Lipschitz: over a cell of half diagonal R two operands come closer to each other than at its center
//! by at most 2R. Where they differ there by the support of their blend plus 2R, the blend is exactly
//! the hard operator in the whole cell, one operand has no part in it, and what is left has the same
//! value to the last bit. The same argument says where no surface is. (Barbier et al., "Lipschitz
//! Pruning: Hierarchical Simplification of Primitive-Based SDFs", 2025.)
//!
//! | file | what it does |
//! |---|---|
//! | `tape_entry` | the words of a tape |
//! | `domain` | the spaces of a component that have tapes: its own, and that of each modifier's content |
//! | `entry` | a component's entries as numbers to evaluate with |
//! | `program` | a tape at one point: its value, and the shorter tape that is enough around the point |
//! | `top_cell` | everything in one top cell |
//! | `build` | the grid of a component, and its top cells as one array |
//! | `field` | the field by the tapes: counterpart of the shader |
//! | `cached_tree` | one component's tree and what it was made from: made anew only where an edit reached |
//! | `tape_cache` | trees kept between frames |
//! | `worker` | makes them beside the frames |

mod build;
mod cached_tree;
mod domain;
mod entry;
mod field;
mod program;
mod tape_cache;
mod tape_entry;
#[cfg(test)]
mod tests;
mod top_cell;
mod worker;

use glam::DVec3;

use top_cell::TapeStats;

pub use field::tape_field;
pub use tape_cache::TapeCache;
pub use tape_entry::{MAX_TAPE_ENTRIES, TapeEntry, TapeOp};

use super::{Component, FlatScene};

/// Components of at least so many entries have tapes: those of fewer are walked as fast without.
const LEAST_TAPE_ENTRIES: u32 = 5;
/// The same with modifiers, whose kernel has more to do for a tape.
const LEAST_MODIFIED_ENTRIES: u32 = 24;
/// What the grid keeps clear around the component's bounds on each side, as a share of their largest extent.
pub const MARGIN_SHARE: f64 = 0.05;
/// Cells along each axis of a block, and top cells along the largest extent.
pub const BRANCHES: u32 = 4;
/// Cells of a block.
pub const BLOCK_CELLS: usize = (BRANCHES * BRANCHES * BRANCHES) as usize;
/// Kinds of cells above one another: 4, 16 and 64 along the largest extent.
pub const LEVELS: u32 = 3;

/// No surface in the cell: the second word is the bound at its center, as the bits of an f32.
pub const CELL_EMPTY: u32 = 0;
/// The first word holds the offset of the cell's first tape entry, the second how many they are.
pub const CELL_TAPE: u32 = 1;
/// The first word holds the offset of the cell's block of [`BLOCK_CELLS`] children, x fastest.
pub const CELL_REFINED: u32 = 2;
/// Where what a cell is stands in its first word; below it is the offset.
pub const CELL_SHIFT: u32 = 30;
/// The offset in a cell's first word.
pub const OFFSET_MASK: u32 = (1 << CELL_SHIFT) - 1;

/// Words before the cells of a component for each of its contents: the grid, see [`CellTree::words`].
pub const HEADER_WORDS: usize = 4;
/// Most contents of a component that has tapes: what a tape entry can name.
pub const MAX_TAPE_DOMAINS: usize = 255;
/// Of the size of coordinates, for rounding in f32.
const SIZE_SLACK: f64 = 1e-6;

/// Where the top cells of a space lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// The lower corner, in meters.
    pub low: DVec3,
    /// The edge of a top cell (a cube), in meters.
    pub side: f64,
    /// Top cells along each axis, 1 to [`BRANCHES`].
    pub counts: [u32; 3],
    /// How far from the surface everything outside is at least, in meters.
    pub clear: f64,
}

impl Grid {
    /// Of a space that has no grid: one cell without end, in which all matters.
    pub const ONE_CELL: Self = Self { low: DVec3::splat(-1e18), side: 2e18, counts: [1; 3], clear: 0.0 };

    /// The distance from `p` in meters, 0 inside.
    fn distance(&self, p: DVec3) -> f64 {
        let high = self.low + self.side * DVec3::from(self.counts.map(f64::from));
        (self.low - p).max(p - high).max(DVec3::ZERO).length()
    }
}

/// The cells of one component with their tapes.
#[derive(Clone, Debug, PartialEq)]
pub struct CellTree {
    /// The grid of the component's own space, relative to its origin; then those of what its modifiers hold, each in its
    /// own space, as [`Component::modifier_domains`] names them.
    pub grids: Vec<Grid>,
    /// A header of [`HEADER_WORDS`] for each content, the last one first: lower corner (3 floats), side of a top cell,
    /// counts (8 bits each), where its top cells stand, [`Grid::clear`]. Then for each grid the top cells (x fastest),
    /// blocks of children, and tape entries. Offsets count from behind the headers.
    pub words: Vec<[u32; 2]>,
    /// Where the words begin from which offsets count: the component's own top cells.
    pub start: usize,
    starts: Vec<u32>,
    lengths: Lengths,
}

/// How many tape entries are walked.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Lengths {
    mean: f64,
    longest: u32,
}

impl Lengths {
    /// Adds what is walked in a space that is visited up to `copies` times.
    fn add(&mut self, stats: &TapeStats, copies: u32) {
        let mean = if stats.faces > 0.0 { stats.sum / stats.faces } else { 0.0 };
        self.mean += mean * f64::from(copies).sqrt();
        self.longest = self.longest.saturating_add(stats.longest.saturating_mul(copies));
    }
}

/// What the tapes say about a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cell<'a> {
    /// The point is outside of the grid.
    Outside,
    /// No surface is near: from here a step of `bound` meters reaches none. Negative in the inside.
    Empty {
        /// Never farther from 0 than the field.
        bound: f64,
    },
    /// These tape entries have the value of the whole component here.
    Tape(&'a [[u32; 2]]),
}

/// Whether a component has tapes: it, or what a modifier in it holds, must be bounded and large enough for them to pay.
pub fn has_tape(flat: &FlatScene, component: &Component) -> bool {
    let least = least_entries(component);
    component.count >= least && has_domains(flat, component, least)
}

/// So many entries of its own space, or of what a modifier holds, have tapes.
fn least_entries(component: &Component) -> u32 {
    if component.is_modified() { LEAST_MODIFIED_ENTRIES } else { LEAST_TAPE_ENTRIES }
}

/// Whether a component may have tapes, however small it is.
fn can_have_tape(flat: &FlatScene, component: &Component) -> bool {
    has_domains(flat, component, 1)
}

fn has_domains(flat: &FlatScene, component: &Component, least: u32) -> bool {
    component.count <= MAX_TAPE_ENTRIES
        && component.modifier_domains.len() <= MAX_TAPE_DOMAINS
        && domain::domains(flat, component, least).is_some()
}

impl CellTree {
    /// The tapes of a component, which must be one that may have some, however small it is.
    pub fn build(flat: &FlatScene, component: &Component) -> Self {
        build::Build::new(flat, component).fresh().0
    }

    /// Tape entries that a point in a cell with a tape meets, about: the mean, weighted by the area that the
    /// cells show to rays.
    pub fn mean_length(&self) -> f64 {
        self.lengths.mean
    }

    /// Tape entries that are walked for a point at most.
    pub fn longest(&self) -> u32 {
        self.lengths.longest
    }

    /// What the tapes say about `p` in the space of a grid: 0 for the component's own, relative to its origin.
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
