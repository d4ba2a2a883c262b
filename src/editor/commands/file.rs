//! Commands on documents.

use egui::{Key, Modifiers};
use egui_material_icons::MaterialIcon;
use egui_material_icons::icons::{
    ICON_FOLDER_OPEN, ICON_HISTORY, ICON_INVENTORY_2, ICON_LOGOUT, ICON_NOTE_ADD, ICON_PHOTO_CAMERA, ICON_REFRESH,
    ICON_SAVE, ICON_SAVE_AS, ICON_UNARCHIVE,
};

use super::command::Command;
use super::info::{CommandInfo, Icon, Menu};
use isolith_session::has_unpacked;

fn row(command: Command, icon: MaterialIcon, label: &str, help: &str) -> CommandInfo {
    CommandInfo::new(Menu::File, command, Icon::from(icon), label, help)
}

pub(super) fn commands() -> Vec<CommandInfo> {
    const CTRL: Modifiers = Modifiers::COMMAND;
    const SHIFT_CTRL: Modifiers = Modifiers::COMMAND.plus(Modifiers::SHIFT);
    let pack = "Stores the files of all models in the scene, so that one file is all of it";
    let unpack = "Writes the stored files of models beside the scene, and takes them out of it";
    vec![
        row(Command::New, ICON_NOTE_ADD, "New", "An empty scene with a light").key(CTRL, Key::N),
        row(Command::Open, ICON_FOLDER_OPEN, "Open…", "Opens a scene file").key(CTRL, Key::O),
        row(Command::Save, ICON_SAVE, "Save", "Writes the scene to its file").key(CTRL, Key::S).group(),
        row(Command::SaveAs, ICON_SAVE_AS, "Save as…", "Writes the scene to another file").key(SHIFT_CTRL, Key::S),
        row(Command::Reload, ICON_REFRESH, "Reload", "Reads the scene's file again")
            .when(|state| state.session.document.path().is_some()),
        row(Command::ReloadModels, ICON_REFRESH, "Reload models", "Reads the models of the scene again from disk")
            .when(|state| !state.flat().meshes.is_empty()),
        row(Command::PackFiles, ICON_INVENTORY_2, "Pack files", pack)
            .when(|state| !state.packing.is_busy() && has_unpacked(state.session.document.resting())),
        row(Command::UnpackFiles, ICON_UNARCHIVE, "Unpack files", unpack).when(|state| {
            let document = &state.session.document;
            !state.packing.is_busy() && !document.resting().packed.is_empty() && document.path().is_some()
        }),
        row(Command::Recover, ICON_HISTORY, "Recover unsaved work…", "Lists what was not saved when Isolith ended")
            .when(|state| state.can_recover),
        row(Command::Render, ICON_PHOTO_CAMERA, "Render…", "Pictures in files: size, samples, format, frames")
            .key(Modifiers::NONE, Key::F12)
            .group(),
        row(Command::Quit, ICON_LOGOUT, "Quit", "Closes the window").key(CTRL, Key::Q).group(),
    ]
}
