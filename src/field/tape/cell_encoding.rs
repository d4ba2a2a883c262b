//! Cells as words, as evaluators and the GPU read them.

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

/// Words before the cells of a component for each of its contents: the grid, see
/// [`CellTree::words`](super::CellTree::words).
pub const HEADER_WORDS: usize = 4;
