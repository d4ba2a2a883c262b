//! The card of modifiers: a list with buttons to add, reorder, switch off and edit, generated from the table
//! of modifiers.

use egui::{Align, Layout, RichText, Ui};
use egui_material_icons::icons::{ICON_ADD, ICON_ARROW_DOWNWARD, ICON_ARROW_UPWARD, ICON_DELETE};

use super::multi_edit::MultiEdit;
use super::{inspector_params, theme, widgets};
use isolith_scene::{MAX_MODIFIERS, ModifierKind, ModifierSlot, Node, Part};

/// Shows the card for objects and groups.
pub fn show(ui: &mut Ui, edit: &mut MultiEdit<'_>) {
    widgets::card(ui, "Modifiers", |ui| {
        let kinds = |n: &Node| n.modifiers.iter().map(|slot| slot.modifier.kind()).collect::<Vec<_>>();
        match edit.common(kinds) {
            Some(kinds) => {
                for (index, kind) in kinds.iter().enumerate() {
                    ui.push_id(index, |ui| {
                        header(ui, edit, index, *kind, kinds.len());
                        for param in kind.params() {
                            inspector_params::row(ui, edit, Part::Modifier(index), param.name);
                        }
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

/// The button that offers all kinds of modifiers.
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
