//! Every operator with every kernel.
//!
//! Rows from the back: union, intersection, difference, exclusive or; columns from the left: the kernels as
//! [`BlendKernel::ALL`] lists them. The row in front: pipe, groove, tongue, engraving, morph, paint, and a union
//! whose arms do not blend with its body.

use super::scene_builder::{SceneBuilder, capsule, cuboid, cylinder, object, sphere, turn_x, turn_z, v};
use isolith_scene::{Blend, BlendKernel, Group, MaterialId, Node, NodeId, NodeKind, Operator, Scene};

/// The blend radius of all cells.
const RADIUS: f64 = 0.26;
/// Distance between cells, in meters.
const PITCH: f64 = 1.35;

pub(super) fn scene() -> Scene {
    let mut builder = SceneBuilder::new([0.02, 0.03, 0.05], [0.055, 0.065, 0.09], [0.24, 0.26, 0.30]);
    let tray = builder.matte("Slate", [0.075, 0.085, 0.11]);
    builder.add(None, object("Tray", cuboid(9.8, 0.3, 7.1, 0.12), tray).at(v(0.0, -0.13, 0.0)));
    let slabs = [
        builder.coated("Amber", [0.74, 0.30, 0.030], 0.1),
        builder.coated("Lime", [0.27, 0.50, 0.075], 0.1),
        builder.coated("Sky", [0.13, 0.36, 0.72], 0.1),
        builder.coated("Rose", [0.66, 0.13, 0.22], 0.1),
    ];
    let post = builder.glossy("Ivory", [0.62, 0.58, 0.50], 0.35);
    for (row, operator) in Operator::SETS.into_iter().enumerate() {
        for (column, kernel) in BlendKernel::ALL.into_iter().enumerate() {
            let blend = Blend { steps: 3, ..Blend::new(kernel, RADIUS) };
            let name = format!("{} {}", kernel.label(), operator.label().to_lowercase());
            let cell = cell(&mut builder, &name, Group::new(operator, blend), column, row);
            builder.add(cell, object("Slab", cuboid(0.95, 0.42, 0.95, 0.0), slabs[row]));
            let (radius, lift) = if operator == Operator::Intersection { (0.49, 0.0) } else { (0.2, 0.34) };
            builder.add(cell, object("Post", cylinder(radius, 0.76, 0.0), post).at(v(0.0, lift, 0.0)));
        }
    }
    for (column, operator) in Operator::ALL[Operator::SETS.len()..].iter().copied().enumerate() {
        let radius = if operator == Operator::Paint { 0.03 } else { 0.04 };
        let blend = Blend::new(BlendKernel::Circular, radius);
        let group = Group { width: 0.14, depth: 0.1, share: 0.5, ..Group::new(operator, blend) };
        let cell = cell(&mut builder, operator.label(), group, column, Operator::SETS.len());
        builder.add(cell, object("Block", cuboid(0.85, 0.6, 0.85, 0.05), slabs[2]).at(v(0.0, 0.09, 0.0)));
        builder.add(cell, object("Ball", sphere(0.42), slabs[0]).at(v(0.1, 0.42, 0.16)));
    }
    body(&mut builder, slabs[3]);
    builder.sun("Key", [-0.8, 0.75, 0.35], [1.0, 0.95, 0.88], 0.92);
    builder.sun("Fill", [0.7, 0.35, 0.9], [0.72, 0.82, 1.0], 0.30);
    builder.sun("Rim", [0.5, 0.4, -1.0], [0.9, 0.95, 1.0], 0.7);
    builder.camera([-0.9, 9.6, 8.6], [0.0, -0.1, 0.2], 50.0);
    builder.finish()
}

/// A group at its cell of the sheet.
fn cell(builder: &mut SceneBuilder, name: &str, group: Group, column: usize, row: usize) -> NodeId {
    let at = v((column as f64 - 3.0) * PITCH, 0.23, (row as f64 - 2.0) * PITCH);
    builder.add(None, Node::new(name, NodeKind::Group(group)).at(at))
}

/// A body with two arms that touch it: they blend with the shoulders, but not with the body.
fn body(builder: &mut SceneBuilder, material: MaterialId) {
    let blend = Blend::new(BlendKernel::Quadratic, 0.16);
    let cell = cell(builder, "Kept apart", Group::new(Operator::Union, blend), 6, 4);
    let trunk = object("Body", capsule([0.0, -0.2, 0.0], [0.0, 0.35, 0.0], 0.22), material);
    let trunk = builder.add(cell, trunk);
    builder.add(cell, object("Shoulders", capsule([-0.26, 0.6, 0.0], [0.26, 0.6, 0.0], 0.12), material));
    for (side, name) in [(-1.0, "Left arm"), (1.0, "Right arm")] {
        let mut arm = object(name, capsule([0.0, -0.6, 0.0], [0.0, 0.0, 0.0], 0.1), material)
            .at(v(side * 0.36, 0.52, 0.0))
            .rotated(turn_z(side * -5.0) * turn_x(-4.0));
        arm.apart = vec![trunk];
        builder.add(cell, arm);
    }
}
