//! Lower bounds of the field of a fold.

use glam::DAffine3;

use super::arrays::Join;
use super::modifier_params::{TwistParams, params_of};
use super::operand::{Operand, Value};
use isolith_geometry::Aabb;
use isolith_scene::ModifierKind;

/// Bounds of the surface of a fold, and a lower bound of its field.
pub(super) struct LowerBound {
    /// Bounds of the surface.
    pub bounds: Aabb,
    /// The field is at least `bound_slope` times the distance to `cull_box`.
    pub cull_box: Aabb,
    /// See `cull_box`; 0 where unknown.
    pub bound_slope: f64,
    /// The bound of `cull_box` also holds for a cylinder of this radius around Y, which is less than what the corners
    /// of the box reach; infinite if no such cylinder is known.
    pub radius: f64,
}

/// Bounds of a fold, and a lower bound of its field as a box and a slope.
///
/// A blended union falls below its least operand by at most its thickening, and a row of them by at most their
/// support; a morph lies between its operands; an exclusive or is at least the union. Intersection, difference,
/// groove, engraving and paint never fall below the result that they join. A tongue falls below it by its height, a
/// pipe below both of its operands by its radius.
pub(super) fn fold_bounds(fold: &[Operand<'_>]) -> LowerBound {
    let first = &fold[0];
    let mut all = LowerBound::new(first.bounds, first.cull_box, first.bound_slope);
    let mut growth = 0.0_f64;
    for operand in &fold[1..] {
        match operand.join {
            Join::Union | Join::Xor | Join::Morph => {
                all.bounds = all.bounds.union(&operand.bounds);
                all.cull_box = all.cull_box.union(&operand.cull_box);
                all.bound_slope = all.bound_slope.min(operand.bound_slope);
                growth = growth.max((growth + operand.blend.thickening()).min(operand.blend.support()));
            }
            Join::Intersection => {
                all.bounds = all.bounds.expanded(growth).intersection(&operand.bounds);
                all.cull_box = lowered(&all.cull_box, all.bound_slope, growth);
                growth = 0.0;
                all.keep_smaller(operand.cull_box, operand.bound_slope);
            }
            Join::Pipe => {
                let radius = operand.detail[0];
                all.cull_box = lowered(&all.cull_box, all.bound_slope, growth + radius);
                growth = 0.0;
                let cull_box = lowered(&operand.cull_box, operand.bound_slope, radius);
                let held =
                    |cull_box: &Aabb, bound_slope: f64| if bound_slope > 0.0 { *cull_box } else { Aabb::EVERYTHING };
                all.bounds = held(&all.cull_box, all.bound_slope).intersection(&held(&cull_box, operand.bound_slope));
                all.keep_smaller(cull_box, operand.bound_slope);
            }
            Join::Tongue => {
                all.cull_box =
                    lowered(&all.cull_box, all.bound_slope, growth + operand.detail[1] + operand.blend.thickening());
                growth = 0.0;
                all.bounds = if all.bound_slope > 0.0 { all.bounds.union(&all.cull_box) } else { Aabb::EVERYTHING };
            }
            Join::ReverseDifference => {
                all = LowerBound::new(operand.bounds, operand.cull_box, operand.bound_slope);
                growth = 0.0;
            }
            Join::First | Join::Difference | Join::Groove | Join::Engrave | Join::Paint => {}
        }
    }
    let cull_box = lowered(&all.cull_box, all.bound_slope, growth);
    let bounds = all.bounds.expanded(growth);
    LowerBound {
        radius: radius_of(fold),
        ..LowerBound::new(bounds, cull_box, if cull_box.is_finite() { all.bound_slope } else { 0.0 })
    }
}

/// See [`LowerBound::radius`]: only a single twist fills a cylinder.
fn radius_of(fold: &[Operand<'_>]) -> f64 {
    match fold {
        [Operand { value: Value::Modified { kind: ModifierKind::Twist, local_from_world, modified, .. }, .. }]
            if *local_from_world == DAffine3::IDENTITY =>
        {
            params_of::<TwistParams, _>(&modified.rows).radius
        }
        _ => f64::INFINITY,
    }
}

impl LowerBound {
    /// A lower bound without a known cylinder.
    pub fn new(bounds: Aabb, cull_box: Aabb, bound_slope: f64) -> Self {
        Self { bounds, cull_box, bound_slope, radius: f64::INFINITY }
    }

    /// Both bounds hold; keeps the smaller box, which is the tighter one.
    fn keep_smaller(&mut self, cull_box: Aabb, bound_slope: f64) {
        if bound_slope > 0.0 && (self.bound_slope == 0.0 || cull_box.half().length() < self.cull_box.half().length()) {
            (self.cull_box, self.bound_slope) = (cull_box, bound_slope);
        }
    }
}

/// The box of a lower bound after the field is lowered by `by`.
fn lowered(cull_box: &Aabb, bound_slope: f64, by: f64) -> Aabb {
    cull_box.expanded(if bound_slope > 0.0 { by / bound_slope } else { 0.0 })
}
