//! Everything in one top cell: its blocks of children and their lists, made by walking down.
//!
//! Offsets count from the beginning of the part. What a cell becomes follows from the list that comes
//! down to it, the numbers of the entries in that list, and where the cell lies, and from nothing else:
//! so where the list is that of the last time and no entry in it has changed, the old cells are copied.

use std::ops::Range;

use glam::DVec3;

use super::entry::Entries;
use super::program::{Pruning, Step};
use super::{BLOCK_CELLS, BRANCHES, CELL_EMPTY, CELL_LIST, CELL_REFINED, CELL_SHIFT, LEVELS, OFFSET_MASK, SIZE_SLACK};

/// Cells with lists no longer than this are not refined; by level, the top cells first.
const LONGEST_UNREFINED: [usize; LEVELS as usize] = [6, 12, usize::MAX];
/// Children that are not refined share the list of their octant where it is no longer than this.
const LONGEST_SHARED: usize = 8;
/// The lists of a cell's octants must be at most this share of its own, empty octants counted as
/// nothing: refining it would be in vain else.
const MOST_LEFT: [f64; LEVELS as usize] = [0.95, 0.75, 0.0];
/// Of a radius, for rounding in f32.
const RADIUS_SLACK: f64 = 1e-5;

/// What all parts of a component have in common.
pub(super) struct Frame<'a> {
    pub entries: &'a Entries<'a>,
    /// The component's entries as a list.
    pub whole: &'a [Step],
    /// How many kinds of cells there are above one another; 0 where there is only one cell, in which all matters.
    pub levels: u32,
    /// The field must be exact wherever it is no farther from 0 than this.
    pub exact: f64,
    /// Which entries have changed since the last time; empty where there is none.
    pub changed: &'a [bool],
}

impl Frame<'_> {
    /// How much closer to each other two operands can come in a cube of this edge than at its centre.
    fn reach(&self, side: f64) -> f64 {
        side * 3.0_f64.sqrt() * (1.0 + RADIUS_SLACK) + self.slack()
    }

    /// Whether a cube of this edge with this value at its centre needs no list.
    fn is_empty(&self, value: f64, side: f64) -> bool {
        value.abs() > self.reach(side) + self.exact
    }

    fn slack(&self) -> f64 {
        self.entries.size * SIZE_SLACK
    }

    fn has_changed(&self, list: &[Step]) -> bool {
        list.iter().any(|step| self.changed[step.token.entry()])
    }
}

/// A cube: its lower corner and its edge, in metres.
#[derive(Clone, Copy)]
pub(super) struct Cube {
    pub low: DVec3,
    pub side: f64,
}

impl Cube {
    fn center(&self) -> DVec3 {
        self.low + 0.5 * self.side
    }

    /// The piece at `index` (x fastest) of those that it falls into when each edge is cut into `pieces`.
    fn piece(&self, index: usize, pieces: u32) -> Self {
        let (side, n) = (self.side / f64::from(pieces), pieces as usize);
        let at = DVec3::new((index % n) as f64, (index / n % n) as f64, (index / n / n) as f64);
        Self { low: self.low + at * side, side }
    }
}

/// Octants of a cell; the children are made octant by octant, since lists in an octant are much shorter.
const OCTANTS: usize = 8;

/// The child at `index` within an octant, as a place in the block.
fn child_of(octant: usize, index: usize) -> usize {
    let axis = |bit: usize| 2 * (octant >> bit & 1) + (index >> bit & 1);
    axis(0) + BRANCHES as usize * (axis(1) + BRANCHES as usize * axis(2))
}

/// What is remembered of a block.
#[derive(Clone, Debug, Default)]
struct Block {
    /// The list of the refined cell, by its hash.
    list: u64,
    /// The lists of its octants, by their hashes.
    octants: [u64; OCTANTS],
    /// The block behind the last one below this one.
    end: usize,
    /// The tokens of this block and of those below.
    tokens: Range<usize>,
}

/// The cells below one top cell.
#[derive(Clone, Debug, Default)]
pub(super) struct Part {
    /// The top cell itself.
    pub top: [u32; 2],
    /// Its list, by its hash.
    list: u64,
    /// Blocks of [`BLOCK_CELLS`], parents before children.
    pub cells: Vec<[u32; 2]>,
    pub tokens: Vec<[u32; 2]>,
    blocks: Vec<Block>,
    pub own: Own,
}

impl Part {
    /// How long its lists are. Blocks do not know how deep they lie, so this walks down.
    fn measured(&self) -> Own {
        let mut own = Own::default();
        let mut cells = vec![(self.top, 1.0)];
        while let Some((cell, face)) = cells.pop() {
            match (cell[0] >> CELL_SHIFT, block_of(cell)) {
                (_, Some(block)) => {
                    let face = face / f64::from(BRANCHES * BRANCHES);
                    cells.extend(self.cells[block * BLOCK_CELLS..][..BLOCK_CELLS].iter().map(|cell| (*cell, face)));
                }
                (CELL_LIST, None) => own.add(&Own { faces: face, sum: face * f64::from(cell[1]), longest: cell[1] }),
                _ => {}
            }
        }
        own
    }
}

/// How long lists are.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Own {
    /// The area that cells with lists show to rays, in faces of a top cell.
    pub faces: f64,
    /// Tokens, weighted by it.
    pub sum: f64,
    /// Tokens of the longest one.
    pub longest: u32,
}

impl Own {
    pub fn add(&mut self, other: &Self) {
        self.faces += other.faces;
        self.sum += other.sum;
        self.longest = self.longest.max(other.longest);
    }
}

/// A cell with its offset moved by `blocks` cells or `tokens`.
pub(super) fn moved(cell: [u32; 2], blocks: usize, tokens: usize) -> [u32; 2] {
    let by = match cell[0] >> CELL_SHIFT {
        CELL_LIST => tokens,
        CELL_REFINED => blocks,
        _ => 0,
    };
    [cell[0] + by as u32, cell[1]]
}

/// Lists on their way down, one set for each level.
#[derive(Default)]
struct Lists {
    octants: [Vec<Step>; OCTANTS],
    cell: Vec<Step>,
}

/// Makes parts; keeps what it works with.
#[derive(Default)]
pub(super) struct Carver {
    pruning: Pruning,
    top: Vec<Step>,
    lists: [Lists; LEVELS as usize],
    /// Lists already written for blocks that are not complete: hash, offset, length.
    written: Vec<(u64, usize, usize)>,
    /// Where those of the innermost block begin. Blocks share no lists, so that each can be copied alone.
    innermost: usize,
}

impl Carver {
    /// The part in the top cell `cube`; `None` where it is as the `old` one.
    pub fn part(&mut self, frame: &Frame<'_>, cube: Cube, old: Option<&Part>) -> Option<Part> {
        let mut top = std::mem::take(&mut self.top);
        let reach = if frame.levels == 0 { f64::INFINITY } else { frame.reach(cube.side) };
        let value = self.pruning.run(frame.whole, frame.entries, cube.center(), reach, &mut top);
        let list = hash(&top);
        let part = if old.is_some_and(|old| old.list == list) && !frame.has_changed(&top) {
            None
        } else {
            let mut lists = std::mem::take(&mut self.lists);
            self.written.clear();
            self.innermost = 0;
            let mut making = Making { carver: self, frame, part: Part { list, ..Part::default() }, old };
            let old_block = old.filter(|old| old.top[0] >> CELL_SHIFT == CELL_REFINED).map(|_| 0);
            let cell = making.cell(&top, value, cube, 1, old_block, &mut lists);
            let mut part = Part { top: cell, ..making.part };
            part.own = part.measured();
            self.lists = lists;
            Some(part)
        };
        self.top = top;
        part
    }
}

/// A part that is being made.
struct Making<'a> {
    carver: &'a mut Carver,
    frame: &'a Frame<'a>,
    part: Part,
    old: Option<&'a Part>,
}

impl Making<'_> {
    /// The cell whose list is `list`, with `value` at its centre; `old` is the block that it had.
    fn cell(
        &mut self,
        list: &[Step],
        value: f64,
        cube: Cube,
        level: u32,
        old: Option<usize>,
        lists: &mut [Lists],
    ) -> [u32; 2] {
        if self.frame.is_empty(value, cube.side) {
            return empty(value, self.frame.slack());
        }
        if list.len() > LONGEST_UNREFINED[level as usize - 1]
            && level < self.frame.levels
            && let Some(block) = self.block(list, cube, level, old, lists)
        {
            return [(CELL_REFINED << CELL_SHIFT) | (block * BLOCK_CELLS) as u32, 0];
        }
        self.list(list.iter().map(|step| step.token.0), list.len())
    }

    /// The children of the cell whose list is `list`, or nothing where they would say no more.
    fn block(
        &mut self,
        list: &[Step],
        cube: Cube,
        level: u32,
        old: Option<usize>,
        lists: &mut [Lists],
    ) -> Option<usize> {
        let list_hash = hash(list);
        if let (Some(part), Some(block)) = (self.old, old)
            && part.blocks[block].list == list_hash
            && !self.frame.has_changed(list)
        {
            return Some(self.copy(part, block));
        }
        let (Lists { octants, cell: child_list }, below) = lists.split_first_mut().expect("a set for each level");
        let mut values = [0.0; OCTANTS];
        if !self.octants(list, cube, level, octants, &mut values) {
            return None;
        }
        let block = self.part.blocks.len();
        let outer = std::mem::replace(&mut self.carver.innermost, self.carver.written.len());
        let first_token = self.part.tokens.len();
        self.part.blocks.push(Block {
            list: list_hash,
            octants: octants.each_ref().map(|o| hash(o)),
            ..Block::default()
        });
        self.part.cells.resize(self.part.cells.len() + BLOCK_CELLS, [0; 2]);
        for (octant, steps) in octants.iter().enumerate() {
            let same = self.same_octant(block, octant, old, steps);
            for index in 0..OCTANTS {
                let child = child_of(octant, index);
                let was = self.old.zip(old).map(|(part, block)| (part, part.cells[block * BLOCK_CELLS + child]));
                let word = match was {
                    Some((part, word)) if same => self.copy_cell(part, word),
                    _ => {
                        let old = was.and_then(|(_, word)| block_of(word));
                        let cube = cube.piece(child, BRANCHES);
                        self.child(steps, values[octant], cube, level + 1, old, child_list, below)
                    }
                };
                self.part.cells[block * BLOCK_CELLS + child] = word;
            }
        }
        self.carver.written.truncate(self.carver.innermost);
        self.carver.innermost = outer;
        self.part.blocks[block].end = self.part.blocks.len();
        self.part.blocks[block].tokens = first_token..self.part.tokens.len();
        Some(block)
    }

    /// The child `cube` of a cell, in the octant whose list is `steps`, with `value` at its centre.
    #[allow(clippy::too_many_arguments, reason = "what comes down from the parent")]
    fn child(
        &mut self,
        steps: &[Step],
        value: f64,
        cube: Cube,
        level: u32,
        old: Option<usize>,
        list: &mut Vec<Step>,
        lists: &mut [Lists],
    ) -> [u32; 2] {
        if steps.is_empty() {
            // No surface is in the octant: what is known at its centre is enough.
            let away = 0.5 * 3.0_f64.sqrt() * cube.side;
            return empty((value.abs() - away).copysign(value), self.frame.slack());
        }
        if level == self.frame.levels && steps.len() <= LONGEST_SHARED {
            return self.list(steps.iter().map(|step| step.token.0), steps.len());
        }
        let reach = self.frame.reach(cube.side);
        let value = self.carver.pruning.run(steps, self.frame.entries, cube.center(), reach, list);
        self.cell(list, value, cube, level, old, lists)
    }

    /// The lists of the octants of a cell, emptied where no surface is, and the values at their centres;
    /// false where they are hardly shorter than its own.
    fn octants(
        &mut self,
        list: &[Step],
        cube: Cube,
        level: u32,
        octants: &mut [Vec<Step>; OCTANTS],
        values: &mut [f64; OCTANTS],
    ) -> bool {
        let mut work = 0;
        for (octant, steps) in octants.iter_mut().enumerate() {
            let cube = cube.piece(octant, 2);
            let reach = self.frame.reach(cube.side);
            let value = self.carver.pruning.run(list, self.frame.entries, cube.center(), reach, steps);
            values[octant] = value;
            if !self.frame.is_empty(value, cube.side) {
                work += steps.len();
            } else {
                steps.clear();
            }
        }
        work as f64 <= (OCTANTS * list.len()) as f64 * MOST_LEFT[level as usize - 1]
    }

    /// Whether the children in an octant are those that `old` has. Where no surface is they follow from more
    /// than the list, and are made anew faster than compared.
    fn same_octant(&self, block: usize, octant: usize, old: Option<usize>, steps: &[Step]) -> bool {
        !steps.is_empty()
            && self.old.zip(old).is_some_and(|(part, old)| {
                part.blocks[old].octants[octant] == self.part.blocks[block].octants[octant]
                    && !self.frame.has_changed(steps)
            })
    }

    /// Writes a list where the block has not got the same already.
    fn list(&mut self, tokens: impl Iterator<Item = [u32; 2]>, count: usize) -> [u32; 2] {
        let first = self.part.tokens.len();
        self.part.tokens.extend(tokens);
        let new = &self.part.tokens[first..];
        let key = hash_words(new.iter());
        let same = self.carver.written[self.carver.innermost..].iter().find(|(other, offset, length)| {
            *other == key && *length == count && self.part.tokens[*offset..offset + length] == *new
        });
        let offset = same.map_or(first, |(_, offset, _)| *offset);
        if offset == first {
            self.carver.written.push((key, first, count));
        } else {
            self.part.tokens.truncate(first);
        }
        [(CELL_LIST << CELL_SHIFT) | offset as u32, count as u32]
    }

    fn copy_cell(&mut self, old: &Part, cell: [u32; 2]) -> [u32; 2] {
        let offset = (cell[0] & OFFSET_MASK) as usize;
        match cell[0] >> CELL_SHIFT {
            CELL_LIST => {
                let count = cell[1] as usize;
                self.list(old.tokens[offset..offset + count].iter().copied(), count)
            }
            CELL_REFINED => {
                let block = self.copy(old, offset / BLOCK_CELLS);
                [(CELL_REFINED << CELL_SHIFT) | (block * BLOCK_CELLS) as u32, 0]
            }
            _ => cell,
        }
    }

    /// Copies a block with all below it.
    fn copy(&mut self, old: &Part, block: usize) -> usize {
        let Block { end, ref tokens, .. } = old.blocks[block];
        let new = self.part.blocks.len();
        let first_token = self.part.tokens.len();
        // Offsets are moved by differences that may be negative: they wrap around and back.
        let by_blocks = new.wrapping_sub(block);
        let by_tokens = first_token.wrapping_sub(tokens.start);
        self.part.tokens.extend_from_slice(&old.tokens[tokens.clone()]);
        self.part.blocks.extend(old.blocks[block..end].iter().map(|b| Block {
            end: b.end.wrapping_add(by_blocks),
            tokens: b.tokens.start.wrapping_add(by_tokens)..b.tokens.end.wrapping_add(by_tokens),
            ..b.clone()
        }));
        let cells = &old.cells[block * BLOCK_CELLS..end * BLOCK_CELLS];
        self.part.cells.extend(cells.iter().map(|cell| {
            let offset = (cell[0] & OFFSET_MASK) as usize;
            let to = match cell[0] >> CELL_SHIFT {
                CELL_LIST => offset.wrapping_add(by_tokens),
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

/// A cell without a surface, with the value at its centre rounded towards 0 by more than f32 can be wrong.
fn empty(value: f64, slack: f64) -> [u32; 2] {
    let bound = (value.abs() - slack) as f32;
    [CELL_EMPTY << CELL_SHIFT, bound.next_down().copysign(value as f32).to_bits()]
}

fn hash(list: &[Step]) -> u64 {
    hash_words(list.iter().map(|step| &step.token.0))
}

/// Tells lists apart: multiply and fold (as in wyhash), no attacker in view.
fn hash_words<'a>(words: impl Iterator<Item = &'a [u32; 2]>) -> u64 {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    for word in words {
        let mixed = u128::from(state ^ (u64::from(word[0]) | u64::from(word[1]) << 32)) * 0xd6e8_feb8_6659_fd93;
        state = (mixed as u64) ^ (mixed >> 64) as u64 ^ 0x2545_f491_4f6c_dd1d;
    }
    state
}
