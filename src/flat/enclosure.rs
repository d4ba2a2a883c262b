//! What encloses a fold of operands.

use super::arrays::Join;
use super::operands::Operand;
use crate::geometry::Aabb;

/// What encloses a fold.
pub(super) struct Enclosure {
    /// Around its surface.
    pub bounds: Aabb,
    /// Its field is at least `slope` times the distance to `skip`.
    pub skip: Aabb,
    /// See `skip`; 0 where nothing is known.
    pub slope: f64,
}

/// Bounds of a fold, and the box and slope below which its field never falls.
///
/// A blended union falls below the least operand by at most its thickening, and a row of them by at
/// most their support; a morph lies between its operands; an exclusive or is at least the union. Intersection,
/// difference, groove, engraving and paint never fall below what they join. A tongue falls below it by its height, a
/// pipe below both of its operands by its radius.
pub(super) fn fold_bounds(fold: &[Operand<'_>]) -> Enclosure {
    let first = &fold[0];
    let mut all = Enclosure { bounds: first.bounds, skip: first.skip, slope: first.slope };
    let mut growth = 0.0_f64;
    for operand in &fold[1..] {
        match operand.join {
            Join::Union | Join::Xor | Join::Morph => {
                all.bounds = all.bounds.union(&operand.bounds);
                all.skip = all.skip.union(&operand.skip);
                all.slope = all.slope.min(operand.slope);
                growth = growth.max((growth + operand.blend.thickening()).min(operand.blend.support()));
            }
            Join::Intersection => {
                all.bounds = all.bounds.expanded(growth).intersection(&operand.bounds);
                all.skip = lowered(&all.skip, all.slope, growth);
                growth = 0.0;
                all.keep_smaller(operand.skip, operand.slope);
            }
            Join::Pipe => {
                let radius = operand.detail[0];
                all.skip = lowered(&all.skip, all.slope, growth + radius);
                growth = 0.0;
                let skip = lowered(&operand.skip, operand.slope, radius);
                let held = |skip: &Aabb, slope: f64| if slope > 0.0 { *skip } else { Aabb::EVERYTHING };
                all.bounds = held(&all.skip, all.slope).intersection(&held(&skip, operand.slope));
                all.keep_smaller(skip, operand.slope);
            }
            Join::Tongue => {
                all.skip = lowered(&all.skip, all.slope, growth + operand.detail[1] + operand.blend.thickening());
                growth = 0.0;
                all.bounds = if all.slope > 0.0 { all.bounds.union(&all.skip) } else { Aabb::EVERYTHING };
            }
            Join::Remainder => {
                all = Enclosure { bounds: operand.bounds, skip: operand.skip, slope: operand.slope };
                growth = 0.0;
            }
            Join::First | Join::Difference | Join::Groove | Join::Engrave | Join::Paint => {}
        }
    }
    let skip = lowered(&all.skip, all.slope, growth);
    let bounds = all.bounds.expanded(growth);
    Enclosure { bounds, skip, slope: if skip.is_finite() { all.slope } else { 0.0 } }
}

impl Enclosure {
    /// The field is at least what both boxes say; the smaller one says more.
    fn keep_smaller(&mut self, skip: Aabb, slope: f64) {
        if slope > 0.0 && (self.slope == 0.0 || skip.half().length() < self.skip.half().length()) {
            (self.skip, self.slope) = (skip, slope);
        }
    }
}

/// The box below which a field never falls, where it is lowered by `by`.
fn lowered(skip: &Aabb, slope: f64, by: f64) -> Aabb {
    skip.expanded(if slope > 0.0 { by / slope } else { 0.0 })
}
