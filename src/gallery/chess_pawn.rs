//! A chess pawn, turned on a lathe of blends: the scene that every renderer of fields begins with.

use glam::DVec3;

use super::stage::{Stage, blended, cone, cuboid, cylinder, ellipsoid, group, object, sphere, torus, turn_y, v};
use crate::scene::{BlendKernel, MaterialId, NodeId, Operator, Scene};

pub(super) fn scene() -> Scene {
    let mut stage = Stage::new([0.05, 0.07, 0.10], [0.135, 0.115, 0.10], [0.26, 0.26, 0.28]);
    let ivory = stage.glossy("Ivory", [0.74, 0.60, 0.40], 0.35, 60.0);
    let ebony = stage.glossy("Ebony", [0.035, 0.026, 0.024], 0.5, 70.0);
    let maple = stage.glossy("Maple", [0.60, 0.40, 0.20], 0.12, 30.0);
    let walnut = stage.glossy("Walnut", [0.13, 0.052, 0.024], 0.18, 30.0);
    let frame = stage.glossy("Frame", [0.06, 0.022, 0.012], 0.3, 40.0);

    board(&mut stage, [maple, walnut, frame]);
    pawn(&mut stage, None, ("White pawn", ivory), v(0.0, 0.0, 0.0));
    pawn(&mut stage, None, ("Black pawn", ebony), v(1.0, 0.0, -1.0));

    stage.sun("Window", [-0.75, 0.9, 0.65], [1.0, 0.93, 0.82], 0.95);
    stage.sun("Sky", [0.9, 0.35, 0.25], [0.55, 0.70, 1.0], 0.30);
    stage.sun("Back light", [0.35, 0.45, -1.0], [1.0, 0.86, 0.66], 0.7);
    stage.camera([-1.15, 1.55, 3.1], [0.17, 0.47, -0.12], 31.0);
    stage.finish()
}

/// Nine squares in a frame; the tops are at height 0.
fn board(stage: &mut Stage, [light, dark, frame]: [MaterialId; 3]) {
    let board = stage.add(None, group("Board", Operator::Union));
    let squares = stage.add(board, group("Squares", Operator::Union));
    for row in -1..=1 {
        for column in -1..=1 {
            let (name, material) =
                if (row + column) % 2 == 0 { ("Dark square", dark) } else { ("Light square", light) };
            let square = object(name, cuboid(0.98, 0.2, 0.98, 0.025), material);
            stage.add(squares, square.at(v(f64::from(column), -0.1, f64::from(row))));
        }
    }
    stage.add(board, object("Base", cuboid(3.5, 0.22, 3.5, 0.06), frame).at(v(0.0, -0.19, 0.0)));
    let rim = stage.add(board, group("Rim", Operator::Difference));
    stage.add(rim, object("Outside", cuboid(3.5, 0.2, 3.5, 0.05), frame).at(v(0.0, -0.06, 0.0)));
    stage.add(rim, object("Inside", cuboid(3.02, 1.0, 3.02, 0.0), frame));
}

/// A pawn that stands at `at`, 1.2 m high.
pub(super) fn pawn(
    stage: &mut Stage,
    parent: Option<NodeId>,
    (name, material): (&str, MaterialId),
    at: DVec3,
) -> NodeId {
    let node = blended(name, Operator::Union, BlendKernel::Circular, 0.07);
    let pawn = stage.add(parent, node.at(at).rotated(turn_y(20.0)));
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
        stage.add(pawn, object(part, shape, material).at(v(0.0, height, 0.0)));
    }
    pawn
}
