//! Writes the fold of one component into the arrays, relative to the component's origin.

use glam::DVec3;

use super::arrays::*;
use super::operands::{Operand, Value, fold_bounds};
use crate::geometry::Aabb;
use crate::scene::{BlendKernel, MaterialId, Shape};

/// Appends the component's entries and returns its description.
pub(super) fn emit(
    flat: &mut FlatScene,
    operands: &[Operand<'_>],
    material: &mut dyn FnMut(&mut FlatScene, MaterialId) -> u32,
) -> Component {
    let bounds = fold_bounds(operands).bounds;
    let origin = origin_of(&bounds, operands);
    let first = flat.nodes.len();
    let numbers = flat.numbers.len().next_multiple_of(ROW_ALIGNMENT);
    flat.numbers.resize(numbers, [0.0; 4]);
    let mut stack = 0;
    for operand in operands {
        stack = stack.max(emit_operand(flat, operand, origin, material));
    }
    Component {
        first: first as u32,
        count: (flat.nodes.len() - first) as u32,
        numbers: numbers as u32,
        rows: (flat.numbers.len() - numbers) as u32,
        origin,
        bounds: bounds.translated(-origin),
        half_space: half_space(operands, origin),
        stack,
    }
}

/// The middle of the bounds; for what has no end, the middle of the first operand that has one, or
/// where the first operand stands. f32 is finest there.
fn origin_of(bounds: &Aabb, operands: &[Operand<'_>]) -> DVec3 {
    if bounds.is_finite() {
        return bounds.center();
    }
    if let Some(bounded) = operands.iter().find(|o| o.bounds.is_finite()) {
        return bounded.bounds.center();
    }
    match &operands[0].value {
        Value::Leaf { local_from_world, .. } => local_from_world.inverse().translation,
        Value::Fold(inner) => origin_of(bounds, inner),
    }
}

/// See [`Component::half_space`]: what begins with a plane and is only cut afterwards stays below it.
fn half_space(operands: &[Operand<'_>], origin: DVec3) -> Option<[f64; 4]> {
    let Value::Leaf { local_from_world, shape: Shape::Plane {}, .. } = &operands[0].value else { return None };
    if operands.iter().any(|o| o.join == Join::Union) {
        return None;
    }
    // The plane's inside is local y < 0.
    let row = local_from_world.matrix3.row(1);
    let length = row.length();
    let normal = row / length;
    Some([normal.x, normal.y, normal.z, local_from_world.transform_point3(origin).y / length])
}

/// Returns how many accumulators have to be put aside within the operand.
fn emit_operand(
    flat: &mut FlatScene,
    operand: &Operand<'_>,
    origin: DVec3,
    material: &mut dyn FnMut(&mut FlatScene, MaterialId) -> u32,
) -> u32 {
    let index = flat.nodes.len();
    let numbers = flat.numbers.len() as u32;
    let kernel = BlendKernel::ALL.iter().position(|k| *k == operand.blend.kernel).expect("ALL holds every kernel");
    let code = |what: u32| what | ((operand.join as u32) << 16) | ((kernel as u32) << 24);
    let support = operand.blend.support() as f32;
    flat.ids.push(operand.node.id);
    match &operand.value {
        Value::Leaf { local_from_world, distance_scale, shape, material: id } => {
            let material = material(flat, *id);
            flat.nodes.push(FlatNode { code: code(shape.kind() as u32), extent: 1, numbers, material });
            let m = &local_from_world.matrix3;
            let shift = local_from_world.transform_point3(origin);
            flat.numbers.push([support, *distance_scale as f32, 0.0, 0.0]);
            for row in 0..3 {
                let r = m.row(row);
                flat.numbers.push([r.x as f32, r.y as f32, r.z as f32, shift[row] as f32]);
            }
            let packed = shape.packed().map(|v| v as f32);
            let rows = shape.kind().rows();
            flat.numbers.extend(packed.chunks_exact(4).take(rows).map(|c| [c[0], c[1], c[2], c[3]]));
            0
        }
        Value::Fold(inner) => {
            flat.nodes.push(FlatNode { code: code(FlatNode::GROUP), extent: 0, numbers, material: 0 });
            let skippable = operand.slope > 0.0;
            let skip = operand.skip.translated(-origin);
            let (center, half) = if skippable { (skip.center(), skip.half()) } else { (DVec3::ZERO, DVec3::ZERO) };
            // Rounding to f32 must never make the box smaller.
            let half = half + (half + center.abs()) * 1e-6;
            let slope = if skippable { (operand.slope * (1.0 - 1e-6)) as f32 } else { 0.0 };
            flat.numbers.push([support, slope, 0.0, 0.0]);
            flat.numbers.push([center.x as f32, center.y as f32, center.z as f32, 0.0]);
            flat.numbers.push([half.x as f32, half.y as f32, half.z as f32, 0.0]);
            let mut stack = 0;
            for operand in inner {
                stack = stack.max(emit_operand(flat, operand, origin, material));
            }
            flat.nodes[index].extent = (flat.nodes.len() - index) as u32;
            stack + 1
        }
    }
}
