//! The golden sheet: every shape, each on its own tile. New shapes appear automatically.

use glam::{DQuat, DVec3};

use super::scene_builder::{SceneBuilder, cuboid, group, object, turn_x, turn_y, v};
use isolith_geometry::Aabb;
use isolith_scene::{Operator, Scene, ShapeKind};

/// Tiles per row.
const COLUMNS: usize = 7;
/// Distance between tiles, in meters.
const SPACING: f64 = 1.7;
/// Half the largest side of every shape, in meters.
const HALF: f64 = 0.6;

pub(super) fn scene() -> Scene {
    let mut builder = SceneBuilder::new([0.03, 0.045, 0.07], [0.10, 0.12, 0.15], [0.27, 0.29, 0.33]);
    let colors = [
        ("Coral", [0.80, 0.19, 0.10]),
        ("Amber", [0.80, 0.42, 0.06]),
        ("Leaf", [0.27, 0.50, 0.08]),
        ("Teal", [0.03, 0.36, 0.34]),
        ("Sky", [0.12, 0.36, 0.74]),
        ("Violet", [0.32, 0.17, 0.62]),
    ]
    .map(|(name, albedo)| builder.glossy(name, albedo, 0.3));
    let tile = builder.matte("Slate", [0.10, 0.11, 0.135]);
    let rows = ShapeKind::ALL.len().div_ceil(COLUMNS);
    for (index, &kind) in ShapeKind::ALL.iter().enumerate() {
        let (column, row) = (index % COLUMNS, index / COLUMNS);
        let x = SPACING * (column as f64 - 0.5 * (COLUMNS - 1) as f64);
        let z = SPACING * (row as f64 - 0.5 * (rows - 1) as f64);
        let name = format!("{} tile", kind.label());
        builder.add(None, object(&name, cuboid(1.5, 0.1, 1.5, 0.04), tile).at(v(x, -0.05, z)));
        add_shape(&mut builder, kind, colors[(column + 2 * row) % colors.len()], v(x, 0.0, z));
    }
    builder.sun("Key", [-0.65, 0.9, 0.6], [1.0, 0.95, 0.88], 0.95);
    builder.sun("Fill", [0.8, 0.5, 0.7], [0.72, 0.82, 1.0], 0.3);
    builder.sun("Rim", [0.4, 0.5, -1.0], [0.95, 0.97, 1.0], 0.5);
    builder.camera([0.0, 13.5, 11.0], [0.0, 0.0, 0.35], 46.0);
    builder.finish()
}

/// The shape with its default parameters, scaled to the size of the others, standing on its tile; a text leans back to
/// face the camera. An unbounded shape is intersected with a box.
fn add_shape(builder: &mut SceneBuilder, kind: ShapeKind, color: isolith_scene::MaterialId, at: DVec3) {
    let shape = kind.default_shape();
    let bounds = shape.bounds();
    if bounds.is_finite() {
        let scale = HALF / bounds.half().max_element();
        let turn = if kind == ShapeKind::Text { turn_x(-50.0) } else { DQuat::IDENTITY };
        let half = bounds.half() * scale;
        let rise: f64 = DVec3::AXES.iter().map(|axis| (turn * (*axis * half)).y.abs()).sum();
        let origin = at + DVec3::Y * rise - turn * (bounds.center() * scale);
        let node = object(kind.label(), shape, color).at(origin).rotated(turn).scaled(DVec3::splat(scale));
        builder.add(None, node);
        return;
    }
    let part = Aabb::new(bounds.min.max(DVec3::splat(-HALF)), bounds.max.min(DVec3::splat(HALF)));
    let foot = at - DVec3::Y * part.min.y;
    let cut = builder.add(None, group(kind.label(), Operator::Intersection).at(foot).rotated(turn_y(25.0)));
    let side = 1.7 * HALF;
    builder.add(cut, object(kind.label(), shape, color));
    builder.add(cut, object("Part", cuboid(side, 2.0 * HALF, side, 0.0), color));
}
