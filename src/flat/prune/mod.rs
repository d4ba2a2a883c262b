//! Pruned lists: where in space which entries of a large component matter.
//!
//! Space is cut into cells, and each cell keeps only the entries that can matter in it. All fields are
//! 1-Lipschitz: over a cell of half diagonal R two operands come closer to each other than at its centre
//! by at most 2R. Where they differ there by the support of their blend plus 2R, the joint is exactly
//! the hard operator in the whole cell, one operand has no part in it, and what is left has the same
//! value to the last bit. The same argument says where no surface is. (Barbier et al., "Lipschitz
//! Pruning: Hierarchical Simplification of Primitive-Based SDFs", 2025.)
//!
//! | file | what it does |
//! |---|---|
//! | `token` | the words of a list |
//! | `entry` | a component's entries as numbers to evaluate with |
//! | `program` | a list at one point: its value, and the shorter list that is enough around the point |
//! | `part` | everything in one top cell |
//! | `build` | the grid of a component, and its parts as one array |
//! | `field` | the field by the lists: twin of the shader |
//! | `kept` | one component's tree and what it was made from: made anew only where an edit reached |
//! | `pruner` | trees kept between frames |
//! | `worker` | makes them beside the frames |

mod build;
mod entry;
mod field;
mod kept;
mod part;
mod program;
mod pruner;
#[cfg(test)]
mod tests;
mod token;
mod worker;

use glam::DVec3;

pub use field::pruned_field;
pub use pruner::Pruner;
pub use token::{MAX_PRUNED_ENTRIES, Token, TokenOp};

use super::{Component, FlatScene};

/// Components of at least so many entries have lists: those of fewer are walked as fast without.
pub const LEAST_PRUNED_ENTRIES: u32 = 24;
/// What the grid keeps clear around the component's bounds on each side, as a share of their largest extent.
pub const MARGIN_SHARE: f64 = 0.05;
/// Cells along each axis of a block, and top cells along the largest extent.
pub const BRANCHES: u32 = 4;
/// Cells of a block.
pub const BLOCK_CELLS: usize = (BRANCHES * BRANCHES * BRANCHES) as usize;
/// Kinds of cells above one another: 4, 16 and 64 along the largest extent.
pub const LEVELS: u32 = 3;

/// No surface in the cell: the second word is the bound at its centre, as the bits of an f32.
pub const CELL_EMPTY: u32 = 0;
/// The first word holds the offset of the cell's first token, the second how many they are.
pub const CELL_LIST: u32 = 1;
/// The first word holds the offset of the cell's block of [`BLOCK_CELLS`] children, x fastest.
pub const CELL_REFINED: u32 = 2;
/// Where what a cell is stands in its first word; below it is the offset.
pub const CELL_SHIFT: u32 = 30;
/// The offset in a cell's first word.
pub const OFFSET_MASK: u32 = (1 << CELL_SHIFT) - 1;

/// The cells of one component with their lists.
#[derive(Clone, Debug, PartialEq)]
pub struct CellTree {
    /// The lower corner of the grid, in metres, relative to the component's origin.
    pub low: DVec3,
    /// The edge of a top cell (a cube), in metres.
    pub side: f64,
    /// Top cells along each axis, 1 to [`BRANCHES`].
    pub counts: [u32; 3],
    /// The top cells (x fastest), then blocks of children, then all tokens. Offsets count from the start.
    pub words: Vec<[u32; 2]>,
    lengths: Lengths,
}

/// How long lists are.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Lengths {
    /// The area that cells with lists show to rays, in faces of a top cell.
    faces: f64,
    /// Tokens, weighted by it.
    sum: f64,
    longest: u32,
}

impl Lengths {
    fn add(&mut self, other: &Self) {
        self.faces += other.faces;
        self.sum += other.sum;
        self.longest = self.longest.max(other.longest);
    }
}

/// What the lists say about a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cell<'a> {
    /// The point is outside of the grid.
    Outside,
    /// No surface is near: from here a step of `bound` metres reaches none. Negative in the inside.
    Empty {
        /// Never farther from 0 than the field.
        bound: f64,
    },
    /// These tokens have the value of the whole component here.
    List(&'a [[u32; 2]]),
}

/// Whether a component has lists: it must be bounded, and large enough for them to pay.
pub fn is_pruned(component: &Component) -> bool {
    component.count >= LEAST_PRUNED_ENTRIES && can_be_pruned(component)
}

/// Whether a component may have lists, however small it is.
fn can_be_pruned(component: &Component) -> bool {
    let bounds = &component.bounds;
    // Copies are seen only where they can matter, so over a cell their field may jump.
    !component.modified
        && component.count <= MAX_PRUNED_ENTRIES
        && bounds.is_finite()
        && !bounds.is_empty()
        && bounds.half().max_element() > 0.0
}

impl CellTree {
    /// The lists of a component, which must be one that [`is_pruned`].
    pub fn build(flat: &FlatScene, component: &Component) -> Self {
        build::Build::new(flat, component).fresh().0
    }

    /// Tokens that a point in a cell with a list meets, about: the mean, weighted by the area that the
    /// cells show to rays.
    pub fn mean_length(&self) -> f64 {
        if self.lengths.faces > 0.0 { self.lengths.sum / self.lengths.faces } else { 0.0 }
    }

    /// Tokens of the longest list.
    pub fn longest(&self) -> u32 {
        self.lengths.longest
    }

    /// How far the grid reaches beyond the component's bounds, in metres.
    pub fn margin(&self) -> f64 {
        self.side * f64::from(BRANCHES) * MARGIN_SHARE / (1.0 + 2.0 * MARGIN_SHARE)
    }

    /// What the lists say about `p`, which is relative to the component's origin.
    pub fn list_at(&self, p: DVec3) -> Cell<'_> {
        if self.distance(p) > 0.0 {
            return Cell::Outside;
        }
        let counts = DVec3::from(self.counts.map(f64::from));
        let (mut low, mut side) = (self.low, self.side);
        let mut at = ((p - low) / side).floor().clamp(DVec3::ZERO, counts - 1.0);
        let mut word = self.words[(at.x + counts.x * (at.y + counts.y * at.z)) as usize];
        loop {
            low += at * side;
            let offset = (word[0] & OFFSET_MASK) as usize;
            match word[0] >> CELL_SHIFT {
                CELL_LIST => return Cell::List(&self.words[offset..offset + word[1] as usize]),
                CELL_REFINED => {
                    let branches = f64::from(BRANCHES);
                    side /= branches;
                    at = ((p - low) / side).floor().clamp(DVec3::ZERO, DVec3::splat(branches - 1.0));
                    word = self.words[offset + (at.x + branches * (at.y + branches * at.z)) as usize];
                }
                _ => {
                    let bound = f64::from(f32::from_bits(word[1]));
                    let way = p.distance(low + 0.5 * side);
                    return Cell::Empty { bound: bound - way * bound.signum() };
                }
            }
        }
    }

    /// The distance from `p` to the grid in metres, 0 inside.
    pub fn distance(&self, p: DVec3) -> f64 {
        let high = self.low + self.side * DVec3::from(self.counts.map(f64::from));
        (self.low - p).max(p - high).max(DVec3::ZERO).length()
    }
}
