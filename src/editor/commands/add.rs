//! Commands that add nodes.

use egui::Context;
use egui_material_icons::MaterialIcon;
use egui_material_icons::icons::{
    ICON_FLASHLIGHT_ON, ICON_FOLDER, ICON_LIGHTBULB, ICON_VIDEOCAM, ICON_VIEW_IN_AR, ICON_WB_SUNNY,
};
use glam::DQuat;

use super::{Command, Icon, Menu};
use crate::editor::{Editor, insertion};
use crate::scene::{Attenuation, CameraNode, Group, Light, LightKind, Node, NodeKind, ShapeKind};

pub(super) fn commands() -> Vec<Command> {
    let shapes = ShapeKind::ALL.iter().map(|&kind| {
        Command::new(Menu::Add, Icon::Shape(kind), kind.label(), kind.help(), move |e, _| insertion::shape(e, kind))
    });
    let mut all: Vec<_> = shapes.collect();
    all.extend([
        new(ICON_FOLDER, "Empty group", "A group without children; drag nodes into it", |e, _| {
            insertion::node(e, Node::new("Group", NodeKind::Group(Group::UNION)));
        })
        .group(),
        new(ICON_VIEW_IN_AR, "Mesh…", "Triangles from a .gltf or .glb file", |e, ctx| e.choose_mesh(ctx)),
        new(ICON_WB_SUNNY, "Sun", "Parallel light", |e, _| add_sun(e)).group(),
        new(ICON_LIGHTBULB, "Point light", "Light from a point into every direction", |e, _| {
            add_lamp(e, "Point light", LightKind::Point { attenuation: Attenuation::default() });
        }),
        new(ICON_FLASHLIGHT_ON, "Spot light", "Light from a point into a cone", |e, _| {
            let attenuation = Attenuation::default();
            add_lamp(e, "Spot light", LightKind::Spot { attenuation, inner: 20.0, outer: 30.0 });
        }),
        new(ICON_VIDEOCAM, "Camera from view", "A camera that sees what the viewport shows now", |e, _| add_camera(e))
            .group(),
    ]);
    all
}

fn new(icon: MaterialIcon, name: &str, help: &str, run: fn(&mut Editor, &Context)) -> Command {
    Command::new(Menu::Add, Icon::from(icon), name, help, run)
}

fn add_sun(editor: &mut Editor) {
    let down = DQuat::from_euler(glam::EulerRot::YXZ, 0.6, -0.9, 0.0);
    insertion::node(editor, Node::new("Sun", NodeKind::Light(Light::sun())).rotated(down));
}

/// A lamp two meters above where the view looks, shining down.
fn add_lamp(editor: &mut Editor, name: &str, light: LightKind) {
    let down = DQuat::from_rotation_x(-std::f64::consts::FRAC_PI_2);
    let light = Light { color: [1.0; 3], intensity: 4.0, light };
    let node = Node::new(name, NodeKind::Light(light)).rotated(down);
    insertion::node_above(editor, node, 2.0);
}

fn add_camera(editor: &mut Editor) {
    let camera = editor.view().camera;
    let kind = CameraNode { fov_y: camera.fov_y.to_degrees(), near: camera.near, far: camera.far };
    let node = Node::new("Camera", NodeKind::Camera(kind)).at(camera.position).rotated(camera.rotation);
    insertion::node_in_world(editor, node);
}
