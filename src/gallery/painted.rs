//! A painted amphora three times: as triangles, as a field, and as a field that has grown into the rock, in the
//! materials and textures of its file.

use super::character::mesh_field;
use super::scene_builder::{
    SceneBuilder, blended, cuboid, cylinder, ellipsoid, mesh, object, sphere, turn_x, turn_y, turn_z, v,
};
use isolith_scene::{BlendKernel, Operator, Scene, Shadowing, Shape};

const AMPHORA: &str = "models/amphora.glb";
/// Voxels along the longest side.
const VOXELS: f64 = 256.0;

/// The amphora in its own materials.
fn amphora() -> Shape {
    match mesh_field(AMPHORA, VOXELS) {
        Shape::MeshField { file, clip, clip_time, resolution, voxel_size, .. } => {
            Shape::MeshField { file, clip, clip_time, resolution, voxel_size, file_materials: true }
        }
        other => other,
    }
}

pub(super) fn scene() -> Scene {
    let mut builder = SceneBuilder::new([0.20, 0.30, 0.42], [0.60, 0.58, 0.55], [0.40, 0.42, 0.45]);
    builder.shade(Shadowing::default());
    let rock = builder.matte("Rock", [0.34, 0.31, 0.27]);
    let moss = builder.matte("Moss", [0.12, 0.18, 0.06]);
    let wood = builder.glossy("Wood", [0.30, 0.17, 0.08], 0.4);
    builder.add(None, object("Table", cuboid(6.0, 0.1, 3.0, 0.03), wood).at(v(0.0, -0.05, -0.4)));

    let turned = turn_y(20.0);
    builder.add(None, mesh("Triangles", AMPHORA).at(v(-0.85, 0.0, 0.0)).rotated(turned));
    builder.add(None, object("Field", amphora(), rock).at(v(0.0, 0.0, 0.0)).rotated(turned));

    let grown = builder.add(None, blended("Grown in", Operator::Union, BlendKernel::Circular, 0.14));
    let leaning = object("Leaning", amphora(), rock).at(v(0.83, 0.10, 0.0));
    builder.add(grown, leaning.rotated(turn_z(-16.0) * turn_x(8.0) * turned));
    builder.add(grown, object("Rock", ellipsoid(0.42, 0.22, 0.32), rock).at(v(0.9, 0.05, -0.02)));
    builder.add(grown, object("Stone", sphere(0.16), moss).at(v(0.62, 0.08, 0.26)));
    builder.add(
        grown,
        object("Bite", cylinder(0.09, 0.8, 0.0), moss).at(v(1.02, 0.62, 0.2)).rotated(turn_x(90.0)).subtracted(),
    );

    builder.sun("Sun", [-0.6, 0.9, 0.7], [1.0, 0.94, 0.85], 1.0);
    builder.sun("Sky", [0.8, 0.4, 0.3], [0.6, 0.75, 1.0], 0.35);
    builder.camera([0.05, 0.95, 3.1], [0.05, 0.44, 0.0], 50.0);
    builder.finish()
}
