//! Below what the field of a fold of operands never falls.

use super::arrays::Join;
use super::operand::Operand;
use crate::geometry::Aabb;

/// Where the surface of a fold is, and below what its field never falls.
pub(super) struct LowerBound {
    /// Around its surface.
    pub bounds: Aabb,
    /// Its field is at least `bound_slope` times the distance to `cull_box`.
    pub cull_box: Aabb,
    /// See `cull_box`; 0 where nothing is known.
    pub bound_slope: f64,
}

/// Bounds of a fold, and the box and slope below which its field never falls.
///
/// A blended union falls below the least operand by at most its thickening, and a row of them by at
/// most their support; a morph lies between its operands; an exclusive or is at least the union. Intersection,
/// difference, groove, engraving and paint never fall below what they join. A tongue falls below it by its height, a
/// pipe below both of its operands by its radius.
pub(super) fn fold_bounds(fold: &[Operand<'_>]) -> LowerBound {
    let first = &fold[0];
    let mut all = LowerBound { bounds: first.bounds, cull_box: first.cull_box, bound_slope: first.bound_slope };
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
                all =
                    LowerBound { bounds: operand.bounds, cull_box: operand.cull_box, bound_slope: operand.bound_slope };
                growth = 0.0;
            }
            Join::First | Join::Difference | Join::Groove | Join::Engrave | Join::Paint => {}
        }
    }
    let cull_box = lowered(&all.cull_box, all.bound_slope, growth);
    let bounds = all.bounds.expanded(growth);
    LowerBound { bounds, cull_box, bound_slope: if cull_box.is_finite() { all.bound_slope } else { 0.0 } }
}

impl LowerBound {
    /// The field is at least what both boxes say; the smaller one says more.
    fn keep_smaller(&mut self, cull_box: Aabb, bound_slope: f64) {
        if bound_slope > 0.0 && (self.bound_slope == 0.0 || cull_box.half().length() < self.cull_box.half().length()) {
            (self.cull_box, self.bound_slope) = (cull_box, bound_slope);
        }
    }
}

/// The box below which a field never falls, where it is lowered by `by`.
fn lowered(cull_box: &Aabb, bound_slope: f64, by: f64) -> Aabb {
    cull_box.expanded(if bound_slope > 0.0 { by / bound_slope } else { 0.0 })
}
