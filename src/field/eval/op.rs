//! The operators.
//!
//! Beyond |a − b| ≥ support, union, intersection and difference are exactly hard; support 0 is hard everywhere. The
//! absolute derivatives of every operator sum to at most 1: where its operands are safe to step by, its result is
//! too.

use std::f64::consts::FRAC_1_SQRT_2;

use super::Real;
use crate::{Join, ParamRow};

/// The result of joining two operands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlendResult<T> {
    /// The value.
    pub value: T,
    /// Its derivative by the first operand.
    pub by_a: f64,
    /// Its derivative by the second operand.
    pub by_b: f64,
    /// The second operand's weight in the material, 0 to 1; the first has the remainder.
    pub weight: f64,
}

/// The parameters of a blend: the content of the first [`ParamRow`] of the joining operand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlendParams {
    /// Support of the blend in meters; for paint, half the width of the soft edge.
    pub support: f64,
    /// The number of steps of the kernel; for pipes, grooves and tongues half their width in meters.
    pub size: f64,
    /// Depth or height in meters; for a morph the second operand's fraction.
    pub depth: f64,
}

impl BlendParams {
    /// A blend without steps.
    pub fn blend(support: f64) -> Self {
        Self { support, size: 1.0, depth: 0.0 }
    }

    /// Reads the parameters from the first row of an operand.
    pub fn read(row: &ParamRow) -> Self {
        Self { support: row[0].into(), size: row[2].into(), depth: row[3].into() }
    }
}

/// Joins the operand `b` to the accumulator `a` by a [`Join`] given as its number.
pub fn op_join<T: Real>(join: u32, a: T, b: T, blend_params: &BlendParams, kernel: u32) -> BlendResult<T> {
    match Join::ALL[join as usize] {
        Join::First => BlendResult { value: b, by_a: 0.0, by_b: 1.0, weight: 1.0 },
        Join::Union => op_union(a, b, blend_params, kernel),
        Join::Intersection => op_intersection(a, b, blend_params, kernel),
        Join::Difference => op_difference(a, b, blend_params, kernel),
        Join::Xor => op_xor(a, b, blend_params, kernel),
        Join::Pipe => op_pipe(a, b, blend_params.size),
        Join::Groove => op_groove(-1.0, a, b, blend_params, kernel),
        Join::Tongue => op_groove(1.0, a, b, blend_params, kernel),
        Join::Engrave => op_engrave(a, b, blend_params, kernel),
        Join::Morph => {
            let share = blend_params.depth;
            BlendResult { value: a * (1.0 - share) + b * share, by_a: 1.0 - share, by_b: share, weight: share }
        }
        Join::Paint => {
            BlendResult { value: a, by_a: 1.0, by_b: 0.0, weight: op_paint(b.value(), blend_params.support) }
        }
        Join::ReverseDifference => {
            let joined = op_difference(b, a, blend_params, kernel);
            BlendResult { by_a: joined.by_b, by_b: joined.by_a, weight: 1.0 - joined.weight, ..joined }
        }
    }
}

/// The union of `a` and `b`.
pub fn op_union<T: Real>(a: T, b: T, blend_params: &BlendParams, kernel: u32) -> BlendResult<T> {
    let b_is_less = b.value() < a.value();
    let (less, greater) = if b_is_less { (b, a) } else { (a, b) };
    let (blend, weight) = op_blend(greater - less, blend_params, kernel);
    let weight = if b_is_less { 1.0 - weight } else { weight };
    BlendResult { value: less - blend, by_a: 1.0 - weight, by_b: weight, weight }
}

/// The intersection of `a` and `b`.
pub fn op_intersection<T: Real>(a: T, b: T, blend_params: &BlendParams, kernel: u32) -> BlendResult<T> {
    let joined = op_union(-a, -b, blend_params, kernel);
    BlendResult { value: -joined.value, ..joined }
}

/// The difference of `a` and `b`.
pub fn op_difference<T: Real>(a: T, b: T, blend_params: &BlendParams, kernel: u32) -> BlendResult<T> {
    let joined = op_union(-a, b, blend_params, kernel);
    BlendResult { value: -joined.value, by_b: -joined.by_b, ..joined }
}

/// The symmetric difference of `a` and `b`.
pub fn op_xor<T: Real>(a: T, b: T, blend_params: &BlendParams, kernel: u32) -> BlendResult<T> {
    let outer = op_union(a, b, blend_params, kernel);
    let inner = op_intersection(a, b, blend_params, kernel);
    if -inner.value.value() > outer.value.value() {
        return BlendResult { value: -inner.value, by_a: -inner.by_a, by_b: -inner.by_b, ..inner };
    }
    outer
}

/// A round tube along the curve where both are 0, in the material of `b`. Both terms are bounds of the distance. The
/// first has the surface (Mercury's hg_sdf, 2015); dividing it by √2 bounds its slope, which is greatest where both
/// surfaces nearly coincide. The second term is greater far away.
pub fn op_pipe<T: Real>(a: T, b: T, radius: f64) -> BlendResult<T> {
    let b_is_greater = b.value().abs() > a.value().abs();
    let (greater, less) = if b_is_greater { (b.abs(), a.abs()) } else { (a.abs(), b.abs()) };
    let least = greater.value().max(1e-30);
    let part = less / (greater.max(T::constant(1e-30)));
    let stretch = (part.squared() + 1.0_f64).sqrt();
    let round = (greater * stretch - T::constant(radius)) * FRAC_1_SQRT_2;
    let straight = greater - T::constant(radius);
    if round.value() > straight.value() {
        let way = FRAC_1_SQRT_2 / (stretch.value() * least);
        return BlendResult { value: round, by_a: a.value() * way, by_b: b.value() * way, weight: 1.0 };
    }
    let sign = |v: f64| if v < 0.0 { -1.0 } else { 1.0 };
    let (by_a, by_b) = if b_is_greater { (0.0, sign(b.value())) } else { (sign(a.value()), 0.0) };
    BlendResult { value: straight, by_a, by_b, weight: 1.0 }
}

/// A tongue (`sign` 1) or a groove (−1) along the surface of `b`.
pub fn op_groove<T: Real>(sign: f64, a: T, b: T, blend_params: &BlendParams, kernel: u32) -> BlendResult<T> {
    let side = b.abs() - T::constant(blend_params.size);
    let end = a * sign - T::constant(blend_params.depth);
    let ends = end.value() > side.value();
    let joined = op_union(a * sign, if ends { end } else { side }, blend_params, kernel);
    let w = joined.weight;
    let along = sign * if b.value() < 0.0 { -w } else { w };
    let (by_a, by_b) = if ends { (1.0, 0.0) } else { (1.0 - w, along) };
    BlendResult { value: joined.value * sign, by_a, by_b, weight: w }
}

/// A V of 45° along the surface of `b`.
pub fn op_engrave<T: Real>(a: T, b: T, blend_params: &BlendParams, kernel: u32) -> BlendResult<T> {
    let cut = (b.abs() - a - T::constant(blend_params.depth)) * 0.5;
    let joined = op_difference(a, cut, blend_params, kernel);
    let w = joined.weight;
    BlendResult { by_a: 1.0 - 0.5 * w, by_b: if b.value() < 0.0 { 0.5 * w } else { -0.5 * w }, ..joined }
}

/// The weight of the paint `b`, whose edge fades over `radius` to both sides.
pub fn op_paint(b: f64, radius: f64) -> f64 {
    if b.abs() >= radius {
        return if b < 0.0 { 1.0 } else { 0.0 };
    }
    let h = 0.5 - 0.5 * b / radius;
    h * h * (3.0 - 2.0 * h)
}

/// The amount that a blend subtracts from the lesser of two operands that differ by `difference`, and the weight of
/// the greater. Kernels: Quilez, "smooth minimum", scaled by their supports to the same thickening. Steps and
/// columns: the coordinates of Mercury's hg_sdf, with columns of 90° so that no derivative exceeds 1.
fn op_blend<T: Real>(difference: T, blend_params: &BlendParams, kernel: u32) -> (T, f64) {
    let support = blend_params.support;
    if difference.value() >= support {
        return (T::constant(0.0), 0.0);
    }
    let h = T::constant(1.0) - difference * support.recip();
    match kernel {
        0 => {
            let root = (h * (T::constant(2.0) - h) + 1.0_f64).sqrt();
            ((h + 1.0_f64 - root) * (0.5 * support), 0.5 * (1.0 - (1.0 - h.value()) / root.value()))
        }
        1 => (h.squared() * (0.25 * support), 0.5 * h.value()),
        2 => (h.squared() * h * (support / 6.0), 0.5 * h.value() * h.value()),
        3 if h.value() > 0.5 => ((T::constant(0.75 * support) - difference) * 0.5, 0.5),
        3 => (h.squared() * (0.5 * support), h.value()),
        4 => (h * (0.5 * support), 0.5),
        _ => {
            // Each step is two `half` wide; t is the position of the point in its step, from 1 to −1.
            let half = support / blend_params.size;
            let step = (0.5 * h.value() * blend_params.size).floor();
            let t = T::constant(1.0 + 2.0 * step) - h * blend_params.size;
            if kernel == 5 {
                let weight = if t.value() >= 0.0 { 1.0 } else { 0.0 };
                return ((h * support + (T::constant(1.0) - t.abs()) * half) * 0.5, weight);
            }
            let root = (T::constant(2.0) - t.squared()).sqrt();
            ((h * support + (root - T::constant(1.0)) * half) * 0.5, 0.5 * (1.0 + t.value() / root.value()))
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::eval::Dual;
    use isolith_scene::BlendKernel;

    const VALUES: [f64; 12] = [-1.0, -0.52, -0.35, -0.3, -0.11, 0.0, 0.1, 0.13, 0.29, 0.31, 0.6, 2.0];

    #[test]
    fn the_derivatives_are_those_by_the_operands() {
        for kernel in 0..BlendKernel::ALL.len() as u32 {
            for join in Join::ALL {
                // Grooves and tongues have no steps.
                let size = if kernel >= 5 { 3.0 } else { 0.2 };
                let blend_params = BlendParams { support: 0.7, size, depth: 0.15 };
                for a in VALUES {
                    for b in VALUES {
                        let (a, b) = (Dual { v: a + 0.003, d: DVec3::X }, Dual { v: b, d: DVec3::Y });
                        let joined = op_join(join as u32, a, b, &blend_params, kernel);
                        let BlendResult { by_a, by_b, weight, .. } = joined;
                        let from_duals = joined.value.d;
                        let error = (from_duals - DVec3::new(by_a, by_b, 0.0)).abs().max_element();
                        assert!(error < 1e-12, "{join:?} {kernel} {a:?} {b:?}: {from_duals}, {by_a}, {by_b}");
                        assert!(by_a.abs() + by_b.abs() <= 1.0 + 1e-12, "{join:?} {kernel}: {by_a} {by_b}");
                        assert!((0.0..=1.0).contains(&weight));
                    }
                }
            }
        }
    }

    #[test]
    fn tiny_and_zero_supports_are_finite() {
        for support in [0.0, f64::MIN_POSITIVE, 1e-300] {
            for (a, b) in [(0.0, 0.0), (1.0, 1.0), (1e6, -1e6), (0.0, 1e-301)] {
                for kernel in 0..BlendKernel::ALL.len() as u32 {
                    for join in Join::ALL {
                        let blend_params = BlendParams { support, size: 4.0, depth: 0.0 };
                        let joined = op_join(join as u32, a, b, &blend_params, kernel);
                        let BlendResult { value, by_a, by_b, weight } = joined;
                        assert!([value, by_a, by_b].iter().all(|v| v.is_finite()) && (0.0..=1.0).contains(&weight));
                    }
                }
            }
        }
    }
}
