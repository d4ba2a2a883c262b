//! Commands as entries of menus.

use egui::{Button, Response, RichText, Ui};

use super::command::Command;
use super::info::Menu;
use crate::state::EditorState;
use crate::theme;

/// Room for an icon in front of a label.
pub const ICON_ROOM: &str = "      ";

/// Where the help of the hovered menu entry waits for the status bar.
pub fn hovered_help() -> egui::Id {
    egui::Id::unique("help of the hovered command")
}

/// The entries of one menu; returns the command chosen.
pub fn menu_entries(ui: &mut Ui, state: &EditorState, menu: Menu) -> Option<Command> {
    let mut chosen = None;
    for (index, command) in Command::all().filter(|command| command.info().menu == menu).enumerate() {
        if command.info().starts_group && index > 0 {
            ui.separator();
        }
        if entry(ui, command, command.is_enabled(state), command.is_on(state)).clicked() {
            chosen = Some(command);
        }
    }
    chosen
}

/// The entries of the context menu of the selection; returns the command chosen.
pub fn context_entries(ui: &mut Ui) -> Option<Command> {
    use Command::{
        Delete, Duplicate, FrameSelected, Group, MoveDown, MoveUp, Rename, ToggleLock, ToggleNegative, ToggleVisible,
        Ungroup,
    };
    const GROUPS: [&[Command]; 4] = [
        &[Rename, Duplicate, Delete],
        &[Group, Ungroup, ToggleNegative],
        &[MoveUp, MoveDown],
        &[ToggleVisible, ToggleLock, FrameSelected],
    ];
    let mut chosen = None;
    for (index, commands) in GROUPS.iter().enumerate() {
        if index > 0 {
            ui.separator();
        }
        for command in *commands {
            if entry(ui, *command, true, None).clicked() {
                chosen = Some(*command);
            }
        }
    }
    chosen
}

/// An entry of a menu; one that switches something has a mark of whether it is on instead of its icon.
fn entry(ui: &mut Ui, command: Command, enabled: bool, on: Option<bool>) -> Response {
    let info = command.info();
    let mut button = Button::new((RichText::new(ICON_ROOM), info.label.as_str())).min_size(egui::vec2(190.0, 0.0));
    if let Some(key) = info.keys.first() {
        button = button.shortcut_text(RichText::new(ui.ctx().format_shortcut(key)).color(theme::FAINT));
    }
    let response = ui.add_enabled(enabled, button);
    ui.ctx().accesskit_node_builder(response.id, |node| {
        node.set_label(info.label.clone());
        if let Some(on) = on {
            node.set_toggled(on.into());
        }
    });
    info.paint_icon(ui, response.rect, enabled, on);
    if response.hovered() {
        // Not as a tooltip: it would hide the next entries. The status bar shows it.
        ui.ctx().data_mut(|d| d.insert_temp(hovered_help(), info.help.clone()));
    }
    response
}
