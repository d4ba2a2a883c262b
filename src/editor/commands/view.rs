//! Commands on what the picture shows.

use egui::{Context, Key, Modifiers};
use egui_material_icons::MaterialIcon;
use egui_material_icons::icons::{
    ICON_CENTER_FOCUS_STRONG, ICON_FIT_SCREEN, ICON_GRID_ON, ICON_LIST, ICON_PHOTO_CAMERA, ICON_SEARCH, ICON_SELECT,
};

use super::{Command, Icon, Menu};
use crate::editor::Editor;
use crate::editor::navigation::Side;
use crate::flat::debug_view::ViewMode;

fn new(icon: MaterialIcon, name: &str, help: &str, run: fn(&mut Editor, &Context)) -> Command {
    Command::new(Menu::View, Icon::from(icon), name, help, run)
}

pub(super) fn commands() -> Vec<Command> {
    const NONE: Modifiers = Modifiers::NONE;
    let mut all = vec![
        new(ICON_CENTER_FOCUS_STRONG, "Frame selected", "Shows all of the selection", |e, _| e.frame_selected())
            .key(NONE, Key::F)
            .key(NONE, Key::Period)
            .when(|e| !e.session.document.selection().is_empty()),
        new(ICON_FIT_SCREEN, "Frame all", "Shows the whole scene", |e, _| e.frame_all())
            .key(NONE, Key::Home)
            .key(NONE, Key::A),
        new(
            ICON_PHOTO_CAMERA,
            "Look through camera",
            "Takes over the view of the scene's camera, or of the next one",
            |e, _| {
                e.look_through_camera();
            },
        )
        .key(NONE, Key::Num0)
        .when(|e| !e.flat().cameras.is_empty()),
    ];
    let sides = [
        ("Front view", Side::Front, NONE, Key::Num1),
        ("Back view", Side::Back, Modifiers::COMMAND, Key::Num1),
        ("Right view", Side::Right, NONE, Key::Num3),
        ("Left view", Side::Left, Modifiers::COMMAND, Key::Num3),
        ("Top view", Side::Top, NONE, Key::Num7),
        ("Bottom view", Side::Bottom, Modifiers::COMMAND, Key::Num7),
    ];
    for (index, (name, side, modifiers, key)) in sides.into_iter().enumerate() {
        let help = "Looks along an axis of the world";
        let command = Command::new(Menu::View, None, name, help, move |e, _| e.navigation.look_from(side));
        let command = command.key(modifiers, key);
        all.push(if index == 0 { command.group() } else { command });
    }
    all.extend([
        new(ICON_GRID_ON, "Grid", "Shows or hides the ground grid", |e, _| e.show_grid ^= true)
            .switch(|e| e.show_grid)
            .group(),
        new(ICON_SELECT, "Selection outline", "Shows or hides what marks the selection", |e, _| {
            e.show_outline ^= true;
        })
        .switch(|e| e.show_outline),
        new(ICON_SEARCH, "Find command…", "Every command by its name", |e, _| e.command_palette.open())
            .key(NONE, Key::F3)
            .key(Modifiers::COMMAND, Key::P)
            .group(),
        new(ICON_LIST, "Log", "All messages so far", |e, _| e.session.messages.show_log ^= true),
    ]);
    all.extend(ViewMode::ALL.into_iter().map(|view_mode| {
        let menu = if is_diagnostic(view_mode) { Menu::Debug } else { Menu::ViewMode };
        let command = Command::new(menu, None, view_mode_command(view_mode), view_mode.help(), move |e, _| {
            e.view_mode = view_mode
        });
        let command = command.switch(move |e| e.view_mode == view_mode);
        if matches!(view_mode, ViewMode::Slope | ViewMode::Nodes) { command.group() } else { command }
    }));
    all
}

/// Whether it shows how the renderer works rather than the scene.
fn is_diagnostic(view_mode: ViewMode) -> bool {
    view_mode.counts() || view_mode == ViewMode::Slope
}

/// The name of the command that has the picture show `view_mode`.
fn view_mode_command(view_mode: ViewMode) -> String {
    format!("Shading: {}", view_mode.name())
}
