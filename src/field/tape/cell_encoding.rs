//! The encoding of cells as words, for evaluators and the GPU.

/// Cells along each axis of a block, and top cells along the largest extent.
pub const BRANCHES: u32 = 4;
/// Cells of a block.
pub const BLOCK_CELLS: usize = (BRANCHES * BRANCHES * BRANCHES) as usize;
/// Levels of cells: 4, 16 and 64 along the largest extent.
pub const LEVELS: u32 = 3;

/// No surface in the cell: the second word is the bound at its center, as the bits of an f32.
pub const CELL_EMPTY: u32 = 0;
/// The first word holds the offset of the cell's first tape entry, the second the number of entries.
pub const CELL_TAPE: u32 = 1;
/// The first word holds the offset of the cell's block of [`BLOCK_CELLS`] children, x fastest.
pub const CELL_REFINED: u32 = 2;
/// The bit position of the cell's kind in its first word; the bits below hold the offset.
pub const CELL_SHIFT: u32 = 30;
/// The offset in a cell's first word.
pub const OFFSET_MASK: u32 = (1 << CELL_SHIFT) - 1;

/// Words before the cells of a component for each modifier content: its grid, see
/// [`CellTree::words`](super::CellTree::words).
pub const HEADER_WORDS: usize = 4;
