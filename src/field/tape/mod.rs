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
//! | `cell_encoding` | cells as words |
//! | `grid` | where the top cells of a space lie |
//! | `domain` | the spaces of a component that have tapes: its own, and that of each modifier's content |
//! | `entry` | a component's entries as numbers to evaluate with |
//! | `program` | a tape at one point: its value, and the shorter tape that is enough around the point |
//! | `top_cell` | everything in one top cell |
//! | `build` | the top cells of a component as one array |
//! | `cell_tree` | the cells of one component, and which of them a point is in |
//! | `field` | the field by the tapes: counterpart of the shader |
//! | `cached_tree` | one component's tree and what it was made from: made anew only where an edit reached |
//! | `tape_cache` | trees kept between frames |
//! | `worker` | makes them beside the frames |

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
