//! Tapes: which entries of a large component matter where in space.
//!
//! Space is divided into cells, and each cell keeps only the entries that can matter in it. All fields are
//! 1-Lipschitz: over a cell of half diagonal R the difference of two operands shrinks by at most 2R from its value at
//! the center. Where it is at least the support of their blend plus 2R there, the blend is exactly the hard operator
//! in the whole cell, one operand has no influence, and the simplified tape has the same value to the last bit. The
//! same argument finds the cells without a surface. (Barbier et al., "Lipschitz Pruning: Hierarchical Simplification
//! of Primitive-Based SDFs", 2025.)
//!
//! | file | content |
//! |---|---|
//! | `tape_entry` | the words of a tape |
//! | `cell_encoding` | cells as words |
//! | `grid` | the grid of a space's top cells |
//! | `domain` | the spaces of a component that have tapes: its own, and that of each modifier's content |
//! | `entry` | a component's entries in f64, ready to evaluate |
//! | `program` | a tape at one point: its value, and the simplified tape for the surroundings of the point |
//! | `top_cell` | the blocks and tapes below one top cell |
//! | `build` | the top cells of a component as one array |
//! | `cell_tree` | the cells of one component, and the lookup of a point |
//! | `field` | evaluation by the tapes: counterpart of the shader |
//! | `cached_tree` | one component's tree with its inputs; an edit rebuilds only what it changed |
//! | `tape_cache` | the cache of trees between frames |
//! | `worker` | the thread that builds trees while frames are drawn |

mod build;
mod cached_tree;
mod cell_encoding;
mod cell_tree;
mod domain;
mod entry;
mod field;
mod grid;
mod program;
mod tape_cache;
mod tape_entry;
#[cfg(test)]
mod tests;
mod top_cell;
mod worker;

pub use cell_encoding::{
    BLOCK_CELLS, BRANCHES, CELL_EMPTY, CELL_REFINED, CELL_SHIFT, CELL_TAPE, HEADER_WORDS, LEVELS, OFFSET_MASK,
};
pub use cell_tree::{Cell, CellTree};
pub use domain::has_tape;
pub use field::tape_field;
pub use grid::{Grid, MARGIN_SHARE};
pub use tape_cache::TapeCache;
pub use tape_entry::{MAX_TAPE_DOMAINS, MAX_TAPE_ENTRIES, TapeEntry, TapeOp};
