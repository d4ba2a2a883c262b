//! A shell built by nesting: each group holds a rib and the next group, turned and scaled, 80 deep.
//!
//! The inner group is the first child everywhere. Evaluators then never need a stack entry, and depth costs nothing but
//! parameters.

use super::scene_builder::{SceneBuilder, blended, cylinder, group, object, sphere, torus, turn_y, turn_z, v};
use isolith_scene::{BlendKernel, Operator, Scene};

/// Number of nested groups.
pub const DEPTH: i32 = 80;
/// Rotation from one rib to the next, in degrees.
const TURN: f64 = 15.0;
/// Size of a rib relative to the one before.
const SHRINK: f64 = 0.9655;

pub(super) fn scene() -> Scene {
    let mut builder = SceneBuilder::new([0.02, 0.05, 0.07], [0.055, 0.125, 0.145], [0.28, 0.30, 0.33]);
    let stops = [[0.88, 0.72, 0.53], [0.85, 0.36, 0.15], [0.50, 0.085, 0.12], [0.16, 0.055, 0.26], [0.045, 0.16, 0.34]];
    let steps = 16;
    let tints: Vec<_> = (0..steps)
        .map(|i| {
            let at = f64::from(i) / f64::from(steps) * (stops.len() - 1) as f64;
            let (low, share) = (at as usize, at.fract());
            let mix = |c: usize| ((stops[low][c] * (1.0 - share) + stops[low + 1][c] * share) * 1e4).round() / 1e4;
            builder.phong(&format!("Nacre {}", i + 1), [mix(0), mix(1), mix(2)], 0.4, 50.0)
        })
        .collect();
    let stone = builder.phong("Stone", [0.20, 0.215, 0.22], 0.08, 16.0);

    let shell =
        builder.add(None, group("Shell", Operator::Union).at(v(0.0, 1.32, 0.0)).rotated(turn_y(-24.0) * turn_z(-62.0)));
    let mut levels = Vec::new();
    let mut parent = shell;
    for level in 0..DEPTH {
        let size = SHRINK.powi(level);
        // Blend radii are in world units, so they are scaled explicitly.
        let level_group = blended(&format!("Level {}", level + 1), Operator::Union, BlendKernel::Circular, 0.11 * size);
        let placed = if level == 0 {
            level_group
        } else {
            level_group.rotated(turn_z(TURN)).scaled(v(SHRINK, SHRINK, SHRINK)).at(v(0.0, 0.0, 0.028))
        };
        parent = builder.add(parent, placed);
        levels.push(parent);
    }
    // Added last, so that the inner group comes first among the children of each.
    for (level, id) in levels.into_iter().enumerate() {
        let tint = tints[(level * tints.len()) / DEPTH as usize];
        let rib = if level % 2 == 0 { 1.0 } else { 0.9 };
        builder.add(id, object("Rib", torus(0.31 * rib, 0.155), tint).at(v(1.0, 0.0, 0.0)));
    }

    let plinth = builder.add(None, blended("Plinth", Operator::Union, BlendKernel::Circular, 0.08));
    builder.add(plinth, object("Slab", cylinder(1.2, 0.2, 0.06), stone).at(v(0.0, -0.11, 0.0)));
    builder.add(plinth, object("Foot", cylinder(0.9, 0.2, 0.06), stone).at(v(0.0, 0.1, 0.0)));
    builder.add(None, object("Pearl", sphere(0.2), tints[0]).at(v(0.95, 0.2, 0.62)));

    builder.sun("Key", [-0.7, 0.8, 0.8], [1.0, 0.94, 0.85], 1.0);
    builder.sun("Fill", [0.9, 0.1, 0.6], [0.55, 0.80, 1.0], 0.35);
    builder.sun("Rim", [0.3, 0.7, -1.0], [1.0, 0.85, 0.7], 0.8);
    builder.camera([0.0, 1.95, 6.0], [0.0, 1.02, 0.0], 33.0);
    builder.finish()
}
