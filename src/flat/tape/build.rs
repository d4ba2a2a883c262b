//! The grids of a component, and their top cells as one array.

use std::sync::Arc;

use glam::DVec3;
use rayon::prelude::*;

use super::domain::{Domain, domains_of};
use super::entry::Entries;
use super::program::full_tape;
use super::top_cell::{CellContext, CellTreeBuilder, Cube, TapeStats, TopCell, moved};
use super::{BRANCHES, CellTree, Grid, HEADER_WORDS, LEVELS, Lengths, MARGIN_SHARE};
use crate::flat::{Component, FlatScene, ModifierDomain};
use crate::geometry::Aabb;

/// Components of fewer entries have no cells of the finest kind: they would cost more than they save.
const LEAST_FOR_ALL_LEVELS: u32 = 48;

impl Grid {
    /// Around what is in a domain whose field must be exact up to `exact` meters; one cell where that has no end.
    pub(super) fn around(content: &ModifierDomain, exact: f64) -> Self {
        let bounds = match content.bound_slope {
            _ if exact == 0.0 => content.bounds,
            bound_slope if bound_slope > 0.0 => content.bounds.union(&content.cull_box.expanded(exact / bound_slope)),
            _ => Aabb::EVERYTHING,
        };
        let largest = 2.0 * bounds.half().max_element();
        if !bounds.is_finite() || bounds.is_empty() || largest <= 0.0 || largest > Self::ONE_CELL.side {
            return Self::ONE_CELL;
        }
        let margin = MARGIN_SHARE * largest;
        let side = (largest + 2.0 * margin) / f64::from(BRANCHES);
        // The largest extent falls into as many cells exactly, whatever is rounded.
        let counts = (2.0 * (bounds.half() + margin) / side).to_array().map(|n| (n.ceil() as u32).clamp(1, BRANCHES));
        Self { low: bounds.min - margin, side, counts, clear: exact + margin }
    }

    fn cells(&self) -> usize {
        self.counts.iter().product::<u32>() as usize
    }

    fn cube(&self, index: usize) -> Cube {
        let [nx, ny, _] = self.counts.map(|n| n as usize);
        let at = DVec3::new((index % nx) as f64, (index / nx % ny) as f64, (index / nx / ny) as f64);
        Cube { low: self.low + at * self.side, side: self.side }
    }

    /// How the GPU reads it: its numbers as bits of f32, and where its top cells stand.
    fn header(&self, at: u32) -> [[u32; 2]; HEADER_WORDS] {
        let [x, y, z] = self.low.as_vec3().to_array().map(f32::to_bits);
        let [nx, ny, nz] = self.counts;
        // A little less, so that f32 may round.
        let clear = (self.clear * (1.0 - 1e-4)) as f32;
        [[x, y], [z, (self.side as f32).to_bits()], [nx | ny << 8 | nz << 16, at], [clear.to_bits(), 0]]
    }
}

/// All that is needed to make a component's tree.
pub(super) struct Build<'a> {
    entries: Entries<'a>,
    pub domains: Vec<Domain>,
}

/// The top cells of every domain.
pub(super) type TopCells = Vec<Vec<Arc<TopCell>>>;

impl<'a> Build<'a> {
    /// Of a component that has tapes.
    pub fn new(flat: &'a FlatScene, component: &'a Component) -> Self {
        let domains = domains_of(flat, component).expect("only components that have tapes get here");
        Self { entries: Entries::new(flat, component), domains }
    }

    /// The size that rounding is relative to; where it changes, every cell does.
    pub fn size(&self) -> f64 {
        self.entries.size
    }

    /// The tree from nothing, with its top cells.
    pub fn fresh(&self) -> (CellTree, TopCells) {
        let changed = vec![false; self.entries.leaves.len()];
        self.top_cells(&changed, None)
    }

    /// The tree from the top cells that it had on the same grids, with the same size, before the entries told by
    /// `changed` did.
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

/// Top cells, then all blocks, then all tape entries, to be put behind `before` words.
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
