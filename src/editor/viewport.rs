//! The viewport: the picture and the pointer actions in it, which are navigating, picking and moving.

use egui::{Color32, Key, PointerButton, Pos2, Rect, Response, Sense, Ui, pos2};
use glam::{DVec2, DVec3};

use super::gizmo::{self, Arrows, Drag};
use super::overlay::{self, Compass, Marker};
use super::panel::{Panel, PanelPlace};
use super::picking::pick_node;
use super::projection::Projection;
use super::state::EditorState;
use super::view_state::PointerActivity;
use super::{lattice_overlay, legend, material_edits, materials, selection, shading_bar, theme};
use isolith_field::debug_view::ViewMode;

/// The current drag.
enum Dragging {
    Orbit,
    Pan,
    Zoom,
    Move(Drag),
}

/// The panel of the viewport.
#[derive(Default)]
pub struct Viewport {
    dragging: Option<Dragging>,
    /// End of the zoom by the wheel, in seconds of the program's clock.
    zooming_until: f64,
}

impl Panel for Viewport {
    fn id(&self) -> &'static str {
        "viewport"
    }

    fn title(&self) -> &'static str {
        "Viewport"
    }

    fn place(&self) -> PanelPlace {
        PanelPlace::Center
    }

    fn ui(&mut self, state: &mut EditorState, ui: &mut Ui) {
        let pixels_per_point = ui.ctx().pixels_per_point();
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        let snapped = |v: f32| (v * pixels_per_point).round() / pixels_per_point;
        state.view.rect = Rect::from_min_max(
            pos2(snapped(rect.min.x), snapped(rect.min.y)),
            pos2(snapped(rect.max.x), snapped(rect.max.y)),
        );
        let size = state.view.rect.size() * pixels_per_point;
        state.view.size_px = [size.x, size.y].map(|v| (v.round() as u32).max(1));
        ui.ctx().accesskit_node_builder(response.id, |node| node.set_label("Viewport"));
        self.navigate(state, ui, &response);
        self.paint(state, ui, &response);
        shading_bar::show(state, ui);
    }
}

impl Viewport {
    fn activity(&self, response: &Response) -> PointerActivity {
        match &self.dragging {
            Some(Dragging::Orbit) => PointerActivity::Orbiting,
            Some(Dragging::Pan) => PointerActivity::Panning,
            Some(Dragging::Zoom) => PointerActivity::Zooming,
            Some(Dragging::Move(drag)) => PointerActivity::Moving(drag.offset),
            None if response.hovered() => PointerActivity::Hovering,
            None => PointerActivity::Away,
        }
    }

    fn navigate(&mut self, state: &mut EditorState, ui: &Ui, response: &Response) {
        let pixels_per_point = ui.ctx().pixels_per_point();
        if response.drag_started() {
            let projection = Projection::new(&state.view, pixels_per_point);
            self.dragging = start_drag(state, ui, response, &projection);
        }
        if !response.dragged() {
            self.dragging = None;
        }
        self.follow_drag(state, ui, response);
        self.zoom_by_wheel(state, ui, response);
        if response.clicked() {
            let projection = Projection::new(&state.view, pixels_per_point);
            click(state, ui, response, &projection);
        }
        take_dropped_material(state, ui, response);
        let now = ui.input(|i| i.time);
        state.view.is_navigating = self.dragging.is_some() || now < self.zooming_until;
        state.view.pointer = self.activity(response);
    }

    fn follow_drag(&mut self, state: &mut EditorState, ui: &Ui, response: &Response) {
        let pixels_per_point = ui.ctx().pixels_per_point();
        let delta = response.drag_delta() * pixels_per_point;
        let delta = DVec2::new(f64::from(delta.x), f64::from(delta.y));
        let height = f64::from(state.view.size_px[1]);
        let center = DVec2::from(state.view.size_px.map(f64::from)) * 0.5;
        let projection = Projection::new(&state.view, pixels_per_point);
        let view = &mut state.view.navigation;
        match &mut self.dragging {
            None => {}
            Some(Dragging::Orbit) => view.orbit(delta, height),
            Some(Dragging::Pan) => view.pan(delta, height),
            Some(Dragging::Zoom) => view.zoom((delta.y / height * 4.0).exp(), center, center * 2.0),
            Some(Dragging::Move(drag)) => {
                let (modifiers, canceled) = ui.input(|i| (i.modifiers, i.key_pressed(Key::Escape)));
                if canceled {
                    drag.offset = DVec3::ZERO;
                    drag.apply(&mut state.session, response.id);
                    state.session.finish();
                    self.dragging = None;
                    return;
                }
                let snap = if modifiers.command { gizmo::snap_step(view.distance) } else { 0.0 };
                if let Some(pointer) = response.interact_pointer_pos() {
                    let forward = view.rotation * DVec3::NEG_Z;
                    drag.follow(&projection.ray(pointer), forward, modifiers.shift, snap);
                    drag.apply(&mut state.session, response.id);
                }
            }
        }
    }

    fn zoom_by_wheel(&mut self, state: &mut EditorState, ui: &Ui, response: &Response) {
        let Some(pointer) = response.hover_pos().filter(|_| response.hovered()) else { return };
        let (scroll, pinch, now) = ui.input(|i| (i.smooth_scroll_delta().y, i.zoom_delta(), i.time));
        if scroll == 0.0 && pinch == 1.0 {
            return;
        }
        let factor = (-f64::from(scroll) * 0.004).exp() / f64::from(pinch);
        let projection = Projection::new(&state.view, ui.ctx().pixels_per_point());
        state.view.navigation.zoom(factor, projection.pixel(pointer), projection.size_px());
        const STILL_AFTER: f64 = 0.2;
        self.zooming_until = now + STILL_AFTER;
        ui.ctx().request_repaint_after_secs(STILL_AFTER as f32);
    }

    fn paint(&self, state: &EditorState, ui: &Ui, response: &Response) {
        let rect = state.view.rect;
        let painter = ui.painter_at(rect);
        match state.picture.texture {
            Some(texture) => {
                let whole = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
                painter.image(texture, rect, whole, Color32::WHITE);
            }
            None => background(state, &painter, rect),
        }
        let projection = Projection::new(&state.view, ui.ctx().pixels_per_point());
        if state.view.show_outline {
            overlay::selection_boxes(state, &painter, &projection);
            lattice_overlay::paint(state, &painter, &projection);
        }
        let markers = overlay::markers(state, &projection);
        overlay::paint_markers(state, &painter, &projection, &markers);
        let pointer = response.hover_pos().filter(|_| response.hovered() || response.dragged());
        let dragged = match &self.dragging {
            Some(Dragging::Move(drag)) => Some(drag.handle),
            _ => None,
        };
        if let Some(arrows) = arrows(state, &projection) {
            let hovered = pointer.and_then(|p| arrows.handle_at(p)).filter(|_| self.dragging.is_none());
            arrows.paint(&painter, dragged.or(hovered));
        }
        if state.view.view_mode != ViewMode::Shaded {
            let depth_range = state.depth_range();
            legend::paint(&painter, rect, state.view.view_mode, &depth_range);
        }
        if materials::is_over(response) {
            let outline = egui::Stroke::new(2.0, theme::ACCENT);
            painter.rect_stroke(rect, 0.0, outline, egui::StrokeKind::Inside);
        }
        let compass = Compass::new(rect, state.view.navigation.rotation);
        compass.paint(&painter, pointer.and_then(|p| compass.side_at(p)));
        let nothing = state.flat().components.is_empty() && state.flat().meshes.is_empty();
        if nothing && state.picture.texture.is_some() {
            overlay::empty_hint(&painter, rect);
        }
    }
}

fn start_drag(state: &EditorState, ui: &Ui, response: &Response, projection: &Projection) -> Option<Dragging> {
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
    let handle = arrows(state, projection).and_then(|a| a.handle_at(origin)).filter(|_| !modifiers.alt);
    let forward = state.view.navigation.rotation * DVec3::NEG_Z;
    let moving = handle.and_then(|h| Drag::begin(&state.session, h, &projection.ray(origin), forward));
    Some(moving.map_or(if modifiers.shift { Dragging::Pan } else { Dragging::Orbit }, Dragging::Move))
}

fn arrows(state: &EditorState, projection: &Projection) -> Option<Arrows> {
    Arrows::new(gizmo::pivot(&state.session)?, projection)
}

fn click(state: &mut EditorState, ui: &Ui, response: &Response, projection: &Projection) {
    let Some(pointer) = response.interact_pointer_pos() else { return };
    let compass = Compass::new(state.view.rect, state.view.navigation.rotation);
    if let Some(side) = compass.side_at(pointer) {
        state.view.navigation.look_from(side);
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
fn take_dropped_material(state: &mut EditorState, ui: &Ui, response: &Response) {
    let Some(material) = materials::dropped_on(response) else { return };
    let Some(pointer) = ui.input(|i| i.pointer.interact_pos()) else { return };
    let projection = Projection::new(&state.view, ui.ctx().pixels_per_point());
    if let Some(node) = pick_node(state, &projection.ray(pointer)) {
        state.session.finish();
        material_edits::assign(&mut state.session, &[node], Some(material));
    }
}

/// Before the first picture: the color of the sky and a text.
fn background(state: &EditorState, painter: &egui::Painter, rect: Rect) {
    let [_, horizon, _] = state.session.document.scene().environment.gradient();
    painter.rect_filled(rect, 0.0, super::inspector_material::display_color(horizon));
    let text = "Preparing the viewport…";
    let font = egui::FontId::proportional(14.0);
    painter.text(rect.center(), egui::Align2::CENTER_CENTER, text, font, theme::WEAK);
}
