//! The blocks of children and the tapes below one top cell, built from the top down.
//!
//! Offsets count from the beginning of the top cell. A cell depends only on the tape that its parent hands down, the
//! parameters of the entries in that tape, and the position of the cell. So if the tape is that of the last build and
//! no entry in it has changed, the builder copies the old cells.

use std::ops::Range;

use super::cell_encoding::{
    BLOCK_CELLS, BRANCHES, CELL_EMPTY, CELL_REFINED, CELL_SHIFT, CELL_TAPE, LEVELS, OFFSET_MASK,
};
use super::entry::Entries;
use super::grid::{Cube, SIZE_SLACK};
use super::program::{Simplifier, Step};

/// Cells with tapes no longer than this are not refined; by level, from the top cells down.
const LONGEST_UNREFINED: [usize; LEVELS as usize] = [6, 12, usize::MAX];
/// Unrefined children share the tape of their octant if it is no longer than this.
const LONGEST_SHARED: usize = 8;
/// The tapes of a cell's octants must be at most this fraction of its own, with empty octants counted as zero;
/// otherwise refining gains nothing.
const MOST_LEFT: [f64; LEVELS as usize] = [0.95, 0.75, 0.0];
/// The slack for rounding in f32, relative to a radius.
const RADIUS_SLACK: f64 = 1e-5;

/// The common inputs of all top cells of a component.
pub(super) struct CellContext<'a> {
    pub entries: &'a Entries<'a>,
    /// The component's entries as a tape.
    pub full_tape: &'a [Step],
    /// The number of levels of cells; 0 for a single cell in which all entries matter.
    pub levels: u32,
    /// The field must be exact where its absolute value is at most this.
    pub exact: f64,
    /// The entries that changed since the last build; empty without a previous build.
    pub changed: &'a [bool],
}

impl CellContext<'_> {
    /// By how much the difference of two operands can shrink in a cube of this edge, from its value at the center.
    fn reach(&self, side: f64) -> f64 {
        side * 3.0_f64.sqrt() * (1.0 + RADIUS_SLACK) + self.slack()
    }

    /// Whether a cube of this edge with this value at its center needs no tape.
    fn is_empty(&self, value: f64, side: f64) -> bool {
        value.abs() > self.reach(side) + self.exact
    }

    fn slack(&self) -> f64 {
        self.entries.size * SIZE_SLACK
    }

    fn has_changed(&self, tape: &[Step]) -> bool {
        tape.iter().any(|step| self.changed[step.tape_entry.entry()])
    }
}

/// Octants of a cell. The builder makes the children octant by octant, since tapes in an octant are much shorter.
const OCTANTS: usize = 8;

/// The index in the block of the child at `index` within an octant.
fn child_of(octant: usize, index: usize) -> usize {
    let axis = |bit: usize| 2 * (octant >> bit & 1) + (index >> bit & 1);
    axis(0) + BRANCHES as usize * (axis(1) + BRANCHES as usize * axis(2))
}

/// The record of a block.
#[derive(Clone, Debug, Default)]
struct Block {
    /// The hash of the refined cell's tape.
    tape: u64,
    /// The hashes of its octants' tapes.
    octants: [u64; OCTANTS],
    /// The index after the last block below this one.
    end: usize,
    /// The tape entries of this block and of the blocks below it.
    tape_entries: Range<usize>,
}

/// The cells below one top cell.
#[derive(Clone, Debug, Default)]
pub(super) struct TopCell {
    /// The top cell itself.
    pub top: [u32; 2],
    /// The hash of its tape.
    tape: u64,
    /// Blocks of [`BLOCK_CELLS`], parents before children.
    pub cells: Vec<[u32; 2]>,
    pub tape_entries: Vec<[u32; 2]>,
    blocks: Vec<Block>,
    pub stats: TapeStats,
}

impl TopCell {
    /// The lengths of its tapes. Blocks do not store their depth, so this descends from the top.
    fn measured(&self) -> TapeStats {
        let mut stats = TapeStats::default();
        let mut cells = vec![(self.top, 1.0)];
        while let Some((cell, face)) = cells.pop() {
            match (cell[0] >> CELL_SHIFT, block_of(cell)) {
                (_, Some(block)) => {
                    let face = face / f64::from(BRANCHES * BRANCHES);
                    cells.extend(self.cells[block * BLOCK_CELLS..][..BLOCK_CELLS].iter().map(|cell| (*cell, face)));
                }
                (CELL_TAPE, None) => {
                    stats.add(&TapeStats { faces: face, sum: face * f64::from(cell[1]), longest: cell[1] })
                }
                _ => {}
            }
        }
        stats
    }
}

/// Statistics of the lengths of tapes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct TapeStats {
    /// The area that cells with tapes expose to rays, in faces of a top cell.
    pub faces: f64,
    /// Tape entries, weighted by that area.
    pub sum: f64,
    /// The length of the longest tape.
    pub longest: u32,
}

impl TapeStats {
    pub fn add(&mut self, other: &Self) {
        self.faces += other.faces;
        self.sum += other.sum;
        self.longest = self.longest.max(other.longest);
    }
}

/// A cell with its offset moved by `blocks` cells or `tape_entries`.
pub(super) fn moved(cell: [u32; 2], blocks: usize, tape_entries: usize) -> [u32; 2] {
    let by = match cell[0] >> CELL_SHIFT {
        CELL_TAPE => tape_entries,
        CELL_REFINED => blocks,
        _ => 0,
    };
    [cell[0] + by as u32, cell[1]]
}

/// Buffers for the tapes of each level.
#[derive(Default)]
struct Tapes {
    octants: [Vec<Step>; OCTANTS],
    cell: Vec<Step>,
}

/// Builds the trees of top cells, and keeps its buffers between them.
#[derive(Default)]
pub(super) struct CellTreeBuilder {
    simplifier: Simplifier,
    top: Vec<Step>,
    tapes: [Tapes; LEVELS as usize],
    /// The tapes already written for incomplete blocks: hash, offset, length.
    written: Vec<(u64, usize, usize)>,
    /// The index of the innermost block's first tape. Blocks share no tapes, so that each can be copied alone.
    innermost: usize,
}

impl CellTreeBuilder {
    /// The top cell in `cube`; `None` if it equals the `old` one.
    pub fn top_cell(&mut self, context: &CellContext<'_>, cube: Cube, old: Option<&TopCell>) -> Option<TopCell> {
        let mut top = std::mem::take(&mut self.top);
        let reach = if context.levels == 0 { f64::INFINITY } else { context.reach(cube.side) };
        let value = self.simplifier.run(context.full_tape, context.entries, cube.center(), reach, &mut top);
        let tape = hash(&top);
        let top_cell = if old.is_some_and(|old| old.tape == tape) && !context.has_changed(&top) {
            None
        } else {
            let mut tapes = std::mem::take(&mut self.tapes);
            self.written.clear();
            self.innermost = 0;
            let mut cell_builder =
                TopCellBuilder { builder: self, context, top_cell: TopCell { tape, ..TopCell::default() }, old };
            let old_block = old.filter(|old| old.top[0] >> CELL_SHIFT == CELL_REFINED).map(|_| 0);
            let cell = cell_builder.cell(&top, value, cube, 1, old_block, &mut tapes);
            let mut top_cell = TopCell { top: cell, ..cell_builder.top_cell };
            top_cell.stats = top_cell.measured();
            self.tapes = tapes;
            Some(top_cell)
        };
        self.top = top;
        top_cell
    }
}

/// A top cell under construction.
struct TopCellBuilder<'a> {
    builder: &'a mut CellTreeBuilder,
    context: &'a CellContext<'a>,
    top_cell: TopCell,
    old: Option<&'a TopCell>,
}

impl TopCellBuilder<'_> {
    /// The cell whose tape is `tape`, with `value` at its center; `old` is its previous block.
    fn cell(
        &mut self,
        tape: &[Step],
        value: f64,
        cube: Cube,
        level: u32,
        old: Option<usize>,
        tapes: &mut [Tapes],
    ) -> [u32; 2] {
        if self.context.is_empty(value, cube.side) {
            return empty(value, self.context.slack());
        }
        if tape.len() > LONGEST_UNREFINED[level as usize - 1]
            && level < self.context.levels
            && let Some(block) = self.block(tape, cube, level, old, tapes)
        {
            return [(CELL_REFINED << CELL_SHIFT) | (block * BLOCK_CELLS) as u32, 0];
        }
        self.tape(tape.iter().map(|step| step.tape_entry.0), tape.len())
    }

    /// The children of the cell whose tape is `tape`; `None` if refining gains nothing.
    fn block(
        &mut self,
        tape: &[Step],
        cube: Cube,
        level: u32,
        old: Option<usize>,
        tapes: &mut [Tapes],
    ) -> Option<usize> {
        let tape_hash = hash(tape);
        if let (Some(top_cell), Some(block)) = (self.old, old)
            && top_cell.blocks[block].tape == tape_hash
            && !self.context.has_changed(tape)
        {
            return Some(self.copy(top_cell, block));
        }
        let (Tapes { octants, cell: child_tape }, below) = tapes.split_first_mut().expect("a set for each level");
        let mut values = [0.0; OCTANTS];
        if !self.octants(tape, cube, level, octants, &mut values) {
            return None;
        }
        let block = self.top_cell.blocks.len();
        let outer = std::mem::replace(&mut self.builder.innermost, self.builder.written.len());
        let first_tape_entry = self.top_cell.tape_entries.len();
        self.top_cell.blocks.push(Block {
            tape: tape_hash,
            octants: octants.each_ref().map(|o| hash(o)),
            ..Block::default()
        });
        self.top_cell.cells.resize(self.top_cell.cells.len() + BLOCK_CELLS, [0; 2]);
        for (octant, steps) in octants.iter().enumerate() {
            let same = self.same_octant(block, octant, old, steps);
            for index in 0..OCTANTS {
                let child = child_of(octant, index);
                let was =
                    self.old.zip(old).map(|(top_cell, block)| (top_cell, top_cell.cells[block * BLOCK_CELLS + child]));
                let word = match was {
                    Some((top_cell, word)) if same => self.copy_cell(top_cell, word),
                    _ => {
                        let old = was.and_then(|(_, word)| block_of(word));
                        let cube = cube.piece(child, BRANCHES);
                        self.child(steps, values[octant], cube, level + 1, old, child_tape, below)
                    }
                };
                self.top_cell.cells[block * BLOCK_CELLS + child] = word;
            }
        }
        self.builder.written.truncate(self.builder.innermost);
        self.builder.innermost = outer;
        self.top_cell.blocks[block].end = self.top_cell.blocks.len();
        self.top_cell.blocks[block].tape_entries = first_tape_entry..self.top_cell.tape_entries.len();
        Some(block)
    }

    /// The child `cube` of a cell, in the octant whose tape is `steps`, with `value` at the octant's center.
    #[allow(clippy::too_many_arguments, reason = "what comes down from the parent")]
    fn child(
        &mut self,
        steps: &[Step],
        value: f64,
        cube: Cube,
        level: u32,
        old: Option<usize>,
        tape: &mut Vec<Step>,
        tapes: &mut [Tapes],
    ) -> [u32; 2] {
        if steps.is_empty() {
            // The octant has no surface: the value at its center is enough.
            let away = 0.5 * 3.0_f64.sqrt() * cube.side;
            return empty((value.abs() - away).copysign(value), self.context.slack());
        }
        if level == self.context.levels && steps.len() <= LONGEST_SHARED {
            return self.tape(steps.iter().map(|step| step.tape_entry.0), steps.len());
        }
        let reach = self.context.reach(cube.side);
        let value = self.builder.simplifier.run(steps, self.context.entries, cube.center(), reach, tape);
        self.cell(tape, value, cube, level, old, tapes)
    }

    /// The tapes of the octants of a cell, empty for octants without a surface, and the values at their centers;
    /// false if they are hardly shorter than the cell's own.
    fn octants(
        &mut self,
        tape: &[Step],
        cube: Cube,
        level: u32,
        octants: &mut [Vec<Step>; OCTANTS],
        values: &mut [f64; OCTANTS],
    ) -> bool {
        let mut work = 0;
        for (octant, steps) in octants.iter_mut().enumerate() {
            let cube = cube.piece(octant, 2);
            let reach = self.context.reach(cube.side);
            let value = self.builder.simplifier.run(tape, self.context.entries, cube.center(), reach, steps);
            values[octant] = value;
            if !self.context.is_empty(value, cube.side) {
                work += steps.len();
            } else {
                steps.clear();
            }
        }
        work as f64 <= (OCTANTS * tape.len()) as f64 * MOST_LEFT[level as usize - 1]
    }

    /// Whether the children in an octant equal those of `old`. Octants without a surface depend on more than the
    /// tape; rebuilding them is faster than comparing.
    fn same_octant(&self, block: usize, octant: usize, old: Option<usize>, steps: &[Step]) -> bool {
        !steps.is_empty()
            && self.old.zip(old).is_some_and(|(top_cell, old)| {
                top_cell.blocks[old].octants[octant] == self.top_cell.blocks[block].octants[octant]
                    && !self.context.has_changed(steps)
            })
    }

    /// Writes a tape unless the block already has the same one.
    fn tape(&mut self, tape_entries: impl Iterator<Item = [u32; 2]>, count: usize) -> [u32; 2] {
        let first = self.top_cell.tape_entries.len();
        self.top_cell.tape_entries.extend(tape_entries);
        let new = &self.top_cell.tape_entries[first..];
        let key = hash_words(new.iter());
        let same = self.builder.written[self.builder.innermost..].iter().find(|(other, offset, length)| {
            *other == key && *length == count && self.top_cell.tape_entries[*offset..offset + length] == *new
        });
        let offset = same.map_or(first, |(_, offset, _)| *offset);
        if offset == first {
            self.builder.written.push((key, first, count));
        } else {
            self.top_cell.tape_entries.truncate(first);
        }
        [(CELL_TAPE << CELL_SHIFT) | offset as u32, count as u32]
    }

    fn copy_cell(&mut self, old: &TopCell, cell: [u32; 2]) -> [u32; 2] {
        let offset = (cell[0] & OFFSET_MASK) as usize;
        match cell[0] >> CELL_SHIFT {
            CELL_TAPE => {
                let count = cell[1] as usize;
                self.tape(old.tape_entries[offset..offset + count].iter().copied(), count)
            }
            CELL_REFINED => {
                let block = self.copy(old, offset / BLOCK_CELLS);
                [(CELL_REFINED << CELL_SHIFT) | (block * BLOCK_CELLS) as u32, 0]
            }
            _ => cell,
        }
    }

    /// Copies a block with all blocks below it.
    fn copy(&mut self, old: &TopCell, block: usize) -> usize {
        let Block { end, ref tape_entries, .. } = old.blocks[block];
        let new = self.top_cell.blocks.len();
        let first_tape_entry = self.top_cell.tape_entries.len();
        // The offset differences may be negative: they wrap around and back.
        let by_blocks = new.wrapping_sub(block);
        let by_tape_entries = first_tape_entry.wrapping_sub(tape_entries.start);
        self.top_cell.tape_entries.extend_from_slice(&old.tape_entries[tape_entries.clone()]);
        self.top_cell.blocks.extend(old.blocks[block..end].iter().map(|b| Block {
            end: b.end.wrapping_add(by_blocks),
            tape_entries: b.tape_entries.start.wrapping_add(by_tape_entries)
                ..b.tape_entries.end.wrapping_add(by_tape_entries),
            ..b.clone()
        }));
        let cells = &old.cells[block * BLOCK_CELLS..end * BLOCK_CELLS];
        self.top_cell.cells.extend(cells.iter().map(|cell| {
            let offset = (cell[0] & OFFSET_MASK) as usize;
            let to = match cell[0] >> CELL_SHIFT {
                CELL_TAPE => offset.wrapping_add(by_tape_entries),
                CELL_REFINED => offset.wrapping_add(by_blocks.wrapping_mul(BLOCK_CELLS)),
                _ => return *cell,
            };
            [(cell[0] & !OFFSET_MASK) | to as u32, cell[1]]
        }));
        new
    }
}

fn block_of(cell: [u32; 2]) -> Option<usize> {
    (cell[0] >> CELL_SHIFT == CELL_REFINED).then_some((cell[0] & OFFSET_MASK) as usize / BLOCK_CELLS)
}

/// A cell without a surface. Rounds the value at its center toward 0 by more than the error of f32.
fn empty(value: f64, slack: f64) -> [u32; 2] {
    let bound = (value.abs() - slack) as f32;
    [CELL_EMPTY << CELL_SHIFT, bound.next_down().copysign(value as f32).to_bits()]
}

fn hash(tape: &[Step]) -> u64 {
    hash_words(tape.iter().map(|step| &step.tape_entry.0))
}

/// Hashes a tape by multiply and fold (as in wyhash); not safe against attackers.
fn hash_words<'a>(words: impl Iterator<Item = &'a [u32; 2]>) -> u64 {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    for word in words {
        let mixed = u128::from(state ^ (u64::from(word[0]) | u64::from(word[1]) << 32)) * 0xd6e8_feb8_6659_fd93;
        state = (mixed as u64) ^ (mixed >> 64) as u64 ^ 0x2545_f491_4f6c_dd1d;
    }
    state
}
