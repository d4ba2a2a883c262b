//! Balls from smooth to rough and from plastic to metal, lit by an image of a studio.

use super::scene_builder::{SceneBuilder, cuboid, object, sphere, v};
use isolith_scene::{Attachment, EnvironmentImage, EnvironmentKind, Scene, Shadowing};

/// Columns and lines of the studio's image.
const STUDIO: [u32; 2] = [128, 64];

pub(super) fn scene() -> Scene {
    let mut builder = SceneBuilder::new([0.0; 3], [0.0; 3], [0.0; 3]);
    builder.shade(Shadowing::default());
    builder.environment(studio_light(1.0, 0.0));
    let floor = builder.surface("Table", [0.16, 0.17, 0.19], 0.0, 0.45);
    builder.add(None, object("Table", cuboid(9.0, 0.3, 5.2, 0.12), floor).at(v(0.0, -0.15, 0.0)));
    for row in 0..3 {
        let (name, color, metalness) = match row {
            0 => ("Plastic", [0.70, 0.08, 0.05], 0.0),
            1 => ("Half metal", [0.25, 0.42, 0.55], 0.5),
            _ => ("Gold", [1.0, 0.71, 0.29], 1.0),
        };
        for column in 0..6 {
            let roughness = 0.05 + 0.19 * f64::from(column);
            let material = builder.surface(&format!("{name} {}", column + 1), color, metalness, roughness);
            let at = v(1.3 * (f64::from(column) - 2.5), 0.55, 1.4 * (1.0 - f64::from(row)));
            builder.add(None, object(name, sphere(0.55), material).at(at));
        }
    }
    builder.camera([0.0, 5.2, 9.0], [0.0, 0.2, -0.1], 34.0);
    builder.finish()
}

/// The image of the studio as an environment; `rotation` in degrees.
pub(super) fn studio_light(strength: f64, rotation: f64) -> EnvironmentKind {
    let image = Attachment::<EnvironmentImage>::painted("studio.hdr", STUDIO, studio);
    EnvironmentKind::Image { image, strength, rotation }
}

/// A gray room with two softboxes, a strip light, a warm lamp and a dark floor.
fn studio(x: u32, y: u32) -> [f32; 3] {
    match (x, y) {
        (14..=37, 12..=27) => [9.0, 9.0, 9.4],
        (88..=103, 8..=33) => [6.0, 6.2, 6.6],
        (56..=75, 3..=6) => [14.0, 13.4, 12.6],
        (112..=116, 24..=30) => [16.0, 9.0, 4.0],
        (_, 34..) => [0.06, 0.058, 0.055],
        _ => [0.16, 0.17, 0.19].map(|gray: f32| gray * (1.0 + (32 - y.min(32)) as f32 / 64.0)),
    }
}
