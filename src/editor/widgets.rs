//! Widgets of the inspector: a label on the left, a field on the right, all on one grid. Number fields are in
//! `numbers`.

use egui::{Align, Color32, Context, Id, Key, Layout, Response, RichText, ScrollArea, TextEdit, Ui, UiBuilder, vec2};

pub use super::theme::MIXED;
use super::{color_picker, theme};

/// Width of the labels: a share of the row, within limits in points.
const LABEL_SHARE: f32 = 0.42;
const LABEL_WIDTH: [f32; 2] = [92.0, 118.0];

/// A row: a label, and the content of `add` in the remaining width.
///
/// The label identifies its widgets, not the position: rows that appear or disappear above do not move the focus.
pub fn row<R>(ui: &mut Ui, label: &str, help: &str, add: impl FnOnce(&mut Ui) -> R) -> R {
    let id = ui.scope_id().with(("row", label));
    let horizontal = |ui: &mut Ui| {
        let width = (LABEL_SHARE * ui.available_width()).clamp(LABEL_WIDTH[0], LABEL_WIDTH[1]).round();
        let size = vec2(width, theme::ROW_HEIGHT);
        let layout = Layout::left_to_right(Align::Center);
        ui.allocate_ui_with_layout(size, layout, |ui| {
            ui.set_min_size(size);
            let text = RichText::new(label).color(theme::WEAK);
            let response = ui.add(egui::Label::new(text).truncate());
            if !help.is_empty() {
                response.on_hover_text(help);
            }
        });
        ui.data_mut(|d| d.insert_temp(row_help(), help.to_owned()));
        let result = add(ui);
        ui.data_mut(|d| d.remove_temp::<String>(row_help()));
        result
    };
    ui.scope_builder(UiBuilder::new().scope_id(id), |ui| ui.horizontal(horizontal).inner).inner
}

/// Key of the help text of the row that is being shown, for its widgets.
fn row_help() -> Id {
    Id::unique("help of the row")
}

/// The response with the help text of its row as a tooltip.
pub fn helped(ui: &Ui, response: Response) -> Response {
    match ui.data(|d| d.get_temp::<String>(row_help())) {
        Some(help) if !help.is_empty() => response.on_hover_text(help),
        _ => response,
    }
}

/// A card with a title.
pub fn card<R>(ui: &mut Ui, title: &str, add: impl FnOnce(&mut Ui) -> R) -> Option<R> {
    folded_card(ui, title, true, add)
}

/// The same, at first open or closed.
pub fn folded_card<R>(ui: &mut Ui, title: &str, is_open: bool, add: impl FnOnce(&mut Ui) -> R) -> Option<R> {
    let frame = egui::Frame::new().fill(*theme::CARD).corner_radius(7.0).inner_margin(egui::Margin::symmetric(10, 8));
    let content = |ui: &mut Ui| {
        ui.set_width(ui.available_width());
        let header = egui::CollapsingHeader::new(RichText::new(title).strong().color(theme::STRONG));
        header.default_open(is_open).show_unindented(ui, |ui| {
            ui.add_space(2.0);
            ui.push_id(title, add).inner
        })
    };
    frame.show(ui, content).inner.body_returned
}

/// A color button; values are linear. Returns the new linear color. `mixed` shows a dash.
pub fn color(ui: &mut Ui, name: &str, linear: [f64; 3], mixed: bool) -> (Id, Option<[f64; 3]>) {
    // The picker handles channels up to 1: a brighter color keeps its peak as a factor.
    let peak = linear.iter().copied().fold(1.0, f64::max);
    let mut shown = linear.map(|v| (v / peak) as f32);
    let before = shown;
    let (response, picked) = color_picker::button(ui, name, &mut shown, mixed);
    let id = helped(ui, response).id;
    let changed = picked && shown != before;
    // Channels unchanged by the picker keep their full precision.
    let mut value = linear;
    for c in 0..3 {
        if shown[c] != before[c] {
            value[c] = (f64::from(shown[c]) * peak * 1e5).round() / 1e5;
        }
    }
    (id, changed.then_some(value))
}

/// A drop-down list. Returns the chosen entry if it differs.
pub fn choice<T: Copy + PartialEq>(
    ui: &mut Ui,
    name: &str,
    current: Option<T>,
    options: &[T],
    label: impl Fn(T) -> &'static str,
    help: impl Fn(T) -> &'static str,
) -> (Id, Option<T>) {
    let mut chosen = None;
    let shown = current.map_or(MIXED, &label);
    let combo = egui::ComboBox::from_id_salt(name).selected_text(shown).width(ui.available_width()).truncate();
    let combo = combo.height(list_room(ui.ctx()));
    let response = combo.show_ui(ui, |ui| {
        for &option in options {
            let mut entry = ui.selectable_label(current == Some(option), label(option));
            let text = help(option);
            if !text.is_empty() {
                entry = entry.on_hover_text(text);
            }
            if entry.clicked() && current != Some(option) {
                chosen = Some(option);
            }
        }
    });
    ui.ctx().accesskit_node_builder(response.response.id, |node| node.set_label(name.to_owned()));
    (helped(ui, response.response).id, chosen)
}

/// A frameless button with an icon.
pub fn icon_button(
    ui: &mut Ui,
    icon: egui_material_icons::MaterialIcon,
    name: &str,
    color: impl Into<Color32>,
) -> Response {
    let text = icon.rich_text().size(theme::ICON_SIZE).color(color);
    let response = ui.add(egui::Button::new(text).frame(false).min_size(vec2(20.0, 20.0)));
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(name.to_owned()));
    response.on_hover_text(name).on_disabled_hover_text(name)
}

/// The same as a switch of several nodes: a dash stands in place of the icon if they differ.
pub fn switch_button(
    ui: &mut Ui,
    (icon, name): (egui_material_icons::MaterialIcon, &str),
    color: impl Into<Color32>,
    mixed: bool,
) -> Response {
    if !mixed {
        return icon_button(ui, icon, name, color);
    }
    let text = RichText::new(MIXED).strong().color(theme::TEXT);
    let response = ui.add(egui::Button::new(text).frame(false).min_size(vec2(20.0, 20.0)));
    ui.ctx().accesskit_node_builder(response.id, |node| {
        node.set_label(name.to_owned());
        node.set_toggled(egui::accesskit::Toggled::Mixed);
    });
    response.on_hover_text(format!("{name}: now they differ"))
}

/// A line of text that takes effect at the end of typing: on Enter, Tab or a click elsewhere, not on Escape.
pub fn line(ui: &mut Ui, name: &str, current: &str, hint: &str) -> (Id, Option<String>) {
    let id = ui.next_auto_id();
    let mut text = ui.data(|d| d.get_temp::<String>(id)).unwrap_or_else(|| current.to_owned());
    let field = TextEdit::singleline(&mut text).id(id).hint_text(hint).desired_width(ui.available_width());
    let response = ui.add(field);
    ui.ctx().accesskit_node_builder(id, |node| node.set_label(name.to_owned()));
    let typing = response.has_focus();
    let typed = response.lost_focus() && !ui.input(|i| i.key_pressed(Key::Escape)) && text != current;
    ui.data_mut(|d| {
        d.remove::<String>(id);
        if typing {
            d.insert_temp(id, text.clone());
        }
    });
    (id, typed.then_some(text))
}

/// Replaces the middle of a text longer than `most` characters by an ellipsis: both ends distinguish names, and the end
/// holds a file's extension.
pub fn elided(text: &str, most: usize) -> String {
    let count = text.chars().count();
    if count <= most {
        return text.to_owned();
    }
    let kept = most.saturating_sub(1);
    let (head, tail) = (kept.div_ceil(2), kept / 2);
    text.chars().take(head).chain(['…']).chain(text.chars().skip(count - tail)).collect()
}

/// Maximum height of a list that opens above or below a widget: at least one of the sides has that much room.
pub fn list_room(ctx: &Context) -> f32 {
    (ctx.content_rect().height() * 0.5 - 24.0).clamp(80.0, 420.0)
}

/// Menu entries that scroll if they are higher than `room`.
pub fn scrolling<R>(ui: &mut Ui, room: f32, add: impl FnOnce(&mut Ui) -> R) -> R {
    // Show the scroll bar before the pointer is near, as a sign of more entries.
    let scroll = &mut ui.spacing_mut().scroll;
    (scroll.floating_width, scroll.dormant_handle_opacity) = (4.0, 0.7);
    // Beside the shortcuts, not over them.
    scroll.floating_allocated_width = 8.0;
    // A popup offers a fixed height, however much room there is.
    ui.set_max_height(room);
    ScrollArea::vertical().max_height(room).show(ui, add).inner
}

/// Maximum height of a menu below a bar at the top of the window.
pub fn room_below(ui: &Ui) -> f32 {
    (ui.ctx().content_rect().bottom() - ui.cursor().top() - 14.0).max(80.0)
}

/// Maximum height of a menu beside another one or at the pointer.
pub fn room_beside(ctx: &Context) -> f32 {
    (ctx.content_rect().height() - 32.0).max(80.0)
}

/// Fills exactly the remaining area and never asks for more.
pub fn fixed<R>(ui: &mut Ui, add: impl FnOnce(&mut Ui) -> R) -> R {
    let rect = ui.available_rect_before_wrap();
    let mut inside = ui.new_child(UiBuilder::new().max_rect(rect));
    inside.shrink_clip_rect(rect.expand(2.0));
    let result = add(&mut inside);
    ui.allocate_rect(rect, egui::Sense::hover());
    result
}

/// The field of a palette in which one searches; `hint` is shown while it is empty, `label` is its accessible name.
pub fn search(ui: &mut Ui, text: &mut String, (hint, label): (&str, &str), takes_focus: bool) -> Response {
    let field =
        TextEdit::singleline(text).hint_text(hint).desired_width(f32::INFINITY).margin(egui::Margin::symmetric(8, 6));
    let response = ui.add(field).on_hover_text(format!("{label}: part of a name"));
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(label));
    if takes_focus {
        response.request_focus();
    }
    response
}

#[cfg(test)]
mod tests {
    use super::elided;

    #[test]
    fn long_names_keep_both_ends() {
        assert_eq!(elided("short", 5), "short");
        assert_eq!(elided("a long name.json", 9), "a lo…json");
        assert_eq!(elided("äöüäöü", 3), "ä…ü");
        assert_eq!(elided("abc", 0), "…");
    }
}
