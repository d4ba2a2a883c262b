//! The card of modifiers: a list that can be added to, reordered, switched off and edited, made from the table
//! of modifiers.

use egui::{Align, Layout, RichText, Ui};
use egui_material_icons::icons::{ICON_ADD, ICON_ARROW_DOWNWARD, ICON_ARROW_UPWARD, ICON_DELETE};
use glam::DVec3;

use super::edit_session::ParamTarget;
use super::multi_edit::MultiEdit;
use super::numbers::NumberField;
use super::widgets::{self, MIXED};
use super::{inspector_kinds, theme};
use crate::scene::{Axis, MAX_MODIFIERS, ModifierKind, ModifierParam, ModifierSlot, ModifierValue, Node};

/// Shows the card for objects and groups.
pub fn show(ui: &mut Ui, edit: &mut MultiEdit<'_>) {
    widgets::card(ui, "Modifiers", |ui| {
        let kinds = |n: &Node| n.modifiers.iter().map(|slot| slot.modifier.kind()).collect::<Vec<_>>();
        match edit.common(kinds) {
            Some(kinds) => {
                for (index, kind) in kinds.iter().enumerate() {
                    ui.push_id(index, |ui| {
                        header(ui, edit, index, *kind, kinds.len());
                        parameters(ui, edit, index, *kind);
                    });
                    ui.add_space(4.0);
                }
            }
            None => {
                ui.label(RichText::new("Different modifiers: choose one node to edit its own").color(theme::WEAK));
            }
        }
        add(ui, edit);
    });
}

/// Switch, name, and buttons to move and remove.
fn header(ui: &mut Ui, edit: &mut MultiEdit<'_>, index: usize, kind: ModifierKind, count: usize) {
    ui.horizontal(|ui| {
        let mut on = edit.active().modifiers[index].enabled;
        let mixed = edit.common(|n| n.modifiers[index].enabled).is_none();
        let text = RichText::new(kind.label()).strong();
        let switch = ui.add(egui::Checkbox::new(&mut on, text).indeterminate(mixed)).on_hover_text(kind.help());
        if switch.changed() {
            edit.change(switch.id, |n| n.modifiers[index].enabled = on);
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let mut button = |icon, help: &str, usable: bool, change: &dyn Fn(&mut Vec<ModifierSlot>)| {
                let color = if usable { theme::WEAK } else { theme::RESTING };
                let response = ui.add_enabled_ui(usable, |ui| widgets::icon_button(ui, icon, help, color)).inner;
                if response.clicked() {
                    edit.change(response.id, |n| change(&mut n.modifiers));
                }
            };
            button(ICON_DELETE, "Remove the modifier", true, &|list| {
                list.remove(index);
            });
            button(ICON_ARROW_DOWNWARD, "Move down", index + 1 < count, &|list| list.swap(index, index + 1));
            button(ICON_ARROW_UPWARD, "Move up", index > 0, &|list| list.swap(index - 1, index));
        });
    });
}

fn parameters(ui: &mut Ui, edit: &mut MultiEdit<'_>, index: usize, kind: ModifierKind) {
    let defaults = kind.default_modifier().values();
    for (at, (param, default)) in kind.params().iter().zip(defaults).enumerate() {
        parameter(ui, edit, [index, at], param, default);
    }
}

fn value(node: &Node, [index, at]: [usize; 2]) -> Option<ModifierValue> {
    node.modifiers.get(index)?.modifier.values().get(at).cloned()
}

fn set(node: &mut Node, [index, at]: [usize; 2], value: ModifierValue) {
    if let Some(slot) = node.modifiers.get_mut(index) {
        slot.modifier.set_value(at, value);
    }
}

/// The nearest whole number that is no less than 0.
fn whole(v: f64) -> u32 {
    v.round().clamp(0.0, f64::from(u32::MAX)) as u32
}

fn parameter(ui: &mut Ui, edit: &mut MultiEdit<'_>, at: [usize; 2], param: &ModifierParam, default: ModifierValue) {
    let label = inspector_kinds::sentence_case(param.name);
    let field =
        |default| NumberField { label: &label, help: param.help, limits: param.limits, default, taken_as: None };
    let whole_field = |default| NumberField { taken_as: Some(f64::round), ..field(default) };
    match default {
        ModifierValue::Scalar(default) => {
            let get = |n: &Node| if let Some(ModifierValue::Scalar(v)) = value(n, at) { Some(v) } else { None };
            edit.number(ui, &field(Some(default)), get, |n, v| set(n, at, ModifierValue::Scalar(v)));
        }
        ModifierValue::Count(default) => {
            let get = |n: &Node| if let Some(ModifierValue::Count(v)) = value(n, at) { Some(v.into()) } else { None };
            edit.number(ui, &whole_field(Some(default.into())), get, |n, v| set(n, at, ModifierValue::Count(whole(v))));
        }
        ModifierValue::Vector(default) => {
            let get = |n: &Node| if let Some(ModifierValue::Vector(v)) = value(n, at) { Some(v) } else { None };
            let same = default.x == default.y && default.y == default.z;
            let field = field(same.then_some(default.x));
            edit.vector(ui, &field, get, |n, v| set(n, at, ModifierValue::Vector(v)));
        }
        ModifierValue::Counts(_) => {
            let get = |n: &Node| {
                let Some(ModifierValue::Counts(v)) = value(n, at) else { return None };
                Some(DVec3::from(v.map(f64::from)))
            };
            edit.vector(ui, &whole_field(None), get, |n, v| set(n, at, ModifierValue::Counts(v.to_array().map(whole))));
        }
        ModifierValue::Flag(_) => {
            let get = |n: &Node| value(n, at) == Some(ModifierValue::Flag(true));
            edit.toggle(ui, (&label, "", param.help), get, |n, on| set(n, at, ModifierValue::Flag(on)));
        }
        ModifierValue::Flags(_) => flags(ui, edit, at, &label, param.help),
        ModifierValue::Axis(_) => {
            let get = |n: &Node| if let Some(ModifierValue::Axis(v)) = value(n, at) { Some(v) } else { None };
            let names = (Axis::label, inspector_kinds::no_help);
            edit.choice(ui, (&label, param.help), &Axis::ALL, names, get, |n, v| set(n, at, ModifierValue::Axis(v)));
        }
        ModifierValue::File(default) => {
            let Some(ModifierValue::File(file)) = value(edit.active(), at) else { return };
            let is_mixed = edit.common(|n| value(n, at)).is_none();
            let shown = if is_mixed { MIXED } else { file.name().unwrap_or("No file") };
            let kept = (ParamTarget::Modifier(at), &file, shown);
            inspector_kinds::attachment(ui, edit, (&label, param.help), kept, &default);
        }
    }
}

/// A row with a check box for each axis.
fn flags(ui: &mut Ui, edit: &mut MultiEdit<'_>, at: [usize; 2], label: &str, help: &str) {
    let get = |n: &Node| if let Some(ModifierValue::Flags(v)) = value(n, at) { v } else { [false; 3] };
    let mut changed = None;
    widgets::row(ui, label, help, |ui| {
        for (axis, name) in ["X", "Y", "Z"].into_iter().enumerate() {
            let mut on = get(edit.active())[axis];
            let mixed = edit.common(|n| get(n)[axis]).is_none();
            let response = ui.add(egui::Checkbox::new(&mut on, name).indeterminate(mixed)).on_hover_text(help);
            ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(format!("{label} {name}")));
            if response.changed() {
                changed = Some((response.id, axis, on));
            }
        }
    });
    if let Some((widget, axis, on)) = changed {
        edit.change(widget, |n| {
            let mut flags = get(n);
            flags[axis] = on;
            set(n, at, ModifierValue::Flags(flags));
        });
    }
}

/// The button that offers all kinds.
fn add(ui: &mut Ui, edit: &mut MultiEdit<'_>) {
    if edit.active().modifiers.len() >= MAX_MODIFIERS {
        let text = format!("{MAX_MODIFIERS} modifiers are the most that a node can have");
        ui.label(RichText::new(text).color(theme::WEAK));
        return;
    }
    let label = format!("{} Add modifier", ICON_ADD.codepoint);
    ui.menu_button(label, |ui| {
        widgets::scrolling(ui, widgets::list_room(&ui.ctx().clone()), |ui| {
            for kind in ModifierKind::ALL {
                let button = ui.button(kind.label()).on_hover_text(kind.help());
                if button.clicked() {
                    edit.change(button.id, |n| n.modifiers.push(kind.default_modifier().into()));
                    ui.close();
                }
            }
        });
    });
}
