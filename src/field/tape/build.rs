//! Builds the top cells of a component into one array.

use std::sync::Arc;

use rayon::prelude::*;

use super::cell_encoding::{HEADER_WORDS, LEVELS};
use super::cell_tree::{CellTree, Lengths};
use super::domain::{Domain, domains_of};
use super::entry::Entries;
use super::grid::Grid;
use super::program::full_tape;
use super::top_cell::{CellContext, CellTreeBuilder, TapeStats, TopCell, moved};
use crate::{Component, FlatScene};

/// Components of fewer entries have no cells of the finest level: these would cost more than they save.
const LEAST_FOR_ALL_LEVELS: u32 = 48;

impl CellTree {
    /// The tapes of a component. It must be able to have tapes, however small it is.
    pub fn build(flat: &FlatScene, component: &Component) -> Self {
        Build::new(flat, component).fresh().0
    }
}

/// The inputs of a component's tree.
pub(super) struct Build<'a> {
    entries: Entries<'a>,
    pub domains: Vec<Domain>,
}

/// The top cells of every domain.
pub(super) type TopCells = Vec<Vec<Arc<TopCell>>>;

impl<'a> Build<'a> {
    /// For a component that has tapes.
    pub fn new(flat: &'a FlatScene, component: &'a Component) -> Self {
        let domains = domains_of(flat, component).expect("only components that have tapes get here");
        Self { entries: Entries::new(flat, component), domains }
    }

    /// The size that rounding is relative to; a change of it changes every cell.
    pub fn size(&self) -> f64 {
        self.entries.size
    }

    /// A new tree, with its top cells.
    pub fn fresh(&self) -> (CellTree, TopCells) {
        let changed = vec![false; self.entries.leaves.len()];
        self.top_cells(&changed, None)
    }

    /// The tree, from its top cells on the same grids and with the same size before the entries in `changed` changed.
    pub fn again(&self, changed: &[bool], old: &TopCells) -> (CellTree, TopCells) {
        self.top_cells(changed, Some(old))
    }

    fn top_cells(&self, changed: &[bool], old: Option<&TopCells>) -> (CellTree, TopCells) {
        let old = |i: usize| old.map(|top_cells| &*top_cells[i]);
        let top_cells: TopCells =
            self.domains.iter().enumerate().map(|(i, domain)| self.top_cells_of(domain, changed, old(i))).collect();
        let mut lengths = Lengths::default();
        for (domain, top_cells) in self.domains.iter().zip(&top_cells) {
            let mut stats = TapeStats::default();
            top_cells.iter().for_each(|top_cell| stats.add(&top_cell.stats));
            lengths.add(&stats, domain.copies);
        }
        let start = HEADER_WORDS * (top_cells.len() - 1);
        let (mut words, mut starts) = (vec![[0; 2]; start], Vec::new());
        for top_cells in &top_cells {
            let at = words.len() - start;
            starts.push(at as u32);
            words.extend(assembled(top_cells, at));
        }
        for (i, (domain, at)) in self.domains.iter().zip(&starts).enumerate().skip(1) {
            words[start - HEADER_WORDS * i..][..HEADER_WORDS].copy_from_slice(&domain.grid.header(*at));
        }
        let grids = self.domains.iter().map(|domain| domain.grid).collect();
        (CellTree { grids, starts, start, words, lengths }, top_cells)
    }

    fn top_cells_of(&self, domain: &Domain, changed: &[bool], old: Option<&[Arc<TopCell>]>) -> Vec<Arc<TopCell>> {
        let full_tape = full_tape(&self.entries, &self.domains, domain.entries.clone());
        let one_cell = domain.grid == Grid::ONE_CELL;
        let levels = match domain.entries.len() {
            _ if one_cell => 0,
            few if few < LEAST_FOR_ALL_LEVELS as usize => LEVELS - 1,
            _ => LEVELS,
        };
        let context =
            CellContext { entries: &self.entries, full_tape: &full_tape, levels, exact: domain.exact, changed };
        let build_cell = |builder: &mut CellTreeBuilder, index: usize| {
            let old = old.map(|top_cells| &top_cells[index]);
            match (builder.top_cell(&context, domain.grid.cube(index), old.map(|top_cell| &**top_cell)), old) {
                (None, Some(old)) => old.clone(),
                (top_cell, _) => Arc::new(top_cell.unwrap_or_default()),
            }
        };
        let cells = (0..domain.grid.cells()).into_par_iter().with_max_len(1);
        cells.map_init(CellTreeBuilder::default, build_cell).collect()
    }
}

/// Top cells, then all blocks, then all tape entries; `before` words precede them.
fn assembled(top_cells: &[Arc<TopCell>], before: usize) -> Vec<[u32; 2]> {
    let cells: usize = top_cells.len() + top_cells.iter().map(|top_cell| top_cell.cells.len()).sum::<usize>();
    let tape_entries: usize = top_cells.iter().map(|top_cell| top_cell.tape_entries.len()).sum();
    let mut words = vec![[0; 2]; cells + tape_entries];
    let (tops, mut rest) = words.split_at_mut(top_cells.len());
    let (mut blocks, mut tapes);
    (blocks, rest) = rest.split_at_mut(cells - top_cells.len());
    tapes = rest;
    let (mut at_block, mut at_tape_entry) = (before + top_cells.len(), before + cells);
    let mut jobs = Vec::with_capacity(top_cells.len());
    for (top_cell, top) in top_cells.iter().zip(tops) {
        *top = moved(top_cell.top, at_block, at_tape_entry);
        let (cells, tape_entries);
        (cells, blocks) = blocks.split_at_mut(top_cell.cells.len());
        (tape_entries, tapes) = tapes.split_at_mut(top_cell.tape_entries.len());
        jobs.push((top_cell, cells, tape_entries, [at_block, at_tape_entry]));
        at_block += top_cell.cells.len();
        at_tape_entry += top_cell.tape_entries.len();
    }
    jobs.into_par_iter().for_each(|(top_cell, cells, tape_entries, [at_block, at_tape_entry])| {
        for (to, cell) in cells.iter_mut().zip(&top_cell.cells) {
            *to = moved(*cell, at_block, at_tape_entry);
        }
        tape_entries.copy_from_slice(&top_cell.tape_entries);
    });
    words
}
