//! A list of a node whose entries have a kind with parameters, such as its modifiers: buttons to add, reorder, switch
//! off and remove, and a row for each parameter, generated from the table of kinds.

use egui::{Align, Layout, RichText, Ui};
use egui_material_icons::icons::{ICON_ADD, ICON_ARROW_DOWNWARD, ICON_ARROW_UPWARD, ICON_DELETE};

use super::multi_edit::MultiEdit;
use super::{inspector_params, theme, widgets};
use isolith_scene::{Node, Param, ParamValue, Part};

/// An entry of such a list.
pub trait SlotList: Sized {
    /// What distinguishes entries.
    type Kind: Copy + PartialEq + 'static;

    /// Most entries of a node.
    const MOST: usize;
    /// What one entry is called, and several.
    const NAMES: [&'static str; 2];
    /// The parameter of the entry that its header shows as a switch.
    const SWITCH: Option<&'static str>;
    /// Parameters of the entry that have rows above those of its kind.
    const ROWS: &'static [&'static str];

    /// Every kind, in the order of the menu.
    fn kinds() -> &'static [Self::Kind];

    /// Display name and help text of a kind.
    fn texts(kind: Self::Kind) -> [&'static str; 2];

    /// The parameters of a kind.
    fn params(kind: Self::Kind) -> &'static [Param];

    /// An entry of this kind with its default parameters.
    fn with_defaults(kind: Self::Kind) -> Self;

    /// The kind of the entry.
    fn kind(&self) -> Self::Kind;

    /// The list of a node.
    fn list(node: &Node) -> &[Self];

    /// The same, mutable; `None` for a node without such a list.
    fn list_mut(node: &mut Node) -> Option<&mut Vec<Self>>;

    /// The part of the node that is the entry at this index.
    fn part(index: usize) -> Part;
}

/// Shows the list.
pub fn show<S: SlotList>(ui: &mut Ui, edit: &mut MultiEdit<'_>) {
    let [name, plural] = S::NAMES;
    ui.push_id(name, |ui| {
        let kinds = |n: &Node| S::list(n).iter().map(S::kind).collect::<Vec<_>>();
        match edit.common(kinds) {
            Some(kinds) => {
                for (index, kind) in kinds.iter().enumerate() {
                    ui.push_id(index, |ui| {
                        header::<S>(ui, edit, index, *kind, kinds.len());
                        for row in S::ROWS.iter().copied().chain(S::params(*kind).iter().map(|param| param.name)) {
                            inspector_params::row(ui, edit, S::part(index), row);
                        }
                    });
                    ui.add_space(4.0);
                }
            }
            None => {
                let text = format!("Different {plural}: choose one node to edit its own");
                ui.label(RichText::new(text).color(theme::WEAK));
            }
        }
        add::<S>(ui, edit);
    });
}

/// Name, with the switch where there is one, and buttons to move and remove.
fn header<S: SlotList>(ui: &mut Ui, edit: &mut MultiEdit<'_>, index: usize, kind: S::Kind, count: usize) {
    ui.horizontal(|ui| {
        let [label, help] = S::texts(kind);
        let text = RichText::new(label).strong();
        match S::SWITCH {
            Some(name) => switch(ui, edit, (S::part(index), name), text, help),
            None => {
                ui.label(text).on_hover_text(help);
            }
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let mut button = |icon, help: &str, usable: bool, change: &dyn Fn(&mut Vec<S>)| {
                let color = if usable { theme::WEAK } else { theme::RESTING };
                let response = ui.add_enabled_ui(usable, |ui| widgets::icon_button(ui, icon, help, color)).inner;
                if response.clicked() {
                    edit.change(response.id, |n| S::list_mut(n).into_iter().for_each(change));
                }
            };
            button(ICON_DELETE, &format!("Remove the {}", S::NAMES[0]), true, &|list| {
                list.remove(index);
            });
            button(ICON_ARROW_DOWNWARD, "Move down", index + 1 < count, &|list| list.swap(index, index + 1));
            button(ICON_ARROW_UPWARD, "Move up", index > 0, &|list| list.swap(index - 1, index));
        });
    });
}

fn switch(ui: &mut Ui, edit: &mut MultiEdit<'_>, (part, name): (Part, &str), text: RichText, help: &str) {
    let flag = |n: &Node| part.params(n).and_then(|params| params.get(name)) == Some(ParamValue::Flag(true));
    let mut on = flag(edit.active());
    let mixed = edit.common(flag).is_none();
    let switch = ui.add(egui::Checkbox::new(&mut on, text).indeterminate(mixed)).on_hover_text(help);
    if switch.changed() {
        edit.change(switch.id, |n| {
            if let Some(params) = part.params_mut(n) {
                params.set(name, ParamValue::Flag(on));
            }
        });
    }
}

/// The button that offers all kinds.
fn add<S: SlotList>(ui: &mut Ui, edit: &mut MultiEdit<'_>) {
    let [name, plural] = S::NAMES;
    if S::list(edit.active()).len() >= S::MOST {
        let text = format!("{} {plural} are the most that a node can have", S::MOST);
        ui.label(RichText::new(text).color(theme::WEAK));
        return;
    }
    let label = format!("{} Add {name}", ICON_ADD.codepoint);
    ui.menu_button(label, |ui| {
        widgets::scrolling(ui, widgets::list_room(&ui.ctx().clone()), |ui| {
            for kind in S::kinds() {
                let [label, help] = S::texts(*kind);
                let button = ui.button(label).on_hover_text(help);
                if button.clicked() {
                    edit.change(button.id, |n| {
                        if let Some(list) = S::list_mut(n) {
                            list.push(S::with_defaults(*kind));
                        }
                    });
                    ui.close();
                }
            }
        });
    });
}
