//! Soft shadows and occlusion: corners, thin rods, contact, and penumbras that grow with the distance.

use super::scene_builder::{SceneBuilder, capsule, cuboid, object, sphere, turn_x, v};
use isolith_scene::{Falloff, LightKind, Scene, Shadowing};

/// Number of rods.
const RODS: usize = 7;

pub(super) fn scene() -> Scene {
    let mut builder = SceneBuilder::new([0.32, 0.42, 0.55], [0.62, 0.63, 0.62], [0.30, 0.32, 0.36]);
    builder.shade(Shadowing::default());
    let plaster = builder.matte("Plaster", [0.62, 0.60, 0.56]);
    let clay = builder.matte("Clay", [0.66, 0.34, 0.22]);
    let steel = builder.matte("Steel", [0.30, 0.33, 0.37]);
    let chalk = builder.matte("Chalk", [0.78, 0.77, 0.74]);
    builder.add(None, object("Floor", cuboid(12.0, 0.4, 9.0, 0.0), plaster).at(v(0.0, -0.2, 0.0)));
    builder.add(None, object("Back wall", cuboid(12.0, 3.4, 0.3, 0.0), plaster).at(v(0.0, 1.5, -3.4)));
    builder.add(None, object("Side wall", cuboid(0.3, 3.4, 4.0, 0.0), plaster).at(v(-4.4, 1.5, -1.5)));
    // Contact: a ball and boxes that touch the floor and each other.
    builder.add(None, object("Ball", sphere(0.7), clay).at(v(-2.6, 0.7, -0.2)));
    builder.add(None, object("Block", cuboid(1.1, 0.8, 1.1, 0.02), chalk).at(v(-2.9, 0.4, -2.5)));
    builder.add(None, object("Top block", cuboid(0.6, 0.6, 0.6, 0.02), clay).at(v(-2.8, 1.1, -2.5)));
    // Penumbras that grow: a plate that leans up from the floor.
    let plate = object("Plate", cuboid(1.5, 0.08, 2.6, 0.01), chalk);
    builder.add(None, plate.at(v(0.3, 1.05, -1.0)).rotated(turn_x(47.0)));
    for i in 0..RODS {
        let x = 1.7 + 0.36 * i as f64;
        let radius = 0.045 - 0.005 * i as f64;
        let rod = object("Rod", capsule([0.0; 3], [0.0, 2.2, 0.0], radius), steel);
        builder.add(None, rod.at(v(x, 0.0, -1.6 + 0.12 * i as f64)));
    }
    let sun = LightKind::Sun { strength: 2.8, angle: 1.5 };
    builder.light("Sun", [[0.7, 0.95, 0.75], [0.0; 3]], [1.0, 0.93, 0.82], sun);
    let falloff = Falloff::Attenuation { constant: 1.0, linear: 0.0, quadratic: 0.12, range: 14.0 };
    let lamp = LightKind::Point { power: 32.0, radius: 0.12, falloff };
    builder.light("Lamp", [[-3.4, 2.6, 1.6], [0.0; 3]], [0.55, 0.72, 1.0], lamp);
    builder.camera([1.2, 3.4, 8.2], [-0.3, 0.65, -0.9], 42.0);
    builder.finish()
}
