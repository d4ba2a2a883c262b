//! The grids of a component, and their parts as one array.

use std::sync::Arc;

use glam::DVec3;
use rayon::prelude::*;

use super::domain::{Domain, domains_of};
use super::entry::Entries;
use super::part::{Carver, Cube, Frame, Own, Part, moved};
use super::program::whole;
use super::{BRANCHES, CellTree, Grid, HEADER_WORDS, LEVELS, Lengths, MARGIN_SHARE};
use crate::flat::{Component, Content, FlatScene};
use crate::geometry::Aabb;

/// Components of fewer entries have no cells of the finest kind: they would cost more than they save.
const LEAST_FOR_ALL_LEVELS: u32 = 48;

impl Grid {
    /// Around what is in a domain whose field must be exact up to `exact` metres; one cell where that has no end.
    pub(super) fn around(content: &Content, exact: f64) -> Self {
        let bounds = match content.slope {
            _ if exact == 0.0 => content.bounds,
            slope if slope > 0.0 => content.bounds.union(&content.skip.expanded(exact / slope)),
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

/// The parts of every domain.
pub(super) type Parts = Vec<Vec<Arc<Part>>>;

impl<'a> Build<'a> {
    /// Of a component that has lists.
    pub fn new(flat: &'a FlatScene, component: &'a Component) -> Self {
        let domains = domains_of(flat, component).expect("only components that have lists get here");
        Self { entries: Entries::new(flat, component), domains }
    }

    /// The size that rounding is relative to; where it changes, every cell does.
    pub fn size(&self) -> f64 {
        self.entries.size
    }

    /// The tree from nothing, with its parts.
    pub fn fresh(&self) -> (CellTree, Parts) {
        let changed = vec![false; self.entries.leaves.len()];
        self.parts(&changed, None)
    }

    /// The tree from the parts that it had on the same grids, with the same size, before the entries told by
    /// `changed` did.
    pub fn again(&self, changed: &[bool], old: &Parts) -> (CellTree, Parts) {
        self.parts(changed, Some(old))
    }

    fn parts(&self, changed: &[bool], old: Option<&Parts>) -> (CellTree, Parts) {
        let old = |i: usize| old.map(|parts| &*parts[i]);
        let parts: Parts =
            self.domains.iter().enumerate().map(|(i, domain)| self.parts_of(domain, changed, old(i))).collect();
        let mut lengths = Lengths::default();
        for (domain, parts) in self.domains.iter().zip(&parts) {
            let mut own = Own::default();
            parts.iter().for_each(|part| own.add(&part.own));
            lengths.add(&own, domain.copies);
        }
        let start = HEADER_WORDS * (parts.len() - 1);
        let (mut words, mut starts) = (vec![[0; 2]; start], Vec::new());
        for parts in &parts {
            let at = words.len() - start;
            starts.push(at as u32);
            words.extend(assembled(parts, at));
        }
        for (i, (domain, at)) in self.domains.iter().zip(&starts).enumerate().skip(1) {
            words[start - HEADER_WORDS * i..][..HEADER_WORDS].copy_from_slice(&domain.grid.header(*at));
        }
        let grids = self.domains.iter().map(|domain| domain.grid).collect();
        (CellTree { grids, starts, start, words, lengths }, parts)
    }

    fn parts_of(&self, domain: &Domain, changed: &[bool], old: Option<&[Arc<Part>]>) -> Vec<Arc<Part>> {
        let whole = whole(&self.entries, &self.domains, domain.entries.clone());
        let one_cell = domain.grid == Grid::ONE_CELL;
        let levels = match domain.entries.len() {
            _ if one_cell => 0,
            few if few < LEAST_FOR_ALL_LEVELS as usize => LEVELS - 1,
            _ => LEVELS,
        };
        let frame = Frame { entries: &self.entries, whole: &whole, levels, exact: domain.exact, changed };
        let carve = |carver: &mut Carver, index: usize| {
            let old = old.map(|parts| &parts[index]);
            match (carver.part(&frame, domain.grid.cube(index), old.map(|part| &**part)), old) {
                (None, Some(old)) => old.clone(),
                (part, _) => Arc::new(part.unwrap_or_default()),
            }
        };
        let cells = (0..domain.grid.cells()).into_par_iter().with_max_len(1);
        cells.map_init(Carver::default, carve).collect()
    }
}

/// Top cells, then all blocks, then all tokens, to be put behind `before` words.
fn assembled(parts: &[Arc<Part>], before: usize) -> Vec<[u32; 2]> {
    let cells: usize = parts.len() + parts.iter().map(|part| part.cells.len()).sum::<usize>();
    let tokens: usize = parts.iter().map(|part| part.tokens.len()).sum();
    let mut words = vec![[0; 2]; cells + tokens];
    let (tops, mut rest) = words.split_at_mut(parts.len());
    let (mut blocks, mut lists);
    (blocks, rest) = rest.split_at_mut(cells - parts.len());
    lists = rest;
    let (mut at_block, mut at_token) = (before + parts.len(), before + cells);
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
