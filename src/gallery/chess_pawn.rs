//! A chess pawn, turned on a lathe of blends: the usual first scene of SDF renderers.

use glam::DVec3;

use super::scene_builder::{
    SceneBuilder, blended, cone, cuboid, cylinder, ellipsoid, group, object, sphere, torus, turn_y, v,
};
use isolith_scene::{BlendKernel, MaterialId, NodeId, Operator, Scene};

pub(super) fn scene() -> Scene {
    let mut builder = SceneBuilder::new([0.05, 0.07, 0.10], [0.135, 0.115, 0.10], [0.26, 0.26, 0.28]);
    let ivory = builder.glossy("Ivory", [0.76, 0.63, 0.43], 0.28);
    let ebony = builder.coated("Ebony", [0.028, 0.020, 0.018], 0.1);
    let maple = builder.glossy("Maple", [0.60, 0.40, 0.20], 0.62);
    let walnut = builder.glossy("Walnut", [0.13, 0.052, 0.024], 0.55);
    let frame = builder.coated("Frame", [0.06, 0.022, 0.012], 0.15);

    board(&mut builder, [maple, walnut, frame]);
    pawn(&mut builder, None, ("White pawn", ivory), v(0.0, 0.0, 0.0));
    pawn(&mut builder, None, ("Black pawn", ebony), v(1.0, 0.0, -1.0));

    builder.sun("Window", [-0.75, 0.9, 0.65], [1.0, 0.93, 0.82], 0.95);
    builder.sun("Sky", [0.9, 0.35, 0.25], [0.55, 0.70, 1.0], 0.30);
    builder.sun("Back light", [0.35, 0.45, -1.0], [1.0, 0.86, 0.66], 0.7);
    builder.camera([-1.15, 1.55, 3.1], [0.17, 0.47, -0.12], 31.0);
    builder.finish()
}

/// Nine squares in a frame, with their tops at height 0.
fn board(builder: &mut SceneBuilder, [light, dark, frame]: [MaterialId; 3]) {
    let board = builder.add(None, group("Board", Operator::Union));
    let squares = builder.add(board, group("Squares", Operator::Union));
    for row in -1..=1 {
        for column in -1..=1 {
            let (name, material) =
                if (row + column) % 2 == 0 { ("Dark square", dark) } else { ("Light square", light) };
            let square = object(name, cuboid(0.98, 0.2, 0.98, 0.025), material);
            builder.add(squares, square.at(v(f64::from(column), -0.1, f64::from(row))));
        }
    }
    builder.add(board, object("Base", cuboid(3.5, 0.22, 3.5, 0.06), frame).at(v(0.0, -0.19, 0.0)));
    let rim = builder.add(board, group("Rim", Operator::Difference));
    builder.add(rim, object("Outside", cuboid(3.5, 0.2, 3.5, 0.05), frame).at(v(0.0, -0.06, 0.0)));
    builder.add(rim, object("Inside", cuboid(3.02, 1.0, 3.02, 0.0), frame));
}

/// A pawn at `at`, 1.2 m high.
pub(super) fn pawn(
    builder: &mut SceneBuilder,
    parent: Option<NodeId>,
    (name, material): (&str, MaterialId),
    at: DVec3,
) -> NodeId {
    let node = blended(name, Operator::Union, BlendKernel::Circular, 0.07);
    let pawn = builder.add(parent, node.at(at).rotated(turn_y(20.0)));
    let parts = [
        ("Foot", cylinder(0.375, 0.13, 0.05), 0.065),
        ("Bead", torus(0.27, 0.055), 0.185),
        ("Skirt", cone(0.27, 0.17, 0.16), 0.26),
        ("Body", cone(0.185, 0.095, 0.46), 0.50),
        ("Collar", ellipsoid(0.215, 0.042, 0.215), 0.775),
        ("Neck", cylinder(0.11, 0.14, 0.0), 0.83),
        ("Head", sphere(0.205), 0.985),
    ];
    for (part, shape, height) in parts {
        builder.add(pawn, object(part, shape, material).at(v(0.0, height, 0.0)));
    }
    pawn
}
