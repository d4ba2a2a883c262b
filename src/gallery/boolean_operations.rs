//! Union, intersection and difference of the same box and sphere: hard behind, blended in front.

use super::scene_builder::{SceneBuilder, blended, cuboid, cylinder, group, object, sphere, turn_y, v};
use isolith_scene::{BlendKernel, MaterialId, Operator, Scene};

pub(super) fn scene() -> Scene {
    let mut builder = SceneBuilder::new([0.05, 0.10, 0.16], [0.16, 0.215, 0.26], [0.28, 0.30, 0.34]);
    let cube = builder.coated("Teal", [0.05, 0.46, 0.48], 0.06);
    let ball = builder.glossy("Coral", [0.82, 0.17, 0.085], 0.3);
    let plinth = builder.matte("Plaster", [0.47, 0.45, 0.42]);

    let stand = builder.add(None, blended("Stand", Operator::Union, BlendKernel::Circular, 0.06));
    builder.add(stand, object("Lower step", cuboid(5.6, 0.3, 3.7, 0.08), plinth).at(v(0.0, -0.15, 0.0)));
    builder.add(stand, object("Upper step", cuboid(5.6, 0.62, 1.75, 0.08), plinth).at(v(0.0, 0.31, -0.975)));
    for (column, operator) in Operator::SETS[..3].iter().copied().enumerate() {
        let x = (column as f64 - 1.0) * 1.75;
        let hard = group(operator.label(), operator);
        let smooth =
            blended(&format!("Blended {}", operator.label().to_lowercase()), operator, BlendKernel::Circular, 0.09);
        for (node, y, z, turn) in [(hard, 0.62, -0.95, 34.0), (smooth, 0.0, 0.9, 34.0)] {
            builder.add(None, object("Disc", cylinder(0.62, 0.08, 0.03), plinth).at(v(x, y + 0.04, z)));
            let node = builder.add(None, node.at(v(x, y + 0.74, z)).rotated(turn_y(turn)));
            add_operands(&mut builder, node, [cube, ball]);
        }
    }
    builder.sun("Key", [-0.6, 0.85, 0.75], [1.0, 0.95, 0.87], 0.95);
    builder.sun("Fill", [0.9, 0.3, 0.5], [0.70, 0.82, 1.0], 0.28);
    builder.sun("Rim", [0.5, 0.6, -0.9], [1.0, 0.97, 0.92], 0.5);
    builder.camera([0.0, 4.1, 7.4], [0.0, 0.42, 0.0], 34.0);
    builder.finish()
}

/// The sphere reaches past the faces of the box, but not to its edges.
fn add_operands(builder: &mut SceneBuilder, group: isolith_scene::NodeId, [cube, ball]: [MaterialId; 2]) {
    builder.add(group, object("Box", cuboid(0.92, 0.92, 0.92, 0.0), cube));
    builder.add(group, object("Sphere", sphere(0.56), ball));
}
