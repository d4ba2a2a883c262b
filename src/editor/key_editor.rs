//! The list of all keys: search, press a key to change one, reset.

use egui::{Button, Context, Event, Key, KeyboardShortcut, RichText, ScrollArea, Ui, vec2};
use egui_material_icons::icons::{ICON_ADD, ICON_CLOSE, ICON_UNDO};

use super::commands::command::Command;
use super::keymap::{Keymap, pressed, shown, written};
use super::state::EditorState;
use super::{theme, widgets};

/// Height of a row, in points.
const ROW: f32 = 28.0;
/// Share of the width for the names of commands.
const NAMES: f32 = 0.46;

/// What the editor of keys cannot do itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeyRequest {
    /// Write the changed keys to a file.
    Export,
    /// Read them from a file.
    Import,
}

/// A key that is to be changed: the command, and which of its keys; past the last one for a new one.
#[derive(Clone, Copy, PartialEq)]
struct Place {
    command: Command,
    index: usize,
}

/// A key that another command has.
struct Taken {
    place: Place,
    shortcut: KeyboardShortcut,
    by: Command,
}

/// State of the list.
#[derive(Default)]
pub struct KeyEditor {
    search: String,
    /// The next key press goes here.
    waiting: Option<Place>,
    /// The question whether to take a key from another command.
    taken: Option<Taken>,
}

impl KeyEditor {
    /// Takes the key press that it waits for. Call before anything else sees the keys.
    pub fn take_key(&mut self, ctx: &Context, state: &mut EditorState) {
        let Some(place) = self.waiting else { return };
        let mut found = None;
        ctx.input_mut(|i| {
            i.events.retain(|event| {
                if let Event::Key { key, pressed: true, repeat: false, modifiers, .. } = event {
                    found = found.or(Some((*modifiers, *key)));
                }
                !matches!(event, Event::Key { .. } | Event::Text(_))
            });
        });
        let Some((modifiers, key)) = found else { return };
        self.waiting = None;
        if key == Key::Escape && modifiers.is_none() {
            return;
        }
        let shortcut = pressed(modifiers, key);
        match owner(state, &shortcut).filter(|owner| *owner != place.command) {
            Some(by) => self.taken = Some(Taken { place, shortcut, by }),
            None => assign(state, place, Some(shortcut)),
        }
    }

    /// Shows the list.
    pub fn show(&mut self, state: &mut EditorState, ui: &mut Ui) -> Option<KeyRequest> {
        let request = self.header(state, ui);
        ui.add_space(6.0);
        self.question(state, ui);
        let found = self.found(state);
        ui.spacing_mut().item_spacing.y = 2.0;
        if found.is_empty() {
            ui.label(RichText::new("No command has this name or key.").color(theme::WEAK));
        }
        ScrollArea::vertical().auto_shrink(false).show_rows(ui, ROW, found.len(), |ui, rows| {
            for index in rows {
                ui.push_id(&found[index].info().label, |ui| self.row(state, ui, found[index]));
            }
        });
        request
    }

    /// Keymap, search, and buttons for all keys.
    fn header(&mut self, state: &mut EditorState, ui: &mut Ui) -> Option<KeyRequest> {
        let mut request = None;
        widgets::row(ui, "Keymap", "Where the keys begin", |ui| {
            let chosen =
                widgets::choice(ui, "Keymap", Some(state.keymap()), &Keymap::ALL, Keymap::label, Keymap::help).1;
            if let Some(keymap) = chosen {
                state.use_keymap(keymap);
            }
        });
        ui.horizontal(|ui| {
            if ui.button("Export…").on_hover_text("Writes the changed keys to a file").clicked() {
                request = Some(KeyRequest::Export);
            }
            if ui.button("Import…").on_hover_text("Reads changed keys from a file").clicked() {
                request = Some(KeyRequest::Import);
            }
            let keymap = state.keymap();
            let is_changed = state.preferences.values().keys.get(keymap.label()).is_some_and(|keys| !keys.is_empty());
            let reset = ui.add_enabled(is_changed, Button::new("Reset all keys"));
            if reset.on_hover_text(format!("Brings back the keys of {}", keymap.label())).clicked() {
                state.preferences.change(|values| {
                    values.keys.remove(keymap.label());
                });
            }
        });
        ui.add_space(4.0);
        widgets::search(ui, &mut self.search, ("Search by name or key…", "Search keys"), false);
        request
    }

    /// Asks whether to take a key from another command.
    fn question(&mut self, state: &mut EditorState, ui: &mut Ui) {
        let Some(Taken { place, shortcut, by }) = &self.taken else { return };
        let key = shown(ui.ctx(), shortcut);
        let text = format!("{key} belongs to {}.", by.info().label);
        let mut answer = None;
        ui.horizontal_wrapped(|ui| {
            ui.label(RichText::new(text).color(theme::WARNING));
            if ui.button(format!("Give it to {}", place.command.info().label)).clicked() {
                answer = Some(true);
            }
            if ui.button("Leave it").clicked() {
                answer = Some(false);
            }
        });
        ui.add_space(4.0);
        if answer == Some(true) {
            let index = keys(state, *by).iter().position(|other| other == shortcut);
            if let Some(index) = index {
                assign(state, Place { command: *by, index }, None);
            }
            assign(state, *place, Some(*shortcut));
        }
        if answer.is_some() {
            self.taken = None;
        }
    }

    /// The commands whose name or key has all of the typed words.
    fn found(&self, state: &EditorState) -> Vec<Command> {
        let wanted = self.search.to_lowercase();
        let fits = |command: &Command| {
            let keys = keys(state, *command).iter().map(written).collect::<Vec<_>>().join(" ");
            let text = format!("{} {keys}", command.info().label).to_lowercase();
            wanted.split_whitespace().all(|word| text.contains(word))
        };
        Command::all().filter(fits).collect()
    }

    fn row(&mut self, state: &mut EditorState, ui: &mut Ui, command: Command) {
        let label = &command.info().label;
        ui.horizontal(|ui| {
            ui.set_height(ROW - 2.0);
            let width = (NAMES * ui.available_width()).round();
            ui.allocate_ui_with_layout(
                vec2(width, ROW - 2.0),
                egui::Layout::left_to_right(egui::Align::Center),
                |ui| {
                    ui.set_min_width(width);
                    ui.add(egui::Label::new(RichText::new(label).color(theme::TEXT)).truncate())
                        .on_hover_text(&command.info().help);
                },
            );
            let keys = keys(state, command);
            for index in 0..=keys.len() {
                self.key(state, ui, Place { command, index }, keys.get(index));
            }
            if state.key_bindings().is_changed(label) {
                let name = format!("Reset the keys of {label}");
                if widgets::icon_button(ui, ICON_UNDO, &name, theme::WEAK).clicked() {
                    let keymap = state.keymap().label();
                    state.preferences.change(|values| {
                        values.keys.entry(keymap.to_owned()).or_default().remove(label);
                    });
                }
            }
        });
    }

    /// A key of a command, or the button for one more.
    fn key(&mut self, state: &mut EditorState, ui: &mut Ui, place: Place, key: Option<&KeyboardShortcut>) {
        let label = &place.command.info().label;
        if self.waiting == Some(place) {
            let text = RichText::new("Press a key…").color(theme::ON_ACCENT);
            if ui.add(Button::new(text).fill(*theme::ACCENT)).on_hover_text("Escape leaves it as it was").clicked() {
                self.waiting = None;
            }
            return;
        }
        let Some(key) = key else {
            if widgets::icon_button(ui, ICON_ADD, &format!("Add a key to {label}"), theme::WEAK).clicked() {
                (self.waiting, self.taken) = (Some(place), None);
            }
            return;
        };
        let text = shown(ui.ctx(), key);
        let response = ui.add(Button::new(RichText::new(&text)));
        ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(format!("{label}: {text}")));
        if response.on_hover_text("Click, then press another key").clicked() {
            (self.waiting, self.taken) = (Some(place), None);
        }
        ui.spacing_mut().item_spacing.x = 2.0;
        let name = format!("Remove {text} from {label}");
        if widgets::icon_button(ui, ICON_CLOSE, &name, theme::FAINT).clicked() {
            assign(state, place, None);
        }
        ui.spacing_mut().item_spacing.x = 6.0;
    }
}

/// The keys of a command now.
fn keys(state: &EditorState, command: Command) -> Vec<KeyboardShortcut> {
    command.info().keys_in(&state.key_bindings()).to_vec()
}

/// The command that has a key.
fn owner(state: &EditorState, shortcut: &KeyboardShortcut) -> Option<Command> {
    let bindings = state.key_bindings();
    Command::all().find(|command| command.info().keys_in(&bindings).contains(shortcut))
}

/// Puts a key in place of another one, or removes it.
fn assign(state: &mut EditorState, place: Place, shortcut: Option<KeyboardShortcut>) {
    let mut keys = keys(state, place.command);
    if place.index < keys.len() {
        keys.remove(place.index);
    }
    if let Some(shortcut) = shortcut.filter(|shortcut| !keys.contains(shortcut)) {
        keys.insert(place.index.min(keys.len()), shortcut);
    }
    let (keymap, info) = (state.keymap(), place.command.info());
    let is_usual = keys == info.keys(keymap);
    state.preferences.change(|values| {
        let changed = values.keys.entry(keymap.label().to_owned()).or_default();
        if is_usual {
            changed.remove(&info.label);
        } else {
            changed.insert(info.label.clone(), keys.iter().map(written).collect());
        }
    });
}
