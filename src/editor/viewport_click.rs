//! Clicks in the picture: on handles, the compass, nodes; and what is dropped there.

use egui::{Pos2, Rect, Response, Ui};

use super::bounds;
use super::choice_walk::{BelowList, Walk, representative};
use super::handles::grip::Grip;
use super::handles::value_drag;
use super::handles::value_handle::{HandleSet, HandleTarget};
use super::overlay::{self, Compass, Marker};
use super::picking::{pick_all, pick_node};
use super::projection::Projection;
use super::state::EditorState;
use super::viewport_drag::handle_at;
use super::{material_edits, materials, selection};
use isolith_document::Edit;
use isolith_scene::{Node, NodeId, NodeKind};

/// A click on a handle: adds a point, or deletes one with Ctrl. Returns whether there is a handle.
fn click_handle(state: &mut EditorState, ui: &Ui, projection: &Projection, pointer: Pos2) -> bool {
    let Some(set) = HandleSet::new(state, projection) else { return false };
    let Some(handle) = handle_at(state, &set, projection, pointer).and_then(|key| set.get(key)) else { return false };
    let scene = state.session.document.scene();
    let (Some(node), deleting) = (scene.node(set.node), ui.input(|i| i.modifiers.command)) else { return true };
    let changed = match (handle.target, handle.grip) {
        (HandleTarget::NewRow(before), Grip::Place { at, .. }) => value_drag::with_new_point(node, handle, before, at),
        (HandleTarget::Row(index), _) if deleting => value_drag::without_point(node, handle, index),
        _ => None,
    };
    if let Some(changed) = changed {
        state.session.finish();
        state.session.apply(Edit::Replace(changed));
    }
    true
}

/// Selects what is under the pointer.
pub fn click(state: &mut EditorState, ui: &Ui, response: &Response, projection: &Projection) {
    let Some(pointer) = response.interact_pointer_pos() else { return };
    let compass = Compass::new(state.view.rect, state.view.navigation.rotation);
    if let Some(side) = compass.side_at(pointer) {
        state.view.navigation.look_along(side);
        return;
    }
    if click_handle(state, ui, projection, pointer) {
        return;
    }
    let (modifiers, camera) = (ui.input(|i| i.modifiers), state.view.navigation.camera());
    if modifiers.alt {
        list_below(state, projection, pointer);
        return;
    }
    if response.double_clicked() && enter(state, projection, pointer) {
        return;
    }
    let revision = state.session.document.revision();
    let chosen = match state.view.walk.take().filter(|walk| walk.continues(pointer, &camera, revision)) {
        Some(mut walk) => {
            // What lies below is looked for when it is asked for.
            if walk.is_first() {
                walk = walk_below(state, &pick_all(state, &projection.ray(pointer)), pointer);
            }
            walk.step();
            let chosen = walk.chosen();
            state.view.walk = Some(walk);
            chosen
        }
        None => first_click(state, projection, pointer),
    };
    choose(state, chosen, modifiers.shift || modifiers.command);
}

fn walk_below(state: &EditorState, below: &[NodeId], pointer: Pos2) -> Walk {
    let scene = state.session.document.scene();
    let camera = state.view.navigation.camera();
    Walk::new(scene, state.view.entered, below, pointer, camera, state.session.document.revision())
}

/// The marker or the outermost group under the pointer; outside of the entered group, that is left.
fn first_click(state: &mut EditorState, projection: &Projection, pointer: Pos2) -> Option<NodeId> {
    let hit = hit_at(state, projection, pointer);
    let scene = state.session.document.scene();
    let is_within = |group: &NodeId| hit.is_some_and(|id| id != *group && scene.is_within(id, *group));
    state.view.entered = state.view.entered.filter(is_within);
    let walk = walk_below(state, hit.as_slice(), pointer);
    let chosen = walk.chosen();
    state.view.walk = Some(walk);
    chosen
}

/// The marker or the node under the pointer.
pub fn hit_at(state: &EditorState, projection: &Projection, pointer: Pos2) -> Option<NodeId> {
    let markers = overlay::markers(state, projection);
    let marker = markers.iter().find(|m| m.at.distance(pointer) < Marker::GRAB).map(|m| m.id);
    marker.or_else(|| pick_node(state, &projection.ray(pointer)))
}

/// Enters the group under the pointer and selects what is under the pointer there. Returns whether there is one.
fn enter(state: &mut EditorState, projection: &Projection, pointer: Pos2) -> bool {
    let Some(hit) = hit_at(state, projection, pointer) else { return false };
    let scene = state.session.document.scene();
    let group = representative(scene, state.view.entered, hit);
    if group == hit || selection::holder_of_lock(scene, hit).is_some() {
        return false;
    }
    let inner = representative(scene, Some(group), hit);
    (state.view.entered, state.view.walk) = (Some(group), None);
    choose(state, Some(inner), false);
    true
}

/// Lists what lies below the pointer, with the groups that hold it.
fn list_below(state: &mut EditorState, projection: &Projection, pointer: Pos2) {
    let mut nodes: Vec<NodeId> = Vec::new();
    let scene = state.session.document.scene();
    for id in pick_all(state, &projection.ray(pointer)) {
        let mut at = Some(id);
        while let Some(id) = at.filter(|id| !nodes.contains(id)) {
            nodes.push(id);
            at = scene.node(id).and_then(|node| node.parent);
        }
    }
    nodes.retain(|id| selection::holder_of_lock(scene, *id).is_none());
    if !nodes.is_empty() {
        state.view.below = Some(BelowList { at: pointer, nodes });
    }
}

/// Selects a node, or nothing; `adding` adds it or takes it out.
fn choose(state: &mut EditorState, chosen: Option<NodeId>, adding: bool) {
    let mut selection = state.session.document.selection().to_vec();
    match chosen {
        Some(id) if adding && selection.contains(&id) => selection.retain(|s| *s != id),
        Some(id) if adding => selection.push(id),
        Some(id) => selection = vec![id],
        None if adding => {}
        None => selection.clear(),
    }
    if selection.is_empty() {
        state.materials.current = None;
    }
    state.session.finish();
    state.session.document.select(selection);
}

/// Selects what is under the pointer for its context menu, unless it is selected.
pub fn prepare_menu(state: &mut EditorState, projection: &Projection, pointer: Pos2) {
    state.view.menu_at = Some(pointer);
    let Some(hit) = hit_at(state, projection, pointer) else { return };
    let scene = state.session.document.scene();
    let is_chosen = |id: &NodeId| scene.is_within(hit, *id);
    if !state.session.document.selection().iter().any(is_chosen) {
        let chosen = first_click(state, projection, pointer);
        choose(state, chosen, false);
    }
}

/// Selects what has its middle in a box of the screen: children of the entered group, or nodes of the top.
pub fn select_in_box(state: &mut EditorState, projection: &Projection, area: Rect, adding: bool) {
    select_where(state, projection, |at| area.contains(at), adding);
}

/// The same within a line around it.
pub fn select_in_lasso(state: &mut EditorState, projection: &Projection, line: &[Pos2], adding: bool) {
    select_where(state, projection, |at| is_around(line, at), adding);
}

/// Whether a closed line runs around a point: a ray to the right crosses it an odd number of times.
fn is_around(line: &[Pos2], at: Pos2) -> bool {
    let mut inside = false;
    for (index, a) in line.iter().enumerate() {
        let b = line[(index + 1) % line.len()];
        if (a.y > at.y) != (b.y > at.y) && at.x < a.x + (at.y - a.y) / (b.y - a.y) * (b.x - a.x) {
            inside = !inside;
        }
    }
    inside
}

fn select_where(state: &mut EditorState, projection: &Projection, is_chosen: impl Fn(Pos2) -> bool, adding: bool) {
    let scene = state.session.document.scene();
    let middle = |node: &Node| match node.kind {
        NodeKind::Light(_) | NodeKind::Camera(_) => Some(scene.world_from_local(node.id).translation),
        _ => bounds::of_nodes(scene, state.derived.library(), &[node.id]).map(|bounds| bounds.center()),
    };
    let entered = state.view.entered.filter(|id| scene.node(*id).is_some());
    let is_in = |node: &Node| middle(node).and_then(|p| projection.to_screen(p)).is_some_and(&is_chosen);
    let inside = scene.children(entered).filter(|node| node.visible && !node.locked && is_in(node));
    let mut found: Vec<NodeId> = inside.map(|node| node.id).collect();
    if adding {
        let before = state.session.document.selection().iter().copied().filter(|id| !found.contains(id));
        found = before.chain(found.iter().copied()).collect();
    }
    state.session.finish();
    state.session.document.select(found);
}

/// Gives a material to the node that it is dropped on.
pub fn take_dropped_material(state: &mut EditorState, ui: &Ui, response: &Response) {
    let Some(material) = materials::dropped_on(response) else { return };
    let Some(pointer) = ui.input(|i| i.pointer.interact_pos()) else { return };
    let projection = Projection::new(&state.view, ui.ctx().pixels_per_point());
    if let Some(node) = pick_node(state, &projection.ray(pointer)) {
        state.session.finish();
        material_edits::assign(&mut state.session, &[node], Some(material));
    }
}
