//! Every kind of light, each over a ball and a box of its own.

use super::scene_builder::{SceneBuilder, cuboid, object, sphere, turn_y, v};
use isolith_scene::{Falloff, LightKind, Scene, Shadowing};

/// Distance from one pair of shapes to the next, in meters.
const SPACING: f64 = 2.4;

pub(super) fn scene() -> Scene {
    let mut builder = SceneBuilder::new([0.012, 0.014, 0.018], [0.03, 0.032, 0.036], [0.025, 0.027, 0.03]);
    builder.shade(Shadowing::default());
    builder.expose(1.5);
    let floor = builder.surface("Floor", [0.42, 0.40, 0.38], 0.0, 0.5);
    let ball = builder.surface("Ball", [0.72, 0.70, 0.66], 0.0, 0.28);
    let wood = builder.surface("Box", [0.46, 0.20, 0.08], 0.0, 0.4);
    builder.add(None, object("Floor", cuboid(14.0, 0.2, 7.0, 0.05), floor).at(v(0.0, -0.1, 0.0)));
    builder.add(None, object("Wall", cuboid(14.0, 4.0, 0.2, 0.05), floor).at(v(0.0, 1.9, -2.2)));
    for i in 0..5 {
        let x = (f64::from(i) - 2.0) * SPACING;
        builder.add(None, object("Ball", sphere(0.55), ball).at(v(x - 0.25, 0.55, 0.2)));
        let part = object("Box", cuboid(0.5, 0.5, 0.5, 0.04), wood);
        builder.add(None, part.at(v(x + 0.65, 0.25, 0.75)).rotated(turn_y(25.0)));
    }
    let falloff = Falloff::InverseSquare {};
    let warm = [1.0, 0.82, 0.62];
    let cool = [0.62, 0.80, 1.0];
    let at = |i: f64, height: f64, z: f64| [(i - 2.0) * SPACING, height, z];
    let below = |i: f64| [(i - 2.0) * SPACING, 0.4, 0.0];
    builder.light("Moon", [[-3.0, 6.0, 4.0], [0.0; 3]], cool, LightKind::Sun { strength: 0.25, angle: 8.0 });
    let point = LightKind::Point { power: 32.0, radius: 0.0, falloff };
    builder.light("Point", [at(0.0, 2.0, 1.0), below(0.0)], warm, point);
    let globe = LightKind::Point { power: 42.0, radius: 0.35, falloff };
    builder.light("Sphere", [at(1.0, 2.1, 1.0), below(1.0)], [1.0, 0.95, 0.85], globe);
    let softbox = LightKind::Rectangle { power: 26.0, width: 1.6, height: 0.8 };
    builder.light("Rectangle", [at(2.0, 2.3, 1.2), below(2.0)], [1.0; 3], softbox);
    let spot = LightKind::Spot { power: 190.0, radius: 0.05, falloff, inner: 9.0, outer: 15.0 };
    builder.light("Spot", [at(3.0, 3.4, 2.2), below(3.0)], cool, spot);
    let lamp = Falloff::Attenuation { constant: 0.6, linear: 0.3, quadratic: 0.3, range: 3.2 };
    let flame = LightKind::Point { power: 60.0, radius: 0.15, falloff: lamp };
    builder.light("Flame", [at(4.0, 1.7, 1.2), below(4.0)], [1.0, 0.42, 0.12], flame);
    builder.camera([0.0, 3.4, 11.5], [0.0, 0.9, 0.0], 38.0);
    builder.finish()
}
