//! An ellipsoid that rises from an endless plane, and pebbles: fields without bounds, exact ellipsoids.

use glam::DVec3;

use super::scene_builder::{SceneBuilder, blended, ellipsoid, object, turn_x, turn_y, turn_z, v};
use isolith_scene::{BlendKernel, Operator, Scene, Shape};

pub(super) fn scene() -> Scene {
    let mut builder = SceneBuilder::new([0.10, 0.25, 0.52], [0.55, 0.60, 0.66], [0.30, 0.33, 0.40]);
    let sand = builder.phong("Sand", [0.72, 0.50, 0.31], 0.08, 16.0);
    let ink = builder.phong("Ink", [0.016, 0.075, 0.17], 0.7, 90.0);
    let shell = builder.phong("Shell", [0.84, 0.76, 0.66], 0.35, 50.0);
    let rust = builder.phong("Rust", [0.52, 0.12, 0.045], 0.25, 40.0);

    let beach = builder.add(None, blended("Beach", Operator::Union, BlendKernel::Circular, 0.5));
    builder.add(beach, object("Ground", Shape::Plane {}, sand));
    let whale = object("Ellipsoid", ellipsoid(1.9, 0.72, 0.95), ink);
    builder.add(beach, whale.at(v(0.0, 0.62, 0.0)).rotated(turn_y(24.0) * turn_z(15.0)));

    let pebbles: [(f64, f64, [f64; 3], f64, _); 6] = [
        (-1.9, 1.3, [0.42, 0.13, 0.30], 20.0, shell),
        (-1.25, 1.85, [0.24, 0.09, 0.19], -35.0, rust),
        (1.55, 1.55, [0.34, 0.16, 0.22], 60.0, shell),
        (2.35, 0.75, [0.20, 0.08, 0.15], 10.0, rust),
        (2.75, -1.3, [0.50, 0.22, 0.36], -20.0, shell),
        (-2.5, -0.6, [0.33, 0.15, 0.24], 75.0, rust),
    ];
    for (x, z, radii, turn, material) in pebbles {
        let pebble = object("Pebble", Shape::Ellipsoid { radii }, material);
        builder.add(None, pebble.at(DVec3::new(x, radii[1] * 0.72, z)).rotated(turn_y(turn) * turn_x(6.0)));
    }
    let leaf = object("Needle", ellipsoid(0.045, 1.0, 0.045), rust);
    builder.add(None, leaf.at(v(-1.05, 1.05, -0.85)).rotated(turn_z(9.0) * turn_x(-12.0)));

    builder.sun("Evening sun", [-0.9, 0.62, 0.45], [1.0, 0.85, 0.66], 1.0);
    builder.sun("Sky", [0.3, 1.0, -0.5], [0.55, 0.72, 1.0], 0.28);
    builder.camera([-0.45, 1.6, 7.4], [0.1, 0.62, 0.0], 44.0);
    builder.finish()
}
