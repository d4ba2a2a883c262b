//! A list of a node whose entries have a kind with parameters, such as its modifiers: buttons to add, reorder, switch
//! off and remove, and a row for each parameter, generated from the table of kinds.

use egui::{Align, Button, Id, Key, Layout, Popup, PopupCloseBehavior, RichText, Ui, vec2};
use egui_material_icons::icons::{
    ICON_ADD, ICON_ARROW_DOWNWARD, ICON_ARROW_UPWARD, ICON_CHEVRON_RIGHT, ICON_DELETE, ICON_EXPAND_MORE,
};

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

    /// Shows what the entry at this index has besides its parameters.
    fn more(_: &mut Ui, _: &mut MultiEdit<'_>, _: usize) {}
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
                        if !header::<S>(ui, edit, index, *kind, kinds.len()) {
                            return;
                        }
                        for row in S::ROWS.iter().copied().chain(S::params(*kind).iter().map(|param| param.name)) {
                            inspector_params::row(ui, edit, S::part(index), row);
                        }
                        S::more(ui, edit, index);
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

/// Name, with the switch where there is one, and buttons to collapse, move and remove. Returns whether it is open.
fn header<S: SlotList>(ui: &mut Ui, edit: &mut MultiEdit<'_>, index: usize, kind: S::Kind, count: usize) -> bool {
    let key = ui.scope_id().with("collapsed");
    let mut is_open = !ui.data(|d| d.get_temp::<bool>(key)).unwrap_or(false);
    ui.horizontal(|ui| {
        let [label, help] = S::texts(kind);
        let (icon, verb) = if is_open { (ICON_EXPAND_MORE, "Collapse") } else { (ICON_CHEVRON_RIGHT, "Open") };
        if widgets::icon_button(ui, icon, &format!("{verb} {}", label.to_lowercase()), theme::WEAK).clicked() {
            is_open ^= true;
            ui.data_mut(|d| d.insert_temp(key, !is_open));
        }
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
    is_open
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
    let opener = ui.button(format!("{} Add {name}", ICON_ADD.codepoint));
    let opener = opener.on_hover_text(format!("Another {name}, by its name; they apply from top to bottom"));
    let popup = Popup::menu(&opener).close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    popup.show(|ui| {
        let chosen = search::<S>(ui, opener.clicked());
        if let Some((widget, kind)) = chosen {
            edit.change(widget, |n| {
                if let Some(list) = S::list_mut(n) {
                    list.push(S::with_defaults(kind));
                }
            });
            ui.close();
        }
    });
}

/// The kinds whose name holds the typed words; Enter takes the first of them.
fn search<S: SlotList>(ui: &mut Ui, is_new: bool) -> Option<(Id, S::Kind)> {
    let name = S::NAMES[0];
    let key = ui.scope_id().with("search");
    let mut text = ui.data(|d| d.get_temp::<String>(key)).unwrap_or_default();
    if is_new {
        text.clear();
    }
    ui.set_width(200.0);
    let label = format!("Find a {name}");
    let field = widgets::search(ui, &mut text, ("Search…", &label), is_new);
    let wanted = text.to_lowercase();
    let is_found =
        |kind: &&S::Kind| wanted.split_whitespace().all(|word| S::texts(**kind)[0].to_lowercase().contains(word));
    let found: Vec<S::Kind> = S::kinds().iter().filter(is_found).copied().collect();
    let enters = !wanted.trim().is_empty() && ui.input(|i| i.key_pressed(Key::Enter));
    let mut chosen = found.first().filter(|_| enters).map(|kind| (field.id, *kind));
    ui.add_space(2.0);
    widgets::scrolling(ui, widgets::list_room(&ui.ctx().clone()), |ui| {
        ui.spacing_mut().item_spacing.y = 1.0;
        for kind in found {
            let [label, help] = S::texts(kind);
            let entry = Button::new(label).frame_when_inactive(false).min_size(vec2(ui.available_width(), 24.0));
            let button = ui.add(entry).on_hover_text(help);
            if button.clicked() {
                chosen = Some((button.id, kind));
            }
        }
    });
    ui.data_mut(|d| d.insert_temp(key, text));
    chosen
}
