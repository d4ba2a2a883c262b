//! Suzanne, a glTF mesh, dressed in fields: hat, spectacles and scarf intersect the triangles.

use super::scene_builder::{
    SceneBuilder, blended, capsule, cone, cuboid, cylinder, ellipsoid, group, mesh, object, sphere, torus, turn_x,
    turn_y, turn_z, v,
};
use isolith_scene::{BlendKernel, MaterialId, NodeId, Operator, Scene};

pub(super) fn scene() -> Scene {
    let mut builder = SceneBuilder::new([0.02, 0.075, 0.09], [0.10, 0.20, 0.20], [0.25, 0.27, 0.28]);
    let felt = builder.matte("Felt", [0.030, 0.032, 0.055]);
    let ribbon = builder.glossy("Ribbon", [0.62, 0.035, 0.045], 0.35);
    let brass = builder.metal("Brass", [0.92, 0.66, 0.24], 0.28);
    let marble = builder.glossy("Marble", [0.55, 0.54, 0.52], 0.22);
    let wool = builder.matte("Wool", [0.055, 0.30, 0.30]);

    let head = mesh("Suzanne", "models/suzanne.glb");
    builder.add(None, head.at(v(0.0, 1.5, 0.0)).rotated(turn_y(-16.0) * turn_x(-6.0)));
    let clothes =
        builder.add(None, group("Worn", Operator::Union).at(v(0.0, 1.5, 0.0)).rotated(turn_y(-16.0) * turn_x(-6.0)));
    top_hat(&mut builder, clothes, [felt, ribbon]);
    spectacles(&mut builder, clothes, brass);
    bust(&mut builder, marble, wool);

    builder.spot("Key", [[-3.2, 4.6, 4.6], [0.0, 1.2, 0.0]], [1.0, 0.94, 0.86], 1.5, [14.0, 32.0]);
    builder.sun("Fill", [1.0, 0.25, 0.5], [0.62, 0.84, 1.0], 0.30);
    builder.sun("Rim", [0.6, 0.6, -0.9], [1.0, 0.92, 0.80], 0.9);
    builder.camera([0.0, 1.7, 6.0], [0.0, 1.27, 0.0], 32.0);
    builder.finish()
}

fn top_hat(builder: &mut SceneBuilder, clothes: NodeId, [felt, ribbon]: [MaterialId; 2]) {
    let hat = builder
        .add(clothes, group("Top hat", Operator::Union).at(v(0.06, 0.58, -0.06)).rotated(turn_z(-9.0) * turn_x(-8.0)));
    let felt_part = builder.add(hat, blended("Felt", Operator::Union, BlendKernel::Circular, 0.05));
    builder.add(felt_part, object("Brim", cylinder(0.66, 0.05, 0.025), felt));
    builder.add(felt_part, object("Crown", cone(0.40, 0.46, 0.62), felt).at(v(0.0, 0.31, 0.0)));
    builder.add(hat, object("Ribbon", cylinder(0.432, 0.12, 0.02), ribbon).at(v(0.0, 0.115, 0.0)));
}

fn spectacles(builder: &mut SceneBuilder, clothes: NodeId, brass: MaterialId) {
    let node = blended("Spectacles", Operator::Union, BlendKernel::Quadratic, 0.03);
    let frame = builder.add(clothes, node.at(v(0.0, 0.245, 0.50)));
    for side in [-1.0, 1.0] {
        let ring = object("Ring", torus(0.205, 0.026), brass);
        builder.add(frame, ring.at(v(side * 0.275, 0.0, 0.06)).rotated(turn_y(side * 12.0) * turn_x(90.0)));
        let temple = capsule([side * 0.47, 0.03, 0.02], [side * 0.70, 0.05, -0.42], 0.022);
        builder.add(frame, object("Temple", temple, brass));
    }
    builder.add(frame, object("Bridge", capsule([-0.09, 0.04, 0.09], [0.09, 0.04, 0.09], 0.024), brass));
}

/// Neck, shoulders and plinth in one blended piece, with a scarf around the neck.
fn bust(builder: &mut SceneBuilder, marble: MaterialId, wool: MaterialId) {
    let bust = builder.add(None, blended("Bust", Operator::Union, BlendKernel::Quadratic, 0.16));
    builder.add(bust, object("Shoulders", ellipsoid(0.82, 0.30, 0.42), marble).at(v(0.0, 0.52, -0.1)));
    builder.add(bust, object("Neck", cylinder(0.30, 1.2, 0.05), marble).at(v(0.04, 0.92, -0.30)));
    builder.add(bust, object("Column", cone(0.24, 0.40, 0.40), marble).at(v(0.0, 0.15, -0.1)));
    let plinth = builder.add(None, blended("Plinth", Operator::Union, BlendKernel::Circular, 0.05));
    builder.add(plinth, object("Top", cylinder(0.50, 0.10, 0.03), marble).at(v(0.0, -0.06, -0.1)));
    builder.add(plinth, object("Block", cuboid(1.1, 0.5, 1.1, 0.05), marble).at(v(0.0, -0.33, -0.1)));
    let scarf = builder.add(None, blended("Scarf", Operator::Union, BlendKernel::Quadratic, 0.06));
    builder.add(scarf, object("Loop", torus(0.36, 0.12), wool).at(v(0.0, 0.80, -0.1)).rotated(turn_x(10.0)));
    builder.add(scarf, object("Knot", sphere(0.15), wool).at(v(0.16, 0.70, 0.30)));
    builder
        .add(scarf, object("End", cuboid(0.22, 0.55, 0.09, 0.04), wool).at(v(0.22, 0.42, 0.36)).rotated(turn_z(12.0)));
}
