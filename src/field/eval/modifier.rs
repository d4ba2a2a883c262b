//! The modifiers: how they map a point into the space of their content, and how they change its field. Each function
//! is the counterpart of the function of the same name in `shaders/mod/`; `modifier_params` says what they read.
//! `field/modifier_table.rs` lists the functions of each kind.

use super::Real;
use super::heightfield::sdf_heights;
use crate::ParamRow;
use crate::modifier_params::{
    BendParams, DisplacementParams, ElongateParams, NoiseParams, OnionParams, RecursionParams, RepeatParams,
    TaperParams, TwistParams, WavesParams,
};

type Point<T> = [T; 3];

fn length<T: Real, const N: usize>(v: [T; N]) -> T {
    v.into_iter().fold(T::constant(0.0), |sum, x| sum + x.squared()).sqrt()
}

fn clamp<T: Real>(x: T, low: f64, high: f64) -> T {
    x.max(T::constant(low)).min(T::constant(high))
}

fn candidates(q: &RepeatParams) -> [u32; 3] {
    let code = q.candidates;
    [code & 127, (code >> 7) & 127, code >> 14]
}

/// The cell around `x` along one axis.
fn repeat_base(x: f64, axis: usize, q: &RepeatParams) -> f64 {
    ((x - q.middle[axis]) / q.spacing[axis]).round_ties_even().clamp(q.first[axis], q.last[axis])
}

/// The offset of the n-th neighbor: the cell itself, the nearer neighbor, the one across, and so on.
fn repeat_step(n: u32, side: f64) -> f64 {
    let away = f64::from(n.div_ceil(2));
    if n & 1 == 1 { away * side } else { -away * side }
}

/// The cell of the k-th copy.
fn repeat_index<T: Real>(p: Point<T>, k: u32, q: &RepeatParams) -> [f64; 3] {
    let n = candidates(q);
    let neighbor = |x: f64, axis: usize, n: u32| {
        let base = repeat_base(x, axis, q);
        let place = x - base * q.spacing[axis] - q.middle[axis];
        base + repeat_step(n, if place >= 0.0 { 1.0 } else { -1.0 })
    };
    let y = neighbor(p[1].value(), 1, k / n[0] % n[1]);
    let z = neighbor(p[2].value(), 2, k / (n[0] * n[1]));
    [neighbor(p[0].value() - q.offset[0] * y, 0, k % n[0]), y, z]
}

/// The number of copies to evaluate for one point.
pub fn mod_repeat_count(q: &RepeatParams) -> u32 {
    candidates(q).iter().product()
}

/// Whether the k-th copy exists.
pub fn mod_repeat_exists<T: Real>(p: Point<T>, k: u32, q: &RepeatParams) -> bool {
    let index = repeat_index(p, k, q);
    let all = |test: &dyn Fn(usize, f64) -> bool| (0..3).all(|i| test(i, index[i]));
    let carved = all(&|i, x| x >= q.carve_from[i] && x < q.carve_to[i]);
    all(&|i, x| x >= q.first[i] && x <= q.last[i]) && !carved
}

/// The distance along one axis to the nearest cell that is not evaluated; `None` without such a cell.
fn repeat_beyond<T: Real>(x: T, axis: usize, q: &RepeatParams) -> Option<T> {
    let (spacing, half, n) = (q.spacing[axis], q.half[axis], candidates(q)[axis]);
    let base = repeat_base(x.value(), axis, q);
    let place = x - (q.middle[axis] + base * spacing);
    let (near, across) = (f64::from(n / 2), f64::from((n - 1) / 2));
    let (above, below) = if place.value() >= 0.0 { (near, across) } else { (across, near) };
    let (above, below) = (above + 1.0, below + 1.0);
    let up = (base + above <= q.last[axis]).then(|| -place + (above * spacing - half));
    let down = (base - below >= q.first[axis]).then(|| place + (below * spacing - half));
    match (up, down) {
        (Some(a), Some(b)) => Some(a.min(b)),
        (a, b) => a.or(b),
    }
}

/// The distance to the cells that are not evaluated.
pub fn mod_repeat_start<T: Real>(p: Point<T>, q: &RepeatParams) -> T {
    let outside: [T; 3] = std::array::from_fn(|i| (-p[i] + q.least[i]).max(p[i] - q.greatest[i]).positive());
    let mut beyond: [Option<T>; 3] = std::array::from_fn(|i| repeat_beyond(p[i], i, q));
    if q.offset[0] != 0.0 && beyond[0].is_some() {
        let (spacing, half, n) = (q.spacing[0], q.half[0], candidates(q)[0]);
        let (near, across) = (f64::from(n / 2), f64::from((n - 1) / 2));
        beyond[0] = Some(T::constant(((near + 0.5) * spacing).min((across + 1.0) * spacing) - half));
    }
    let mut least = T::constant(f64::INFINITY);
    for (axis, away) in beyond.into_iter().enumerate() {
        if let Some(away) = away {
            let mut corner = outside;
            corner[axis] = away;
            least = least.min(length(corner));
        }
    }
    least
}

/// Maps the point into the k-th copy.
pub fn mod_repeat_point<T: Real>(p: Point<T>, k: u32, q: &RepeatParams) -> Point<T> {
    let index = repeat_index(p, k, q);
    let offset = q.offset;
    let shift = [offset[0] * index[1], offset[1] * index[0], offset[2] * index[0]];
    let mut at: Point<T> = std::array::from_fn(|i| p[i] - (index[i] * q.spacing[i] + shift[i]));
    if q.turn != 0.0 {
        let (s, c) = (q.turn * index.iter().sum::<f64>()).sin_cos();
        at = [at[0] * c - at[2] * s, at[1], at[0] * s + at[2] * c];
    }
    std::array::from_fn(|i| {
        let odd = (index[i] - 2.0 * (index[i] * 0.5).floor()).abs() > 0.5;
        if odd && q.mirrored & (1 << i) != 0 { -at[i] } else { at[i] }
    })
}

/// Maps the point into the k-th copy.
pub fn mod_recursion_point<T: Real>(p: Point<T>, k: u32, q: &RecursionParams) -> Point<T> {
    let (offset, flags) = (q.offset, q.mirrored);
    let mut at = p;
    for _ in 0..k {
        let folded: Point<T> = std::array::from_fn(|i| {
            let side = if flags & (8 << i) != 0 { -1.0 } else { 1.0 };
            if flags & (1 << i) != 0 { at[i].abs() * side - offset[i] } else { at[i] - offset[i] }
        });
        at = [q.inverse_x, q.inverse_y, q.inverse_z]
            .map(|m| (folded[0] * m[0] + folded[1] * m[1] + folded[2] * m[2]) * q.scale.recip());
    }
    at
}

/// Counterpart of the shader function, which documents it.
pub fn mod_enclosed<T: Real>(value: T, away: T, margin: f64) -> T {
    away.max(value.min(-away + 2.0 * margin))
}

/// Maps the point into the twisted content.
pub fn mod_twist_point<T: Real>(p: Point<T>, q: &TwistParams) -> Point<T> {
    let reach = q.half + q.margin;
    let angle = clamp(p[1], q.center - reach, q.center + reach) * q.rate;
    let (c, s) = (angle.cos(), angle.sin());
    [c * p[0] - s * p[2], p[1], s * p[0] + c * p[2]]
}

/// The field of the twisted content.
pub fn mod_twist_value<T: Real>(f: T, p: Point<T>, q: &TwistParams) -> T {
    let away = (length([p[0], p[2]]) - q.radius).max((p[1] - q.center).abs() - q.half);
    mod_enclosed(f * q.slope, away, q.margin)
}

/// The position along the arc, and from the arc toward the center.
fn bend_place<T: Real>(p: Point<T>, q: &BendParams) -> [T; 2] {
    let height = p[1] * q.side;
    let down = -height + q.radius;
    let r = length([p[0], down]);
    [p[0].atan2(down), (height * (2.0 * q.radius) - p[0].squared() - height.squared()) / (r + q.radius)]
}

/// Maps the point into the bent content.
pub fn mod_bend_point<T: Real>(p: Point<T>, q: &BendParams) -> Point<T> {
    let [angle, height] = bend_place(p, q);
    [angle * q.radius, height * q.side, p[2]]
}

/// The field of the bent content.
pub fn mod_bend_value<T: Real>(f: T, p: Point<T>, q: &BendParams) -> T {
    let [angle, height] = bend_place(p, q);
    let quarter = std::f64::consts::FRAC_PI_2;
    let open = clamp(angle.abs() - q.reach, -quarter, quarter);
    let of_arc = (height - q.high).max(-height + q.low).max((-height + q.radius) * open.sin());
    mod_enclosed(f * q.slope, of_arc.max(chebyshev(p, q.center, q.half)), q.margin)
}

/// The largest of a point's distances to the sides of a box; negative inside.
fn chebyshev<T: Real>(p: Point<T>, center: [f64; 3], half: [f64; 3]) -> T {
    let [x, y, z]: Point<T> = std::array::from_fn(|i| (p[i] - center[i]).abs() - half[i]);
    x.max(y).max(z)
}

/// Maps the point into the tapered content.
pub fn mod_taper_point<T: Real>(p: Point<T>, q: &TaperParams) -> Point<T> {
    let width = clamp(p[1], q.low, q.high) * q.rate + 1.0;
    [p[0] / width, p[1], p[2] / width]
}

/// The field of the tapered content.
pub fn mod_taper_value<T: Real>(f: T, p: Point<T>, q: &TaperParams) -> T {
    mod_enclosed(f * q.slope, chebyshev(p, q.center, q.half), q.margin)
}

/// Maps the point into the elongated content.
pub fn mod_elongate_point<T: Real>(p: Point<T>, q: &ElongateParams) -> Point<T> {
    std::array::from_fn(|i| p[i] - clamp(p[i], -q.half[i], q.half[i]))
}

/// The field of the onion's walls.
pub fn mod_onion_value<T: Real>(f: T, q: &OnionParams) -> T {
    let OnionParams { half, walls, spacing } = *q;
    let wall = (-f.value() / spacing).round_ties_even().clamp(0.0, walls - 1.0);
    (f + wall * spacing).abs() - half
}

/// The field displaced by waves.
pub fn mod_waves_value<T: Real>(f: T, p: Point<T>, q: &WavesParams) -> T {
    let WavesParams { amplitude, frequency, phase, slope } = *q;
    let [x, y, z] = p.map(|x| (x * frequency + phase).sin());
    let displaced = f + x * y * z * amplitude;
    (displaced * slope).max(f - amplitude).min(f + amplitude)
}

/// A random value between −1 and 1 for a corner of the grid.
fn noise_corner(at: [i32; 3], seed: u32) -> f64 {
    let [x, y, z] = at.map(|v| v as u32);
    let mut h = x.wrapping_mul(0x8da6_b343) ^ y.wrapping_mul(0xd816_3841) ^ z.wrapping_mul(0xcb1a_b31f);
    h ^= seed.wrapping_mul(0x9e37_79b9);
    h = (h ^ (h >> 15)).wrapping_mul(0x2c1b_3c6d);
    h = (h ^ (h >> 12)).wrapping_mul(0x297a_2d39);
    h ^= h >> 15;
    f64::from(h >> 8) * (2.0 / 16_777_215.0) - 1.0
}

/// Value noise between −1 and 1.
pub fn noise_value<T: Real>(p: Point<T>, seed: u32) -> T {
    let cell = p.map(|x| x.value().floor());
    let w: Point<T> = std::array::from_fn(|i| {
        let u = p[i] - cell[i];
        u * u * (u * -2.0 + 3.0)
    });
    let corner = |i: usize| {
        // Far away the cast saturates: all points share the last cell.
        let at = std::array::from_fn(|axis| (cell[axis] as i32).wrapping_add((i >> axis & 1) as i32));
        T::constant(noise_corner(at, seed))
    };
    let mix = |a: T, b: T, w: T| a + (b - a) * w;
    let edge = |i: usize| mix(corner(i), corner(i + 1), w[0]);
    mix(mix(edge(0), edge(2), w[1]), mix(edge(4), edge(6), w[1]), w[2])
}

/// The field displaced by noise.
pub fn mod_noise_value<T: Real>(f: T, p: Point<T>, q: &NoiseParams) -> T {
    let (mut amplitude, mut frequency) = (q.amplitude, q.frequency);
    let mut moved = f;
    for layer in 0..q.layers {
        moved = moved + noise_value(p.map(|x| x * frequency), q.seed + layer) * amplitude;
        amplitude *= 0.5;
        frequency *= 2.0;
    }
    (moved * q.slope).max(f - q.reach).min(f + q.reach)
}

/// The position of the point in the image, in tiles, mirrored at their borders.
fn displacement_place<T: Real>([x, y, z]: Point<T>, q: &DisplacementParams) -> [T; 2] {
    let (across, down) = match q.axis {
        0 => (-z, -y),
        1 => (x, z),
        _ => (x, -y),
    };
    [across * q.tiles[0] + 0.5, down * q.tiles[1] + 0.5].map(|tiles| {
        let even = 2.0 * (tiles.value() * 0.5).round_ties_even();
        (tiles - even).abs()
    })
}

/// The field displaced by an image.
pub fn mod_displacement_value<T: Real>(f: T, p: Point<T>, q: &DisplacementParams, data: &[ParamRow]) -> T {
    let [x, y] = displacement_place(p, q);
    let height = sdf_heights([x * q.cells[0], y * q.cells[1]], q.cells, &|i: usize| data[i].map(f64::from));
    ((f - height) * q.slope).max(f - q.greatest).min(f - q.least)
}
