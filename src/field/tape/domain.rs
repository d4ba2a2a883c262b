//! The spaces of a component that have tapes of their own: that of the component, and that of what each modifier holds.
//!
//! A modifier is one operand where it stands; what it holds has tapes in its own space, so they stay right whatever it
//! does to that space. But there more than the surface matters: a shell of 0.1 m needs the field up to 0.1 m to the last
//! bit, a blend as far as it reaches. So a domain says up to which value its field must be exact; only cells beyond that
//! are without a tape.

use std::ops::Range;

use super::grid::{Grid, SIZE_SLACK};
use super::tape_entry::{MAX_TAPE_DOMAINS, MAX_TAPE_ENTRIES};
use crate::eval::BlendParams;
use crate::modifier_table::content_exactness;
use crate::{Component, FlatNode, FlatScene, Join, MODIFIER_ROWS, ModifierDomain, ParamRow};
use isolith_scene::ModifierKind;

/// Components of at least so many entries have tapes: those of fewer are walked as fast without.
const LEAST_TAPE_ENTRIES: u32 = 5;
/// The same with modifiers, whose kernel has more to do for a tape.
const LEAST_MODIFIED_ENTRIES: u32 = 24;

/// A space that has tapes.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Domain {
    /// Its entries, counted from the component's first; with those of modifiers in it, which are no operands here.
    pub entries: Range<usize>,
    /// Where its cells lie.
    pub grid: Grid,
    /// Its field must be exact wherever it is no farther from 0 than this, in meters.
    pub exact: f64,
    /// How often it may be evaluated for one point of the component.
    pub copies: u32,
}

/// Whether a component has tapes: it, or what a modifier in it holds, must be bounded and large enough for them to pay.
pub fn has_tape(flat: &FlatScene, component: &Component) -> bool {
    let least = least_entries(component);
    component.count >= least && has_domains(flat, component, least)
}

/// So many entries of its own space, or of what a modifier holds, have tapes.
fn least_entries(component: &Component) -> u32 {
    if component.is_modified() { LEAST_MODIFIED_ENTRIES } else { LEAST_TAPE_ENTRIES }
}

/// Whether a component may have tapes, however small it is.
pub(super) fn can_have_tape(flat: &FlatScene, component: &Component) -> bool {
    has_domains(flat, component, 1)
}

fn has_domains(flat: &FlatScene, component: &Component, least: u32) -> bool {
    component.count <= MAX_TAPE_ENTRIES
        && component.modifier_domains.len() <= MAX_TAPE_DOMAINS
        && domains(flat, component, least).is_some()
}

/// The domains of a component that has tapes, because it is large or because all should have some.
pub(super) fn domains_of(flat: &FlatScene, component: &Component) -> Option<Vec<Domain>> {
    domains(flat, component, least_entries(component)).or_else(|| domains(flat, component, 1))
}

/// The domains of a component: its own, then those of its contents; those of `least` entries have a grid. Nothing where
/// none has.
fn domains(flat: &FlatScene, component: &Component, least: u32) -> Option<Vec<Domain>> {
    let nodes = &flat.nodes[component.first as usize..][..component.count as usize];
    let rows = |node: &FlatNode| &flat.params[node.params as usize..];
    let mut exact = vec![0.0; component.modifier_domains.len()];
    // Asked of every large component in each frame that changes anything; few hold modifiers.
    if component.is_modified() {
        fill_exact(
            &Entries { nodes, rows: &rows, modifier_domains: &component.modifier_domains },
            0..nodes.len(),
            0.0,
            &mut exact,
        );
    }
    let size = component.bounds.min.abs().max(component.bounds.max.abs()).max_element();
    let own =
        ModifierDomain { entry: 0, bounds: component.bounds, cull_box: component.bounds, bound_slope: 0.0, copies: 1 };
    let first = std::iter::once((&own, 0..nodes.len(), 0.0));
    let inner = component.modifier_domains.iter().zip(exact).map(|(content, exact)| {
        let at = content.entry as usize;
        (content, at + 1..at + nodes[at].extent as usize, exact)
    });
    let all: Vec<Domain> = first
        .chain(inner)
        .map(|(content, entries, exact)| {
            let is_large = own_entries(nodes, entries.clone()) >= least as usize;
            let exact = if exact > 0.0 { exact + SIZE_SLACK * (exact + size) } else { 0.0 };
            let grid = if is_large { Grid::around(content, exact) } else { Grid::ONE_CELL };
            Domain { entries, grid, exact, copies: content.copies }
        })
        .collect();
    all.iter().any(|domain| domain.grid != Grid::ONE_CELL).then_some(all)
}

/// How many entries of a range do not stand within a modifier that does.
fn own_entries(nodes: &[FlatNode], range: Range<usize>) -> usize {
    let (mut at, mut count) = (range.start, 0);
    while at < range.end {
        count += 1;
        at += if nodes[at].modifier().is_some() { nodes[at].extent as usize } else { 1 };
    }
    count
}

struct Entries<'a> {
    nodes: &'a [FlatNode],
    rows: &'a dyn Fn(&FlatNode) -> &'a [ParamRow],
    modifier_domains: &'a [ModifierDomain],
}

/// Finds how exact the contents of modifiers in the fold `range` must be, where that fold must be up to `exact`.
fn fill_exact(entries: &Entries<'_>, range: Range<usize>, exact: f64, out: &mut [f64]) {
    let mut operands = Vec::new();
    let mut at = range.start;
    while at < range.end {
        let node = &entries.nodes[at];
        if node.is_run() {
            at += 1;
            continue;
        }
        operands.push(at);
        at += node.extent as usize;
    }
    // From the last to the first, since each blend after an operand needs more of it.
    let mut needed = exact;
    for (i, index) in operands.iter().enumerate().rev() {
        let node = &entries.nodes[*index];
        let rows = (entries.rows)(node);
        if i > 0 {
            needed += before_blend(node, rows);
        }
        let inside = index + 1..index + node.extent as usize;
        match node.modifier() {
            Some(kind) => {
                let of = entries.modifier_domains.iter().position(|content| content.entry as usize == *index);
                let needed = of_content(kind, rows, needed);
                out[of.expect("every modifier holds something")] = needed;
                fill_exact(entries, inside, needed, out);
            }
            None if node.is_group() => fill_exact(entries, inside, needed, out),
            None => {}
        }
    }
}

/// How much farther than its result the operands of a blend must be exact: where they differ by the support of the blend
/// the blend is hard, and beyond twice the support it stays beyond whatever the far one is. Nothing is known of the
/// extended operators.
fn before_blend(node: &FlatNode, rows: &[ParamRow]) -> f64 {
    match Join::ALL[node.join() as usize] {
        Join::Union | Join::Intersection | Join::Difference | Join::ReverseDifference => {
            2.0 * BlendParams::read(&rows[0]).support
        }
        _ => f64::INFINITY,
    }
}

/// How exact the content must be for a modifier's field to be exact up to `exact`.
fn of_content(kind: ModifierKind, rows: &[ParamRow], exact: f64) -> f64 {
    // What follows from a distance scale of 0 is not evaluated.
    let local = exact / f64::from(rows[1][3]).max(f64::MIN_POSITIVE);
    let own = |row: usize, column: usize| f64::from(rows[MODIFIER_ROWS + row][column]);
    content_exactness(kind, local, &own)
}
