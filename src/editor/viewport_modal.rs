//! The transform that follows the pointer after G, R or S, until a click or a key ends it.

use egui::{Painter, Pos2, Stroke, Ui};

use super::gizmo;
use super::handles::handle_paint::tag;
use super::projection::Projection;
use super::state::EditorState;
use super::transforms::kinds::{Constraint, TransformKind};
use super::transforms::modal::{ModalStep, take_keys};
use super::transforms::transform_drag::{Following, TransformDrag};
use super::viewport_surface::{SurfaceUnderPointer, with_bounds};
use super::{selection, theme};

/// The transform in progress.
#[derive(Default)]
pub struct ModalTransform {
    drag: Option<Box<TransformDrag>>,
    surface: SurfaceUnderPointer,
    /// The click that ended it has not been released: it selects nothing.
    ignoring: bool,
}

impl ModalTransform {
    /// Whether the picture's clicks and drags have another meaning now.
    pub fn takes_pointer(&self) -> bool {
        self.drag.is_some() || self.ignoring
    }

    /// Whether a transform is in progress.
    pub fn is_active(&self) -> bool {
        self.drag.is_some()
    }

    /// Clicks have their usual meaning again after the one that ended a transform. Call at the end of a frame.
    pub fn settle(&mut self, ui: &Ui) {
        self.ignoring &= ui.input(|i| i.pointer.any_down());
    }

    /// Begins, follows the pointer and the keys, and ends.
    pub fn update(&mut self, state: &mut EditorState, ui: &Ui, widget: egui::Id) {
        let events = std::mem::take(&mut state.view.modal_events);
        let Some(kind) = state.view.transforming else {
            self.end(state, ui);
            return;
        };
        let pointer = ui.input(|i| i.pointer.latest_pos()).unwrap_or(state.view.rect.center());
        if self.drag.is_none() && !self.begin(state, kind, pointer) {
            return;
        }
        let Some(drag) = &mut self.drag else { return };
        let (pressed, right) = ui.input(|i| (i.pointer.primary_pressed(), i.pointer.secondary_pressed()));
        let step = match take_keys(drag, &events, state.view.orientation) {
            ModalStep::Going if right => ModalStep::Canceled,
            ModalStep::Going if pressed => ModalStep::Done,
            step => step,
        };
        match step {
            ModalStep::Canceled => state.session.cancel(),
            ModalStep::Switch(kind) => {
                state.session.cancel();
                state.view.transforming = Some(kind);
                self.begin(state, kind, pointer);
                return;
            }
            ModalStep::Going | ModalStep::Done => {
                let projection = Projection::new(&state.view, ui.ctx().pixels_per_point());
                let modifiers = ui.input(|i| i.modifiers);
                let view = &state.view.navigation;
                let snap = state.view.snap.length_step(modifiers.command, view.distance);
                let angle_snap = state.view.snap.angle_step(modifiers.command);
                let surface = self.surface.find(state, &projection, pointer, drag);
                let following = Following { precise: modifiers.shift, snap, angle_snap, surface };
                drag.follow(&projection, view.rotation, pointer, following);
                drag.apply(&mut state.session, widget);
                state.view.last_motion = drag.last_motion().or(state.view.last_motion);
            }
        }
        if step != ModalStep::Going {
            state.view.transforming = None;
            self.end(state, ui);
        }
    }

    /// Starts at the pointer; returns whether there is something to transform.
    fn begin(&mut self, state: &mut EditorState, kind: TransformKind, pointer: Pos2) -> bool {
        let axes = (state.view.orientation, state.view.navigation.rotation, state.view.pivot);
        let drag = TransformDrag::begin(&state.session, kind, axes, pointer);
        self.drag = drag.map(|drag| Box::new(with_bounds(state, drag)));
        self.surface = SurfaceUnderPointer::default();
        state.session.is_held = self.drag.is_some();
        if self.drag.is_none() {
            let ids = selection::roots(&state.session);
            selection::refuse_locked(&mut state.session, &ids, kind.done());
            state.view.transforming = None;
        }
        self.drag.is_some()
    }

    fn end(&mut self, state: &mut EditorState, ui: &Ui) {
        if self.drag.take().is_some() {
            state.session.is_held = false;
            state.session.finish();
            self.ignoring = ui.input(|i| i.pointer.any_down());
        }
    }

    /// Paints the axes and the amount.
    pub fn paint(&self, painter: &Painter, projection: &Projection, pointer: Option<Pos2>) {
        let Some(drag) = &self.drag else { return };
        paint_limits(painter, projection, drag);
        let center = projection.to_screen(drag.pivot());
        let at = pointer.or(center).unwrap_or(painter.clip_rect().center());
        if let Some(center) = center.filter(|_| drag.kind != TransformKind::Move) {
            painter.add(egui::Shape::dashed_line(&[center, at], Stroke::new(1.0, theme::ON_PICTURE), 4.0, 4.0));
        }
        tag(painter, at, drag.text());
    }
}

/// Paints the axes that a transform is limited to.
pub fn paint_limits(painter: &Painter, projection: &Projection, drag: &TransformDrag) {
    let axes: &[usize] = match drag.constraint {
        Constraint::Free => &[],
        Constraint::Axis(axis) => [&[0], &[1], &[2]][axis.min(2)],
        Constraint::Plane(axis) => [&[1, 2], &[0, 2], &[0, 1]][axis.min(2)],
    };
    for &axis in axes {
        gizmo::paint_axis(painter, projection, drag.pivot(), drag.axis(axis), axis);
    }
}
