//! Shapes drawn point by point: a knot of a tube, a turned vase, a star, a word, hills and the sea.

use std::f64::consts::TAU;

use super::scene_builder::{SceneBuilder, cuboid, object, turn_x, turn_y, v};
use isolith_scene::{Attachment, Corners, Points, Scene, Shape};

/// Points of the knot.
const KNOT_POINTS: i32 = 64;

pub(super) fn scene() -> Scene {
    let mut builder = SceneBuilder::new([0.05, 0.10, 0.20], [0.30, 0.34, 0.42], [0.24, 0.26, 0.30]);
    let brass = builder.metal("Brass", [0.92, 0.66, 0.24], 0.32);
    let clay = builder.coated("Glaze", [0.13, 0.46, 0.50], 0.05);
    let red = builder.coated("Lacquer", [0.80, 0.06, 0.06], 0.08);
    let ivory = builder.glossy("Ivory", [0.75, 0.70, 0.58], 0.25);
    let grass = builder.matte("Grass", [0.20, 0.30, 0.10]);
    let water = builder.water("Water", [0.03, 0.14, 0.22]);
    let stone = builder.matte("Stone", [0.34, 0.33, 0.32]);

    builder.add(None, object("Table", cuboid(6.4, 0.2, 4.4, 0.05), stone).at(v(0.0, -0.1, 0.0)));
    builder.add(None, object("Knot", knot(), brass).at(v(-1.9, 0.95, 0.7)).rotated(turn_y(20.0) * turn_x(-12.0)));
    let vase = Shape::Revolution { corners: Corners::vase(), smooth: true, offset: 0.0 };
    builder.add(None, object("Vase", vase, clay).at(v(0.0, 0.64, 0.9)));
    let star = Shape::Extrusion { corners: Corners::star(5, 0.75, 0.32), smooth: false, depth: 0.3, rounding: 0.06 };
    builder.add(None, object("Star", star, red).at(v(1.9, 0.62, 0.8)).rotated(turn_y(-24.0)));
    let text =
        Shape::Text { text: "Isolith".to_owned(), font: Attachment::NONE, size: 0.85, depth: 0.22, rounding: 0.02 };
    builder.add(None, object("Word", text, ivory).at(v(0.0, 0.30, 1.85)).rotated(turn_x(-8.0)));
    let hills = Shape::Terrain {
        size: [2.9, 0.2, 1.9],
        amplitude: 0.55,
        wavelength: 1.1,
        octaves: 6.0,
        roughness: 0.45,
        seed: 7.0,
    };
    builder.add(None, object("Hills", hills, grass).at(v(-1.55, 0.35, -1.15)));
    let sea = Shape::Ocean {
        size: [2.9, 0.3, 1.9],
        amplitude: 0.14,
        wavelength: 1.0,
        waves: 5.0,
        direction: 35.0,
        spread: 50.0,
        sharpness: 0.5,
        phase: 40.0,
        speed: 0.0,
    };
    builder.add(None, object("Sea", sea, water).at(v(1.55, 0.3, -1.15)));

    builder.spot("Key", [[-4.0, 6.0, 5.0], [0.0, 0.4, 0.0]], [1.0, 0.94, 0.85], 1.6, [20.0, 40.0]);
    builder.sun("Fill", [1.0, 0.5, 0.6], [0.60, 0.75, 1.0], 0.55);
    builder.sun("Rim", [0.4, 0.5, -1.0], [1.0, 0.9, 0.8], 0.6);
    builder.camera([0.48, 4.23, 8.66], [0.0, 0.45, -0.1], 38.0);
    builder.finish()
}

/// A trefoil knot whose tube swells three times along its length.
fn knot() -> Shape {
    let point = |i: i32| {
        let t = TAU * f64::from(i) / f64::from(KNOT_POINTS);
        let r = 0.48 + 0.22 * (3.0 * t).cos();
        [r * (2.0 * t).cos(), r * (2.0 * t).sin(), 0.26 * (3.0 * t).sin(), 0.03 + 0.03 * (3.0 * t).sin()]
    };
    Shape::Tube { points: Points::new((0..KNOT_POINTS).map(point).collect::<Vec<_>>()), radius: 0.05, closed: true }
}
