//! Edits that move, copy or remove many nodes: each builds the new table of nodes in one pass.

use std::collections::{HashMap, HashSet};
use std::ops::Range;
use std::sync::Arc;

use super::links;
use super::placement::kept_in_place;
use isolith_scene::limits::MAX_NAME;
use isolith_scene::{Node, NodeId, Scene, SceneError};

/// Removes nodes with their subtrees.
pub(super) fn remove(scene: &mut Arc<Scene>, ids: &[NodeId]) -> Result<(), SceneError> {
    let (rest, _) = split(scene, &tops(scene, ids)?);
    Arc::make_mut(scene).set_nodes(rest)
}

/// Makes nodes children of `parent`, from `position` on, counted without the moved nodes.
pub(super) fn move_to(
    scene: &mut Arc<Scene>,
    ids: &[NodeId],
    parent: Option<NodeId>,
    position: usize,
) -> Result<(), SceneError> {
    let tops = tops(scene, ids)?;
    if let Some(p) = parent {
        let target = scene.index_of(p).ok_or(SceneError::NoNode(p))?;
        if let Some(top) = tops.iter().find(|t| t.contains(&target)) {
            return Err(SceneError::Cycle(scene.nodes()[top.start].id));
        }
    }
    let (mut nodes, mut moved) = split(scene, &tops);
    let mut at = 0;
    for range in &tops {
        let transform = kept_in_place(scene, scene.nodes()[range.start].id, parent);
        let top = Arc::make_mut(&mut moved[at]);
        (top.parent, top.transform) = (parent, transform);
        at += range.len();
    }
    let place = place_of(&nodes, parent, position);
    nodes.splice(place..place, moved);
    Arc::make_mut(scene).set_nodes(nodes)
}

/// Puts nodes into `node`, a new group or instancer, at the position of the first of them. Returns its id.
pub(super) fn group(scene: &mut Arc<Scene>, ids: &[NodeId], node: Node) -> Result<NodeId, SceneError> {
    let tops = tops(scene, ids)?;
    let first = tops.first().ok_or(SceneError::Nothing)?;
    let first = &scene.nodes()[first.start];
    let (first_id, parent) = (first.id, first.parent);
    let position = scene.children(parent).position(|n| n.id == first_id).unwrap_or(usize::MAX);
    // Both steps run on a copy: the second can fail at the limit of nesting.
    let mut next = Scene::clone(scene);
    let id = next.insert(parent, position, node)?;
    let mut next = Arc::new(next);
    move_to(&mut next, ids, Some(id), 0)?;
    *scene = next;
    Ok(id)
}

/// Adds a copy behind each node. Returns the ids of the copies' top nodes.
pub(super) fn duplicate(scene: &mut Arc<Scene>, ids: &[NodeId], is_linked: bool) -> Result<Vec<NodeId>, SceneError> {
    let tops = tops(scene, ids)?;
    // On failure the scene is unchanged.
    let mut next = Arc::clone(scene);
    if is_linked {
        links::link(&mut next, tops.iter().cloned().flatten())?;
    }
    let added = copy(&mut next, tops, is_linked)?;
    *scene = next;
    Ok(added)
}

/// Adds a copy of each of these subtrees behind it.
fn copy(scene: &mut Arc<Scene>, tops: Vec<Range<usize>>, is_linked: bool) -> Result<Vec<NodeId>, SceneError> {
    let mut names = FreeNames::new(scene);
    let mut next_id = scene.next_id();
    let (mut nodes, mut added, mut done) = (Vec::with_capacity(scene.nodes().len()), Vec::new(), 0);
    let mut new_id: HashMap<NodeId, NodeId> = HashMap::new();
    for range in tops {
        nodes.extend_from_slice(&scene.nodes()[done..range.end]);
        done = range.end;
        let originals = &scene.nodes()[range];
        added.push(NodeId(next_id));
        for (i, original) in originals.iter().enumerate() {
            let mut copy = Node::clone(original);
            copy.id = NodeId(next_id);
            next_id += 1;
            new_id.insert(original.id, copy.id);
            copy.linked = copy.linked.filter(|_| is_linked);
            copy.parent = copy.parent.map(|p| new_id.get(&p).copied().unwrap_or(p));
            if i == 0 {
                copy.name = names.next(copy.parent, &copy.name);
            }
            nodes.push(Arc::new(copy));
        }
    }
    nodes.extend_from_slice(&scene.nodes()[done..]);
    // What is copied together keeps together: a copy of an instancer stands on the copy of its target.
    let first_copy = added.first().map_or(u64::MAX, |id| id.0);
    for copy in nodes.iter_mut().filter(|node| node.id.0 >= first_copy) {
        Arc::make_mut(copy).rename_references(|id| new_id.get(&id).copied());
    }
    let scene = Arc::make_mut(scene);
    scene.set_nodes(nodes)?;
    scene.copy_tracks(&new_id)?;
    Ok(added)
}

/// The ranges of the nodes' subtrees in table order, without those inside another one.
pub(super) fn tops(scene: &Scene, ids: &[NodeId]) -> Result<Vec<Range<usize>>, SceneError> {
    let mut starts = ids
        .iter()
        .map(|id| scene.index_of(*id).ok_or(SceneError::NoNode(*id)))
        .collect::<Result<Vec<usize>, SceneError>>()?;
    starts.sort_unstable();
    let mut ranges: Vec<Range<usize>> = Vec::new();
    for start in starts {
        if ranges.last().is_none_or(|r| start >= r.end) {
            ranges.push(scene.subtree(start));
        }
    }
    Ok(ranges)
}

/// Separates the nodes outside and inside of the ranges.
fn split(scene: &Scene, ranges: &[Range<usize>]) -> (Vec<Arc<Node>>, Vec<Arc<Node>>) {
    let (mut rest, mut taken, mut done) = (Vec::with_capacity(scene.nodes().len()), Vec::new(), 0);
    for range in ranges {
        rest.extend_from_slice(&scene.nodes()[done..range.start]);
        taken.extend_from_slice(&scene.nodes()[range.clone()]);
        done = range.end;
    }
    rest.extend_from_slice(&scene.nodes()[done..]);
    (rest, taken)
}

/// The index in a pre-order table of the `position`-th child of `parent`, existing or new.
fn place_of(nodes: &[Arc<Node>], parent: Option<NodeId>, position: usize) -> usize {
    let Some(parent) = parent else {
        let nth = nodes.iter().enumerate().filter(|(_, n)| n.parent.is_none()).nth(position);
        return nth.map_or(nodes.len(), |(i, _)| i);
    };
    let Some(start) = nodes.iter().position(|n| n.id == parent) else { return nodes.len() };
    let mut inside = HashSet::from([parent]);
    let mut count = 0;
    for (i, node) in nodes.iter().enumerate().skip(start + 1) {
        let Some(p) = node.parent.filter(|p| inside.contains(p)) else { return i };
        inside.insert(node.id);
        if p == parent {
            if count == position {
                return i;
            }
            count += 1;
        }
    }
    nodes.len()
}

/// Finds names that no sibling has, by counting up the number at their end: `Pawn` → `Pawn 2`, `Pawn 7` → `Pawn 8`.
pub(super) struct FreeNames {
    taken: HashSet<(Option<NodeId>, String)>,
    /// The last number tried, per parent and name without number.
    last: HashMap<(Option<NodeId>, String), u64>,
}

impl FreeNames {
    pub fn new(scene: &Scene) -> Self {
        let taken = scene.nodes().iter().map(|n| (n.parent, n.name.clone())).collect();
        Self { taken, last: HashMap::new() }
    }

    /// The name itself if no child of `parent` has it.
    pub fn free(&mut self, parent: Option<NodeId>, name: &str) -> String {
        if self.taken.insert((parent, name.to_owned())) { name.to_owned() } else { self.next(parent, name) }
    }

    fn next(&mut self, parent: Option<NodeId>, name: &str) -> String {
        let numbered = name.rsplit_once(' ').and_then(|(base, n)| Some((base, n.parse::<u32>().ok()?)));
        let (base, number) = numbered.map_or((name, 1), |(base, n)| (base, u64::from(n)));
        // Leaves room for the longest number.
        let base: String = base.chars().take(MAX_NAME - 12).collect();
        let last = self.last.entry((parent, base.clone())).or_insert(number);
        loop {
            *last += 1;
            let candidate = (parent, format!("{base} {last}"));
            if self.taken.insert(candidate.clone()) {
                return candidate.1;
            }
        }
    }
}
