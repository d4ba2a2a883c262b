//! Commands that transform the selection, and the choice of tools, axes and keys; the preferences.

use egui::{Key, Modifiers};
use egui_material_icons::icons::ICON_SETTINGS;

use super::command::Command;
use super::info::{CommandInfo, Icon, Menu};
use crate::icons::{orientation_icon, pivot_icon, tool_icon};
use crate::keymap::Keymap;
use crate::state::EditorState;
use crate::transforms::kinds::{Orientation, PivotPoint, Tool, TransformKind};

const NONE: Modifiers = Modifiers::NONE;

fn any(state: &EditorState) -> bool {
    !state.session.document.selection().is_empty()
}

fn transform(kind: TransformKind, key: Key, help: &str) -> CommandInfo {
    let icon = Icon::from(tool_icon(Tool::Transform(kind)));
    CommandInfo::new(Menu::Tool, Command::Transform(kind), icon, kind.label(), help)
        .when(any)
        .key(NONE, key)
        .only_in(Keymap::Blender)
}

pub(super) fn commands() -> Vec<CommandInfo> {
    let mut all = vec![
        transform(TransformKind::Move, Key::G, "Follows the pointer; then X, Y, Z or a number; Enter ends it"),
        transform(TransformKind::Rotate, Key::R, "Around the pivot; then X, Y, Z or degrees; Enter ends it"),
        transform(TransformKind::Scale, Key::S, "From the pivot; then X, Y, Z or a factor; Enter ends it"),
    ];
    let keys = [Key::Q, Key::W, Key::E, Key::R];
    all.extend(Tool::ALL.into_iter().zip(keys).map(|(tool, key)| {
        let info = CommandInfo::new(
            Menu::Tool,
            Command::UseTool(tool),
            Icon::from(tool_icon(tool)),
            tool.label(),
            tool.help(),
        )
        .switch(|state, command| command == Command::UseTool(state.view.tool))
        .key(NONE, key)
        .only_in(Keymap::Industry);
        if tool == Tool::Select { info.group() } else { info }
    }));
    all.extend(Orientation::ALL.into_iter().map(|orientation| {
        let label = format!("Orientation: {}", orientation.label());
        let icon = Icon::from(orientation_icon(orientation));
        CommandInfo::new(Menu::Orientation, Command::UseOrientation(orientation), icon, label, orientation.help())
            .switch(|state, command| command == Command::UseOrientation(state.view.orientation))
    }));
    all.extend(PivotPoint::ALL.into_iter().map(|pivot| {
        let label = format!("Pivot: {}", pivot.label().to_lowercase());
        let icon = Icon::from(pivot_icon(pivot));
        CommandInfo::new(Menu::Pivot, Command::UsePivot(pivot), icon, label, pivot.help())
            .switch(|state, command| command == Command::UsePivot(state.view.pivot))
    }));
    all.extend(Keymap::ALL.into_iter().map(|keymap| {
        let label = format!("Keymap: {}", keymap.label());
        CommandInfo::new(Menu::Keymap, Command::UseKeymap(keymap), None, label, keymap.help())
            .switch(|state, command| command == Command::UseKeymap(state.keymap()))
    }));
    let preferences = "Theme, scale, units and keys, kept for the next start";
    all.push(
        CommandInfo::new(Menu::Edit, Command::Preferences, Icon::from(ICON_SETTINGS), "Preferences…", preferences)
            .key(Modifiers::COMMAND, Key::Comma)
            .group(),
    );
    all
}
