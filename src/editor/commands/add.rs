//! Commands that add nodes.

use egui_material_icons::MaterialIcon;
use egui_material_icons::icons::{
    ICON_ADD, ICON_FLASHLIGHT_ON, ICON_FLUORESCENT, ICON_FOLDER, ICON_GRID_ON, ICON_LIGHTBULB, ICON_VIDEOCAM,
    ICON_VIEW_IN_AR, ICON_WB_SUNNY,
};

use super::command::Command;
use super::info::{CommandInfo, Icon, Menu};
use isolith_scene::ShapeKind;

fn row(command: Command, icon: MaterialIcon, label: &str, help: &str) -> CommandInfo {
    CommandInfo::new(Menu::Add, command, Icon::from(icon), label, help)
}

pub(super) fn commands() -> Vec<CommandInfo> {
    let shape = |kind: ShapeKind| {
        CommandInfo::new(Menu::Add, Command::AddShape(kind), Icon::Shape(kind), kind.label(), kind.help())
    };
    let help = "Everything that can be added, by category or name; it goes where the pointer is";
    let palette =
        row(Command::AddAtPointer, ICON_ADD, "Add at the pointer…", help).key(egui::Modifiers::SHIFT, egui::Key::A);
    let mut all = vec![palette];
    all.extend(ShapeKind::ALL.iter().map(|kind| shape(*kind)));
    all.extend([
        row(Command::AddGroup, ICON_FOLDER, "Empty group", "A group without children; drag nodes into it").group(),
        row(Command::AddInstancer, ICON_GRID_ON, "Instancer", "Places copies of what is dragged into it"),
        row(Command::AddMesh, ICON_VIEW_IN_AR, "Mesh…", "Triangles from a .gltf or .glb file"),
        row(Command::AddSun, ICON_WB_SUNNY, "Sun", "Parallel light").group(),
        row(Command::AddPointLight, ICON_LIGHTBULB, "Point light", "Light from a point into every direction"),
        row(Command::AddSpotLight, ICON_FLASHLIGHT_ON, "Spot light", "Light from a point into a cone"),
        row(Command::AddAreaLight, ICON_FLUORESCENT, "Area light", "Light from one side of a rectangle"),
        row(Command::AddCamera, ICON_VIDEOCAM, "Camera from view", "A camera that sees what the viewport shows now")
            .group(),
    ]);
    all
}
