//! The picture and what the pointer does in it: looking around, picking, moving.

use egui::{Color32, Key, PointerButton, Pos2, Rect, Response, Sense, Ui, pos2, vec2};
use glam::{DVec2, DVec3};

use super::edit_session::EditSession;
use super::gizmo::{self, Arrows, Drag};
use super::navigation::Navigation;
use super::numbers::number_text;
use super::overlay::{self, Compass, Marker};
use super::picking::pick_node;
use super::{Editor, Picture, legend, selection, theme};
use crate::flat::debug_view::ViewMode;
use crate::geometry::Camera;

/// What the pointer is dragging.
enum Dragging {
    Orbit,
    Pan,
    Zoom,
    Move(Drag),
}

/// What the viewport remembers between frames.
pub struct Viewport {
    rect: Rect,
    size_px: [u32; 2],
    dragging: Option<Dragging>,
    /// Until when the wheel counts as turning, in seconds of the program's clock.
    zooming_until: f64,
    navigating: bool,
    hovered: bool,
}

impl Default for Viewport {
    fn default() -> Self {
        Self {
            rect: Rect::from_min_size(Pos2::ZERO, vec2(640.0, 480.0)),
            size_px: [640, 480],
            dragging: None,
            zooming_until: 0.0,
            navigating: false,
            hovered: false,
        }
    }
}

/// From the world to the screen and back, for one frame.
pub struct Projection {
    camera: Camera,
    rect: Rect,
    pixels_per_point: f32,
    size_px: DVec2,
}

impl Projection {
    /// Where a point of the world appears, in points; `None` behind the eye or far outside.
    pub fn to_screen(&self, p: DVec3) -> Option<Pos2> {
        let (pixel, _) = self.camera.project(p, self.size_px)?;
        let point = pixel / f64::from(self.pixels_per_point);
        // Far outside, single precision would wrap lines around the screen.
        (point.abs().max_element() < 1e5).then(|| self.rect.min + vec2(point.x as f32, point.y as f32))
    }

    /// How many meters a point of the screen is wide at the depth of a point of the world.
    pub fn meters_per_point(&self, p: DVec3) -> f64 {
        let depth = (p - self.camera.position).dot(self.camera.rotation * DVec3::NEG_Z).max(0.0);
        self.camera.footprint(self.size_px.y) * depth * f64::from(self.pixels_per_point)
    }

    /// The pixel under a point of the screen.
    pub fn pixel(&self, at: Pos2) -> DVec2 {
        gizmo::to_pixel(at, self.rect.min, self.pixels_per_point)
    }

    /// The ray through a point of the screen.
    pub fn ray(&self, at: Pos2) -> crate::geometry::Ray {
        self.camera.ray(self.pixel(at), self.size_px)
    }
}

impl Viewport {
    /// Where it is, in points.
    pub fn rect(&self) -> Rect {
        self.rect
    }

    /// Its size in pixels, at least 1 × 1.
    pub fn size_px(&self) -> [u32; 2] {
        self.size_px
    }

    /// Whether the camera is being moved, or something in the picture is.
    pub fn is_navigating(&self) -> bool {
        self.navigating
    }

    /// What the mouse does now, in one line.
    pub fn hint(&self, session: &EditSession) -> String {
        match &self.dragging {
            Some(Dragging::Orbit) => "Orbiting · Shift with the middle button pans".into(),
            Some(Dragging::Pan) => "Panning".into(),
            Some(Dragging::Zoom) => "Zooming · up is nearer".into(),
            Some(Dragging::Move(drag)) => {
                let [x, y, z] = drag.offset.to_array().map(|v| number_text((v * 1e3).round() / 1e3));
                format!("Moving by {x}, {y}, {z} m · Ctrl: snap · Shift: precise · Esc: cancel")
            }
            None if session.is_changing() => "Drag sideways to change · Shift: precise · Click: type a number".into(),
            None if self.hovered => {
                "Click: select · Shift click: add · Drag: orbit · Shift middle button: pan · Wheel: zoom · F: frame"
                    .into()
            }
            None => "Hover a field for help · Drag rows in the outliner to reorder · F3: find a command".into(),
        }
    }

    fn projection(&self, navigation: &Navigation, pixels_per_point: f32) -> Projection {
        let [width, height] = self.size_px.map(f64::from);
        Projection {
            camera: navigation.camera(),
            rect: self.rect,
            pixels_per_point,
            size_px: DVec2::new(width, height),
        }
    }
}

/// Shows the viewport and takes its input.
pub fn show(editor: &mut Editor, ui: &mut Ui, picture: &Picture) {
    let pixels_per_point = ui.ctx().pixels_per_point();
    let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
    let snapped = |v: f32| (v * pixels_per_point).round() / pixels_per_point;
    editor.viewport.rect = Rect::from_min_max(
        pos2(snapped(rect.min.x), snapped(rect.min.y)),
        pos2(snapped(rect.max.x), snapped(rect.max.y)),
    );
    let size = editor.viewport.rect.size() * pixels_per_point;
    editor.viewport.size_px = [size.x, size.y].map(|v| (v.round() as u32).max(1));
    editor.viewport.hovered = response.hovered();
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label("Viewport"));
    navigate(editor, ui, &response);
    paint(editor, ui, &response, picture);
}

fn navigate(editor: &mut Editor, ui: &Ui, response: &Response) {
    let pixels_per_point = ui.ctx().pixels_per_point();
    if response.drag_started() {
        let projection = editor.viewport.projection(&editor.navigation, pixels_per_point);
        editor.viewport.dragging = start_drag(editor, ui, response, &projection);
    }
    if !response.dragged() {
        editor.viewport.dragging = None;
    }
    follow_drag(editor, ui, response);
    zoom_by_wheel(editor, ui, response);
    if response.clicked() {
        let projection = editor.viewport.projection(&editor.navigation, pixels_per_point);
        click(editor, ui, response, &projection);
    }
    let now = ui.input(|i| i.time);
    editor.viewport.navigating = editor.viewport.dragging.is_some() || now < editor.viewport.zooming_until;
}

fn start_drag(editor: &Editor, ui: &Ui, response: &Response, projection: &Projection) -> Option<Dragging> {
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
    let handle = arrows(editor, projection).and_then(|a| a.handle_at(origin)).filter(|_| !modifiers.alt);
    let forward = editor.navigation.rotation * DVec3::NEG_Z;
    let moving = handle.and_then(|h| Drag::begin(&editor.session, h, &projection.ray(origin), forward));
    Some(moving.map_or(if modifiers.shift { Dragging::Pan } else { Dragging::Orbit }, Dragging::Move))
}

fn arrows(editor: &Editor, projection: &Projection) -> Option<Arrows> {
    Arrows::new(gizmo::pivot(&editor.session)?, projection)
}

fn follow_drag(editor: &mut Editor, ui: &Ui, response: &Response) {
    let pixels_per_point = ui.ctx().pixels_per_point();
    let delta = response.drag_delta() * pixels_per_point;
    let delta = DVec2::new(f64::from(delta.x), f64::from(delta.y));
    let height = f64::from(editor.viewport.size_px[1]);
    let center = DVec2::from(editor.viewport.size_px.map(f64::from)) * 0.5;
    let projection = editor.viewport.projection(&editor.navigation, pixels_per_point);
    let view = &mut editor.navigation;
    match &mut editor.viewport.dragging {
        None => {}
        Some(Dragging::Orbit) => view.orbit(delta, height),
        Some(Dragging::Pan) => view.pan(delta, height),
        Some(Dragging::Zoom) => view.zoom((delta.y / height * 4.0).exp(), center, center * 2.0),
        Some(Dragging::Move(drag)) => {
            let (modifiers, canceled) = ui.input(|i| (i.modifiers, i.key_pressed(Key::Escape)));
            if canceled {
                drag.offset = DVec3::ZERO;
                drag.apply(&mut editor.session, response.id);
                editor.session.finish();
                editor.viewport.dragging = None;
                return;
            }
            let snap = if modifiers.command { gizmo::snap_step(view.distance) } else { 0.0 };
            if let Some(pointer) = response.interact_pointer_pos() {
                let forward = view.rotation * DVec3::NEG_Z;
                drag.follow(&projection.ray(pointer), forward, modifiers.shift, snap);
                drag.apply(&mut editor.session, response.id);
            }
        }
    }
}

fn zoom_by_wheel(editor: &mut Editor, ui: &Ui, response: &Response) {
    let Some(pointer) = response.hover_pos().filter(|_| response.hovered()) else { return };
    let (scroll, pinch, now) = ui.input(|i| (i.smooth_scroll_delta().y, i.zoom_delta(), i.time));
    if scroll == 0.0 && pinch == 1.0 {
        return;
    }
    let factor = (-f64::from(scroll) * 0.004).exp() / f64::from(pinch);
    let projection = editor.viewport.projection(&editor.navigation, ui.ctx().pixels_per_point());
    editor.navigation.zoom(factor, projection.pixel(pointer), projection.size_px);
    const STILL_AFTER: f64 = 0.2;
    editor.viewport.zooming_until = now + STILL_AFTER;
    ui.ctx().request_repaint_after_secs(STILL_AFTER as f32);
}

fn click(editor: &mut Editor, ui: &Ui, response: &Response, projection: &Projection) {
    let Some(pointer) = response.interact_pointer_pos() else { return };
    let compass = Compass::new(editor.viewport.rect, editor.navigation.rotation);
    if let Some(side) = compass.side_at(pointer) {
        editor.navigation.look_from(side);
        return;
    }
    let markers = overlay::markers(editor, projection);
    let marker = markers.iter().find(|m| m.at.distance(pointer) < Marker::GRAB).map(|m| m.id);
    let hit = marker.or_else(|| pick_node(editor, &projection.ray(pointer)));
    let scene = editor.session.document.scene();
    let hit = hit.filter(|id| selection::holder_of_lock(scene, *id).is_none());
    let mut selection = editor.session.document.selection().to_vec();
    let adding = ui.input(|i| i.modifiers.shift || i.modifiers.command);
    match hit {
        Some(id) if adding && selection.contains(&id) => selection.retain(|s| *s != id),
        Some(id) if adding => selection.push(id),
        Some(id) => selection = vec![id],
        None if adding => {}
        None => selection.clear(),
    }
    editor.session.finish();
    editor.session.document.select(selection);
}

fn paint(editor: &mut Editor, ui: &Ui, response: &Response, picture: &Picture) {
    let rect = editor.viewport.rect;
    let painter = ui.painter_at(rect);
    match picture.texture {
        Some(texture) => {
            let whole = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
            painter.image(texture, rect, whole, Color32::WHITE);
        }
        None => background(editor, &painter, rect),
    }
    let projection = editor.viewport.projection(&editor.navigation, ui.ctx().pixels_per_point());
    if editor.show_outline {
        overlay::selection_boxes(editor, &painter, &projection);
    }
    let markers = overlay::markers(editor, &projection);
    overlay::paint_markers(editor, &painter, &projection, &markers);
    let pointer = response.hover_pos().filter(|_| response.hovered() || response.dragged());
    let dragged = match &editor.viewport.dragging {
        Some(Dragging::Move(drag)) => Some(drag.handle),
        _ => None,
    };
    if let Some(arrows) = arrows(editor, &projection) {
        let hovered = pointer.and_then(|p| arrows.handle_at(p)).filter(|_| editor.viewport.dragging.is_none());
        arrows.paint(&painter, dragged.or(hovered));
    }
    if editor.view_mode != ViewMode::Shaded {
        let depth_range = editor.depth_range();
        legend::paint(&painter, rect, editor.view_mode, &depth_range);
    }
    let compass = Compass::new(rect, editor.navigation.rotation);
    compass.paint(&painter, pointer.and_then(|p| compass.side_at(p)));
    let nothing = editor.flat().components.is_empty() && editor.flat().meshes.is_empty();
    if nothing && picture.texture.is_some() {
        overlay::empty_hint(&painter, rect);
    }
}

/// Before the first picture: the sky's color and a word.
fn background(editor: &Editor, painter: &egui::Painter, rect: Rect) {
    let horizon = editor.session.document.scene().environment.horizon;
    painter.rect_filled(rect, 0.0, super::inspector_material::display_color(horizon));
    let text = "Preparing the viewport…";
    let font = egui::FontId::proportional(14.0);
    painter.text(rect.center(), egui::Align2::CENTER_CENTER, text, font, theme::WEAK);
}
