//! Commands that transform the selection, and the choice of tools, axes and keys; the preferences.

use egui::{Key, Modifiers};
use egui_material_icons::icons::ICON_SETTINGS;

use super::command::Command;
use super::info::{CommandInfo, Icon, Menu};
use crate::icons::{orientation_icon, pivot_icon, tool_icon};
use crate::keymap::Keymap;
use crate::numbers::number_text;
use crate::snapping::{ANGLES, LENGTHS};
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
    let keys = [Key::Q, Key::W, Key::E, Key::R, Key::P];
    all.extend(Tool::ALL.into_iter().zip(keys).map(|(tool, key)| {
        let info = CommandInfo::new(
            Menu::Tool,
            Command::UseTool(tool),
            Icon::from(tool_icon(tool)),
            tool.label(),
            tool.help(),
        )
        .switch(|state, command| command == Command::UseTool(state.view.tool))
        .key(NONE, key);
        let info = if tool == Tool::Draw { info } else { info.only_in(Keymap::Industry) };
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
    all.extend(snapping());
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

/// Whether drags snap, and to which steps.
fn snapping() -> Vec<CommandInfo> {
    let always = "Drags snap without Ctrl; Ctrl then lets them run free";
    let lengths = "Moves, sizes and what is drawn snap to multiples of it";
    let angles = "Rotations and angles snap to multiples of it";
    let snap = |command, label, help| CommandInfo::new(Menu::Snap, command, None, label, help);
    let mut all = vec![
        CommandInfo::new(Menu::Snap, Command::ToggleSnap, None, "Snap always", always).key(Modifiers::SHIFT, Key::S),
        snap(Command::SnapLengths(None), "Snap lengths: by the view".to_owned(), "A step that suits the distance")
            .group(),
    ];
    all.extend(LENGTHS.iter().enumerate().map(|(index, step)| {
        snap(Command::SnapLengths(Some(index)), format!("Snap lengths: {} m", number_text(*step)), lengths)
    }));
    all.extend(ANGLES.iter().enumerate().map(|(index, step)| {
        let info = snap(Command::SnapAngles(index), format!("Snap angles: {}°", number_text(*step)), angles);
        if index == 0 { info.group() } else { info }
    }));
    let is_on = |state: &EditorState, command: Command| match command {
        Command::SnapLengths(index) => state.view.snap.length == index.map(|index| LENGTHS[index]),
        Command::SnapAngles(index) => state.view.snap.angle == ANGLES[index],
        _ => state.view.snap.is_on,
    };
    all.into_iter().map(|info| info.switch(is_on)).collect()
}
