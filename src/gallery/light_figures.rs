//! The figures for soft shadow and for occlusion, of white matter: shapes that stand, float and lean under a wide sun; and
//! hollows, contacts and steps under light from everywhere.

use super::scene_builder::{
    SceneBuilder, cone, cuboid, cylinder, group, object, sphere, torus, turn_x, turn_y, turn_z, v,
};
use isolith_scene::{LightKind, MaterialId, Operator, Scene, Shadowing};

/// Steps of the stairs, and balls that touch.
const STEPS: usize = 5;
const BALLS: usize = 4;

pub(super) fn scene() -> Scene {
    let mut builder = SceneBuilder::new([0.42, 0.47, 0.55], [0.68, 0.68, 0.68], [0.52, 0.54, 0.58]);
    builder.shade(Shadowing::default());
    let white = builder.matte("White", [0.72, 0.71, 0.69]);
    builder.add(None, object("Floor", cuboid(14.0, 0.4, 10.0, 0.0), white).at(v(0.0, -0.2, 0.0)));
    soft_shadow(&mut builder, white);
    occlusion(&mut builder, white);
    let sun = LightKind::Sun { strength: 1.9, angle: 5.0 };
    builder.light("Sun", [[-0.8, 0.85, 0.5], [0.0; 3]], [1.0, 0.95, 0.87], sun);
    builder.camera([0.0, 4.6, 8.2], [0.0, 0.35, -0.2], 42.0);
    builder.finish()
}

/// The left half: penumbras that grow with the distance from what casts them.
fn soft_shadow(builder: &mut SceneBuilder, white: MaterialId) {
    builder.add(None, object("Floating ball", sphere(0.4), white).at(v(-3.0, 1.1, -0.6)));
    builder.add(None, object("Pillar", cuboid(0.35, 2.2, 0.35, 0.0), white).at(v(-2.2, 1.1, -2.2)));
    builder.add(None, object("Ring", torus(0.45, 0.1), white).at(v(-1.3, 0.55, 0.9)).rotated(turn_x(70.0)));
    let cone = object("Cone", cone(0.4, 0.0, 1.0), white);
    builder.add(None, cone.at(v(-3.0, 0.5, 1.4)));
    let plate = object("Plate", cuboid(1.1, 0.06, 1.1, 0.0), white);
    builder.add(None, plate.at(v(-0.7, 1.0, -1.6)).rotated(turn_z(24.0)));
}

/// The right half: what lies in hollows and at contacts is darker.
fn occlusion(builder: &mut SceneBuilder, white: MaterialId) {
    for step in 0..STEPS {
        let high = 0.22 * (step + 1) as f64;
        let block = cuboid(1.6, high, 0.36, 0.0);
        builder.add(None, object("Step", block, white).at(v(3.2, 0.5 * high, -0.6 - 0.36 * step as f64)));
    }
    for ball in 0..BALLS {
        builder.add(None, object("Ball", sphere(0.32), white).at(v(0.9 + 0.64 * ball as f64, 0.32, 1.7)));
    }
    builder.add(None, object("Top ball", sphere(0.32), white).at(v(1.22, 0.874, 1.7)));
    let bowl = builder.add(None, group("Bowl", Operator::Union).at(v(1.1, 0.0, -0.2)));
    builder.add(bowl, object("Rim", cylinder(0.75, 0.7, 0.08), white).at(v(0.0, 0.35, 0.0)));
    builder.add(bowl, object("Hollow", sphere(0.62), white).at(v(0.0, 0.78, 0.0)).subtracted());
    builder
        .add(None, object("Leaning", cuboid(0.3, 1.6, 0.3, 0.0), white).at(v(0.9, 0.72, -2.2)).rotated(turn_y(20.0)));
}
