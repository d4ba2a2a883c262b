//! A jester of beads and patches: sixty materials, which mix where the parts of the figure blend.

use std::f64::consts::TAU;

use super::scene_builder::{
    SceneBuilder, blended, capsule, cone, cuboid, cylinder, ellipsoid, group, object, sphere, torus, turn_y, turn_z, v,
};
use isolith_scene::{BlendKernel, MaterialId, NodeId, Operator, Scene, Shadowing};

/// Materials of the figure.
pub(super) const MATERIALS: usize = 60;
/// Beads of an arm and of a leg, rows and columns of patches, points of the collar.
const BEADS: usize = 7;
const PATCHES: [usize; 2] = [3, 6];
const POINTS: usize = 10;

pub(super) fn scene() -> Scene {
    let mut builder = SceneBuilder::new([0.16, 0.20, 0.30], [0.55, 0.52, 0.50], [0.36, 0.37, 0.42]);
    builder.shade(Shadowing::default());
    let mut paints: Vec<MaterialId> = (0..MATERIALS).map(|at| paint(&mut builder, at)).collect();
    let stone = builder.matte("Stone", [0.30, 0.31, 0.33]);
    let mut next = || paints.pop().expect("as many as there are parts");
    let figure = builder.add(None, group("Jester", Operator::Union).rotated(turn_y(-16.0)));
    let body = builder.add(figure, blended("Body", Operator::Union, BlendKernel::Circular, 0.09));
    torso(&mut builder, body, &mut next);
    for side in [-1.0, 1.0] {
        limb(&mut builder, body, [[side * 0.44, 1.62], [side * 0.98, 0.92]], &mut next);
        limb(&mut builder, body, [[side * 0.22, 0.84], [side * 0.36, 0.10]], &mut next);
    }
    head(&mut builder, figure, &mut next);
    builder.add(None, object("Pedestal", cylinder(1.1, 0.3, 0.04), stone).at(v(0.0, -0.19, 0.0)));
    builder.add(None, object("Ground", cuboid(30.0, 0.2, 30.0, 0.0), stone).at(v(0.0, -0.44, 0.0)));
    builder.sun("Key", [-0.8, 1.0, 0.9], [1.0, 0.94, 0.84], 1.1);
    builder.sun("Rim", [0.9, 0.6, -0.8], [0.55, 0.7, 1.0], 0.5);
    builder.camera([0.3, 1.9, 6.4], [0.0, 1.32, 0.0], 32.0);
    builder.finish()
}

/// One of the sixty: hues by the golden ratio, and in turn enamel, plastic, metal and cloth.
fn paint(builder: &mut SceneBuilder, at: usize) -> MaterialId {
    let hue = (0.618_034 * at as f64).fract();
    let channel = |shift: f64| 0.5 + 0.5 * ((hue + shift) * TAU).cos();
    // Three decimals, the same by every math library.
    let color = [0.0, 1.0 / 3.0, 2.0 / 3.0].map(|shift| ((0.06 + 0.74 * channel(shift)) * 1e3).round() * 1e-3);
    let name = format!("Paint {}", at + 1);
    match at % 4 {
        0 => builder.coated(&name, color, 0.1),
        1 => builder.glossy(&name, color, 0.35),
        2 => builder.metal(&name, color, 0.3),
        _ => builder.matte(&name, color),
    }
}

fn torso(builder: &mut SceneBuilder, body: NodeId, next: &mut impl FnMut() -> MaterialId) {
    for row in 0..PATCHES[0] {
        for column in 0..PATCHES[1] {
            let angle = TAU * (column as f64 + 0.5 * (row % 2) as f64) / PATCHES[1] as f64;
            let wide = [0.24, 0.3, 0.34][row];
            let at = v(wide * angle.sin(), 0.98 + 0.27 * row as f64, 0.8 * wide * angle.cos());
            builder.add(body, object("Patch", sphere(0.22), next()).at(at));
        }
    }
}

/// Beads from the first point to the second, each of its own material.
fn limb(builder: &mut SceneBuilder, body: NodeId, [from, to]: [[f64; 2]; 2], next: &mut impl FnMut() -> MaterialId) {
    for bead in 0..BEADS {
        let share = bead as f64 / (BEADS - 1) as f64;
        let [x, y] = [0, 1].map(|axis| from[axis] + (to[axis] - from[axis]) * share);
        let forward = 0.3 * share * (1.0 - share) + 0.12 * share;
        let size = 0.13 - 0.03 * (2.0 * share - 1.0).powi(2);
        builder.add(body, object("Bead", sphere(size), next()).at(v(x, y, forward)));
    }
}

fn head(builder: &mut SceneBuilder, figure: NodeId, next: &mut impl FnMut() -> MaterialId) {
    let skin = next();
    let face = builder.add(figure, blended("Head", Operator::Union, BlendKernel::Circular, 0.06));
    builder.add(face, object("Face", ellipsoid(0.3, 0.36, 0.3), skin).at(v(0.0, 2.18, 0.02)));
    builder.add(face, object("Nose", ellipsoid(0.07, 0.08, 0.14), next()).at(v(0.0, 2.16, 0.34)));
    let eye = next();
    for side in [-1.0, 1.0] {
        builder.add(face, object("Eye", sphere(0.05), eye).at(v(side * 0.12, 2.28, 0.27)));
        let horn = capsule([0.0; 3], [side * 0.42, 0.34, 0.0], 0.13);
        builder.add(face, object("Cap", horn, skin).at(v(side * 0.12, 2.45, -0.02)));
        builder.add(face, object("Bell", sphere(0.1), eye).at(v(side * 0.6, 2.84, -0.02)));
    }
    builder.add(figure, object("Ring", torus(0.27, 0.05), next()).at(v(0.0, 1.86, 0.0)));
    for point in 0..POINTS {
        let turn = turn_y(360.0 * point as f64 / POINTS as f64);
        let spike = object("Point", cone(0.11, 0.01, 0.3), next());
        builder.add(figure, spike.at(v(0.0, 1.82, 0.0) + turn * v(0.36, -0.02, 0.0)).rotated(turn * turn_z(-112.0)));
    }
}
