//! Aligns and distributes the selection, and moves the origin of groups: each is one step of undo.

use glam::DVec3;

use super::arrangement::{AXIS_NAMES, BoundsEdge, OriginPlace};
use super::bounds;
use super::edit_session::EditSession;
use super::messages::Message;
use super::selection;
use super::state::EditorState;
use isolith_document::Edit;
use isolith_geometry::Aabb;
use isolith_scene::{Node, NodeId, NodeKind, ParamOwner, Track};

/// The selected nodes that can move, with their bounds in the world; empty with a message if a lock is in the way.
fn movable(state: &mut EditorState) -> Vec<(NodeId, Aabb)> {
    let ids = selection::roots(&state.session);
    if selection::refuse_locked(&mut state.session, &ids, "moved") {
        return Vec::new();
    }
    let scene = state.session.document.scene();
    let with_bounds = |id: &NodeId| Some((*id, bounds::of_nodes(scene, state.derived.library(), &[*id])?));
    ids.iter().filter_map(with_bounds).collect()
}

/// Moves the selected nodes so that they agree with the active one.
pub fn align(state: &mut EditorState, axis: usize, edge: BoundsEdge) {
    let nodes = movable(state);
    let active = state.session.document.selection().last().copied();
    let scene = state.session.document.scene();
    let is_active = |id: &NodeId| active.is_some_and(|active| scene.is_within(active, *id));
    let Some(target) = nodes.iter().find(|(id, _)| is_active(id)).map(|(_, bounds)| edge.of(bounds, axis)) else {
        return;
    };
    let ways: Vec<_> =
        nodes.iter().map(|(id, bounds)| (*id, DVec3::AXES[axis] * (target - edge.of(bounds, axis)))).collect();
    let label = format!("Align {} {}", edge.label(axis), AXIS_NAMES[axis]);
    move_each(&mut state.session, label, &ways);
}

/// Moves the nodes between the two outermost so that all gaps along an axis are equal.
pub fn distribute(state: &mut EditorState, axis: usize) {
    let mut nodes = movable(state);
    nodes.sort_by(|a, b| a.1.center()[axis].total_cmp(&b.1.center()[axis]));
    let (Some(first), Some(last)) = (nodes.first(), nodes.last()) else { return };
    if nodes.len() < 3 {
        return;
    }
    let size = |bounds: &Aabb| bounds.max[axis] - bounds.min[axis];
    let total: f64 = nodes.iter().map(|(_, bounds)| size(bounds)).sum();
    let gap = (last.1.max[axis] - first.1.min[axis] - total) / (nodes.len() - 1) as f64;
    let mut at = first.1.min[axis];
    let mut ways = Vec::new();
    for (place, (id, bounds)) in nodes.iter().enumerate() {
        // The outermost stay to the bit.
        if place > 0 && place + 1 < nodes.len() {
            ways.push((*id, DVec3::AXES[axis] * (at - bounds.min[axis])));
        }
        at += size(bounds) + gap;
    }
    move_each(&mut state.session, format!("Distribute along {}", AXIS_NAMES[axis]), &ways);
}

/// Moves nodes by offsets in the world.
fn move_each(session: &mut EditSession, label: String, ways: &[(NodeId, DVec3)]) {
    session.document.begin_step(label);
    for (id, way) in ways.iter().filter(|(_, way)| *way != DVec3::ZERO && way.is_finite()) {
        let scene = session.document.scene();
        let Some(node) = scene.node(*id) else { continue };
        let way = node.parent.map_or(*way, |p| scene.world_from_local(p).inverse().transform_vector3(*way));
        let mut node = Node::clone(node);
        node.transform.translation = tidy(node.transform.translation + way);
        if node.transform.translation.is_finite() {
            session.apply(Edit::Replace(node));
        }
    }
    session.document.end_gesture();
}

/// Without the last digits, which come from rounding.
fn tidy(place: DVec3) -> DVec3 {
    let digits = |v: f64| 10.0_f64.powf(10.0 - v.abs().max(1e-3).log10().ceil());
    DVec3::from(place.to_array().map(|v| (v * digits(v)).round() / digits(v) + 0.0))
}

/// Moves the origin of the selected groups to what they hold, which stays in place. Modifiers and dynamics work from
/// the origin: a group that has some keeps it, with a message.
pub fn origin_to_children(state: &mut EditorState, place: OriginPlace) {
    let scene = state.session.document.snapshot();
    let groups: Vec<_> =
        state.session.selected().into_iter().filter(|node| matches!(node.kind, NodeKind::Group(_))).collect();
    let mut refused = None;
    let mut edits = Vec::new();
    for group in &groups {
        if !group.modifiers.is_empty() || !group.dynamics.is_empty() {
            refused = Some(group.name.clone());
            continue;
        }
        let Some((_, bounds)) = bounds::oriented(&scene, state.derived.library(), group.id) else { continue };
        let center = bounds.center();
        let origin = match place {
            OriginPlace::Center => center,
            OriginPlace::Bottom => DVec3::new(center.x, bounds.min.y, center.z),
        };
        edits.push((group.id, tidy(origin)));
    }
    let touched: Vec<NodeId> =
        edits.iter().flat_map(|(id, _)| scene.children(Some(*id)).map(|n| n.id).chain([*id])).collect();
    if selection::refuse_locked(&mut state.session, &touched, "moved") {
        return;
    }
    state.session.document.begin_step("Move the origin");
    for (id, origin) in edits {
        move_origin(&mut state.session, id, origin);
    }
    state.session.document.end_gesture();
    if let Some(name) = refused {
        let text = format!("“{name}” has modifiers or dynamics, which work from its origin: it stays where it is.");
        state.session.messages.push(Message::warning(text));
    }
}

/// Moves the origin of a group to a point in its space; its content stays in place.
fn move_origin(session: &mut EditSession, id: NodeId, origin: DVec3) {
    // A group within another one that has moved its origin.
    let scene = session.document.snapshot();
    let Some(group) = scene.node(id) else { return };
    let mut moved = Node::clone(group);
    moved.transform.translation = group.transform.to_affine().transform_point3(origin);
    session.apply(Edit::Replace(moved));
    for child in scene.children(Some(id)) {
        let mut child = Node::clone(child);
        child.transform.translation -= origin;
        session.apply(Edit::Replace(child));
    }
}

/// Makes a group by `group`, and puts its origin below the middle of what it holds, so that it turns and grows there. One step
/// of undo. Keys of positions are those from the origin: with such children it stays where it was.
pub fn grouped(state: &mut EditorState, group: impl FnOnce(&mut EditSession)) {
    let before = state.session.document.snapshot();
    state.session.document.begin_gesture();
    group(&mut state.session);
    let scene = state.session.document.snapshot();
    let selection = state.session.document.selection().to_vec();
    for id in selection.into_iter().filter(|id| before.node(*id).is_none()) {
        let children: Vec<NodeId> = scene.children(Some(id)).map(|child| child.id).collect();
        let moves = |track: &Track| matches!(track.path.owner, ParamOwner::Node(node, _) if children.contains(&node));
        let is_free = !scene.animation.tracks().iter().any(|track| moves(track));
        let has_size = children.iter().any(|child| bounds::is_solid(&scene, *child));
        let bounds = bounds::oriented(&scene, state.derived.library(), id).map(|(_, bounds)| bounds);
        if let Some(bounds) = bounds.filter(|_| is_free && has_size) {
            let origin = tidy(bounds.center().with_y(bounds.min.y));
            move_origin(&mut state.session, id, origin);
        }
    }
    state.session.document.end_gesture();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tidy_places_are_written_short() {
        assert_eq!(tidy(DVec3::new(0.1 + 0.2, -0.0, 1.0 / 3.0)).x, 0.3);
        assert!((tidy(DVec3::splat(1.0 / 3.0)).x - 1.0 / 3.0).abs() < 1e-9);
    }
}
