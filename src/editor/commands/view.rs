//! Commands on the view.

use egui::{Key, Modifiers};
use egui_material_icons::MaterialIcon;
use egui_material_icons::icons::{
    ICON_BOOKMARK, ICON_CENTER_FOCUS_STRONG, ICON_CONTRAST, ICON_CROP_FREE, ICON_DASHBOARD, ICON_FIT_SCREEN,
    ICON_GRID_ON, ICON_LIST, ICON_LOCK, ICON_PHOTO_CAMERA, ICON_PLAY_ARROW, ICON_SEARCH, ICON_SELECT, ICON_SPLITSCREEN,
    ICON_VIEW_IN_AR,
};

use super::command::Command;
use super::info::{CommandInfo, Icon, Menu};
use crate::navigation::Side;
use crate::pass_step::PassStep;
use isolith_field::Shading;
use isolith_field::debug_view::ViewMode;
use isolith_scene::MAX_BOOKMARKS as BOOKMARKS;

fn row(command: Command, icon: MaterialIcon, label: &str, help: &str) -> CommandInfo {
    CommandInfo::new(Menu::View, command, Icon::from(icon), label, help)
}

pub(super) fn commands() -> Vec<CommandInfo> {
    const NONE: Modifiers = Modifiers::NONE;
    let through_camera = "Takes over the view of the scene's camera, or of the next one";
    let mut all = vec![
        row(Command::FrameSelected, ICON_CENTER_FOCUS_STRONG, "Frame selected", "Shows all of the selection")
            .key(NONE, Key::F)
            .key(NONE, Key::Period)
            .when(|state| !state.session.document.selection().is_empty()),
        row(Command::FrameAll, ICON_FIT_SCREEN, "Frame all", "Shows the whole scene")
            .key(NONE, Key::Home)
            .key(NONE, Key::A),
        row(Command::LookThroughCamera, ICON_PHOTO_CAMERA, "Look through camera", through_camera)
            .key(NONE, Key::Num0)
            .when(|state| !state.flat().cameras.is_empty()),
    ];
    all.extend(cameras());
    let sides = [
        ("Front view", Side::Front, NONE, Key::Num1),
        ("Back view", Side::Back, Modifiers::COMMAND, Key::Num1),
        ("Right view", Side::Right, NONE, Key::Num3),
        ("Left view", Side::Left, Modifiers::COMMAND, Key::Num3),
        ("Top view", Side::Top, NONE, Key::Num7),
        ("Bottom view", Side::Bottom, Modifiers::COMMAND, Key::Num7),
    ];
    for (label, side, modifiers, key) in sides {
        let help = "Looks along an axis of the world, in parallel until you orbit";
        let info = CommandInfo::new(Menu::Sides, Command::LookFrom(side), None, label, help).key(modifiers, key);
        all.push(info);
    }
    let split = "Splits the view: viewports beside each other, each with a view and a shading of its own; keys mean the one under the \
         pointer";
    let views = [(1, "One view"), (2, "Two views"), (4, "Four views")];
    all.extend(views.map(|(count, label)| {
        let icon = if count == 1 { ICON_CROP_FREE } else { ICON_SPLITSCREEN };
        CommandInfo::new(Menu::Split, Command::SplitView(count), Icon::from(icon), label, split)
    }));
    all.extend(shown());
    all.extend(Shading::ALL.into_iter().map(|shading| {
        let label = format!("Shading: {}", shading.label());
        CommandInfo::new(Menu::Shading, Command::ShowShading(shading), None, label, shading.help())
            .switch(|state, command| state.view.lit_by().map(Command::ShowShading) == Some(command))
    }));
    let cycle = "Solid, Material Preview and Rendered in turn";
    all.push(
        CommandInfo::new(Menu::Shading, Command::CycleShading, Icon::from(ICON_CONTRAST), "Next shading", cycle)
            .key(NONE, Key::Z),
    );
    all.extend(ViewMode::ALL.into_iter().filter(|view_mode| *view_mode != ViewMode::Shaded).map(|view_mode| {
        let label = format!("Debug: {}", view_mode.name());
        let info = CommandInfo::new(Menu::Debug, Command::ShowView(view_mode), None, label, view_mode.help());
        let info = info.switch(|state, command| command == Command::ShowView(state.view.view_mode));
        if matches!(view_mode, ViewMode::Distance | ViewMode::Nodes) { info.group() } else { info }
    }));
    all.extend(passes());
    all.extend([1, 16, 64, 256, 1024].map(|samples| {
        let label = if samples == 1 { "1 sample".to_owned() } else { format!("{samples} samples") };
        CommandInfo::new(Menu::Samples, Command::Samples(samples), None, label, SAMPLES)
            .switch(|state, command| command == Command::Samples(state.view.samples))
    }));
    all
}

/// Steps through the passes over the parts of the scene.
fn passes() -> [CommandInfo; 3] {
    let of = |step, label, help| CommandInfo::new(Menu::Debug, Command::ShowPass(step), None, label, help);
    let next = "The picture after one more part of the scene is marched; after all of them, after the first";
    let previous = "The picture before the last part of the scene is marched; before the first, after all";
    let all = "The picture after all parts of the scene are marched";
    [
        of(PassStep::Next, "Debug: next pass", next).group(),
        of(PassStep::Previous, "Debug: previous pass", previous),
        of(PassStep::All, "Debug: all passes", all).switch(|state, _| state.view.passes.is_none()),
    ]
}

/// What the viewport shows besides the scene, playback, and the windows in front.
fn shown() -> Vec<CommandInfo> {
    const NONE: Modifiers = Modifiers::NONE;
    vec![
        row(
            Command::ToggleOrthographic,
            ICON_VIEW_IN_AR,
            "Orthographic",
            "Parallel lines stay parallel, or meet far away",
        )
        .key(NONE, Key::Num5)
        .switch(|state, _| state.view.navigation.orthographic)
        .group(),
        row(Command::ToggleGrid, ICON_GRID_ON, "Grid", "Shows or hides the grid")
            .switch(|state, _| state.view.show_grid),
        row(Command::ToggleOutline, ICON_SELECT, "Selection outline", "Shows or hides what marks the selection")
            .switch(|state, _| state.view.show_outline),
        row(Command::Play, ICON_PLAY_ARROW, "Play", "Plays the timeline, or pauses").key(NONE, Key::Space).group(),
        row(Command::FindCommand, ICON_SEARCH, "Find command…", "Every command by its name")
            .key(NONE, Key::F3)
            .key(Modifiers::COMMAND, Key::P)
            .group(),
        row(Command::ShowMessages, ICON_LIST, "Log", "All messages so far"),
        row(Command::ResetLayout, ICON_DASHBOARD, "Reset layout", "Puts all panels back into their usual places"),
    ]
}

/// The camera that one looks through, and bookmarks of views.
fn cameras() -> Vec<CommandInfo> {
    let lock = "The camera that you look through moves with the view";
    let safe = "Where action and titles are safe, in the frame of the camera that you look through";
    let mut all = vec![
        row(Command::LockCamera, ICON_LOCK, "Lock camera to view", lock)
            .switch(|state, _| state.view.locks_camera)
            .when(|state| state.view.through.is_some() || state.view.locks_camera),
        row(Command::ToggleSafeAreas, ICON_CROP_FREE, "Safe areas", safe).switch(|state, _| state.view.show_safe_areas),
    ];
    let keys = [Key::F5, Key::F6, Key::F7, Key::F8];
    let bookmark = |command, label: String, help, modifiers, key| {
        CommandInfo::new(Menu::Bookmarks, command, Icon::from(ICON_BOOKMARK), label, help).key(modifiers, key)
    };
    all.extend(keys.into_iter().take(BOOKMARKS).enumerate().map(|(index, key)| {
        let label = format!("Bookmark {}", index + 1);
        bookmark(Command::ShowBookmark(index), label, "Shows the view that was kept", Modifiers::NONE, key)
    }));
    all.extend(keys.into_iter().take(BOOKMARKS).enumerate().map(|(index, key)| {
        let label = format!("Set bookmark {}", index + 1);
        let info = bookmark(Command::SetBookmark(index), label, "Keeps the view", Modifiers::SHIFT, key);
        if index == 0 { info.group() } else { info }
    }));
    all
}

const SAMPLES: &str = "Smooth edges: samples per pixel that the viewport adds up while nothing changes";
