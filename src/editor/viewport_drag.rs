//! Drags in the picture: of the view, of a handle, of the gizmo.

use egui::{PointerButton, Pos2, Response, Ui};
use glam::DVec3;

use super::drawing::DrawDrag;
use super::gizmo::Gizmo;
use super::handles::value_drag::ValueDrag;
use super::handles::value_handle::{HandleKey, HandleSet};
use super::projection::Projection;
use super::state::EditorState;
use super::transforms::kinds::{Tool, TransformKind};
use super::transforms::starts::pivot_of;
use super::transforms::transform_drag::{TransformDrag, axes_of};
use super::viewport_surface::with_bounds;

/// The current drag.
pub enum Dragging {
    /// Turns the camera.
    Orbit,
    /// Moves the camera sideways.
    Pan,
    /// Moves the camera forward and backward.
    Zoom,
    /// Flies through the scene.
    Fly,
    /// Transforms the selection by the gizmo.
    Transform(Box<TransformDrag>),
    /// Changes the selected shape by a handle.
    Shape(Box<ValueDrag>),
    /// Draws a new shape.
    Draw(Box<DrawDrag>),
    /// Draws a box from here to there; what is in it is selected at the end.
    Box([Pos2; 2]),
    /// Draws a line around what is selected at the end.
    Lasso(Vec<Pos2>),
}

/// The gizmo of the selection.
pub fn gizmo_of(state: &EditorState, projection: &Projection) -> Option<Gizmo> {
    let Tool::Transform(kind) = state.view.tool else { return None };
    let turn = state.view.navigation.rotation;
    let axes = axes_of(&state.session, state.view.orientation, turn);
    Gizmo::new(kind, pivot_of(&state.session, state.view.pivot)?, &axes, turn * DVec3::Z, projection)
}

/// The handle of a shape under the pointer. The middle of the gizmo lies over the handles.
pub fn handle_at(state: &EditorState, set: &HandleSet, projection: &Projection, pointer: Pos2) -> Option<HandleKey> {
    let found = set.at(pointer)?;
    let middle = gizmo_of(state, projection).map_or(f32::INFINITY, |gizmo| gizmo.center().distance(pointer));
    (found.at.distance(pointer) <= middle).then_some(found.key)
}

fn start_shaping(state: &EditorState, projection: &Projection, origin: Pos2) -> Option<Dragging> {
    let set = HandleSet::new(state, projection)?;
    let handle = set.get(handle_at(state, &set, projection, origin)?)?;
    let forward = state.view.navigation.rotation * DVec3::NEG_Z;
    let drag = ValueDrag::begin(&state.session, &set, handle, (&projection.ray(origin), forward))?;
    Some(Dragging::Shape(Box::new(drag)))
}

/// The drag that begins where the button was pressed.
pub fn start_drag(state: &EditorState, ui: &Ui, response: &Response, projection: &Projection) -> Option<Dragging> {
    let modifiers = ui.input(|i| i.modifiers);
    if response.drag_started_by(PointerButton::Middle) {
        return Some(match () {
            () if modifiers.shift || modifiers.alt => Dragging::Pan,
            () if modifiers.command => Dragging::Zoom,
            () => Dragging::Orbit,
        });
    }
    if response.drag_started_by(PointerButton::Secondary) {
        return Some(match () {
            () if modifiers.alt => Dragging::Zoom,
            () if modifiers.shift => Dragging::Pan,
            () => Dragging::Orbit,
        });
    }
    let origin = ui.input(|i| i.pointer.press_origin())?;
    if state.view.wants_box {
        return Some(Dragging::Box([origin; 2]));
    }
    if state.view.wants_lasso || (modifiers.command && modifiers.alt) {
        return Some(Dragging::Lasso(vec![origin]));
    }
    if let Some(shaping) = start_shaping(state, projection, origin).filter(|_| !modifiers.alt) {
        return Some(shaping);
    }
    if state.view.tool == Tool::Draw && !modifiers.alt && !modifiers.shift {
        return DrawDrag::begin(state, projection, origin, modifiers.command)
            .map(|drag| Dragging::Draw(Box::new(drag)));
    }
    let handle = gizmo_of(state, projection).and_then(|gizmo| gizmo.handle_at(origin)).filter(|_| !modifiers.alt);
    let transforming = handle.zip(transform_kind(state)).and_then(|(constraint, kind)| {
        let axes = (state.view.orientation, state.view.navigation.rotation, state.view.pivot);
        let drag = TransformDrag::begin(&state.session, kind, axes, origin)?.limited(constraint);
        Some(with_bounds(state, drag))
    });
    let otherwise = match () {
        () if modifiers.command => Dragging::Box([origin; 2]),
        () if modifiers.shift => Dragging::Pan,
        () => Dragging::Orbit,
    };
    Some(transforming.map_or(otherwise, |drag| Dragging::Transform(Box::new(drag))))
}

fn transform_kind(state: &EditorState) -> Option<TransformKind> {
    match state.view.tool {
        Tool::Transform(kind) => Some(kind),
        Tool::Select | Tool::Draw => None,
    }
}
