//! Clicks in the picture: on handles, the compass, nodes; and what is dropped there.

use egui::{Pos2, Response, Ui};

use super::handles::grip::Grip;
use super::handles::value_drag;
use super::handles::value_handle::{HandleSet, HandleTarget};
use super::overlay::{self, Compass, Marker};
use super::picking::pick_node;
use super::projection::Projection;
use super::state::EditorState;
use super::viewport_drag::handle_at;
use super::{material_edits, materials, selection};
use isolith_document::Edit;

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
        state.view.navigation.look_from(side);
        return;
    }
    if click_handle(state, ui, projection, pointer) {
        return;
    }
    let markers = overlay::markers(state, projection);
    let marker = markers.iter().find(|m| m.at.distance(pointer) < Marker::GRAB).map(|m| m.id);
    let hit = marker.or_else(|| pick_node(state, &projection.ray(pointer)));
    let scene = state.session.document.scene();
    let hit = hit.filter(|id| selection::holder_of_lock(scene, *id).is_none());
    let mut selection = state.session.document.selection().to_vec();
    let adding = ui.input(|i| i.modifiers.shift || i.modifiers.command);
    match hit {
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
