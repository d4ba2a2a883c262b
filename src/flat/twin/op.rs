//! The operators.
//!
//! Beyond |a − b| ≥ support an operator is exactly hard; support 0 is hard everywhere.

use super::Real;
use crate::flat::Join;

/// Two operands joined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joined<T> {
    /// The value.
    pub value: T,
    /// How much the value follows the second operand, 0 to 1: the size of its derivative, and the
    /// second operand's share of the material. The first has the rest.
    pub weight: f64,
}

/// The operand `b` joins what stands so far, `a`, by a [`Join`] given as its number.
pub fn op_join<T: Real>(join: u32, a: T, b: T, support: f64, kernel: u32) -> Joined<T> {
    const UNION: u32 = Join::Union as u32;
    const INTERSECTION: u32 = Join::Intersection as u32;
    const DIFFERENCE: u32 = Join::Difference as u32;
    match join {
        UNION => op_union(a, b, support, kernel),
        INTERSECTION => op_intersection(a, b, support, kernel),
        DIFFERENCE => op_difference(a, b, support, kernel),
        _ => Joined { value: b, weight: 1.0 },
    }
}

/// What is in `a` or in `b`.
pub fn op_union<T: Real>(a: T, b: T, support: f64, kernel: u32) -> Joined<T> {
    let b_is_less = b.value() < a.value();
    let (less, greater) = if b_is_less { (b, a) } else { (a, b) };
    let Joined { value: blend, weight } = op_blend(greater - less, support, kernel);
    Joined { value: less - blend, weight: if b_is_less { 1.0 - weight } else { weight } }
}

/// What is in `a` and in `b`.
pub fn op_intersection<T: Real>(a: T, b: T, support: f64, kernel: u32) -> Joined<T> {
    let joined = op_union(-a, -b, support, kernel);
    Joined { value: -joined.value, ..joined }
}

/// What is in `a` and not in `b`.
pub fn op_difference<T: Real>(a: T, b: T, support: f64, kernel: u32) -> Joined<T> {
    let joined = op_union(-a, b, support, kernel);
    Joined { value: -joined.value, ..joined }
}

/// What a blend takes from the lesser of two operands that differ by `difference`, and the weight of
/// the greater. Kernels: Quilez, "smooth minimum", scaled by their supports to one thickening.
fn op_blend<T: Real>(difference: T, support: f64, kernel: u32) -> Joined<T> {
    if difference.value() >= support {
        return Joined { value: T::constant(0.0), weight: 0.0 };
    }
    let h = T::constant(1.0) - difference * support.recip();
    match kernel {
        0 => {
            let root = (h * (T::constant(2.0) - h) + 1.0_f64).sqrt();
            let weight = 0.5 * (1.0 - (1.0 - h.value()) / root.value());
            Joined { value: (h + 1.0_f64 - root) * (0.5 * support), weight }
        }
        1 => Joined { value: h.squared() * (0.25 * support), weight: 0.5 * h.value() },
        _ => Joined { value: h.squared() * h * (support / 6.0), weight: 0.5 * h.value() * h.value() },
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::flat::twin::Dual;

    #[test]
    fn the_weight_is_the_derivative_by_the_second_operand() {
        let a = Dual { v: 0.3, d: DVec3::X };
        for kernel in 0..3 {
            for join in 1..4 {
                for b in [-1.0, -0.35, -0.3, 0.0, 0.1, 0.29, 0.31, 0.6, 2.0] {
                    let joined = op_join(join, a, Dual { v: b, d: DVec3::Y }, 0.7, kernel);
                    assert!((joined.value.d.y.abs() - joined.weight).abs() < 1e-12, "{join} {kernel} {b}");
                    assert!((joined.value.d.x.abs() - (1.0 - joined.weight)).abs() < 1e-12, "{join} {kernel} {b}");
                }
            }
        }
    }

    #[test]
    fn tiny_and_zero_supports_are_finite() {
        for support in [0.0, f64::MIN_POSITIVE, 1e-300] {
            for (a, b) in [(0.0, 0.0), (1.0, 1.0), (1e6, -1e6)] {
                for kernel in 0..3 {
                    let joined = op_union(a, b, support, kernel);
                    assert!(joined.value.is_finite() && (0.0..=1.0).contains(&joined.weight));
                }
            }
        }
    }
}
