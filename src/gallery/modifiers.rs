//! The sheet of all modifiers: one on each stand, in the order of their list, row by row from the left.

use super::scene_builder::{
    SceneBuilder, blended, capsule, cuboid, cylinder, group, object, sphere, torus, turn_x, turn_z, v,
};
use isolith_scene::{
    Attachment, Axis, BlendKernel, MaterialId, Modifier, ModifierKind, NodeId, Operator, Scene, Shape,
};

/// Stands in a row.
const COLUMNS: usize = 4;
/// Distance between stands, in meters.
const SPACING: f64 = 1.9;

pub(super) fn scene() -> Scene {
    let mut builder = SceneBuilder::new([0.30, 0.36, 0.42], [0.52, 0.54, 0.55], [0.34, 0.36, 0.40]);
    let clay = builder.glossy("Clay", [0.62, 0.24, 0.13], 0.42);
    let slate = builder.glossy("Slate", [0.10, 0.22, 0.32], 0.32);
    let floor = builder.matte("Floor", [0.20, 0.21, 0.22]);
    let stand_material = builder.matte("Stands", [0.42, 0.41, 0.40]);
    builder.add(None, object("Floor", Shape::Plane {}, floor));
    for (index, kind) in ModifierKind::ALL.iter().enumerate() {
        let (column, row) = (index % COLUMNS, index / COLUMNS);
        let at = v((column as f64 - 1.5) * SPACING, 0.0, (row as f64 - 1.5) * SPACING);
        builder.add(None, object("Stand", cylinder(0.8, 0.06, 0.02), stand_material).at(at + v(0.0, 0.03, 0.0)));
        let stand = builder.add(None, group(kind.label(), Operator::Union).at(at + v(0.0, 0.06, 0.0)));
        add(&mut builder, stand, *kind, [clay, slate]);
    }
    builder.sun("Key", [-0.5, 1.0, 0.7], [1.0, 0.95, 0.88], 0.95);
    builder.sun("Fill", [0.9, 0.5, 0.4], [0.75, 0.85, 1.0], 0.3);
    builder.camera([0.0, 9.6, 11.9], [0.0, 0.2, 0.4], 32.0);
    builder.finish()
}

fn add(builder: &mut SceneBuilder, stand: NodeId, kind: ModifierKind, [clay, slate]: [MaterialId; 2]) {
    let mut put = |node| builder.add(stand, node);
    match kind {
        ModifierKind::Mirror => {
            let modifier = Modifier::Mirror { axes: [true, false, false], blend: 0.12 };
            let half = put(blended("Half", Operator::Union, BlendKernel::Circular, 0.06).modified(modifier));
            builder.add(half, object("Arm", capsule([0.12, 0.2, 0.0], [0.5, 0.75, 0.0], 0.1), clay));
            builder.add(half, object("Foot", sphere(0.19), slate).at(v(0.16, 0.19, 0.0)));
        }
        ModifierKind::Repeat => {
            put(object("Posts", cuboid(0.2, 0.5, 0.2, 0.03), clay).at(v(-0.42, 0.25, -0.42)).modified(grid()));
        }
        ModifierKind::Polar => {
            let modifier = Modifier::Polar { count: 9, radius: 0.5, mirrored: false };
            put(object("Ring", cuboid(0.1, 0.5, 0.22, 0.03), clay).at(v(0.0, 0.25, 0.0)).modified(modifier));
        }
        ModifierKind::Recursion => {
            put(object("Tree", capsule([0.0; 3], [0.0, 0.42, 0.0], 0.07), clay).modified(branches()));
        }
        ModifierKind::Twist => {
            let twist = Modifier::Twist { angle: 150.0 };
            put(object("Bar", cuboid(0.36, 1.0, 0.36, 0.03), clay).at(v(0.0, 0.5, 0.0)).modified(twist));
        }
        ModifierKind::Bend => {
            let node = group("Bow", Operator::Union).at(v(0.0, 0.75, 0.0)).modified(Modifier::Bend { angle: -110.0 });
            let bow = put(node);
            builder.add(bow, object("Rod", cuboid(1.6, 0.16, 0.16, 0.03), clay));
            for x in [-0.6, -0.2, 0.2, 0.6] {
                builder.add(bow, object("Ring", torus(0.15, 0.04), slate).at(v(x, 0.0, 0.0)).rotated(turn_z(90.0)));
            }
        }
        ModifierKind::Taper => {
            let taper = Modifier::Taper { change: -0.9 };
            let node = object("Obelisk", cuboid(0.6, 1.0, 0.6, 0.03), clay).at(v(0.0, 0.5, 0.0));
            put(node.modified(taper));
        }
        ModifierKind::Elongate => {
            let elongate = Modifier::Elongate { length: [0.5, 0.0, 0.2] };
            let node = object("Chain link", torus(0.22, 0.09), clay).at(v(0.0, 0.4, 0.0)).rotated(turn_x(65.0));
            put(node.modified(elongate));
        }
        ModifierKind::Round => {
            let round = Modifier::Round { radius: 0.08 };
            let frame = Shape::BoxFrame { size: [0.6; 3], thickness: 0.05 };
            put(object("Soft frame", frame, clay).at(v(0.0, 0.4, 0.0)).modified(round));
        }
        ModifierKind::Onion => {
            let onion = Modifier::Onion { thickness: 0.04, walls: 3, spacing: 0.12 };
            let cut = put(group("Cut open", Operator::Difference).at(v(0.0, 0.52, 0.0)));
            builder.add(cut, object("Ball", sphere(0.48), clay).modified(onion));
            builder.add(cut, object("Knife", cuboid(1.2, 1.2, 1.2, 0.0), slate).at(v(0.6, 0.6, 0.6)));
        }
        ModifierKind::Waves => {
            let waves = Modifier::Waves { amplitude: 0.05, length: 0.3, phase: 0.0 };
            put(object("Burr", sphere(0.45), clay).at(v(0.0, 0.5, 0.0)).modified(waves));
        }
        ModifierKind::Noise => {
            let noise = Modifier::Noise { amplitude: 0.12, size: 0.3, octaves: 3, seed: 4 };
            put(object("Rock", sphere(0.45), clay).at(v(0.0, 0.46, 0.0)).modified(noise));
        }
        ModifierKind::Displacement => {
            let image = Attachment::drawn("bricks.png", [QUARTER[0], 2 * QUARTER[1]], bricks);
            let bricks = Modifier::Displacement { image, height: 0.05, tile: 0.15, axis: Axis::Z };
            let node = object("Wall", cuboid(1.0, 0.8, 0.2, 0.02), clay).at(v(0.0, 0.45, 0.0));
            put(node.rotated(turn_x(-25.0)).modified(bricks));
        }
    }
}

/// Rows and columns of turned copies around a hole.
fn grid() -> Modifier {
    Modifier::Repeat {
        counts: [3, 1, 3],
        spacing: [0.42, 1.0, 0.42],
        offset: [0.0; 3],
        turn: 15.0,
        mirrored: [false; 3],
        carve_from: [1, 0, 1],
        carve_to: [2, 1, 2],
    }
}

/// A branching recursion: two smaller copies at the end of each branch.
fn branches() -> Modifier {
    Modifier::Recursion {
        count: 6,
        offset: [0.0, 0.42, 0.0],
        rotation: [0.0, 50.0, 35.0],
        scale: 0.72,
        mirrored: [true, false, false],
    }
}

/// Width and height of a quarter of a brick with its mortar, in pixels.
const QUARTER: [u32; 2] = [16, 6];

/// The lower right quarter of a brick over the upper left one of another: its mirrored tiles form a wall.
fn bricks(x: u32, y: u32) -> u8 {
    let [width, height] = QUARTER;
    let from_joints = if y < height { [width - 1 - x, height - 1 - y] } else { [x, y - height] };
    // The slope of a brick up to its flat top.
    from_joints.map(|pixels| pixels.min(4)).iter().product::<u32>() as u8 * 15
}
