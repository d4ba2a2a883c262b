//! A chart of materials: roughness against metalness, coats of growing roughness, and emission of growing strength.

use super::scene_builder::{SceneBuilder, cuboid, group, object, sphere, v};
use isolith_scene::{Material, MaterialId, Operator, Scene};

/// Balls in a row.
const COLUMNS: u32 = 6;
/// Radius of a ball, and distance between the middles of two.
const BALL: f64 = 0.42;
const SPACING: f64 = 1.0;

pub(super) fn scene() -> Scene {
    let mut builder = SceneBuilder::new([0.10, 0.15, 0.24], [0.42, 0.40, 0.38], [0.30, 0.31, 0.33]);
    let base = Material::new(MaterialId(0), "", [0.92, 0.55, 0.26]);
    for (row, metalness) in [0.0, 0.5, 1.0].into_iter().enumerate() {
        add_row(&mut builder, row, &format!("Metalness {metalness}"), |share| Material {
            base_metalness: metalness,
            specular_roughness: share,
            ..base.clone()
        });
    }
    add_row(&mut builder, 3, "Coat", |share| Material {
        base_color: [0.03, 0.10, 0.36],
        specular_roughness: 0.6,
        coat_weight: 1.0,
        coat_roughness: thousandths(share * 0.6),
        ..base.clone()
    });
    add_row(&mut builder, 4, "Emission", |share| Material {
        base_color: [0.08, 0.03, 0.02],
        emission_color: [1.0, 0.34, 0.08],
        emission_luminance: thousandths(share * 1.2),
        ..base.clone()
    });
    let wall = builder.matte("Wall", [0.15, 0.155, 0.165]);
    let size = cuboid(f64::from(COLUMNS) * SPACING + 0.5, 5.0 * SPACING + 0.5, 0.2, 0.08);
    builder.add(None, object("Wall", size, wall).at(v(0.0, 0.0, -0.62)));
    builder.sun("Key", [-0.7, 0.9, 1.0], [1.0, 0.95, 0.88], 1.1);
    builder.sun("Fill", [1.0, 0.15, 0.6], [0.60, 0.76, 1.0], 0.35);
    builder.sun("Rim", [0.5, 0.7, -0.35], [1.0, 0.9, 0.8], 0.6);
    builder.camera([0.0, 0.0, 11.6], [0.0, 0.0, 0.0], 30.0);
    builder.finish()
}

/// The number as a file should show it.
fn thousandths(value: f64) -> f64 {
    (value * 1e3).round() / 1e3
}

/// A row of balls; `material` gets their place in it, from 0 to 1.
fn add_row(builder: &mut SceneBuilder, row: usize, name: &str, material: impl Fn(f64) -> Material) {
    let balls = builder.add(None, group(name, Operator::Union));
    for column in 0..COLUMNS {
        let share = f64::from(column) / f64::from(COLUMNS - 1);
        let label = format!("{name}, {share}");
        let id = builder.material(Material { name: label.clone(), ..material(share) });
        let x = (f64::from(column) - f64::from(COLUMNS - 1) * 0.5) * SPACING;
        builder.add(balls, object(&label, sphere(BALL), id).at(v(x, (2.0 - row as f64) * SPACING, 0.0)));
    }
}
