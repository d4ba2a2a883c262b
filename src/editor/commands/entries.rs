//! Menu entries of commands.

use egui::{Button, Response, RichText, Ui};

use super::command::Command;
use super::info::Menu;
use crate::keymap::{KeyBindings, shown};
use crate::state::EditorState;
use crate::theme;

/// Room for an icon in front of a label.
pub const ICON_ROOM: &str = "      ";

/// Key of the help text of the hovered menu entry, for the status bar.
pub fn hovered_help() -> egui::Id {
    egui::Id::unique("help of the hovered command")
}

/// Shows the entries of one menu; returns the chosen command.
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

/// Shows the shadings, with the views for debugging and the samples in submenus; returns the chosen command.
pub fn shading_entries(ui: &mut Ui, state: &EditorState) -> Option<Command> {
    let chosen = menu_entries(ui, state, Menu::Shading);
    ui.separator();
    let debug = ui.menu_button("Debug", |ui| {
        ui.set_min_width(190.0);
        menu_entries(ui, state, Menu::Debug)
    });
    let samples = ui.menu_button("Samples", |ui| menu_entries(ui, state, Menu::Samples));
    debug.inner.flatten().or(samples.inner.flatten()).or(chosen)
}

/// Shows the context menu of the selection; returns the chosen command.
pub fn context_entries(ui: &mut Ui) -> Option<Command> {
    use Command::{
        Delete, Duplicate, FrameSelected, Group, InstanceSelection, MoveDown, MoveUp, Rename, ToggleIntersect,
        ToggleLock, ToggleSubtract, ToggleVisible, Ungroup,
    };
    const GROUPS: [&[Command]; 4] = [
        &[Rename, Duplicate, Delete],
        &[Group, Ungroup, InstanceSelection, ToggleSubtract, ToggleIntersect],
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

/// Shows the context menu of the viewport; returns the chosen command.
pub fn viewport_entries(ui: &mut Ui, state: &EditorState) -> Option<Command> {
    use Command::{
        AddAtPointer, Delete, DropOnSurface, Duplicate, FrameAll, FrameSelected, Group, Isolate, SelectAll,
        SelectParents, SelectSimilar, ShowAll, ToggleIntersect, ToggleLock, ToggleSubtract, ToggleVisible,
    };
    const GROUPS: [&[Command]; 5] = [
        &[AddAtPointer],
        &[Duplicate, Delete, Group, ToggleSubtract, ToggleIntersect],
        &[DropOnSurface, SelectParents, SelectSimilar],
        &[Isolate, ToggleVisible, ToggleLock, FrameSelected],
        &[SelectAll, ShowAll, FrameAll],
    ];
    let mut chosen = None;
    let enabled = GROUPS.map(|commands| commands.iter().copied().filter(|command| command.is_enabled(state)));
    for (index, commands) in enabled.into_iter().enumerate() {
        for (place, command) in commands.enumerate() {
            if index > 0 && place == 0 {
                ui.separator();
            }
            if entry(ui, command, true, None).clicked() {
                chosen = Some(command);
            }
        }
    }
    chosen
}

/// A menu entry. A switch shows its state in place of the icon.
fn entry(ui: &mut Ui, command: Command, enabled: bool, on: Option<bool>) -> Response {
    let info = command.info();
    let mut button = Button::new((RichText::new(ICON_ROOM), info.label.as_str())).min_size(egui::vec2(190.0, 0.0));
    if let Some(key) = info.keys_in(&KeyBindings::of(ui.ctx())).first() {
        button = button.shortcut_text(RichText::new(shown(ui.ctx(), key)).color(theme::WEAK));
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
        // The status bar shows the help text: a tooltip would hide the next entries.
        ui.ctx().data_mut(|d| d.insert_temp(hovered_help(), info.help.clone()));
    }
    response
}
