//! The tree of one component with its inputs, so that an edit rebuilds only what it changed.

use std::sync::Arc;
use std::time::{Duration, Instant};

use super::build::{Build, TopCells};
use super::cell_tree::CellTree;
use super::domain::{Domain, domains_of};
use crate::eval::BlendParams;
use crate::{
    Component, FlatNode, FlatScene, LEAF_ROWS, MODIFIER_ROWS, ParamRow, leaf_payload, modifier_payload, modifier_rows,
};
use isolith_scene::ShapeKind;

/// A component's tree, and the state of the component that it was built from.
#[derive(Debug)]
pub(super) struct CachedTree {
    of: FlatScene,
    domains: Vec<Domain>,
    size: f64,
    pub tree: Arc<CellTree>,
    top_cells: TopCells,
    /// The build time.
    pub took: Duration,
}

/// What an edit did to a component.
enum Change {
    /// Nothing that the tapes depend on has changed.
    None,
    /// Only these entries have other parameters or join in another way.
    Some(Vec<bool>),
    /// The component has another structure, or the changes are too many to be worth finding.
    All,
}

/// If more than this fraction of the entries has changed, the cache rebuilds all cells.
const MOST_CHANGED: f64 = 0.25;

/// A component by itself: all inputs of its tapes, with rows counted from its first, without materials.
pub(super) fn isolate(flat: &FlatScene, component: &Component) -> FlatScene {
    FlatScene {
        nodes: nodes(flat, component).collect(),
        params: params(flat, component).to_vec(),
        components: vec![Component { first: 0, params: 0, ..component.clone() }],
        bricks: flat.bricks.clone(),
        ..FlatScene::default()
    }
}

impl CachedTree {
    /// The tree of an isolated component, see [`isolate`], from its previous tree if it had one.
    pub fn new(of: FlatScene, old: Option<Self>) -> Self {
        let start = Instant::now();
        let component = &of.components[0];
        let build = Build::new(&of, component);
        let change = match &old {
            Some(old) if old.domains == build.domains && old.size == build.size() => old.change(&of, component),
            _ => Change::All,
        };
        let (tree, top_cells) = match (change, old) {
            (Change::None, Some(old)) => return old,
            (Change::Some(changed), Some(old)) => build.again(&changed, &old.top_cells),
            _ => build.fresh(),
        };
        let (size, domains) = (build.size(), build.domains);
        Self { of, domains, size, tree: Arc::new(tree), top_cells, took: start.elapsed() }
    }

    /// Whether nothing that the tapes depend on has changed.
    pub fn is_current(&self, flat: &FlatScene, component: &Component) -> bool {
        // The domains depend on more than the parameters.
        matches!(self.change(flat, component), Change::None)
            && domains_of(flat, component).is_some_and(|domains| domains == self.domains)
    }

    fn change(&self, flat: &FlatScene, component: &Component) -> Change {
        let (old, new_params) = (&self.of, params(flat, component));
        if old.nodes.len() != component.count as usize || old.params.len() != new_params.len() {
            return Change::All;
        }
        let mut changed = vec![false; old.nodes.len()];
        let mut count = 0;
        for (index, (was, is)) in old.nodes.iter().zip(nodes(flat, component)).enumerate() {
            let form = |node: &FlatNode| (node.extent, node.params, node.modifier(), node.is_group(), node.is_run());
            if form(was) != form(&is) {
                return Change::All;
            }
            let first = is.params as usize;
            // Tapes do not depend on a run at all, and of a group's parameters only on its blend: bounds merely say
            // sooner what the leaves would.
            let same = match () {
                () if is.is_run() => true,
                () if is.is_group() => {
                    was.code == is.code
                        && BlendParams::read(&old.params[first]) == BlendParams::read(&new_params[first])
                }
                () if is.modifier().is_some() => {
                    was.code == is.code && modifier(&is, &old.params[first..]) == modifier(&is, &new_params[first..])
                }
                () => was.code == is.code && leaf(&is, &old.params[first..]) == leaf(&is, &new_params[first..]),
            };
            changed[index] = !same;
            count += usize::from(!same);
        }
        // A modifier and its content are one operand.
        for (index, node) in old.nodes.iter().enumerate().filter(|(_, node)| node.modifier().is_some()) {
            changed[index] = changed[index..][..node.extent as usize].contains(&true);
        }
        match count {
            0 => Change::None,
            _ if count as f64 > MOST_CHANGED * changed.len() as f64 => Change::All,
            _ => Change::Some(changed),
        }
    }
}

/// The rows and the payload of a leaf whose rows `params` begins with.
fn leaf<'a>(node: &FlatNode, params: &'a [ParamRow]) -> [&'a [ParamRow]; 2] {
    let kind = ShapeKind::ALL[(node.code & 0xffff) as usize];
    [&params[..LEAF_ROWS + kind.rows()], leaf_payload(kind, params)]
}

/// The rows and the payload of a modifier.
fn modifier<'a>(node: &FlatNode, params: &'a [ParamRow]) -> Option<[&'a [ParamRow]; 2]> {
    let kind = node.modifier()?;
    Some([&params[..MODIFIER_ROWS + modifier_rows(kind)], modifier_payload(kind, &params[MODIFIER_ROWS..])])
}

fn nodes<'a>(flat: &'a FlatScene, component: &'a Component) -> impl Iterator<Item = FlatNode> + 'a {
    let nodes = &flat.nodes[component.first as usize..][..component.count as usize];
    nodes.iter().map(|node| FlatNode { params: node.params - component.params, material: 0, ..*node })
}

fn params<'a>(flat: &'a FlatScene, component: &Component) -> &'a [ParamRow] {
    &flat.params[component.params as usize..][..component.param_rows as usize]
}
