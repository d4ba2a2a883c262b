//! The viewport: the picture and the pointer actions in it, which are navigating, picking and moving.

use egui::{Color32, Event, Key, Pos2, Rect, Response, Sense, Ui, pos2};
use glam::{DVec2, DVec3};

use super::commands::entries::viewport_entries;
use super::drawing::{self, DrawDrag};
use super::fly::{self, FlySpeed};
use super::ghosts::Ghosts;
use super::handles::handle_paint;
use super::handles::value_drag::Pace;
use super::handles::value_handle::{HandleSet, HandleTarget};
use super::hover::Hover;
use super::overlay::{self, Compass};
use super::panel::{Panel, PanelPlace};
use super::projection::Projection;
use super::state::{EditorState, Request};
use super::transforms::kinds::Tool;
use super::transforms::transform_bar;
use super::transforms::transform_drag::Following;
use super::view_slots::SIDES;
use super::view_state::PointerActivity;
use super::viewport_click::{click, prepare_menu, select_in_box, select_in_lasso, take_dropped_material};
use super::viewport_drag::{Dragging, gizmo_of, handle_at, start_drag};
use super::viewport_modal::{ModalTransform, paint_limits};
use super::viewport_surface::SurfaceUnderPointer;
use super::{camera_view, grid_labels, lattice_overlay, legend, materials, pass_view, shading_bar, steps, theme};
use isolith_field::debug_view::ViewMode;

/// Frames without a turn of the wheel after which it zooms again.
const CALM_FRAMES: u8 = 4;

/// The panel of the viewport.
#[derive(Default)]
pub struct Viewport {
    /// Its number: 0 for the main one.
    index: usize,
    dragging: Option<Dragging>,
    modal: ModalTransform,
    surface: SurfaceUnderPointer,
    ghosts: Ghosts,
    hover: Hover,
    /// The wheel belongs to what was drawn until it has rested for so many frames: egui spreads its way over some.
    wheel_rests_in: u8,
    /// End of the zoom by the wheel, in seconds of the program's clock.
    zooming_until: f64,
    fly_speed: FlySpeed,
    /// A flight ends in this frame: the right button opens no menu.
    has_flown: bool,
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
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        let is_down = ui.input(|i| i.pointer.any_down() && !i.pointer.any_pressed());
        let pointer = response.hover_pos().filter(|_| response.hovered() && !is_down);
        // What is dragged in from a palette hovers without a hover.
        let dropping = ui.input(|i| i.pointer.latest_pos()).filter(|at| rect.contains(*at));
        let pointer = pointer.or(dropping.filter(|_| state.view.dragging_in.is_some()));
        state.show_view(self.index, pointer, |state| self.show(state, ui, rect, &response));
    }
}

impl Viewport {
    /// The viewport of this number.
    pub fn of(index: usize) -> Self {
        Self { index, ..Self::default() }
    }

    fn show(&mut self, state: &mut EditorState, ui: &mut Ui, rect: Rect, response: &Response) {
        let pixels_per_point = ui.ctx().pixels_per_point();
        let snapped = |v: f32| (v * pixels_per_point).round() / pixels_per_point;
        state.view.rect = Rect::from_min_max(
            pos2(snapped(rect.min.x), snapped(rect.min.y)),
            pos2(snapped(rect.max.x), snapped(rect.max.y)),
        );
        let size = state.view.rect.size() * pixels_per_point;
        state.view.size_px = [size.x, size.y].map(|v| (v.round() as u32).max(1));
        let name = self.index.checked_sub(1).map_or("Viewport", |beside| SIDES[beside].1);
        ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(name));
        self.navigate(state, ui, response);
        self.paint(state, ui, response);
        state.view.copy_path = self.hover.copy_path(state.session.document.scene());
        shading_bar::show(state, ui);
        if self.index == 0 {
            transform_bar::show(state, ui);
        }
        if state.views.is_split() && state.views.active == self.index {
            let line = egui::Stroke::new(1.0, theme::ACCENT.gamma_multiply(0.7));
            ui.painter().rect_stroke(state.view.rect, 0.0, line, egui::StrokeKind::Inside);
        }
        self.modal.settle(ui);
    }

    fn activity(&self, state: &EditorState, ui: &Ui, response: &Response) -> PointerActivity {
        let over_handle = || {
            let projection = Projection::new(&state.view, ui.ctx().pixels_per_point());
            let set = HandleSet::new(state, &projection)?;
            let key = handle_at(state, &set, &projection, response.hover_pos()?)?;
            Some(PointerActivity::OverHandle(matches!(
                set.get(key)?.target,
                HandleTarget::Row(_) | HandleTarget::NewRow(_)
            )))
        };
        match &self.dragging {
            _ if self.modal.is_active() => PointerActivity::Transforming,
            Some(Dragging::Orbit) => PointerActivity::Orbiting,
            Some(Dragging::Pan) => PointerActivity::Panning,
            Some(Dragging::Zoom) => PointerActivity::Zooming,
            Some(Dragging::Fly) => PointerActivity::Flying,
            Some(Dragging::Transform(_)) => PointerActivity::Moving,
            Some(Dragging::Shape(_)) => PointerActivity::Shaping,
            Some(Dragging::Box(_)) => PointerActivity::Boxing,
            Some(Dragging::Lasso(_)) => PointerActivity::Lassoing,
            Some(Dragging::Draw(_)) => PointerActivity::Drawing,
            None if state.view.wants_box => PointerActivity::Boxing,
            None if state.view.wants_lasso => PointerActivity::Lassoing,
            None if response.hovered() && state.view.tool == Tool::Draw => {
                over_handle().unwrap_or(PointerActivity::Drawing)
            }
            None if response.hovered() => over_handle().unwrap_or(PointerActivity::Hovering),
            None => PointerActivity::Away,
        }
    }

    fn navigate(&mut self, state: &mut EditorState, ui: &Ui, response: &Response) {
        let pixels_per_point = ui.ctx().pixels_per_point();
        self.modal.update(state, ui, response.id);
        if response.drag_started() && !self.modal.takes_pointer() {
            let projection = Projection::new(&state.view, pixels_per_point);
            self.dragging = start_drag(state, ui, response, &projection);
            self.surface = SurfaceUnderPointer::default();
        }
        if fly::begins(ui, response)
            && matches!(self.dragging, None | Some(Dragging::Orbit))
            && !self.modal.takes_pointer()
        {
            self.dragging = Some(Dragging::Fly);
        }
        let is_flying = matches!(self.dragging, Some(Dragging::Fly));
        self.has_flown = is_flying && !fly::goes_on(ui);
        if !response.dragged() && (!is_flying || self.has_flown) {
            let projection = Projection::new(&state.view, pixels_per_point);
            let adding = ui.input(|i| i.modifiers.shift);
            match self.dragging.take() {
                Some(Dragging::Box([from, to])) => {
                    select_in_box(state, &projection, Rect::from_two_pos(from, to), adding);
                }
                Some(Dragging::Lasso(line)) => select_in_lasso(state, &projection, &line, adding),
                Some(Dragging::Transform(drag)) => {
                    state.view.last_motion = drag.last_motion().or(state.view.last_motion);
                }
                Some(Dragging::Draw(drag)) => self.finish_drawing(state, ui, &projection, (*drag, response.id)),
                _ => {}
            }
        }
        self.follow_drag(state, ui, response);
        self.zoom_by_wheel(state, ui, response);
        if response.clicked() && !self.modal.takes_pointer() {
            let projection = Projection::new(&state.view, pixels_per_point);
            click(state, ui, response, &projection);
        }
        take_dropped_material(state, ui, response);
        self.context_menu(state, ui, response);
        camera_view::follow(state, response.id);
        let now = ui.input(|i| i.time);
        state.view.is_navigating = self.dragging.is_some() || self.modal.is_active() || now < self.zooming_until;
        state.view.pointer = self.activity(state, ui, response);
    }

    /// A slow frame may hold the last of the way and of the wheel beside the release.
    fn finish_drawing(
        &mut self,
        state: &mut EditorState,
        ui: &Ui,
        projection: &Projection,
        (mut drag, widget): (DrawDrag, egui::Id),
    ) {
        let released = |event: &Event| match event {
            Event::PointerButton { pos, pressed: false, modifiers, .. } => Some((*pos, modifiers.command)),
            _ => None,
        };
        drag.turn(ui);
        if let Some((at, ctrl)) = ui.input(|i| i.events.iter().find_map(released)) {
            drag.follow(state, projection, at, ctrl, widget);
        }
        self.wheel_rests_in = if drag.has_turned() { CALM_FRAMES } else { 0 };
    }

    fn context_menu(&mut self, state: &mut EditorState, ui: &Ui, response: &Response) {
        if self.modal.takes_pointer() || self.has_flown {
            return;
        }
        if let Some(pointer) = response.interact_pointer_pos().filter(|_| response.secondary_clicked()) {
            let projection = Projection::new(&state.view, ui.ctx().pixels_per_point());
            prepare_menu(state, &projection, pointer);
        }
        if response.clicked() {
            state.view.menu_at = None;
        }
        let mut chosen = None;
        response.context_menu(|ui| {
            ui.set_min_width(220.0);
            chosen = viewport_entries(ui, state);
            if chosen.is_some() {
                ui.close();
            }
        });
        state.requests.extend(chosen.map(Request::Run));
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
            Some(Dragging::Fly) => fly::follow(view, &mut self.fly_speed, ui, delta, height),
            Some(Dragging::Box([_, to])) => {
                *to = response.interact_pointer_pos().unwrap_or(*to);
                state.view.wants_box = false;
                if ui.input(|i| i.key_pressed(Key::Escape)) {
                    self.dragging = None;
                }
            }
            Some(Dragging::Lasso(line)) => {
                line.extend(response.interact_pointer_pos().filter(|at| line.last() != Some(at)));
                state.view.wants_lasso = false;
                if ui.input(|i| i.key_pressed(Key::Escape)) {
                    self.dragging = None;
                }
            }
            Some(Dragging::Transform(_) | Dragging::Shape(_) | Dragging::Draw(_)) => {
                self.follow_change(state, ui, response, &projection)
            }
        }
    }

    /// Follows a drag that changes the scene.
    fn follow_change(&mut self, state: &mut EditorState, ui: &Ui, response: &Response, projection: &Projection) {
        let (modifiers, canceled) = ui.input(|i| (i.modifiers, i.key_pressed(Key::Escape)));
        if canceled {
            state.session.cancel();
            self.dragging = None;
            return;
        }
        let Some(pointer) = response.interact_pointer_pos() else { return };
        let view = &state.view.navigation;
        let forward = view.rotation * DVec3::NEG_Z;
        let snap = state.view.snap.length_step(modifiers.command, view.distance);
        let angle_snap = state.view.snap.angle_step(modifiers.command);
        let ray = projection.ray(pointer);
        match &mut self.dragging {
            Some(Dragging::Transform(drag)) => {
                if ui.input(|i| i.key_pressed(Key::F)) {
                    drag.surface = drag.surface.next();
                }
                let surface = self.surface.find(state, projection, pointer, drag);
                let following = Following { precise: modifiers.shift, snap, angle_snap, surface };
                drag.follow(projection, state.view.navigation.rotation, pointer, following);
                drag.apply(&mut state.session, response.id);
            }
            Some(Dragging::Shape(drag)) => {
                let pace = Pace {
                    precise: modifiers.shift,
                    snap,
                    angle_snap,
                    both: modifiers.alt,
                    finest: steps::finest_step(projection.meters_per_point(view.target)),
                };
                drag.follow(&ray, forward, pace);
                drag.apply(&mut state.session, response.id);
            }
            Some(Dragging::Draw(drag)) => {
                drag.turn(ui);
                drag.follow(state, projection, pointer, modifiers.command, response.id);
            }
            _ => {}
        }
    }

    fn zoom_by_wheel(&mut self, state: &mut EditorState, ui: &Ui, response: &Response) {
        let (scroll, pinch, now) = ui.input(|i| (i.smooth_scroll_delta().y, i.zoom_delta(), i.time));
        if self.wheel_rests_in > 0 {
            self.wheel_rests_in -= u8::from(scroll == 0.0);
            ui.ctx().request_repaint();
            return;
        }
        let Some(pointer) = response.hover_pos().filter(|_| response.hovered()) else { return };
        let is_taken = matches!(self.dragging, Some(Dragging::Fly | Dragging::Draw(_)));
        if is_taken || (scroll == 0.0 && pinch == 1.0) {
            return;
        }
        let factor = (-f64::from(scroll) * 0.004).exp() / f64::from(pinch);
        let projection = Projection::new(&state.view, ui.ctx().pixels_per_point());
        state.view.navigation.zoom(factor, projection.pixel(pointer), projection.size_px());
        const STILL_AFTER: f64 = 0.2;
        self.zooming_until = now + STILL_AFTER;
        ui.ctx().request_repaint_after_secs(STILL_AFTER as f32);
    }

    /// The shape that is being drawn.
    fn drawn(&self) -> Option<&DrawDrag> {
        match &self.dragging {
            Some(Dragging::Draw(drag)) => Some(drag),
            _ => None,
        }
    }

    /// Paints the gizmo and the handles, or the transform in progress instead of them.
    fn paint_tools(&self, state: &EditorState, ui: &Ui, projection: &Projection, pointer: Option<Pos2>) {
        let painter = ui.painter_at(state.view.rect);
        if self.modal.is_active() {
            self.modal.paint(&painter, projection, ui.input(|i| i.pointer.latest_pos()));
            return;
        }
        let transform = match &self.dragging {
            Some(Dragging::Transform(drag)) => Some(drag),
            _ => None,
        };
        if let Some(drag) = transform {
            paint_limits(&painter, projection, drag);
        }
        drawing::paint(state, ui, &painter, projection, self.drawn(), pointer);
        if let Some(gizmo) = gizmo_of(state, projection) {
            let hovered = pointer.and_then(|p| gizmo.handle_at(p)).filter(|_| self.dragging.is_none());
            gizmo.paint(&painter, transform.map(|drag| drag.constraint).or(hovered));
        }
        match transform {
            Some(drag) => {
                let at = pointer.unwrap_or(state.view.rect.center());
                handle_paint::tag(&painter, at, drag.text());
            }
            None => self.paint_handles(state, ui, projection, pointer),
        }
    }

    /// Paints the handles of the selected shape, with the value of the one in use.
    fn paint_handles(&self, state: &EditorState, ui: &Ui, projection: &Projection, pointer: Option<Pos2>) {
        let Some(set) = HandleSet::new(state, projection) else { return };
        let painter = ui.painter_at(state.view.rect);
        let dragged = match &self.dragging {
            Some(Dragging::Shape(drag)) => Some((drag.key(), Some(drag.text.clone()))),
            None => pointer.and_then(|p| handle_at(state, &set, projection, p)).map(|key| (key, None)),
            _ => None,
        };
        handle_paint::paint(&painter, &set, dragged.as_ref().map(|(key, _)| *key));
        if let Some((handle, text)) = dragged.and_then(|(key, text)| Some((set.get(key)?, text))) {
            let text = text.filter(|text| !text.is_empty()).unwrap_or_else(|| handle_paint::text_of(handle));
            handle_paint::tag(&painter, handle.at, text);
        }
        handle_paint::announce(ui, &set);
    }

    fn paint(&mut self, state: &EditorState, ui: &Ui, response: &Response) {
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
        if state.view.shows_grid() {
            grid_labels::paint(state, ui, &projection);
        }
        if state.view.show_outline {
            overlay::selection_boxes(state, &painter, &projection);
            self.ghosts.paint(state, &painter, &projection);
            lattice_overlay::paint(state, &painter, &projection);
        }
        camera_view::paint(state, &painter);
        let markers = overlay::markers(state, &projection);
        overlay::paint_markers(state, &painter, &projection, &markers);
        let pointer = response.hover_pos().filter(|_| response.hovered() || response.dragged());
        let is_free = matches!(state.view.pointer, PointerActivity::Hovering) && state.view.show_outline;
        self.hover.look(state, &projection, pointer.filter(|_| is_free));
        self.hover.paint(state, &painter, &projection);
        self.paint_tools(state, ui, &projection, pointer);
        if state.view.view_mode != ViewMode::Shaded {
            let depth_range = state.depth_range();
            legend::paint(&painter, rect, state.view.view_mode, &depth_range);
        }
        pass_view::paint(state, &painter, rect);
        if materials::is_over(response) {
            let outline = egui::Stroke::new(2.0, theme::ACCENT);
            painter.rect_stroke(rect, 0.0, outline, egui::StrokeKind::Inside);
        }
        if let Some(Dragging::Box([from, to])) = self.dragging {
            let area = Rect::from_two_pos(from, to);
            painter.rect(area, 0.0, theme::ACCENT.gamma_multiply(0.12), (1.0, theme::ACCENT), egui::StrokeKind::Inside);
        }
        if let Some(Dragging::Lasso(line)) = &self.dragging {
            overlay::lasso(&painter, line);
        }
        let compass = Compass::new(rect, state.view.navigation.rotation);
        compass.paint(&painter, pointer.and_then(|p| compass.side_at(p)));
        let nothing = state.flat().components.is_empty() && state.flat().meshes.is_empty();
        if nothing && state.picture.texture.is_some() {
            overlay::empty_hint(&painter, rect);
        }
    }
}

/// Before the first picture: the color of the sky and a text.
fn background(state: &EditorState, painter: &egui::Painter, rect: Rect) {
    let [_, horizon, _] = state.session.document.scene().environment.gradient();
    painter.rect_filled(rect, 0.0, super::inspector_material::display_color(horizon));
    let text = "Preparing the viewport…";
    let font = egui::FontId::proportional(14.0);
    painter.text(rect.center(), egui::Align2::CENTER_CENTER, text, font, theme::ON_PICTURE);
}
