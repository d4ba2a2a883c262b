//! The fractals on their stands: a Mandelbulb, a Menger sponge, a Julia set, a Kleinian set, and a tree that is a group
//! repeated by recursion.

use super::scene_builder::{SceneBuilder, blended, capsule, cylinder, object, torus, turn_x, turn_y, v};
use isolith_scene::{BlendKernel, Modifier, Operator, Scene, Shape};

pub(super) fn scene() -> Scene {
    let mut builder = SceneBuilder::new([0.012, 0.016, 0.03], [0.07, 0.08, 0.11], [0.24, 0.26, 0.31]);
    let copper = builder.glossy("Copper", [0.62, 0.24, 0.11], 0.5);
    let jade = builder.glossy("Jade", [0.10, 0.36, 0.24], 0.2);
    let ivory = builder.glossy("Ivory", [0.72, 0.65, 0.52], 0.32);
    let glaze = builder.coated("Glaze", [0.08, 0.25, 0.58], 0.06);
    let coral = builder.glossy("Coral", [0.50, 0.13, 0.16], 0.45);
    let floor = builder.glossy("Floor", [0.055, 0.06, 0.075], 0.85);
    let stone = builder.glossy("Stands", [0.17, 0.175, 0.19], 0.7);

    builder.add(None, object("Floor", Shape::Plane {}, floor));
    for ([x, z], radius, height) in [
        ([0.0, -1.0], 0.8, 0.9),
        ([-1.85, -0.9], 0.66, 0.5),
        ([1.75, -0.9], 0.6, 0.5),
        ([-0.9, 1.05], 0.62, 0.24),
        ([0.98, 1.05], 0.66, 0.24),
    ] {
        builder.add(None, object("Stand", cylinder(radius, height, 0.03), stone).at(v(x, 0.5 * height, z)));
    }
    let bulb = Shape::Mandelbulb { radius: 1.0, power: 8.0, iterations: 3.0 };
    builder.add(None, object("Mandelbulb", bulb, copper).at(v(0.0, 1.86, -1.0)).rotated(turn_y(12.0) * turn_x(22.0)));
    let sponge = Shape::MengerSponge { size: 0.9, iterations: 3.0 };
    builder.add(None, object("Menger sponge", sponge, ivory).at(v(-1.85, 0.95, -0.9)).rotated(turn_y(30.0)));
    let julia = Shape::Julia { radius: 0.86, constant: [-0.2, 0.8, 0.0], fourth: 0.0, iterations: 7.0 };
    builder.add(None, object("Julia set", julia, jade).at(v(-0.9, 0.84, 1.05)).rotated(turn_y(-60.0)));
    let kleinian = Shape::Kleinian {
        radius: 0.66,
        reach: 2.0,
        fold: [1.0, 0.5, 1.0],
        inversion: 0.5,
        thickness: 0.06,
        iterations: 4.0,
    };
    builder.add(None, object("Kleinian set", kleinian, glaze).at(v(0.98, 0.86, 1.05)).rotated(turn_y(-12.0)));

    let recursion = Modifier::Recursion {
        count: 7,
        offset: [0.0, 0.48, 0.0],
        rotation: [0.0, 58.0, 32.0],
        scale: 0.72,
        mirrored: [true, false, false],
    };
    let tree = blended("Tree", Operator::Union, BlendKernel::Circular, 0.05);
    let tree = builder.add(None, tree.at(v(1.75, 0.5, -0.9)).rotated(turn_y(60.0)).modified(recursion));
    builder.add(tree, object("Branch", capsule([0.0; 3], [0.0, 0.48, 0.0], 0.06), coral));
    builder.add(tree, object("Ring", torus(0.1, 0.03), coral).at(v(0.0, 0.34, 0.0)));

    builder.sun("Key", [-0.6, 0.8, 0.75], [1.0, 0.94, 0.84], 1.0);
    builder.sun("Fill", [0.9, 0.35, 0.55], [0.55, 0.72, 1.0], 0.4);
    builder.sun("Rim", [0.2, 0.55, -1.0], [1.0, 0.85, 0.7], 0.5);
    builder.camera([0.0, 4.1, 8.6], [0.0, 0.95, 0.0], 29.0);
    builder.finish()
}
