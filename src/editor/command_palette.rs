//! The command palette: finds every command by name.

use egui::{Align2, Button, Color32, Context, Frame, Id, Key, Modal, Modifiers, RichText, ScrollArea, vec2};

use super::commands::command::Command;
use super::commands::entries::ICON_ROOM;
use super::keymap::{KeyBindings, shown};
use super::state::EditorState;
use super::{theme, widgets};

/// State of the palette while it is open.
#[derive(Default)]
pub struct CommandPalette {
    open: bool,
    text: String,
    chosen: usize,
    focus: bool,
}

impl CommandPalette {
    /// Opens the empty palette.
    pub fn open(&mut self) {
        *self = Self { open: true, focus: true, ..Self::default() };
    }

    /// Whether the palette is open.
    pub fn is_open(&self) -> bool {
        self.open
    }
}

impl CommandPalette {
    /// Shows the palette if it is open; returns the chosen command.
    pub fn show(&mut self, state: &EditorState, ctx: &Context) -> Option<Command> {
        if !self.open {
            return None;
        }
        let found = matches(&self.text);
        let (up, down, enter, escape) = ctx.input_mut(|i| {
            let mut key = |key| i.consume_key(Modifiers::NONE, key);
            (key(Key::ArrowUp), key(Key::ArrowDown), key(Key::Enter), key(Key::Escape))
        });
        let last = found.len().saturating_sub(1);
        self.chosen = (self.chosen + usize::from(down)).min(last).saturating_sub(usize::from(up));
        let mut run = found.get(self.chosen).copied().filter(|_| enter);
        let moved = up || down;
        // A click outside closes the palette and reaches nothing else.
        let id = Id::unique("palette");
        let top = (ctx.content_rect().height() * 0.15).min(120.0);
        let response = Modal::new(id)
            .area(Modal::default_area(id).anchor(Align2::CENTER_TOP, vec2(0.0, top)))
            .backdrop_color(Color32::TRANSPARENT)
            .frame(Frame::popup(&ctx.global_style()).inner_margin(10.0))
            .show(ctx, |ui| {
                ui.set_width(420.0);
                if let Some(command) = self.list(state, ui, &found, moved) {
                    run = Some(command);
                }
            });
        let outside = response.backdrop_response.clicked() && !self.focus;
        self.focus = false;
        if escape || outside || enter || run.is_some() {
            self.open = false;
            // The palette consumes the key before the widget that had the focus.
            ctx.memory_mut(|m| m.stop_text_input());
        }
        run
    }

    fn list(&mut self, state: &EditorState, ui: &mut egui::Ui, found: &[Command], moved: bool) -> Option<Command> {
        if widgets::search(ui, &mut self.text, ("Find a command…", "Find command"), self.focus).changed() {
            self.chosen = 0;
        }
        ui.add_space(4.0);
        let mut run = None;
        let room = (ui.ctx().content_rect().bottom() - ui.cursor().top() - 24.0).clamp(80.0, 320.0);
        ScrollArea::vertical().max_height(room).auto_shrink([false, true]).show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = 1.0;
            if found.is_empty() {
                ui.label(RichText::new("No command has this name.").color(theme::WEAK));
            }
            for (index, command) in found.iter().enumerate() {
                let (info, is_enabled) = (command.info(), command.is_enabled(state));
                let keys =
                    info.keys_in(&KeyBindings::of(ui.ctx())).first().map_or_else(String::new, |k| shown(ui.ctx(), k));
                let button = Button::selectable(index == self.chosen, (RichText::new(ICON_ROOM), info.label.as_str()))
                    .min_size(vec2(ui.available_width(), 26.0))
                    .shortcut_text(RichText::new(keys).color(theme::WEAK));
                let response = ui.add_enabled(is_enabled, button);
                info.paint_icon(ui, response.rect, is_enabled, None);
                ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(format!("Run {}", info.label)));
                if index == self.chosen && moved {
                    response.scroll_to_me(None);
                }
                if response.on_hover_text(&info.help).clicked() {
                    run = Some(*command);
                }
            }
        });
        run
    }
}

/// The commands whose label contains every typed word; those that start with the text come first. If there are none, those
/// whose help contains them.
fn matches(text: &str) -> Vec<Command> {
    let wanted = text.to_lowercase();
    let words: Vec<&str> = wanted.split_whitespace().collect();
    let label = |command: &Command| command.info().label.to_lowercase();
    let help = |command: &Command| format!("{} {}", command.info().label, command.info().help).to_lowercase();
    let of = |text: &dyn Fn(&Command) -> String| -> Vec<Command> {
        Command::all().filter(|command| words.iter().all(|word| text(command).contains(word))).collect()
    };
    let mut found = of(&label);
    if found.is_empty() {
        found = of(&help);
    }
    found.sort_by_key(|command| !label(command).starts_with(wanted.trim()));
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_may_come_in_any_order_and_a_beginning_comes_first() {
        let names = |text| matches(text).into_iter().map(|command| command.info().label.clone()).collect::<Vec<_>>();
        assert_eq!(names("view top"), ["Top view"]);
        assert_eq!(names("s").first().map(String::as_str), Some("Save"));
        assert_eq!(names("").len(), Command::all().count());
        assert!(names("xyzzy").is_empty());
        // By what it does, if no name says so.
        assert!(names("split").contains(&"Two views".to_owned()), "{:?}", names("split"));
    }
}
