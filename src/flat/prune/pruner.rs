//! Trees kept between frames, made anew only where an edit reached.

use std::collections::HashMap;
use std::sync::Arc;

use super::build::{Build, Grid};
use super::part::Part;
use super::{CellTree, is_pruned};
use crate::flat::twin::Joint;
use crate::flat::{Component, FlatNode, FlatScene, LEAF_ROWS, Row, leaf_data};
use crate::scene::{NodeId, ShapeKind};

/// The lists of a scene.
#[derive(Clone, Debug, Default)]
pub struct Lists {
    /// Beside [`FlatScene::components`]; nothing for those that are walked without lists.
    pub trees: Vec<Option<Arc<CellTree>>>,
}

/// Keeps the trees of the last scene, and makes those of the next one from them.
#[derive(Debug, Default)]
pub struct Pruner {
    kept: HashMap<NodeId, Kept>,
    lists: Arc<Lists>,
}

/// A component as it was the last time.
#[derive(Debug)]
struct Kept {
    /// With rows counted from the component's first, and without materials.
    nodes: Vec<FlatNode>,
    numbers: Vec<Row>,
    grid: Grid,
    size: f64,
    tree: Arc<CellTree>,
    parts: Vec<Arc<Part>>,
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

impl Pruner {
    /// The lists of all components that have lists. A scene in which nothing has changed keeps them: the
    /// same [`Arc`] as the last time.
    pub fn lists(&mut self, flat: &FlatScene) -> Arc<Lists> {
        let trees = self.trees(flat, &vec![true; flat.components.len()]);
        let same = |(a, b): (&Option<Arc<CellTree>>, &Option<Arc<CellTree>>)| match (a, b) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (a, b) => a.is_none() && b.is_none(),
        };
        if trees.len() != self.lists.trees.len() || !trees.iter().zip(&self.lists.trees).all(same) {
            self.lists = Arc::new(Lists { trees });
        }
        self.lists.clone()
    }

    /// The trees of those components that are `wanted` and have lists, beside [`FlatScene::components`]. One that
    /// has not changed keeps its tree: the same [`Arc`] as the last time.
    pub fn trees(&mut self, flat: &FlatScene, wanted: &[bool]) -> Vec<Option<Arc<CellTree>>> {
        let mut old = std::mem::take(&mut self.kept);
        let mut tree = |(component, wanted): (&Component, &bool)| {
            if !wanted || !is_pruned(component) {
                return None;
            }
            let id = flat.ids[component.first as usize];
            let kept = match old.remove(&id) {
                Some(kept) => kept.brought_up_to_date(flat, component),
                None => Kept::new(flat, component),
            };
            let tree = kept.tree.clone();
            self.kept.insert(id, kept);
            Some(tree)
        };
        flat.components.iter().zip(wanted).map(&mut tree).collect()
    }
}

impl Kept {
    fn new(flat: &FlatScene, component: &Component) -> Self {
        let build = Build::new(flat, component);
        let (tree, parts) = build.fresh();
        Self {
            nodes: nodes(flat, component).collect(),
            numbers: numbers(flat, component).to_vec(),
            grid: build.grid,
            size: build.size(),
            tree: Arc::new(tree),
            parts,
        }
    }

    fn brought_up_to_date(mut self, flat: &FlatScene, component: &Component) -> Self {
        if self.grid != Grid::new(component) {
            return Self::new(flat, component);
        }
        match self.change(flat, component) {
            Change::None => {}
            Change::All => return Self::new(flat, component),
            Change::Some(changed) => {
                let build = Build::new(flat, component);
                if build.size() != self.size {
                    return Self::new(flat, component);
                }
                let (tree, parts) = build.again(&changed, &self.parts);
                (self.tree, self.parts) = (Arc::new(tree), parts);
            }
        }
        self.nodes.clear();
        self.nodes.extend(nodes(flat, component));
        self.numbers.clear();
        self.numbers.extend_from_slice(numbers(flat, component));
        self
    }

    fn change(&self, flat: &FlatScene, component: &Component) -> Change {
        let new_numbers = numbers(flat, component);
        if self.nodes.len() != component.count as usize || self.numbers.len() != new_numbers.len() {
            return Change::All;
        }
        let mut changed = vec![false; self.nodes.len()];
        let mut count = 0;
        for (index, (old, new)) in self.nodes.iter().zip(nodes(flat, component)).enumerate() {
            let form = |node: &FlatNode| (node.extent, node.numbers, node.is_group(), node.is_run());
            if form(old) != form(&new) {
                return Change::All;
            }
            let first = new.numbers as usize;
            // Lists do not depend on a run at all, and of a group's numbers only on its joint: bounds
            // merely tell sooner what the leaves would.
            let same = match () {
                () if new.is_run() => true,
                () if new.is_group() => {
                    old.code == new.code && Joint::read(&self.numbers[first]) == Joint::read(&new_numbers[first])
                }
                () => {
                    let kind = ShapeKind::ALL[(new.code & 0xffff) as usize];
                    let last = first + LEAF_ROWS + kind.rows();
                    let data = |numbers: &[Row]| leaf_data(kind, &numbers[first..]).to_vec();
                    old.code == new.code
                        && self.numbers[first..last] == new_numbers[first..last]
                        && data(&self.numbers) == data(new_numbers)
                }
            };
            changed[index] = !same;
            count += usize::from(!same);
        }
        match count {
            0 => Change::None,
            _ if count as f64 > MOST_CHANGED * changed.len() as f64 => Change::All,
            _ => Change::Some(changed),
        }
    }
}

fn nodes<'a>(flat: &'a FlatScene, component: &'a Component) -> impl Iterator<Item = FlatNode> + 'a {
    let nodes = &flat.nodes[component.first as usize..][..component.count as usize];
    nodes.iter().map(|node| FlatNode { numbers: node.numbers - component.numbers, material: 0, ..*node })
}

fn numbers<'a>(flat: &'a FlatScene, component: &Component) -> &'a [Row] {
    &flat.numbers[component.numbers as usize..][..component.rows as usize]
}
