//! The list of presets: balls with names, found by typing.

use egui::{
    Align2, FontId, Popup, PopupCloseBehavior, Rect, Response, RichText, ScrollArea, Sense, TextEdit, Ui, vec2,
};

use super::material_library::MaterialLibrary;
use super::thumbnails::ThumbnailKey;
use super::{theme, widgets};
use isolith_scene::Material;

/// Side of a ball, in points.
const BALL: f32 = 72.0;
/// Size of an entry: a ball above a name.
const ENTRY: egui::Vec2 = vec2(BALL + 8.0, BALL + 26.0);
const COLUMNS: usize = 4;

/// The list, which a click on `opener` opens; returns the chosen preset.
pub fn show(opener: &Response, library: &mut MaterialLibrary) -> Option<Material> {
    let popup = Popup::menu(opener).close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    let shown = popup.show(|ui| {
        ui.set_width(ENTRY.x * COLUMNS as f32 + 12.0);
        let is_new = opener.clicked();
        if is_new {
            library.search.clear();
        }
        let field = TextEdit::singleline(&mut library.search).hint_text("Search presets…").desired_width(f32::INFINITY);
        let field = ui.add(field.margin(egui::Margin::symmetric(8, 4)));
        ui.ctx().accesskit_node_builder(field.id, |node| node.set_label("Search presets"));
        if is_new {
            field.request_focus();
        }
        ui.add_space(4.0);
        let chosen = entries(ui, library);
        if chosen.is_some() {
            ui.close();
        }
        chosen
    });
    shown.and_then(|shown| shown.inner)
}

fn entries(ui: &mut Ui, library: &mut MaterialLibrary) -> Option<Material> {
    let wanted = library.search.to_lowercase();
    let is_found =
        |preset: &&(usize, Material)| wanted.split_whitespace().all(|word| preset.1.name.to_lowercase().contains(word));
    let all: Vec<_> = library.presets().iter().cloned().enumerate().collect();
    let found: Vec<_> = all.iter().filter(is_found).collect();
    if found.is_empty() {
        ui.label(RichText::new("No preset has this name.").color(theme::WEAK));
    }
    let enter = !found.is_empty() && !wanted.is_empty() && ui.input(|i| i.key_pressed(egui::Key::Enter));
    let mut chosen = if enter { found.first().map(|(_, preset)| preset.clone()) } else { None };
    ui.vertical(|ui| {
        ui.spacing_mut().item_spacing = vec2(0.0, 2.0);
        let (room, rows) = (widgets::list_room(ui.ctx()), found.len().div_ceil(COLUMNS));
        ui.set_max_height(room);
        let area = ScrollArea::vertical().max_height(room).auto_shrink([false, true]);
        area.show_rows(ui, ENTRY.y, rows, |ui, shown| {
            for row in found.chunks(COLUMNS).skip(shown.start).take(shown.len()) {
                ui.horizontal(|ui| {
                    for (index, preset) in row {
                        if entry(ui, library, *index, preset).clicked() {
                            chosen = Some(preset.clone());
                        }
                    }
                });
            }
        });
    });
    chosen
}

fn entry(ui: &mut Ui, library: &mut MaterialLibrary, index: usize, preset: &Material) -> Response {
    let (rect, response) = ui.allocate_exact_size(ENTRY, Sense::click());
    if !ui.is_rect_visible(rect) {
        return response;
    }
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, format!("Preset {}", preset.name)));
    if response.hovered() {
        ui.painter().rect_filled(rect, f32::from(theme::RADIUS), theme::SELECTED);
    }
    let ball = Rect::from_min_size(rect.min + vec2(4.0, 4.0), vec2(BALL, BALL));
    library.thumbnails.paint(ui, ball, ThumbnailKey::OfPreset(index), preset);
    let name = widgets::elided(&preset.name, 13);
    let at = rect.center_bottom() - vec2(0.0, 5.0);
    let color = if response.hovered() { *theme::STRONG } else { *theme::TEXT };
    ui.painter().text(at, Align2::CENTER_BOTTOM, name, FontId::proportional(11.5), color);
    response
}
