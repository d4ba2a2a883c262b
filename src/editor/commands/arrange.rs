//! Commands on the clipboard, and those that align, distribute and move origins.

use egui::{Key, Modifiers};
use egui_material_icons::MaterialIcon;
use egui_material_icons::icons::{ICON_CONTENT_COPY, ICON_CONTENT_CUT, ICON_CONTENT_PASTE, ICON_FILTER_CENTER_FOCUS};

use super::command::Command;
use super::info::{CommandInfo, Icon, Menu};
use crate::arrangement::{AXIS_NAMES, BoundsEdge, CopiedPart, OriginPlace};
use crate::clipboard::can_paste;
use crate::state::EditorState;
use isolith_scene::NodeKind;

const CTRL: Modifiers = Modifiers::COMMAND;

fn any(state: &EditorState) -> bool {
    !state.session.document.selection().is_empty()
}

fn row(command: Command, icon: MaterialIcon, label: &str, help: &str) -> CommandInfo {
    CommandInfo::new(Menu::Edit, command, Icon::from(icon), label, help)
}

pub(super) fn clipboard() -> Vec<CommandInfo> {
    let paste = "Adds what was copied beside the active node, also from another scene or window";
    let copy = "Copies the selection, for this scene, another scene or window, or a text editor";
    let mut all = vec![
        row(Command::Cut, ICON_CONTENT_CUT, "Cut", "Copies the selection and deletes it")
            .key(CTRL, Key::X)
            .when(any)
            .group(),
        row(Command::Copy, ICON_CONTENT_COPY, "Copy", copy).key(CTRL, Key::C).when(any),
        row(Command::Paste, ICON_CONTENT_PASTE, "Paste", paste).key(CTRL, Key::V),
    ];
    all.extend(CopiedPart::ALL.map(|part| {
        CommandInfo::new(Menu::PastePart, Command::PastePart(part), None, part.label(), part.help()).when(match part {
            CopiedPart::Transform => |state| can_paste(state, CopiedPart::Transform),
            CopiedPart::Material => |state| can_paste(state, CopiedPart::Material),
            CopiedPart::Modifiers => |state| can_paste(state, CopiedPart::Modifiers),
            CopiedPart::Dynamics => |state| can_paste(state, CopiedPart::Dynamics),
        })
    }));
    all
}

pub(super) fn commands() -> Vec<CommandInfo> {
    let mut all = Vec::new();
    for axis in 0..3 {
        for edge in BoundsEdge::ALL {
            let label = format!("Align {} {}", edge.label(axis), AXIS_NAMES[axis]);
            let help = format!("Moves the selection so that its {} agrees with the active node", edge.label(axis));
            let info = CommandInfo::new(Menu::Arrange, Command::Align(axis, edge), None, label, help)
                .when(|state| state.session.document.selection().len() > 1);
            all.push(if edge == BoundsEdge::Least && axis > 0 { info.group() } else { info });
        }
    }
    for axis in 0..3 {
        let label = format!("Distribute along {}", AXIS_NAMES[axis]);
        let help = "Equal gaps between the selected nodes; the outermost stay";
        let info = CommandInfo::new(Menu::Arrange, Command::Distribute(axis), None, label, help)
            .when(|state| state.session.document.selection().len() > 2);
        all.push(if axis == 0 { info.group() } else { info });
    }
    let has_group =
        |state: &EditorState| state.session.selected().iter().any(|node| matches!(node.kind, NodeKind::Group(_)));
    let center = "Moves the origin of the selected groups to the middle of what they hold";
    let bottom = "Moves the origin of the selected groups to the middle of the lower side of what they hold";
    let icon = ICON_FILTER_CENTER_FOCUS;
    let origin =
        |place, label, help| row(Command::MoveOrigin(place), icon, label, help).when(has_group).within(Menu::Arrange);
    all.push(origin(OriginPlace::Center, "Origin to the middle", center).group());
    all.push(origin(OriginPlace::Bottom, "Origin to the bottom", bottom));
    all
}
