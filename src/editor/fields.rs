//! The widgets of the inspector: a label on the left, a field on the right, all on one grid.

use std::cell::RefCell;

use egui::{Align, Color32, DragValue, Id, Key, Layout, Response, RichText, Ui, vec2};

use super::{color_picker, expression, theme};
use crate::scene::Limits;

/// What stands around a number.
#[derive(Clone, Copy)]
pub struct Field<'a> {
    /// On its left.
    pub label: &'a str,
    /// One sentence, as a tooltip.
    pub help: &'a str,
    /// Soft for dragging, hard for typing.
    pub limits: Limits,
    /// What a reset gives; `None` where there is no natural one.
    pub default: Option<f64>,
}

/// What a number field answers.
pub struct Answer {
    /// Names the gesture.
    pub widget: Id,
    /// The new value, where the artist changed it.
    pub value: Option<f64>,
}

/// What a field shows where the selected nodes have different numbers.
const MIXED: &str = "–";

/// Width of the labels in points.
const LABEL_WIDTH: f32 = 92.0;

/// A row: label, then whatever `add` adds in the width that is left.
pub fn row<R>(ui: &mut Ui, label: &str, help: &str, add: impl FnOnce(&mut Ui) -> R) -> R {
    ui.horizontal(|ui| {
        let size = vec2(LABEL_WIDTH, theme::ROW_HEIGHT);
        let layout = Layout::left_to_right(Align::Center);
        ui.allocate_ui_with_layout(size, layout, |ui| {
            ui.set_min_size(size);
            let text = RichText::new(label).color(theme::WEAK);
            let response = ui.add(egui::Label::new(text).truncate());
            if !help.is_empty() {
                response.on_hover_text(help);
            }
        });
        add(ui)
    })
    .inner
}

/// A card with a title.
pub fn card<R>(ui: &mut Ui, title: &str, add: impl FnOnce(&mut Ui) -> R) -> Option<R> {
    let frame = egui::Frame::new().fill(theme::CARD).corner_radius(7.0).inner_margin(egui::Margin::symmetric(10, 8));
    frame
        .show(ui, |ui| {
            ui.set_width(ui.available_width());
            let header = egui::CollapsingHeader::new(RichText::new(title).strong().color(Color32::WHITE));
            header.default_open(true).show_unindented(ui, |ui| {
                ui.add_space(2.0);
                add(ui)
            })
        })
        .inner
        .body_returned
}

/// A number in a field of the given width. `mixed` shows a dash until it is changed.
pub fn number(ui: &mut Ui, field: &Field<'_>, name: &str, value: f64, mixed: bool, width: f32) -> Answer {
    prefixed_number(ui, field, name, value, mixed, width, None)
}

fn prefixed_number(
    ui: &mut Ui,
    field: &Field<'_>,
    name: &str,
    value: f64,
    mixed: bool,
    width: f32,
    axis: Option<usize>,
) -> Answer {
    let Limits { soft, hard, unit } = field.limits;
    let dragged = ui.ctx().is_being_dragged(ui.next_auto_id());
    // A value beyond the soft range, typed before, is not thrown back by a drag.
    let range = if dragged { soft[0].min(value)..=soft[1].max(value) } else { hard[0]..=hard[1] };
    let mut edited = value;
    let typed = RefCell::new(None);
    let parse = |text: &str| {
        typed.replace(Some(text.to_owned()));
        expression::evaluate(text)
    };
    let mut drag = DragValue::new(&mut edited)
        .range(range)
        .clamp_existing_to_range(false)
        .speed(drag_speed(soft, value))
        .max_decimals(4)
        .min_size(vec2(width, theme::ROW_HEIGHT))
        .clip_text(true)
        .custom_parser(parse);
    if mixed {
        drag = drag.custom_formatter(|_, _| MIXED.into());
    }
    if !unit.is_empty() && axis.is_none() {
        drag = drag.suffix(RichText::new(format!(" {unit}")).color(theme::WEAK));
    }
    let response = ui.add(drag);
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(name.to_owned()));
    if let Some(axis) = axis {
        paint_axis_mark(ui, &response, axis);
    }
    let is_done = response.lost_focus() && !ui.input(|i| i.key_pressed(Key::Escape));
    let reason = typed.take().filter(|_| is_done).and_then(|text| refusal(name, &text, field.limits));
    if let Some(reason) = reason {
        ui.data_mut(|d| d.insert_temp(refused(), reason));
    }
    let changed = response.changed() && (edited != value || mixed);
    let mut answer = Answer { widget: response.id, value: changed.then_some(edited) };
    if let Some(default) = field.default
        && wants_reset(ui, &response, default, field.limits.unit)
    {
        answer.value = Some(default);
    }
    if !field.help.is_empty() && !dragged {
        response.on_hover_text(field.help);
    }
    answer
}

/// Why a field does not show what was typed into it, if it does not.
fn refusal(name: &str, typed: &str, limits: Limits) -> Option<String> {
    let Limits { hard: [least, most], unit, .. } = limits;
    let bound = |bound: f64| format!("{bound} {unit}").trim_end().to_owned();
    match expression::evaluate(typed) {
        _ if typed == MIXED => None,
        None => Some(format!("{name}: “{typed}” is not a number, so it stays as it was.")),
        Some(value) if value < least => {
            Some(format!("{name}: {typed} is less than {}, the least there can be.", bound(least)))
        }
        Some(value) if value > most => {
            Some(format!("{name}: {typed} is more than {}, the most there can be.", bound(most)))
        }
        Some(_) => None,
    }
}

/// Where that waits for the editor.
fn refused() -> Id {
    Id::unique("what was typed and refused")
}

/// Why what was just typed is not taken as it is, to be told.
pub fn take_refusal(ctx: &egui::Context) -> Option<String> {
    ctx.data_mut(|d| d.remove_temp(refused()))
}

/// Three numbers side by side, marked in the axes' colours. Answers with the axis changed.
pub fn vector(ui: &mut Ui, field: &Field<'_>, values: [f64; 3], mixed: [bool; 3]) -> Option<(usize, Answer)> {
    let gap = 4.0;
    let width = ((ui.available_width() - 2.0 * gap) / 3.0).floor();
    let mut changed = None;
    ui.spacing_mut().item_spacing.x = gap;
    ui.spacing_mut().button_padding.x = 4.0;
    for axis in 0..3 {
        let name = format!("{} {}", field.label, ["X", "Y", "Z"][axis]);
        let answer = prefixed_number(ui, field, &name, values[axis], mixed[axis], width, Some(axis));
        if answer.value.is_some() {
            changed = Some((axis, answer));
        }
    }
    changed
}

/// Points of drag that cross the soft range; a large value moves faster.
fn drag_speed(soft: [f64; 2], value: f64) -> f64 {
    let crossing = 700.0;
    let span = (soft[1] - soft[0]).min(20.0);
    (span / crossing).max(value.abs() * 0.004)
}

fn paint_axis_mark(ui: &Ui, response: &Response, axis: usize) {
    let rect = response.rect;
    let bar = egui::Rect::from_min_max(rect.left_top() + vec2(0.0, 5.0), rect.left_bottom() + vec2(2.5, -5.0));
    ui.painter().rect_filled(bar, 1.0, theme::AXES[axis]);
}

/// Backspace over the field, or the entry of its context menu.
fn wants_reset(ui: &Ui, response: &Response, default: f64, unit: &str) -> bool {
    let mut reset = false;
    response.context_menu(|ui| {
        let text = format!("Reset to {} {unit}", tidy(default));
        if ui.button(text.trim_end()).clicked() {
            reset = true;
            ui.close();
        }
    });
    let typing = ui.ctx().text_edit_focused();
    reset || (!typing && response.hovered() && ui.input(|i| i.key_pressed(Key::Backspace)))
}

fn tidy(value: f64) -> f64 {
    (value * 1e4).round() / 1e4
}

/// A button that holds a colour; values are linear. Answers with the new linear colour.
pub fn color(ui: &mut Ui, name: &str, linear: [f64; 3]) -> (Id, Option<[f64; 3]>) {
    // The picker works on brightness-limited colours; what is brighter keeps its brightness as a factor.
    let peak = linear.iter().copied().fold(1.0, f64::max);
    let mut shown = linear.map(|v| (v / peak) as f32);
    let before = shown;
    let (response, picked) = color_picker::button(ui, name, &mut shown);
    let id = response.id;
    let changed = picked && shown != before;
    // Channels that the picker left alone keep their full precision.
    let mut value = linear;
    for c in 0..3 {
        if shown[c] != before[c] {
            value[c] = (f64::from(shown[c]) * peak * 1e5).round() / 1e5;
        }
    }
    (id, changed.then_some(value))
}

/// A drop-down list. Answers with the entry chosen, where it differs.
pub fn choice<T: Copy + PartialEq>(
    ui: &mut Ui,
    name: &str,
    current: Option<T>,
    options: &[T],
    label: impl Fn(T) -> &'static str,
    help: impl Fn(T) -> &'static str,
) -> (Id, Option<T>) {
    let mut chosen = None;
    let shown = current.map_or("–", &label);
    let combo = egui::ComboBox::from_id_salt(name).selected_text(shown).width(ui.available_width()).truncate();
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
    (response.response.id, chosen)
}

/// A frameless button with an icon.
pub fn icon_button(ui: &mut Ui, icon: egui_material_icons::MaterialIcon, name: &str, color: Color32) -> Response {
    let text = icon.rich_text().size(theme::ICON_SIZE).color(color);
    let response = ui.add(egui::Button::new(text).frame(false).min_size(vec2(20.0, 20.0)));
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(name.to_owned()));
    response.on_hover_text(name)
}
