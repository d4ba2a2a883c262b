//! Actions on the selection; each function is one undo step.

use std::collections::HashSet;
use std::sync::Arc;

use super::edit_session::EditSession;
use super::messages::Message;
use isolith_document::Edit;
use isolith_scene::{Group, MaterialId, Node, NodeId, NodeKind, Operation, Operator, Scene};

/// The selected nodes without a selected ancestor, in scene order.
pub fn roots(session: &EditSession) -> Vec<NodeId> {
    let scene = session.document.scene();
    let mut ids = session.document.selection().to_vec();
    ids.sort_by_key(|id| scene.index_of(*id));
    let mut roots: Vec<NodeId> = Vec::new();
    for id in ids {
        if !roots.last().is_some_and(|root| scene.is_within(id, *root)) {
            roots.push(id);
        }
    }
    roots
}

/// The node whose lock holds this node: itself or a locked ancestor.
pub fn holder_of_lock(scene: &Scene, id: NodeId) -> Option<&Node> {
    let mut at = scene.node(id);
    while let Some(node) = at {
        if node.locked {
            return Some(node);
        }
        at = node.parent.and_then(|parent| scene.node(parent));
    }
    None
}

/// The node whose lock prevents a deletion: as [`holder_of_lock`], or a locked descendant.
fn lock_in_the_way(scene: &Scene, id: NodeId) -> Option<&Node> {
    let below = scene.index_of(id).map_or(0..0, |index| scene.subtree(index));
    holder_of_lock(scene, id).or_else(|| scene.nodes()[below].iter().map(|node| &**node).find(|node| node.locked))
}

/// Warns if a lock prevents an action on the nodes, and returns whether one does.
pub fn refuse_locked(session: &mut EditSession, ids: &[NodeId], wanted: &str) -> bool {
    let scene = session.document.scene();
    let Some(locked) = ids.iter().find_map(|id| holder_of_lock(scene, *id)) else { return false };
    let text = format!("“{}” is locked and cannot be {wanted}. Unlock it first.", locked.name);
    session.messages.push(Message::warning(text));
    true
}

/// Duplicates the selection and selects the copies.
pub fn duplicate(session: &mut EditSession) {
    let added = session.apply(Edit::Duplicate(roots(session)));
    if !added.is_empty() {
        session.document.select(added);
    }
}

/// Duplicates the selection and selects the copies, whose objects share shape and material with their originals.
pub fn duplicate_linked(session: &mut EditSession) {
    let added = session.apply(Edit::DuplicateLinked(roots(session)));
    if !added.is_empty() {
        session.document.select(added);
    }
}

/// Takes the selected objects, and those in the selected groups, out of their sets of linked ones.
pub fn unlink(session: &mut EditSession) {
    let linked = linked_in_selection(session);
    session.document.begin_step("Unlink");
    for node in linked {
        session.apply(Edit::Replace(Node { linked: None, ..Node::clone(&node) }));
    }
    session.document.end_gesture();
}

/// The linked objects that are selected or in selected groups.
pub fn linked_in_selection(session: &EditSession) -> Vec<Arc<Node>> {
    let scene = session.document.scene();
    let places = roots(session).into_iter().filter_map(|id| scene.index_of(id)).flat_map(|at| scene.subtree(at));
    places.map(|at| scene.nodes()[at].clone()).filter(|node| node.linked.is_some()).collect()
}

/// Deletes the selection except nodes that are locked or contain locked nodes; clears the selection.
pub fn delete(session: &mut EditSession) {
    let scene = session.document.snapshot();
    let (locked, free): (Vec<_>, Vec<_>) =
        roots(session).into_iter().partition(|id| lock_in_the_way(&scene, *id).is_some());
    if let Some(lock) = locked.first().and_then(|id| lock_in_the_way(&scene, *id)) {
        let others = if locked.len() > 1 { format!(" So are {} more.", locked.len() - 1) } else { String::new() };
        let text = format!("“{}” is locked and cannot be deleted. Unlock it first.{others}", lock.name);
        session.messages.push(Message::warning(text));
    }
    if !free.is_empty() {
        session.apply(Edit::Remove(free));
        session.document.select(Vec::new());
    }
}

/// Makes the selection the operands of `operator`. A single selected group only changes its operator,
/// unless `new` asks for another group.
pub fn join(session: &mut EditSession, operator: Operator, new: bool) {
    let mut ids = roots(session);
    if !new {
        // With everything selected, lights and cameras stay where they are: they are no operands.
        let scene = session.document.scene();
        let is_operand = |id: &NodeId| {
            scene.node(*id).is_some_and(|node| !matches!(node.kind, NodeKind::Light(_) | NodeKind::Camera(_)))
        };
        let operands: Vec<NodeId> = ids.iter().copied().filter(is_operand).collect();
        ids = if operands.is_empty() { ids } else { operands };
    }
    if refuse_locked(session, &ids, "joined with others") {
        return;
    }
    let single = ids.first().filter(|_| ids.len() == 1).and_then(|id| session.document.scene().node(*id).cloned());
    if let (false, Some(NodeKind::Group(group))) = (new, single.as_ref().map(|n| &n.kind)) {
        let node = Node {
            kind: NodeKind::Group(Group { operator, ..*group }),
            ..Node::clone(single.as_ref().expect("matched above"))
        };
        session.apply(Edit::Replace(node));
        return;
    }
    let group = Group { operator, ..Group::UNION };
    let added = session.apply(Edit::Group { ids, group });
    if !added.is_empty() {
        session.document.select(added);
    }
}

/// Moves the children out of the selected groups and removes the groups.
pub fn ungroup(session: &mut EditSession) {
    let scene = session.document.snapshot();
    let groups: Vec<_> =
        roots(session).into_iter().filter_map(|id| scene.node(id)).filter(|n| n.has_children()).cloned().collect();
    let children = groups.iter().flat_map(|group| scene.children(Some(group.id)).map(|child| child.id));
    let touched: Vec<NodeId> = groups.iter().map(|group| group.id).chain(children).collect();
    if groups.is_empty() || refuse_locked(session, &touched, "taken out of its group") {
        return;
    }
    let freed = session.together(|session| {
        let mut freed = Vec::new();
        for group in &groups {
            let children: Vec<NodeId> = scene.children(Some(group.id)).map(|n| n.id).collect();
            let position = place(session.document.scene(), group.id);
            freed.extend(children.iter().copied());
            session.apply(Edit::Move { ids: children, parent: group.parent, position });
            session.apply(Edit::Remove(vec![group.id]));
        }
        freed
    });
    session.document.select(freed);
}

/// Moves each selected node one place up (−1) or down (+1) among its siblings.
pub fn shift(session: &mut EditSession, by: isize) {
    let mut ids = roots(session);
    if refuse_locked(session, &ids, "moved") {
        return;
    }
    if by > 0 {
        ids.reverse();
    }
    session.together(|session| {
        let mut done = HashSet::new();
        for id in ids {
            let scene = session.document.scene();
            let Some(parent) = scene.node(id).map(|n| n.parent) else { continue };
            let siblings: Vec<NodeId> = scene.children(parent).map(|n| n.id).collect();
            let at = place(scene, id);
            let target = at.checked_add_signed(by).filter(|t| *t < siblings.len());
            // A block of selected nodes at the border keeps its order.
            if let Some(position) = target.filter(|t| !done.contains(&siblings[*t])) {
                session.apply(Edit::Move { ids: vec![id], parent, position });
            }
            done.insert(id);
        }
    });
}

/// The position of a node among its siblings.
pub fn place(scene: &Scene, id: NodeId) -> usize {
    let parent = scene.node(id).and_then(|n| n.parent);
    scene.children(parent).position(|n| n.id == id).unwrap_or(0)
}

/// Toggles between this operation and [`Operation::Add`]; all nodes get the new state of the active one.
pub fn toggle_operation(session: &mut EditSession, operation: Operation) {
    let ids: Vec<NodeId> = session.document.selection().into();
    if refuse_locked(session, &ids, "subtracted, intersected or added again") {
        return;
    }
    let on = session.selected().last().is_some_and(|n| n.operation != operation);
    change_each(session, |n| n.operation = if on && n.has_field() { operation } else { Operation::Add });
}

/// Hides or shows the selection; all nodes get the new state of the active one.
pub fn toggle_visible(session: &mut EditSession) {
    let on = session.selected().last().is_some_and(|n| !n.visible);
    change_each(session, |n| n.visible = on);
}

/// Locks or unlocks the selection; all nodes get the new state of the active one.
pub fn toggle_locked(session: &mut EditSession) {
    let on = session.selected().last().is_some_and(|n| !n.locked);
    change_each(session, |n| n.locked = on);
}

fn change_each(session: &mut EditSession, change: impl Fn(&mut Node)) {
    let nodes = session.selected();
    session.together(|session| {
        for node in nodes {
            let mut node = Node::clone(&node);
            change(&mut node);
            session.apply(Edit::Replace(node));
        }
    });
}

/// Shows all hidden nodes.
pub fn show_all(session: &mut EditSession) {
    let hidden: Vec<_> = session.document.scene().nodes().iter().filter(|n| !n.visible).cloned().collect();
    session.together(|session| {
        for node in hidden {
            session.apply(Edit::Replace(Node { visible: true, ..Node::clone(&node) }));
        }
    });
}

/// Selects all unlocked nodes at the top level.
pub fn select_all(session: &mut EditSession) {
    let ids = session.document.scene().children(None).filter(|n| !n.locked).map(|n| n.id).collect();
    session.document.select(ids);
}

/// Unused materials; keeps the first for new objects if all are unused.
pub fn unused_materials(scene: &Scene) -> Vec<MaterialId> {
    let used: HashSet<MaterialId> = scene.nodes().iter().flat_map(|node| node.materials()).collect();
    let keep_first = usize::from(used.is_empty());
    scene.materials().iter().map(|m| m.id).filter(|id| !used.contains(id)).skip(keep_first).collect()
}
