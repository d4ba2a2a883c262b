//! The tree of one component with what it was made from, so that it is made anew only where an edit reached.

use std::sync::Arc;
use std::time::{Duration, Instant};

use super::CellTree;
use super::build::{Build, Parts};
use super::domain::{Domain, domains_of};
use crate::flat::twin::Joint;
use crate::flat::{
    Component, FlatNode, FlatScene, LEAF_ROWS, MODIFIER_ROWS, Row, leaf_data, modifier_data, modifier_rows,
};
use crate::scene::ShapeKind;

/// A component's tree, and the component as it was then.
#[derive(Debug)]
pub(super) struct Kept {
    of: FlatScene,
    domains: Vec<Domain>,
    size: f64,
    pub tree: Arc<CellTree>,
    parts: Parts,
    /// How long it took to make.
    pub took: Duration,
}

/// What an edit did to a component.
enum Change {
    /// Nothing that the lists depend on.
    None,
    /// Only these entries have other numbers or join in another way.
    Some(Vec<bool>),
    /// The component has another form, or more has changed than is worth looking for.
    All,
}

/// Where more than this share of the entries has changed, all is made anew.
const MOST_CHANGED: f64 = 0.25;

/// A component by itself: all that lists are made from, with rows counted from its first, without materials.
pub(super) fn alone(flat: &FlatScene, component: &Component) -> FlatScene {
    FlatScene {
        nodes: nodes(flat, component).collect(),
        numbers: numbers(flat, component).to_vec(),
        components: vec![Component { first: 0, numbers: 0, ..component.clone() }],
        ..FlatScene::default()
    }
}

impl Kept {
    /// The tree of a component that stands [`alone`], from the one that it had before, if it had one.
    pub fn new(of: FlatScene, old: Option<Self>) -> Self {
        let start = Instant::now();
        let component = &of.components[0];
        let build = Build::new(&of, component);
        let change = match &old {
            Some(old) if old.domains == build.domains && old.size == build.size() => old.change(&of, component),
            _ => Change::All,
        };
        let (tree, parts) = match (change, old) {
            (Change::None, Some(old)) => return old,
            (Change::Some(changed), Some(old)) => build.again(&changed, &old.parts),
            _ => build.fresh(),
        };
        let (size, domains) = (build.size(), build.domains);
        Self { of, domains, size, tree: Arc::new(tree), parts, took: start.elapsed() }
    }

    /// Whether nothing has changed that the lists depend on.
    pub fn is_current(&self, flat: &FlatScene, component: &Component) -> bool {
        // What the domains follow from is not all in the numbers.
        matches!(self.change(flat, component), Change::None)
            && domains_of(flat, component).is_some_and(|domains| domains == self.domains)
    }

    fn change(&self, flat: &FlatScene, component: &Component) -> Change {
        let (old, new_numbers) = (&self.of, numbers(flat, component));
        if old.nodes.len() != component.count as usize || old.numbers.len() != new_numbers.len() {
            return Change::All;
        }
        let mut changed = vec![false; old.nodes.len()];
        let mut count = 0;
        for (index, (was, is)) in old.nodes.iter().zip(nodes(flat, component)).enumerate() {
            let form = |node: &FlatNode| (node.extent, node.numbers, node.modifier(), node.is_group(), node.is_run());
            if form(was) != form(&is) {
                return Change::All;
            }
            let first = is.numbers as usize;
            // Lists do not depend on a run at all, and of a group's numbers only on its joint: bounds
            // merely tell sooner what the leaves would.
            let same = match () {
                () if is.is_run() => true,
                () if is.is_group() => {
                    was.code == is.code && Joint::read(&old.numbers[first]) == Joint::read(&new_numbers[first])
                }
                () if is.modifier().is_some() => {
                    was.code == is.code && modifier(&is, &old.numbers[first..]) == modifier(&is, &new_numbers[first..])
                }
                () => was.code == is.code && leaf(&is, &old.numbers[first..]) == leaf(&is, &new_numbers[first..]),
            };
            changed[index] = !same;
            count += usize::from(!same);
        }
        // A modifier is one operand with all that it holds.
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

/// The rows and the data of a leaf whose rows `numbers` begins with.
fn leaf<'a>(node: &FlatNode, numbers: &'a [Row]) -> [&'a [Row]; 2] {
    let kind = ShapeKind::ALL[(node.code & 0xffff) as usize];
    [&numbers[..LEAF_ROWS + kind.rows()], leaf_data(kind, numbers)]
}

/// The same of a modifier.
fn modifier<'a>(node: &FlatNode, numbers: &'a [Row]) -> Option<[&'a [Row]; 2]> {
    let kind = node.modifier()?;
    Some([&numbers[..MODIFIER_ROWS + modifier_rows(kind)], modifier_data(kind, &numbers[MODIFIER_ROWS..])])
}

fn nodes<'a>(flat: &'a FlatScene, component: &'a Component) -> impl Iterator<Item = FlatNode> + 'a {
    let nodes = &flat.nodes[component.first as usize..][..component.count as usize];
    nodes.iter().map(|node| FlatNode { numbers: node.numbers - component.numbers, material: 0, ..*node })
}

fn numbers<'a>(flat: &'a FlatScene, component: &Component) -> &'a [Row] {
    &flat.numbers[component.numbers as usize..][..component.rows as usize]
}
