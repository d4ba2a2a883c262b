//! Smooth noise for masks and dynamics. Counterpart of `shaders/copy/noise.wgsl`.
//!
//! Coordinates are a whole number and a fraction from 0 to 1, so that they are as exact far away as near, and after
//! days as at the start.

use super::hash::{copy_hash, copy_random};
use std::f64::consts::TAU;

/// A coordinate as a whole number and a fraction.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Coordinate {
    /// The whole number, modulo 2³².
    pub whole: i32,
    /// From 0 to below 1.
    pub fraction: f64,
}

impl Coordinate {
    /// Splits a number.
    pub fn new(value: f64) -> Self {
        let whole = value.floor();
        // Beyond 2³² noise repeats; the sign is kept by the remainder.
        Self { whole: whole.rem_euclid(4_294_967_296.0) as u32 as i32, fraction: value - whole }
    }

    /// The coordinate moved by `by`.
    pub fn moved(self, by: f64) -> Self {
        let sum = self.fraction + by;
        let whole = sum.floor();
        Self { whole: self.whole.wrapping_add(whole as i32), fraction: sum - whole }
    }
}

/// The weight of the next lattice point: t³ (6 t² − 15 t + 10), with its slope (Perlin, "Improving noise", 2002).
fn fade(t: f64) -> [f64; 2] {
    [t * t * t * (t * (t * 6.0 - 15.0) + 10.0), 30.0 * t * t * (t * (t - 2.0) + 1.0)]
}

/// Noise between −1 and 1 over one coordinate.
pub fn copy_noise_1(key: u32, at: Coordinate) -> f64 {
    let value = |i: i32| 2.0 * copy_random(copy_hash(key, [at.whole.wrapping_add(i), 0, 0], 0)[0]) - 1.0;
    let [s, _] = fade(at.fraction);
    value(0) * (1.0 - s) + value(1) * s
}

/// Noise between 0 and 1 over two coordinates.
pub fn copy_noise_2(key: u32, at: [Coordinate; 2]) -> f64 {
    let value = |i: i32, k: i32| {
        copy_random(copy_hash(key, [at[0].whole.wrapping_add(i), 1, at[1].whole.wrapping_add(k)], 0)[0])
    };
    let [[s, _], [t, _]] = at.map(|c| fade(c.fraction));
    let row = |k: i32| value(0, k) * (1.0 - s) + value(1, k) * s;
    row(0) * (1.0 - t) + row(1) * t
}

/// The curl of three noises over three coordinates whose values at lattice points go up and down with `phase`, in turns.
/// No component exceeds 7.5 in magnitude.
pub fn copy_curl(key: u32, at: [Coordinate; 3], phase: f64) -> [f64; 3] {
    let [fx, fy, fz] = at.map(|c| fade(c.fraction));
    let mut slopes = [[0.0; 3]; 3];
    for corner in 0..8 {
        let step = [corner & 1, corner >> 1 & 1, corner >> 2];
        let cell = std::array::from_fn(|axis| at[axis].whole.wrapping_add(step[axis]));
        let weight = |fade: [f64; 2], step: i32| if step == 1 { fade } else { [1.0 - fade[0], -fade[1]] };
        let [x, y, z] = [weight(fx, step[0]), weight(fy, step[1]), weight(fz, step[2])];
        let values = copy_hash(key, cell, 2).map(|word| (TAU * (copy_random(word) + phase)).sin());
        for (slope, value) in slopes.iter_mut().zip(values) {
            for (sum, weight) in slope.iter_mut().zip([x[1] * y[0] * z[0], x[0] * y[1] * z[0], x[0] * y[0] * z[1]]) {
                *sum += value * weight;
            }
        }
    }
    let [a, b, c] = slopes;
    [c[1] - b[2], a[2] - c[0], b[0] - a[1]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_is_continuous_bounded_and_never_still() {
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for i in -4_000..4_000 {
            let x = f64::from(i) * 0.013;
            let [a, b] = [x, x + 1e-6].map(|x| copy_noise_1(5, Coordinate::new(x)));
            assert!((a - b).abs() < 1e-5, "a jump at {x}");
            (least, most) = (least.min(a), most.max(a));
            let [a, b] = [x, x + 1e-6].map(|x| copy_noise_2(5, [Coordinate::new(x), Coordinate::new(0.7 - x)]));
            assert!((a - b).abs() < 1e-5 && (0.0..=1.0).contains(&a), "{x}: {a}, {b}");
            let at = [Coordinate::new(x), Coordinate::new(1.3 * x), Coordinate::new(0.2 - x)];
            assert!(copy_curl(5, at, x).iter().all(|v| v.abs() <= 7.5));
        }
        assert!(least < -0.9 && most > 0.9, "{least} to {most}");
    }

    #[test]
    fn coordinates_are_exact_far_away() {
        let far = Coordinate::new(1e6 + 0.25);
        assert_eq!(far, Coordinate { whole: 1_000_000, fraction: 0.25 });
        assert_eq!(Coordinate::new(-0.25), Coordinate { whole: -1, fraction: 0.75 });
        assert_eq!(far.moved(-0.5), Coordinate { whole: 999_999, fraction: 0.75 });
    }

    /// The divergence of a curl is zero; the differences are central, of width 2e-4.
    #[test]
    fn flows_have_no_sources() {
        for i in 0..200 {
            let p = [0.37 * f64::from(i), 5.0 - 0.21 * f64::from(i), 0.11 * f64::from(i)];
            let along = |axis: usize, by: f64| {
                let mut q = p;
                q[axis] += by;
                copy_curl(9, q.map(Coordinate::new), 0.3)[axis]
            };
            let divergence: f64 = (0..3).map(|axis| (along(axis, 1e-4) - along(axis, -1e-4)) / 2e-4).sum();
            assert!(divergence.abs() < 1e-4, "{divergence} at {p:?}");
        }
    }
}
