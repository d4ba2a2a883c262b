//! Commands on documents.

use std::path::Path;

use egui::{Context, Key, Modifiers};
use egui_material_icons::MaterialIcon;
use egui_material_icons::icons::{
    ICON_FOLDER_OPEN, ICON_HISTORY, ICON_LOGOUT, ICON_NOTE_ADD, ICON_REFRESH, ICON_SAVE, ICON_SAVE_AS,
};

use super::{Command, Icon, Menu};
use crate::editor::Editor;
use crate::editor::dialogs::Intent;

fn new(icon: MaterialIcon, name: &str, help: &str, run: fn(&mut Editor, &Context)) -> Command {
    Command::new(Menu::File, Icon::from(icon), name, help, run)
}

pub(super) fn commands() -> Vec<Command> {
    const CTRL: Modifiers = Modifiers::COMMAND;
    const SHIFT_CTRL: Modifiers = Modifiers::COMMAND.plus(Modifiers::SHIFT);
    vec![
        new(ICON_NOTE_ADD, "New", "An empty scene with a light", |e, ctx| e.intend(Intent::New, ctx)).key(CTRL, Key::N),
        new(ICON_FOLDER_OPEN, "Open…", "Opens a scene file", |e, ctx| e.intend(Intent::Choose, ctx)).key(CTRL, Key::O),
        new(ICON_SAVE, "Save", "Writes the scene to its file", |e, ctx| e.save(None, ctx)).key(CTRL, Key::S).group(),
        new(ICON_SAVE_AS, "Save as…", "Writes the scene to another file", |e, ctx| e.choose_save_path(None, ctx))
            .key(SHIFT_CTRL, Key::S),
        new(ICON_REFRESH, "Reload", "Reads the scene's file again", |e, ctx| {
            if let Some(path) = e.document().path().map(Path::to_path_buf) {
                e.intend(Intent::Open(path), ctx);
            }
        })
        .when(|e| e.document().path().is_some()),
        new(ICON_REFRESH, "Reload models", "Reads the models of the scene again from disk", |e, _| e.reload_models())
            .when(|e| !e.flat().meshes.is_empty()),
        new(ICON_HISTORY, "Recover unsaved work…", "Lists what was not saved when Isolith ended", |e, _| {
            e.offer_lost_work();
        })
        .when(Editor::has_safekeeping),
        new(ICON_LOGOUT, "Quit", "Closes the window", |e, ctx| e.intend(Intent::Quit, ctx)).key(CTRL, Key::Q).group(),
    ]
}
