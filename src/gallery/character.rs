//! A figure whose head is a model: it blends with the body, wears horns that grow out of it, and a bite is missing.

use super::scene_builder::{
    SceneBuilder, blended, capsule, cuboid, cylinder, ellipsoid, group, object, round_cone, sphere, turn_x, turn_y,
    turn_z, v,
};
use isolith_scene::{BlendKernel, MaterialId, ModelFile, NodeId, Operator, Points, Scene, Shadowing, Shape};

/// A model of the examples as a field.
pub(super) fn mesh_field(path: &str, resolution: f64) -> Shape {
    Shape::MeshField { file: ModelFile::new(path), clip: String::new(), clip_time: 0.0, resolution, voxel_size: 0.0 }
}

pub(super) fn scene() -> Scene {
    let mut builder = SceneBuilder::new([0.10, 0.16, 0.26], [0.50, 0.46, 0.42], [0.34, 0.36, 0.42]);
    builder.shade(Shadowing::default());
    let fur = builder.glossy("Fur", [0.42, 0.20, 0.085], 0.62);
    let belly = builder.glossy("Belly", [0.72, 0.52, 0.33], 0.6);
    let horn = builder.glossy("Horn", [0.80, 0.74, 0.60], 0.3);
    let stone = builder.matte("Stone", [0.22, 0.23, 0.26]);

    let figure = builder.add(None, group("Figure", Operator::Union).rotated(turn_y(-14.0)));
    let body = builder.add(figure, blended("Body", Operator::Union, BlendKernel::Circular, 0.16));
    let head = object("Head", mesh_field("models/suzanne.glb", 192.0), fur);
    builder.add(body, head.at(v(0.0, 2.05, 0.1)).rotated(turn_x(-4.0)).scaled(v(0.85, 0.85, 0.85)));
    torso(&mut builder, body, [fur, belly]);
    limbs(&mut builder, body, fur);
    horns(&mut builder, body, horn);
    let bite = object("Bite", sphere(0.2), belly).subtracted();
    builder.add(body, bite.at(v(0.98, 2.36, -0.02)));

    builder.add(None, object("Plinth", cylinder(1.5, 0.3, 0.04), stone).at(v(0.0, -0.15, 0.0)));
    builder.add(None, object("Ground", cuboid(40.0, 0.2, 40.0, 0.0), stone).at(v(0.0, -0.4, 0.0)));
    builder.sun("Key", [-0.7, 1.0, 0.8], [1.0, 0.93, 0.82], 1.0);
    builder.sun("Rim", [0.8, 0.5, -0.9], [0.55, 0.7, 1.0], 0.6);
    builder.camera([0.4, 2.1, 6.9], [0.0, 1.5, 0.0], 36.0);
    builder.finish()
}

fn torso(builder: &mut SceneBuilder, body: NodeId, [fur, belly]: [MaterialId; 2]) {
    builder.add(body, object("Chest", round_cone(0.52, 0.34, 0.55), fur).at(v(0.0, 1.0, -0.05)));
    builder.add(body, object("Belly", ellipsoid(0.42, 0.46, 0.34), belly).at(v(0.0, 0.78, 0.26)));
}

fn limbs(builder: &mut SceneBuilder, body: NodeId, fur: MaterialId) {
    for side in [-1.0, 1.0] {
        let name = if side < 0.0 { "Left" } else { "Right" };
        let arm = capsule([side * 0.42, 1.25, 0.0], [side * 0.82, 0.72, 0.28], 0.13);
        builder.add(body, object(&format!("{name} arm"), arm, fur));
        builder.add(body, object(&format!("{name} hand"), sphere(0.17), fur).at(v(side * 0.85, 0.66, 0.32)));
        let leg = capsule([side * 0.26, 0.5, 0.0], [side * 0.34, 0.1, 0.1], 0.18);
        builder.add(body, object(&format!("{name} leg"), leg, fur));
        builder
            .add(body, object(&format!("{name} foot"), ellipsoid(0.2, 0.12, 0.3), fur).at(v(side * 0.36, 0.1, 0.22)));
    }
}

fn horns(builder: &mut SceneBuilder, body: NodeId, horn: MaterialId) {
    for side in [-1.0, 1.0] {
        let points =
            [[0.0, -0.1, 0.0, 0.11], [0.1, 0.16, 0.02, 0.085], [0.1, 0.36, 0.1, 0.04], [0.02, 0.48, 0.22, 0.01]];
        let points = Points::new(points.map(|[x, y, z, r]| [side * x, y, z, r]));
        let curve = Shape::Tube { points, radius: 0.02, closed: false };
        builder.add(body, object("Horn", curve, horn).at(v(side * 0.33, 2.72, 0.0)).rotated(turn_z(side * -14.0)));
    }
}
