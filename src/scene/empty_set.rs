//! The empty set as an operand. Its field is infinite everywhere, and every rule here follows from that.
//!
//! Empty are: a visible group without children, or whose children are all hidden or empty; a text that draws no letter;
//! a shape whose size is 0 along every axis, unless a modifier thickens it. Hidden nodes are not empty: the fold leaves
//! them out ([`Operator::needs_first`] has the one exception). It also leaves out groups that hold only lights, cameras
//! and meshes.

use super::{Modifier, Operator, Shape};
use isolith_geometry::Aabb;

/// The result of joining `a` with `b` if at least one of them is the empty set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EmptyOperandResult {
    /// The empty set.
    Nothing,
    /// `a`, unchanged.
    First,
    /// `b`, unchanged.
    Second,
}

impl Operator {
    /// The result of joining `a` with `b` if one of them is the empty set: `is_first` says that only `a` is present,
    /// otherwise only `b` is. `share` is that of [`super::Group::share`].
    ///
    /// A morph is (1 − share) a + share b: infinite wherever the empty set has a nonzero share.
    pub fn with_nothing(self, share: f64, is_first: bool) -> EmptyOperandResult {
        match (self, is_first) {
            (Self::Union | Self::Xor, false) => EmptyOperandResult::Second,
            (Self::Intersection | Self::Pipe, _) => EmptyOperandResult::Nothing,
            (Self::Morph, true) if share == 0.0 => EmptyOperandResult::First,
            (Self::Morph, false) if share == 1.0 => EmptyOperandResult::Second,
            (Self::Morph, _) | (_, false) => EmptyOperandResult::Nothing,
            (_, true) => EmptyOperandResult::First,
        }
    }

    /// Whether the later children are tools that work on the first one. If the first child is hidden, the whole group
    /// is hidden: as in other programs, hiding the workpiece never shows the cutter in its place. The children of all
    /// other operators have equal parts, so a hidden one is left out and the others stay.
    pub fn needs_first(self) -> bool {
        matches!(self, Self::Difference | Self::Groove | Self::Tongue | Self::Engrave | Self::Paint)
    }
}

impl Shape {
    /// Whether the shape has no interior and its surface is at most a point. `bounds` are the shape's own bounds.
    pub fn is_point(bounds: &Aabb) -> bool {
        bounds.is_empty() || bounds.min == bounds.max
    }

    /// Whether the shape is a text that draws no letter: blanks only, or letters that its font does not draw. No
    /// modifier makes it non-empty.
    pub fn is_blank(&self, bounds: &Aabb) -> bool {
        let is_line = bounds.min.x == bounds.max.x && bounds.min.y == bounds.max.y;
        matches!(self, Self::Text { .. }) && (is_line || bounds.is_empty())
    }
}

impl Modifier {
    /// Whether the modifier can give a point an interior, by growing it or by drawing it apart.
    pub fn thickens(&self) -> bool {
        matches!(
            self,
            Self::Elongate { .. }
                | Self::Round { .. }
                | Self::Onion { .. }
                | Self::Waves { .. }
                | Self::Noise { .. }
                | Self::Displacement { .. }
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The formula of each operator on numbers, without a blend, with a very large field for the empty set.
    fn join(operator: Operator, a: f64, b: f64, share: f64) -> f64 {
        let (half, depth) = (0.05, 0.1);
        match operator {
            Operator::Union => a.min(b),
            Operator::Intersection => a.max(b),
            Operator::Difference => a.max(-b),
            Operator::Xor => a.min(b).max(-a.max(b)),
            Operator::Pipe => a.hypot(b) - half,
            Operator::Groove => a.max(-(-a - depth).max(b.abs() - half)),
            Operator::Tongue => a.min((a - depth).max(b.abs() - half)),
            Operator::Engrave => a.max((a + depth - b.abs()) * 0.5),
            Operator::Morph => a * (1.0 - share) + b * share,
            Operator::Paint => a,
        }
    }

    #[test]
    fn what_is_left_follows_from_the_formulas() {
        const FAR: f64 = 1e12;
        for operator in Operator::ALL {
            for share in [0.0, 0.3, 1.0] {
                for there in [-0.2, 0.3] {
                    for is_first in [true, false] {
                        let (a, b) = if is_first { (there, FAR) } else { (FAR, there) };
                        let value = join(operator, a, b, share);
                        match operator.with_nothing(share, is_first) {
                            EmptyOperandResult::Nothing => {
                                assert!(value > 1e9, "{operator:?} {share} {is_first}: {value}")
                            }
                            EmptyOperandResult::First => {
                                assert!(is_first && value == there, "{operator:?} {share}: {value}")
                            }
                            EmptyOperandResult::Second => {
                                assert!(!is_first && value == there, "{operator:?} {share}: {value}")
                            }
                        }
                    }
                }
            }
        }
    }
}
