//! Runs commands by their shortcuts.

use egui::{Context, Event, Key, KeyboardShortcut, Modifiers, Popup};

use super::command::Command;
use super::info::Menu;
use crate::add_palette::AddPalette;
use crate::clipboard;
use crate::command_palette::CommandPalette;
use crate::keymap::KeyBindings;
use crate::root::Editor;

impl Editor {
    /// Runs the commands of the pressed shortcuts, except during text input or a drag or while a menu is open: there
    /// the keys have other meanings. Commands that save, open or close documents run at any time, but at the end of the
    /// frame, when the fields have taken the typed text.
    pub(crate) fn run_shortcuts(&mut self, ctx: &Context) {
        if self.dialogs.is_open() {
            return;
        }
        let keymap = &KeyBindings::of(ctx);
        let is_of_document = |command: Command| command.info().menu == Menu::File;
        if let Some(command) = ctx.input_mut(|i| take_shortcut(i, keymap, is_of_document)) {
            ctx.memory_mut(|memory| memory.stop_text_input());
            Popup::close_all(ctx);
            self.command_palette = CommandPalette::default();
            self.add_palette = AddPalette::default();
            self.pending = Some(command);
            return;
        }
        if self.state.view.transforming.is_some() {
            // Until its end, keys and texts belong to the transform.
            let belongs = |event: &Event| matches!(event, Event::Key { .. } | Event::Text(_));
            self.state.view.modal_events = ctx.input(|i| i.events.iter().filter(|e| belongs(e)).cloned().collect());
            ctx.input_mut(|i| i.events.retain(|event| !belongs(event)));
            return;
        }
        let dragging = ctx.input(|i| i.pointer.any_down());
        // Not `Context::any_popup_open`: it knows only the popups shown so far in this pass.
        if self.has_dialog() || self.typing || ctx.text_edit_focused() || dragging || Popup::is_any_open(ctx) {
            return;
        }
        // Escape first cancels the current action.
        let jobs = self.state.derived.jobs();
        if jobs.escapable().is_some() && ctx.input_mut(|i| i.consume_key(Modifiers::NONE, Key::Escape)) {
            jobs.cancel_foremost();
        }
        if ctx.input(|i| i.key_pressed(Key::Escape)) && self.close_foremost(ctx) {
            ctx.input_mut(|i| i.consume_key(Modifiers::NONE, Key::Escape));
        }
        clipboard::take_events(&mut self.state, ctx);
        while let Some(command) = ctx.input_mut(|i| take_shortcut(i, keymap, |_| true)) {
            self.run(command, ctx);
        }
    }
}

/// Consumes the first key press that belongs to one of these commands.
fn take_shortcut(
    input: &mut egui::InputState,
    keymap: &KeyBindings,
    is_wanted: impl Fn(Command) -> bool,
) -> Option<Command> {
    let mut found = None;
    input.events.retain(|event| {
        let egui::Event::Key { key, pressed: true, repeat: false, modifiers, .. } = event else { return true };
        if found.is_some() {
            return true;
        }
        // Compare modifiers exactly: Ctrl Z is not Shift Ctrl Z.
        let fits = |k: &KeyboardShortcut| k.logical_key == *key && modifiers.matches_exact(k.modifiers);
        found = Command::all().find(|command| is_wanted(*command) && command.info().keys_in(keymap).iter().any(fits));
        found.is_none()
    });
    found
}
