//! The three blend kernels, column by column, at one radius: union, intersection, difference.

use super::scene_builder::{SceneBuilder, blended, cuboid, cylinder, object, v};
use isolith_scene::{BlendKernel, Operator, Scene};

/// One radius for all nine.
const RADIUS: f64 = 0.26;

pub(super) fn scene() -> Scene {
    let mut builder = SceneBuilder::new([0.02, 0.03, 0.05], [0.055, 0.065, 0.09], [0.22, 0.24, 0.29]);
    let columns = [
        (BlendKernel::Circular, [0.74, 0.30, 0.030], [0.50, 0.065, 0.030]),
        (BlendKernel::Quadratic, [0.27, 0.50, 0.075], [0.030, 0.27, 0.20]),
        (BlendKernel::Cubic, [0.13, 0.36, 0.72], [0.11, 0.085, 0.45]),
    ];
    let tray = builder.phong("Slate", [0.075, 0.085, 0.11], 0.08, 16.0);
    builder.add(None, object("Tray", cuboid(4.9, 0.3, 4.9, 0.12), tray).at(v(0.0, -0.13, 0.0)));
    for (column, (kernel, slab_color, post_color)) in columns.into_iter().enumerate() {
        let slab = builder.phong(&format!("{} slab", kernel.label()), slab_color, 0.3, 50.0);
        let post = builder.phong(&format!("{} post", kernel.label()), post_color, 0.3, 50.0);
        for (row, operator) in Operator::SETS[..3].iter().copied().enumerate() {
            let name = format!("{} {}", kernel.label(), operator.label().to_lowercase());
            let at = v((column as f64 - 1.0) * 1.55, 0.27, (row as f64 - 1.0) * 1.55);
            let cell = builder.add(None, blended(&name, operator, kernel, RADIUS).at(at));
            builder.add(cell, object("Slab", cuboid(1.15, 0.5, 1.15, 0.05), slab));
            let (radius, lift) = if operator == Operator::Intersection { (0.58, 0.0) } else { (0.24, 0.4) };
            builder.add(cell, object("Post", cylinder(radius, 0.9, 0.03), post).at(v(0.0, lift, 0.0)));
        }
    }
    builder.sun("Key", [-0.8, 0.75, 0.35], [1.0, 0.95, 0.88], 0.92);
    builder.sun("Fill", [0.7, 0.35, 0.9], [0.72, 0.82, 1.0], 0.30);
    builder.sun("Rim", [0.5, 0.4, -1.0], [0.9, 0.95, 1.0], 0.7);
    builder.camera([-0.9, 5.2, 5.9], [0.0, 0.0, 0.05], 39.0);
    builder.finish()
}
