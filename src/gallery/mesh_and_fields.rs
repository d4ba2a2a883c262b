//! Suzanne, a glTF mesh, dressed in fields: hat, spectacles and scarf run right through the triangles.

use super::stage::{
    Stage, blended, capsule, cone, cuboid, cylinder, ellipsoid, group, mesh, object, sphere, torus, turn_x, turn_y,
    turn_z, v,
};
use crate::scene::{BlendKernel, MaterialId, NodeId, Operator, Scene};

pub(super) fn scene() -> Scene {
    let mut stage = Stage::new([0.02, 0.075, 0.09], [0.10, 0.20, 0.20], [0.25, 0.27, 0.28]);
    let felt = stage.matt("Felt", [0.030, 0.032, 0.055]);
    let ribbon = stage.glossy("Ribbon", [0.62, 0.035, 0.045], 0.3, 40.0);
    let brass = stage.glossy("Brass", [0.70, 0.43, 0.11], 0.8, 70.0);
    let marble = stage.glossy("Marble", [0.52, 0.51, 0.49], 0.3, 60.0);
    let wool = stage.matt("Wool", [0.055, 0.30, 0.30]);

    let head = mesh("Suzanne", "models/suzanne.glb");
    stage.add(None, head.at(v(0.0, 1.5, 0.0)).rotated(turn_y(-16.0) * turn_x(-6.0)));
    let worn =
        stage.add(None, group("Worn", Operator::Union).at(v(0.0, 1.5, 0.0)).rotated(turn_y(-16.0) * turn_x(-6.0)));
    top_hat(&mut stage, worn, [felt, ribbon]);
    spectacles(&mut stage, worn, brass);
    bust(&mut stage, marble, wool);

    stage.spot("Key", [[-3.2, 4.6, 4.6], [0.0, 1.2, 0.0]], [1.0, 0.94, 0.86], 1.5, [14.0, 32.0]);
    stage.sun("Fill", [1.0, 0.25, 0.5], [0.62, 0.84, 1.0], 0.30);
    stage.sun("Rim", [0.6, 0.6, -0.9], [1.0, 0.92, 0.80], 0.9);
    stage.camera([0.0, 1.7, 6.0], [0.0, 1.27, 0.0], 32.0);
    stage.finish()
}

fn top_hat(stage: &mut Stage, worn: NodeId, [felt, ribbon]: [MaterialId; 2]) {
    let hat = stage
        .add(worn, group("Top hat", Operator::Union).at(v(0.06, 0.58, -0.06)).rotated(turn_z(-9.0) * turn_x(-8.0)));
    let felt_part = stage.add(hat, blended("Felt", Operator::Union, BlendKernel::Circular, 0.05));
    stage.add(felt_part, object("Brim", cylinder(0.66, 0.05, 0.025), felt));
    stage.add(felt_part, object("Crown", cone(0.40, 0.46, 0.62), felt).at(v(0.0, 0.31, 0.0)));
    stage.add(hat, object("Ribbon", cylinder(0.432, 0.12, 0.02), ribbon).at(v(0.0, 0.115, 0.0)));
}

fn spectacles(stage: &mut Stage, worn: NodeId, brass: MaterialId) {
    let node = blended("Spectacles", Operator::Union, BlendKernel::Quadratic, 0.03);
    let frame = stage.add(worn, node.at(v(0.0, 0.245, 0.50)));
    for side in [-1.0, 1.0] {
        let ring = object("Ring", torus(0.205, 0.026), brass);
        stage.add(frame, ring.at(v(side * 0.275, 0.0, 0.06)).rotated(turn_y(side * 12.0) * turn_x(90.0)));
        let temple = capsule([side * 0.47, 0.03, 0.02], [side * 0.70, 0.05, -0.42], 0.022);
        stage.add(frame, object("Temple", temple, brass));
    }
    stage.add(frame, object("Bridge", capsule([-0.09, 0.04, 0.09], [0.09, 0.04, 0.09], 0.024), brass));
}

/// Neck, shoulders and plinth in one blended piece, with a scarf around the neck.
fn bust(stage: &mut Stage, marble: MaterialId, wool: MaterialId) {
    let bust = stage.add(None, blended("Bust", Operator::Union, BlendKernel::Quadratic, 0.16));
    stage.add(bust, object("Shoulders", ellipsoid(0.82, 0.30, 0.42), marble).at(v(0.0, 0.52, -0.1)));
    stage.add(bust, object("Neck", cylinder(0.30, 1.2, 0.05), marble).at(v(0.04, 0.92, -0.30)));
    stage.add(bust, object("Column", cone(0.24, 0.40, 0.40), marble).at(v(0.0, 0.15, -0.1)));
    let plinth = stage.add(None, blended("Plinth", Operator::Union, BlendKernel::Circular, 0.05));
    stage.add(plinth, object("Top", cylinder(0.50, 0.10, 0.03), marble).at(v(0.0, -0.06, -0.1)));
    stage.add(plinth, object("Block", cuboid(1.1, 0.5, 1.1, 0.05), marble).at(v(0.0, -0.33, -0.1)));
    let scarf = stage.add(None, blended("Scarf", Operator::Union, BlendKernel::Quadratic, 0.06));
    stage.add(scarf, object("Loop", torus(0.36, 0.12), wool).at(v(0.0, 0.80, -0.1)).rotated(turn_x(10.0)));
    stage.add(scarf, object("Knot", sphere(0.15), wool).at(v(0.16, 0.70, 0.30)));
    stage.add(scarf, object("End", cuboid(0.22, 0.55, 0.09, 0.04), wool).at(v(0.22, 0.42, 0.36)).rotated(turn_z(12.0)));
}
