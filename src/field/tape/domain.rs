//! The spaces of a component that have tapes of their own: that of the component, and that of each modifier's
//! content.
//!
//! Outside, a modifier is one operand; its content has tapes in its own space, so they stay valid however the
//! modifier deforms that space. But inside, more than the surface matters: a shell of 0.1 m needs the field up to 0.1
//! m to the last bit, a blend needs it as far as its support. So a domain states up to which value its field must be
//! exact; only cells beyond that value have no tape.

use std::ops::Range;

use super::grid::{Grid, SIZE_SLACK};
use super::tape_entry::{MAX_TAPE_DOMAINS, MAX_TAPE_ENTRIES};
use crate::eval::BlendParams;
use crate::modifier_table::content_exactness;
use crate::{Component, FlatNode, FlatScene, Join, MODIFIER_ROWS, ModifierDomain, ParamRow};
use isolith_scene::ModifierKind;

/// The least number of entries of a component with tapes; smaller ones evaluate as fast without.
const LEAST_TAPE_ENTRIES: u32 = 5;
/// The same for components with modifiers, whose shader does more work per tape.
const LEAST_MODIFIED_ENTRIES: u32 = 24;

/// A space that has tapes.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Domain {
    /// Its entries, counted from the component's first. The entries inside its modifiers are included, but are not
    /// operands here.
    pub entries: Range<usize>,
    /// The grid of its cells.
    pub grid: Grid,
    /// Its field must be exact where its absolute value is at most this, in meters.
    pub exact: f64,
    /// The largest number of evaluations for one point of the component.
    pub copies: u32,
}

/// Whether a component has tapes: it, or the content of a modifier in it, must be bounded and large enough for them
/// to pay.
pub fn has_tape(flat: &FlatScene, component: &Component) -> bool {
    let least = least_entries(component);
    component.count >= least && has_domains(flat, component, least)
}

/// The least number of entries, of its own space or of a modifier's content, for tapes.
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

/// The domains of a component that has tapes, because it is large or because all components shall have tapes.
pub(super) fn domains_of(flat: &FlatScene, component: &Component) -> Option<Vec<Domain>> {
    domains(flat, component, least_entries(component)).or_else(|| domains(flat, component, 1))
}

/// The domains of a component: its own, then those of its modifiers' contents. Those with at least `least` entries
/// have a grid. `None` if no domain has one.
fn domains(flat: &FlatScene, component: &Component, least: u32) -> Option<Vec<Domain>> {
    let nodes = &flat.nodes[component.first as usize..][..component.count as usize];
    let rows = |node: &FlatNode| &flat.params[node.params as usize..];
    let mut exact = vec![0.0; component.modifier_domains.len()];
    // Every change of the scene asks this of each large component; few hold modifiers.
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

/// The number of entries of a range that are not inside a modifier of that range.
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

/// Computes how exact the contents of modifiers in the fold `range` must be, if that fold must be exact up to
/// `exact`.
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
    // From the last to the first, since each blend after an operand raises the exactness that it needs.
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

/// The additional exactness that the operands of a blend need over its result. Operands that differ by the support of
/// the blend join hard; beyond twice the support they stay hard whatever the value of the far operand. For the
/// extended operators no bound is known.
fn before_blend(node: &FlatNode, rows: &[ParamRow]) -> f64 {
    match Join::ALL[node.join() as usize] {
        Join::Union | Join::Intersection | Join::Difference | Join::ReverseDifference => {
            2.0 * BlendParams::read(&rows[0]).support
        }
        _ => f64::INFINITY,
    }
}

/// The exactness of the content for a modifier's field to be exact up to `exact`.
fn of_content(kind: ModifierKind, rows: &[ParamRow], exact: f64) -> f64 {
    // The evaluators do not evaluate the result of a distance scale of 0.
    let local = exact / f64::from(rows[1][3]).max(f64::MIN_POSITIVE);
    content_exactness(kind, local, &rows[MODIFIER_ROWS..])
}
