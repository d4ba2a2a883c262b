//! Statues by the thousand: three models as fields, in a garden where each turns a little by itself.

use super::character::mesh_field;
use super::scene_builder::{SceneBuilder, cuboid, cylinder, group, object, v};
use isolith_scene::{
    CameraNode, Dynamic, Instancer, MaterialVariation, Node, NodeKind, Operator, Scene, Shadowing, Variation,
};

/// Voxels along the longest side of each statue.
const VOXELS: f64 = 160.0;

pub(super) fn scene() -> Scene {
    let mut builder = SceneBuilder::new([0.16, 0.30, 0.55], [0.62, 0.66, 0.70], [0.36, 0.40, 0.46]);
    builder.shade(Shadowing { occlusion: false, ..Shadowing::default() });
    let marble = builder.glossy("Marble", [0.66, 0.63, 0.58], 0.3);
    let palette = vec![
        marble,
        builder.glossy("Jade", [0.16, 0.38, 0.24], 0.22),
        builder.metal("Bronze", [0.62, 0.38, 0.18], 0.34),
        builder.glossy("Basalt", [0.09, 0.09, 0.10], 0.4),
    ];
    let grass = builder.matte("Grass", [0.10, 0.17, 0.06]);
    let stone = builder.matte("Stone", [0.35, 0.33, 0.30]);
    builder.add(None, object("Ground", cuboid(400.0, 0.2, 400.0, 0.0), grass).at(v(0.0, -0.1, 0.0)));

    let mut garden = Instancer::grid([40, 1, 40], [2.6, 1.0, 2.6]);
    garden.seed = 11;
    garden.probability = 0.82;
    garden.palette = palette;
    garden.material = MaterialVariation { value: 0.12, roughness: 0.08, ..MaterialVariation::default() };
    garden.variation = Variation {
        looseness: 0.25,
        rotation_min: [0.0, -180.0, 0.0],
        rotation_max: [0.0, 180.0, 0.0],
        scale_min: [0.8; 3],
        scale_max: [1.25; 3],
        ..Variation::default()
    };
    let turn = Dynamic::Spin { axis: [0.0, 1.0, 0.0], frequency: 0.03, phase: 0.0, spread: 1.0 };
    let node = Node::new("Garden", NodeKind::Instancer(Box::new(garden))).moving(turn);
    let garden = builder.add(None, node);
    for (name, path, height, weight) in [
        ("Bust", "models/bust.glb", 0.5, 1.0),
        ("Vase", "models/vase.glb", 0.36, 0.8),
        ("Column", "models/column.glb", 0.18, 0.6),
    ] {
        let statue = builder.add(garden, group(name, Operator::Union).weighted(weight));
        builder.add(statue, object("Plinth", cylinder(0.46, height, 0.03), stone).at(v(0.0, 0.5 * height, 0.0)));
        builder.add(statue, object(name, mesh_field(path, VOXELS), marble).at(v(0.0, height, 0.0)));
    }
    builder.sun("Sun", [-0.6, 0.8, 0.5], [1.0, 0.94, 0.84], 1.1);
    let camera = CameraNode { fov_y: 40.0, far: 400.0, ..CameraNode::default() };
    builder.view(camera, [1.3, 2.3, 7.5], [1.3, 1.0, 0.0]);
    builder.finish()
}
