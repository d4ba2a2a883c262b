//! Commands that explain the program, or what is wrong with the scene.

use egui::{Key, Modifiers};
use egui_material_icons::MaterialIcon;
use egui_material_icons::icons::{
    ICON_CAMPAIGN, ICON_HELP, ICON_HOME, ICON_KEYBOARD, ICON_MONITOR_HEART, ICON_SIGNPOST,
};

use super::command::Command;
use super::info::{CommandInfo, Icon, Menu};

fn row(command: Command, icon: MaterialIcon, label: &str, help: &str) -> CommandInfo {
    CommandInfo::new(Menu::Help, command, Icon::from(icon), label, help)
}

pub(super) fn commands() -> Vec<CommandInfo> {
    let doctor = "Finds nodes that are broken or slow, and repairs them";
    vec![
        CommandInfo::new(Menu::View, Command::ExamineScene, Icon::from(ICON_MONITOR_HEART), "Field doctor…", doctor)
            .key(Modifiers::NONE, Key::F10),
        row(Command::ShowHelp, ICON_HELP, "Help…", "A page about the panel under the pointer")
            .key(Modifiers::NONE, Key::F1),
        row(Command::ShowKeys, ICON_KEYBOARD, "Keys…", "All keys of the keymap"),
        row(Command::StartTour, ICON_SIGNPOST, "Tour", "Six steps through the window").group(),
        row(Command::ShowWelcome, ICON_HOME, "Welcome…", "Templates, recent files and examples"),
        row(Command::ShowNews, ICON_CAMPAIGN, "What's new…", "The latest changes of the program").group(),
    ]
}
