//! Scenes to start from: what an artist would otherwise build first, each time.

use glam::DVec3;

use super::scene_builder::{SceneBuilder, blended, capsule, cuboid, ellipsoid, group, object, sphere, turn_x, v};
use isolith_scene::{BlendKernel, CameraNode, LightKind, MaterialId, Modifier, Operator, Scene, Shadowing, Shape};

/// A scene to start from.
#[derive(Clone, Debug)]
pub struct Template {
    /// Its name.
    pub name: &'static str,
    /// One sentence about it.
    pub help: &'static str,
    /// The scene.
    pub scene: Scene,
}

/// All templates besides the empty scene.
pub fn templates() -> Vec<Template> {
    vec![
        Template {
            name: "Studio",
            help: "A backdrop, three soft lights and a camera, for a single thing",
            scene: studio(),
        },
        Template { name: "Landscape", help: "Hills, water, a low sun and a wide view", scene: landscape() },
        Template { name: "Character", help: "A body of soft parts: both sides follow from one", scene: character() },
    ]
}

/// Three soft lights around the origin: key, fill, rim.
fn soft_lights(builder: &mut SceneBuilder, height: f64) {
    let target = [0.0, height, 0.0];
    let panel = |power: f64, side: f64| LightKind::Rectangle { power, width: side, height: side };
    builder.light("Key light", [[-2.6, 3.4, 3.0], target], [1.0, 0.95, 0.88], panel(150.0, 1.6));
    builder.light("Fill light", [[3.2, 1.8, 2.6], target], [0.82, 0.90, 1.0], panel(45.0, 2.4));
    builder.light("Rim light", [[1.6, 3.0, -2.2], target], [1.0, 0.97, 0.94], panel(80.0, 1.2));
}

/// A floor that bends up into a wall, so that no edge shows.
fn backdrop(builder: &mut SceneBuilder, material: MaterialId) {
    let backdrop = builder.add(None, blended("Backdrop", Operator::Union, BlendKernel::Circular, 1.2));
    builder.add(backdrop, object("Floor", cuboid(14.0, 0.2, 10.0, 0.0), material).at(v(0.0, -0.1, 0.0)));
    builder.add(backdrop, object("Wall", cuboid(14.0, 7.0, 0.2, 0.0), material).at(v(0.0, 3.4, -3.6)));
}

fn studio() -> Scene {
    let mut builder = SceneBuilder::new([0.05; 3], [0.05; 3], [0.16, 0.165, 0.18]);
    builder.shade(Shadowing::default());
    let paper = builder.matte("Paper", [0.52, 0.53, 0.55]);
    let glaze = builder.coated("Glaze", [0.62, 0.10, 0.07], 0.08);
    backdrop(&mut builder, paper);
    builder.add(None, object("Replace me", sphere(0.6), glaze).at(v(0.0, 0.6, 0.0)));
    soft_lights(&mut builder, 0.6);
    builder.view(CameraNode { fov_y: 28.0, ..CameraNode::default() }, [1.5, 1.5, 4.8], [0.0, 0.62, 0.0]);
    builder.finish()
}

fn landscape() -> Scene {
    let mut builder = SceneBuilder::new([0.20, 0.34, 0.62], [0.86, 0.66, 0.48], [0.30, 0.34, 0.42]);
    builder.shade(Shadowing::default());
    let grass = builder.matte("Grass", [0.16, 0.20, 0.07]);
    let sea = builder.water("Water", [0.02, 0.09, 0.12]);
    let hills = Shape::Terrain {
        size: [60.0, 4.0, 60.0],
        amplitude: 5.0,
        wavelength: 17.0,
        octaves: 6.0,
        roughness: 0.43,
        seed: 7.0,
    };
    builder.add(None, object("Hills", hills, grass).at(v(0.0, 0.4, -14.0)));
    let ocean = Shape::Ocean {
        size: [90.0, 3.0, 90.0],
        amplitude: 0.05,
        wavelength: 1.6,
        waves: 7.0,
        direction: 30.0,
        spread: 50.0,
        sharpness: 0.5,
        phase: 0.0,
        speed: 0.25,
    };
    builder.add(None, object("Water", ocean, sea).at(v(0.0, -0.6, -14.0)));
    builder.sun("Low sun", [-0.9, 0.34, -0.25], [1.0, 0.80, 0.58], 1.0);
    builder.camera([0.0, 3.4, 20.0], [0.0, 1.2, -6.0], 46.0);
    builder.finish()
}

fn character() -> Scene {
    let mut builder = SceneBuilder::new([0.05; 3], [0.05; 3], [0.17, 0.17, 0.18]);
    builder.shade(Shadowing::default());
    let paper = builder.matte("Paper", [0.40, 0.47, 0.52]);
    let skin = builder.glossy("Skin", [0.16, 0.46, 0.42], 0.42);
    let white = builder.glossy("White of the eyes", [0.9, 0.9, 0.88], 0.2);
    let pupil = builder.coated("Pupil", [0.02, 0.02, 0.025], 0.05);
    backdrop(&mut builder, paper);
    let figure = builder.add(None, group("Character", Operator::Union));
    let body = builder.add(figure, blended("Body", Operator::Union, BlendKernel::Circular, 0.14));
    builder.add(body, object("Torso", ellipsoid(0.34, 0.44, 0.28), skin).at(v(0.0, 0.86, 0.0)));
    builder.add(body, object("Head", sphere(0.34), skin).at(v(0.0, 1.56, 0.02)));
    let mirrored = |name: &str| {
        let both = Modifier::Mirror { axes: [true, false, false], blend: 0.0 };
        group(name, Operator::Union).modified(both)
    };
    let limbs = builder.add(body, mirrored("Limbs"));
    let arm = capsule([0.28, 1.08, 0.0], [0.62, 0.72, 0.12], 0.095);
    builder.add(limbs, object("Arm", arm, skin));
    builder.add(limbs, object("Hand", sphere(0.125), skin).at(v(0.65, 0.68, 0.14)));
    builder.add(limbs, object("Leg", capsule([0.17, 0.62, 0.0], [0.2, 0.16, 0.02], 0.12), skin));
    builder.add(limbs, object("Foot", ellipsoid(0.14, 0.09, 0.22), skin).at(v(0.21, 0.09, 0.09)));
    let ear = object("Ear", ellipsoid(0.05, 0.11, 0.09), skin);
    builder.add(limbs, ear.at(v(0.345, 1.58, 0.0)));
    let face = builder.add(figure, mirrored("Face"));
    builder.add(face, object("Eye", sphere(0.082), white).at(v(0.125, 1.62, 0.285)));
    builder.add(face, object("Pupil", sphere(0.045), pupil).at(v(0.128, 1.622, 0.334)));
    builder.add(figure, object("Nose", sphere(0.06), skin).at(v(0.0, 1.53, 0.355)));
    let smile = Shape::Capsule { start: [-0.09, 0.0, 0.0], end: [0.09, 0.0, 0.0], radius: 0.018 };
    builder.add(figure, object("Mouth", smile, pupil).at(v(0.0, 1.41, 0.325)).rotated(turn_x(10.0)));
    soft_lights(&mut builder, 1.0);
    builder.view(
        CameraNode { fov_y: 30.0, ..CameraNode::default() },
        [1.3, 1.5, 4.6],
        DVec3::new(0.0, 0.95, 0.0).to_array(),
    );
    builder.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use isolith_scene::{NodeKind, file};

    #[test]
    fn templates_are_sound_have_a_camera_and_read_back() {
        for Template { name, help, scene } in templates() {
            assert!(!help.is_empty() && scene.nodes().iter().any(|node| matches!(node.kind, NodeKind::Camera(_))));
            let json = file::to_json(&scene).unwrap_or_else(|error| panic!("{name}: {error}"));
            let again = file::parse(json.as_bytes(), std::path::Path::new(name)).expect("it reads back");
            assert_eq!(again.nodes().len(), scene.nodes().len(), "{name}");
        }
    }
}
