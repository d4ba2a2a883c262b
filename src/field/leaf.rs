//! A placed shape as an operand.

use std::rc::Rc;

use glam::{DAffine3, DMat3, DVec3};

use super::lower_bound::LowerBound;
use super::operand::{Operand, Value};
use super::prepare::PreparedShape;
use isolith_geometry::singular_values;
use isolith_scene::{Node, Object, Shape};

/// The shape of a node as an operand, still to be joined. `drawn` is the prepared shape if it has a payload and an
/// earlier copy made it.
pub(super) fn leaf<'a>(
    node: &'a Node,
    outermost: &'a Node,
    world_from_local: &DAffine3,
    object: &Object,
    drawn: Option<Rc<PreparedShape>>,
) -> Operand<'a> {
    let Object { shape, material } = object;
    let (shape, mut world_from_local, least, greatest) = normalize(shape, world_from_local);
    if least == 1.0 && matches!(shape, Shape::Sphere { .. }) {
        // A sphere looks the same from every side: without a rotation its kernel is shorter.
        world_from_local.matrix3 = DMat3::IDENTITY;
    }
    let prepared = drawn.unwrap_or_else(|| Rc::new(PreparedShape::new(&shape)));
    let bounds = prepared.bounds.transformed(&world_from_local);
    let bound_slope = if bounds.is_finite() { least / greatest } else { 0.0 };
    let local_from_world = world_from_local.inverse();
    let value =
        Value::Leaf { local_from_world, distance_scale: least, prepared, material: *material, object_from_world: None };
    Operand::first(node, outermost, LowerBound::new(bounds, bounds, bound_slope), value)
}

/// Moves the scale of the transform into the shape if the shape can absorb it. Returns the least and greatest stretch
/// of the remaining transform: 1 and 1 in that case.
fn normalize(shape: &Shape, world_from_local: &DAffine3) -> (Shape, DAffine3, f64, f64) {
    let m = &world_from_local.matrix3;
    let scale = DVec3::new(m.x_axis.length(), m.y_axis.length(), m.z_axis.length());
    let skew = (m.x_axis.dot(m.y_axis).abs() / (scale.x * scale.y))
        .max(m.x_axis.dot(m.z_axis).abs() / (scale.x * scale.z))
        .max(m.y_axis.dot(m.z_axis).abs() / (scale.y * scale.z));
    if skew < 1e-12 {
        // Factors that differ only by the rounding of chained rotations count as one factor.
        let mean = (scale.x + scale.y + scale.z) / 3.0;
        let scale = if (scale - mean).abs().max_element() < 1e-12 * mean { DVec3::splat(mean) } else { scale };
        if let Some(absorbed) = shape.absorb_scale(scale) {
            let rotation = DMat3::from_cols(m.x_axis / scale.x, m.y_axis / scale.y, m.z_axis / scale.z);
            return (absorbed, DAffine3 { matrix3: rotation, ..*world_from_local }, 1.0, 1.0);
        }
        return (shape.clone(), *world_from_local, scale.min_element(), scale.max_element());
    }
    let (least, greatest) = singular_values(m);
    (shape.clone(), *world_from_local, least, greatest)
}
