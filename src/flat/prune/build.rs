//! The grid of a component, and its parts as one array.

use std::sync::Arc;

use glam::DVec3;
use rayon::prelude::*;

use super::entry::Entries;
use super::part::{Carver, Cube, Frame, Part, moved};
use super::program::{Step, whole};
use super::{BRANCHES, CellTree, LEVELS, Lengths, MARGIN_SHARE};
use crate::flat::{Component, FlatScene};

/// Components of fewer entries have no cells of the finest kind: they would cost more than they save.
const LEAST_FOR_ALL_LEVELS: u32 = 48;

/// Where the top cells lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Grid {
    low: DVec3,
    side: f64,
    counts: [u32; 3],
}

impl Grid {
    pub fn new(component: &Component) -> Self {
        let bounds = &component.bounds;
        let largest = 2.0 * bounds.half().max_element();
        let margin = MARGIN_SHARE * largest;
        let side = (largest + 2.0 * margin) / f64::from(BRANCHES);
        // The largest extent falls into as many cells exactly, whatever is rounded.
        let counts = (2.0 * (bounds.half() + margin) / side).to_array().map(|n| (n.ceil() as u32).clamp(1, BRANCHES));
        Self { low: bounds.min - margin, side, counts }
    }

    fn cells(&self) -> usize {
        self.counts.iter().product::<u32>() as usize
    }

    fn cube(&self, index: usize) -> Cube {
        let [nx, ny, _] = self.counts.map(|n| n as usize);
        let at = DVec3::new((index % nx) as f64, (index / nx % ny) as f64, (index / nx / ny) as f64);
        Cube { low: self.low + at * self.side, side: self.side }
    }
}

/// All that is needed to make a component's tree.
pub(super) struct Build {
    entries: Entries,
    whole: Vec<Step>,
    levels: u32,
    pub grid: Grid,
}

impl Build {
    pub fn new(flat: &FlatScene, component: &Component) -> Self {
        Self {
            entries: Entries::new(flat, component),
            whole: whole(flat, component),
            levels: if component.count < LEAST_FOR_ALL_LEVELS { LEVELS - 1 } else { LEVELS },
            grid: Grid::new(component),
        }
    }

    /// The size that rounding is relative to; where it changes, every cell does.
    pub fn size(&self) -> f64 {
        self.entries.size
    }

    /// The tree from nothing, with its parts.
    pub fn fresh(&self) -> (CellTree, Vec<Arc<Part>>) {
        let changed = vec![false; self.entries.leaves.len()];
        self.parts(&changed, None)
    }

    /// The tree from the parts that it had on the same grid, with the same size, before the entries told by
    /// `changed` did.
    pub fn again(&self, changed: &[bool], old: &[Arc<Part>]) -> (CellTree, Vec<Arc<Part>>) {
        self.parts(changed, Some(old))
    }

    fn parts(&self, changed: &[bool], old: Option<&[Arc<Part>]>) -> (CellTree, Vec<Arc<Part>>) {
        let frame = Frame { entries: &self.entries, whole: &self.whole, levels: self.levels, changed };
        let carve = |carver: &mut Carver, index: usize| {
            let old = old.map(|parts| &parts[index]);
            match (carver.part(&frame, self.grid.cube(index), old.map(|part| &**part)), old) {
                (None, Some(old)) => old.clone(),
                (part, _) => Arc::new(part.unwrap_or_default()),
            }
        };
        let cells = (0..self.grid.cells()).into_par_iter().with_max_len(1);
        let parts: Vec<Arc<Part>> = cells.map_init(Carver::default, carve).collect();
        let Grid { low, side, counts } = self.grid;
        let mut lengths = Lengths::default();
        parts.iter().for_each(|part| lengths.add(&part.lengths));
        (CellTree { low, side, counts, words: assembled(&parts), lengths }, parts)
    }
}

/// Top cells, then all blocks, then all tokens.
fn assembled(parts: &[Arc<Part>]) -> Vec<[u32; 2]> {
    let cells: usize = parts.len() + parts.iter().map(|part| part.cells.len()).sum::<usize>();
    let tokens: usize = parts.iter().map(|part| part.tokens.len()).sum();
    let mut words = vec![[0; 2]; cells + tokens];
    let (tops, mut rest) = words.split_at_mut(parts.len());
    let (mut blocks, mut lists);
    (blocks, rest) = rest.split_at_mut(cells - parts.len());
    lists = rest;
    let (mut at_block, mut at_token) = (parts.len(), cells);
    let mut jobs = Vec::with_capacity(parts.len());
    for (part, top) in parts.iter().zip(tops) {
        *top = moved(part.top, at_block, at_token);
        let (cells, tokens);
        (cells, blocks) = blocks.split_at_mut(part.cells.len());
        (tokens, lists) = lists.split_at_mut(part.tokens.len());
        jobs.push((part, cells, tokens, [at_block, at_token]));
        at_block += part.cells.len();
        at_token += part.tokens.len();
    }
    jobs.into_par_iter().for_each(|(part, cells, tokens, [at_block, at_token])| {
        for (to, cell) in cells.iter_mut().zip(&part.cells) {
            *to = moved(*cell, at_block, at_token);
        }
        tokens.copy_from_slice(&part.tokens);
    });
    words
}
