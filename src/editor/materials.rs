//! The materials of the scene: a list with thumbnails, in the order of the file.

use egui::{
    Align, Align2, Button, Color32, DragAndDrop, FontId, Id, Key, LayerId, Layout, Order, Rect, Response, RichText,
    ScrollArea, Sense, TextEdit, Ui, UiBuilder, vec2,
};
use egui_material_icons::icons::{ICON_ADD, ICON_APPS, ICON_CONTENT_COPY, ICON_DELETE_SWEEP, ICON_FORMAT_COLOR_FILL};

use super::commands::command::Command;
use super::edit_session::EditSession;
use super::material_edits::{self, NEW, takes_material, use_text, users};
use super::material_library::MaterialLibrary;
use super::messages::Message;
use super::panel::{Panel, PanelPlace};
use super::state::{EditorState, Request};
use super::thumbnails::ThumbnailKey;
use super::{preset_picker, theme, widgets};
use isolith_document::Edit;
use isolith_scene::limits::MAX_NAME;
use isolith_scene::{Material, MaterialId, NodeId};

/// Height of a row, in points.
const ROW: f32 = 46.0;
/// Side of a thumbnail, in points.
const BALL: f32 = 40.0;

/// The panel of the materials.
#[derive(Default)]
pub struct Materials {
    rename: Option<Rename>,
    /// The material that was in the foreground in the last frame; another one scrolls into view.
    seen: Option<MaterialId>,
}

struct Rename {
    id: MaterialId,
    text: String,
    focused: bool,
}

/// A material that is dragged from the list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DraggedMaterial(pub MaterialId);

/// A request of a row, carried out after the list is shown.
enum MaterialRequest {
    Choose(MaterialId),
    Assign(MaterialId),
    SelectUsers(MaterialId),
    StartRename(MaterialId),
    Rename(MaterialId, String),
    EndRename,
    Duplicate(MaterialId),
    Remove(MaterialId),
    Move(MaterialId, usize),
}

impl Panel for Materials {
    fn id(&self) -> &'static str {
        "materials"
    }

    fn title(&self) -> &'static str {
        "Materials"
    }

    fn place(&self) -> PanelPlace {
        PanelPlace::BelowLeft(300.0)
    }

    fn ui(&mut self, state: &mut EditorState, ui: &mut Ui) {
        widgets::fixed(ui, |ui| self.show(ui, state));
    }

    fn forget(&mut self) {
        *self = Self::default();
    }
}

impl Materials {
    fn show(&mut self, ui: &mut Ui, state: &mut EditorState) {
        self.header(ui, state);
        ui.add_space(2.0);
        let scene = state.session.document.snapshot();
        let materials = scene.materials();
        let reveal = state.materials.current.filter(|current| self.seen != Some(*current));
        self.seen = state.materials.current;
        let mut requests = Vec::new();
        let targets = targets(&state.session);
        ui.spacing_mut().item_spacing.y = 1.0;
        let mut area = ScrollArea::vertical().auto_shrink(false);
        if let Some(at) = reveal.and_then(|id| materials.iter().position(|material| material.id == id)) {
            // Rows out of view are not drawn, so a row cannot scroll to itself.
            let (top, height) = (at as f32 * (ROW + 1.0), ui.available_height());
            let offset = ui.data(|d| d.get_temp::<f32>(Id::unique("offset of materials"))).unwrap_or(0.0);
            if top < offset || top + ROW > offset + height {
                area = area.vertical_scroll_offset((top - 0.4 * height).max(0.0));
            }
        }
        let shown = area.show_rows(ui, ROW, materials.len(), |ui, rows| {
            for index in rows {
                let material = &materials[index];
                ui.push_id(material.id, |ui| {
                    let row = Row { material, index, count: materials.len(), has_targets: !targets.is_empty() };
                    row.show(ui, &mut state.materials, self.rename.as_mut(), &mut requests);
                });
            }
        });
        ui.data_mut(|d| d.insert_temp(Id::unique("offset of materials"), shown.state.clamped_offset().y));
        for request in requests {
            self.answer(state, request, &targets);
        }
    }

    /// The count, and buttons for the whole list.
    fn header(&mut self, ui: &mut Ui, state: &mut EditorState) {
        ui.horizontal(|ui| {
            let count = state.session.document.scene().materials().len();
            let text = format!("{count} {}", if count == 1 { "material" } else { "materials" });
            ui.label(RichText::new(text).color(theme::WEAK));
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                ui.spacing_mut().item_spacing.x = 4.0;
                let unused = widgets::icon_button(ui, ICON_DELETE_SWEEP, "Delete unused materials", theme::WEAK);
                if unused.clicked() {
                    state.requests.push(Request::Run(Command::RemoveUnusedMaterials));
                }
                let copy = ui.add_enabled_ui(state.materials.current.is_some(), |ui| {
                    widgets::icon_button(ui, ICON_CONTENT_COPY, "Duplicate the material", theme::WEAK)
                });
                if copy.inner.clicked()
                    && let Some(id) = state.materials.current
                {
                    self.duplicate(state, id);
                }
                let presets = widgets::icon_button(ui, ICON_APPS, "Add a material from a preset", theme::WEAK);
                if let Some(preset) = preset_picker::show(&presets, &mut state.materials) {
                    self.add(state, preset);
                }
                if widgets::icon_button(ui, ICON_ADD, "New material", theme::WEAK).clicked() {
                    let color = material_edits::next_color(state.session.document.scene());
                    self.add(state, Material::new(MaterialId(0), NEW, color));
                }
            });
        });
    }

    fn add(&mut self, state: &mut EditorState, material: Material) {
        state.session.finish();
        if let Some(id) = material_edits::insert(&mut state.session, material) {
            choose(state, id);
        }
    }

    fn duplicate(&mut self, state: &mut EditorState, id: MaterialId) {
        state.session.finish();
        if let Some(id) = material_edits::duplicate(&mut state.session, id) {
            choose(state, id);
        }
    }

    fn answer(&mut self, state: &mut EditorState, request: MaterialRequest, targets: &[NodeId]) {
        state.session.finish();
        let session = &mut state.session;
        match request {
            MaterialRequest::Choose(id) => choose(state, id),
            MaterialRequest::Assign(id) => material_edits::assign(session, targets, Some(id)),
            MaterialRequest::SelectUsers(id) => {
                let users = users(session.document.scene(), id);
                session.document.select(users);
            }
            MaterialRequest::StartRename(id) => {
                let text = session.document.scene().material(id).map(|material| material.name.clone());
                self.rename = text.map(|text| Rename { id, text, focused: false });
            }
            MaterialRequest::EndRename => self.rename = None,
            MaterialRequest::Rename(id, name) => {
                self.rename = None;
                rename(session, id, name);
            }
            MaterialRequest::Duplicate(id) => self.duplicate(state, id),
            MaterialRequest::Remove(id) => drop(session.apply(Edit::RemoveMaterial(id))),
            MaterialRequest::Move(id, position) => drop(session.apply(Edit::MoveMaterial { id, position })),
        }
    }
}

/// Brings a material into the foreground: the inspector shows it.
fn choose(state: &mut EditorState, id: MaterialId) {
    state.session.document.select(Vec::new());
    state.materials.choose(id);
}

fn rename(session: &mut EditSession, id: MaterialId, name: String) {
    let Some(old) = session.document.scene().material(id).cloned() else { return };
    if name.trim().is_empty() {
        let text = format!("A name needs a letter, so it stays “{}”.", old.name);
        session.messages.push(Message::warning(text));
    } else {
        session.apply(Edit::ReplaceMaterial(Material { name, ..Material::clone(&old) }));
    }
}

/// The selected nodes that take materials.
fn targets(session: &EditSession) -> Vec<NodeId> {
    session.selected().iter().filter(|node| takes_material(node)).map(|node| node.id).collect()
}

/// A row of the list.
struct Row<'a> {
    material: &'a Material,
    index: usize,
    count: usize,
    /// Whether something is selected that takes a material.
    has_targets: bool,
}

impl Row<'_> {
    fn show(
        &self,
        ui: &mut Ui,
        library: &mut MaterialLibrary,
        rename: Option<&mut Rename>,
        requests: &mut Vec<MaterialRequest>,
    ) {
        let material = self.material;
        let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::click_and_drag());
        let is_current = library.current == Some(material.id);
        let label = format!("Material {}", material.name);
        response.widget_info(|| egui::WidgetInfo::selected(egui::Role::ListItem, true, is_current, &label));
        self.paint_background(ui, rect, &response, is_current);
        let ball = Rect::from_min_size(rect.left_center() + vec2(4.0, -0.5 * BALL), vec2(BALL, BALL));
        library.thumbnails.paint(ui, ball, ThumbnailKey::OfScene(material.id), material);
        let hovered = ui.rect_contains_pointer(rect);
        let text = Rect::from_min_max(ball.right_top() + vec2(9.0, 0.0), rect.right_bottom() - vec2(4.0, 0.0));
        let rename = rename.filter(|rename| rename.id == material.id);
        match rename {
            Some(rename) => name_field(ui, text, rename, requests),
            None => self.texts(ui, text, library.uses(material.id), hovered && self.has_targets),
        }
        if hovered && self.has_targets && self.assign_button(ui, rect).clicked() {
            requests.push(MaterialRequest::Assign(material.id));
        }
        if response.clicked() {
            requests.push(MaterialRequest::Choose(material.id));
        }
        if response.double_clicked() {
            requests.push(MaterialRequest::StartRename(material.id));
        }
        response.dnd_set_drag_payload(DraggedMaterial(material.id));
        if response.dragged() {
            paint_dragged(ui, library, material);
        }
        if let Some(dragged) = response.dnd_release_payload::<DraggedMaterial>() {
            requests.push(MaterialRequest::Move(dragged.0, self.index));
        }
        response.context_menu(|ui| self.menu(ui, library.uses(material.id), requests));
    }

    fn paint_background(&self, ui: &Ui, rect: Rect, response: &Response, is_current: bool) {
        let fill = match (is_current, response.contains_pointer()) {
            (true, _) => *theme::SELECTED,
            (false, true) => *theme::CARD,
            (false, false) => Color32::TRANSPARENT,
        };
        ui.painter().rect_filled(rect, f32::from(theme::RADIUS), fill);
        if let Some(dragged) = response.dnd_hover_payload::<DraggedMaterial>()
            && dragged.0 != self.material.id
        {
            ui.painter().hline(rect.x_range(), rect.top(), (2.0, theme::ACCENT));
        }
    }

    fn texts(&self, ui: &Ui, rect: Rect, uses: usize, has_button: bool) {
        let room = if has_button { 30.0 } else { 0.0 };
        let painter = ui.painter().with_clip_rect(rect.with_max_x(rect.right() - room).intersect(ui.clip_rect()));
        let name = if self.material.name.is_empty() { "(no name)" } else { self.material.name.as_str() };
        let at = rect.left_center();
        painter.text(at + vec2(0.0, -1.0), Align2::LEFT_BOTTOM, name, FontId::proportional(13.5), *theme::TEXT);
        let color = if uses == 0 { theme::FAINT } else { theme::WEAK };
        painter.text(at + vec2(0.0, 2.0), Align2::LEFT_TOP, use_text(uses), FontId::proportional(11.5), *color);
    }

    fn assign_button(&self, ui: &mut Ui, rect: Rect) -> Response {
        let room = Rect::from_center_size(rect.right_center() - vec2(18.0, 0.0), vec2(26.0, 26.0));
        let mut inside = ui.new_child(UiBuilder::new().max_rect(room));
        let text = ICON_FORMAT_COLOR_FILL.rich_text().size(theme::ICON_SIZE).color(theme::ACCENT);
        let response = inside.add(Button::new(text).min_size(room.size()));
        let name = format!("Assign {}", self.material.name);
        ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(name));
        response.on_hover_text("Give this material to the selection")
    }

    fn menu(&self, ui: &mut Ui, uses: usize, requests: &mut Vec<MaterialRequest>) {
        let id = self.material.id;
        ui.set_min_width(190.0);
        let mut entry = |enabled: bool, label: &str, request: MaterialRequest| {
            if ui.add_enabled(enabled, Button::new(label)).clicked() {
                requests.push(request);
                ui.close();
            }
        };
        entry(self.has_targets, "Assign to selection", MaterialRequest::Assign(id));
        entry(uses > 0, "Select what uses it", MaterialRequest::SelectUsers(id));
        entry(true, "Rename material", MaterialRequest::StartRename(id));
        entry(true, "Duplicate material", MaterialRequest::Duplicate(id));
        entry(self.index > 0, "Material up", MaterialRequest::Move(id, self.index.saturating_sub(1)));
        entry(self.index + 1 < self.count, "Material down", MaterialRequest::Move(id, self.index + 1));
        entry(uses == 0, "Delete material", MaterialRequest::Remove(id));
    }
}

fn name_field(ui: &mut Ui, rect: Rect, rename: &mut Rename, requests: &mut Vec<MaterialRequest>) {
    let mut inside = ui.new_child(UiBuilder::new().max_rect(rect).layout(Layout::left_to_right(Align::Center)));
    let field = TextEdit::singleline(&mut rename.text).char_limit(MAX_NAME).desired_width(rect.width() - 12.0);
    let response = inside.add(field.margin(egui::Margin::symmetric(4, 1)));
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label("New name of the material"));
    if !rename.focused {
        rename.focused = true;
        response.request_focus();
    } else if response.lost_focus() {
        let canceled = ui.input(|i| i.key_pressed(Key::Escape));
        let named = MaterialRequest::Rename(rename.id, rename.text.clone());
        requests.push(if canceled { MaterialRequest::EndRename } else { named });
    }
}

/// The ball at the pointer during a drag.
fn paint_dragged(ui: &mut Ui, library: &mut MaterialLibrary, material: &Material) {
    let Some(pointer) = ui.input(|i| i.pointer.interact_pos()) else { return };
    let layer = LayerId::new(Order::Tooltip, Id::unique("dragged material"));
    let mut above = ui.new_child(UiBuilder::new().layer_id(layer).max_rect(ui.ctx().content_rect()));
    above.set_clip_rect(ui.ctx().content_rect());
    let rect = Rect::from_center_size(pointer, vec2(BALL, BALL));
    library.thumbnails.paint(&above, rect, ThumbnailKey::OfScene(material.id), material);
}

/// The material that is dropped onto a widget in this frame.
pub fn dropped_on(response: &Response) -> Option<MaterialId> {
    response.dnd_release_payload::<DraggedMaterial>().map(|dragged| dragged.0)
}

/// Whether a material is dragged over a widget.
pub fn is_over(response: &Response) -> bool {
    DragAndDrop::has_payload_of_type::<DraggedMaterial>(&response.ctx) && response.contains_pointer()
}
