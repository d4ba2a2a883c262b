//! The modifiers: how they map a point into the space of their content, and how they change its field. Each function
//! is the counterpart of the function of the same name in `shaders/mod/`, which documents the rows.
//! `field/modifier_table.rs` lists the functions of each kind.

use super::Real;
use super::heightfield::sdf_heights;
use crate::ParamRow;

type Point<T> = [T; 3];

fn row(rows: &[ParamRow], i: usize) -> [f64; 4] {
    rows[i].map(f64::from)
}

fn length<T: Real, const N: usize>(v: [T; N]) -> T {
    v.into_iter().fold(T::constant(0.0), |sum, x| sum + x.squared()).sqrt()
}

fn clamp<T: Real>(x: T, low: f64, high: f64) -> T {
    x.max(T::constant(low)).min(T::constant(high))
}

fn candidates(rows: &[ParamRow]) -> [u32; 3] {
    let code = rows[2][3] as u32;
    [code & 127, (code >> 7) & 127, code >> 14]
}

/// The cell around `x` along one axis.
fn repeat_base(x: f64, axis: usize, rows: &[ParamRow]) -> f64 {
    let at = |row: usize| f64::from(rows[row][axis]);
    ((x - at(3)) / at(0)).round_ties_even().clamp(at(1), at(2))
}

/// The offset of the n-th neighbor: the cell itself, the nearer neighbor, the one across, and so on.
fn repeat_step(n: u32, side: f64) -> f64 {
    let away = f64::from(n.div_ceil(2));
    if n & 1 == 1 { away * side } else { -away * side }
}

/// The cell of the k-th copy.
fn repeat_index<T: Real>(p: Point<T>, k: u32, rows: &[ParamRow]) -> [f64; 3] {
    let n = candidates(rows);
    let neighbor = |x: f64, axis: usize, n: u32| {
        let base = repeat_base(x, axis, rows);
        let place = x - base * f64::from(rows[0][axis]) - f64::from(rows[3][axis]);
        base + repeat_step(n, if place >= 0.0 { 1.0 } else { -1.0 })
    };
    let y = neighbor(p[1].value(), 1, k / n[0] % n[1]);
    let z = neighbor(p[2].value(), 2, k / (n[0] * n[1]));
    [neighbor(p[0].value() - f64::from(rows[5][0]) * y, 0, k % n[0]), y, z]
}

/// The number of copies to evaluate for one point.
pub fn mod_repeat_count(rows: &[ParamRow]) -> u32 {
    candidates(rows).iter().product()
}

/// Whether the k-th copy exists.
pub fn mod_repeat_exists<T: Real>(p: Point<T>, k: u32, rows: &[ParamRow]) -> bool {
    let index = repeat_index(p, k, rows);
    let all = |test: &dyn Fn(usize, f64) -> bool| (0..3).all(|i| test(i, index[i]));
    let at = |row: usize, i: usize| f64::from(rows[row][i]);
    let carved = all(&|i, x| x >= at(6, i) && x < at(7, i));
    all(&|i, x| x >= at(1, i) && x <= at(2, i)) && !carved
}

/// The distance along one axis to the nearest cell that is not evaluated; `None` without such a cell.
fn repeat_beyond<T: Real>(x: T, axis: usize, rows: &[ParamRow]) -> Option<T> {
    let at = |row: usize| f64::from(rows[row][axis]);
    let (spacing, half, n) = (at(0), at(4), candidates(rows)[axis]);
    let base = repeat_base(x.value(), axis, rows);
    let place = x - (at(3) + base * spacing);
    let (near, across) = (f64::from(n / 2), f64::from((n - 1) / 2));
    let (above, below) = if place.value() >= 0.0 { (near, across) } else { (across, near) };
    let (above, below) = (above + 1.0, below + 1.0);
    let up = (base + above <= at(2)).then(|| -place + (above * spacing - half));
    let down = (base - below >= at(1)).then(|| place + (below * spacing - half));
    match (up, down) {
        (Some(a), Some(b)) => Some(a.min(b)),
        (a, b) => a.or(b),
    }
}

/// The distance to the cells that are not evaluated.
pub fn mod_repeat_start<T: Real>(p: Point<T>, rows: &[ParamRow]) -> T {
    let outside: [T; 3] = std::array::from_fn(|i| {
        let (low, high) = (f64::from(rows[8][i]), f64::from(rows[9][i]));
        (-p[i] + low).max(p[i] - high).positive()
    });
    let mut beyond: [Option<T>; 3] = std::array::from_fn(|i| repeat_beyond(p[i], i, rows));
    if rows[5][0] != 0.0 && beyond[0].is_some() {
        let (spacing, half, n) = (f64::from(rows[0][0]), f64::from(rows[4][0]), candidates(rows)[0]);
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
pub fn mod_repeat_point<T: Real>(p: Point<T>, k: u32, rows: &[ParamRow]) -> Point<T> {
    let index = repeat_index(p, k, rows);
    let (spacing, offset) = (row(rows, 0), row(rows, 5));
    let shift = [offset[0] * index[1], offset[1] * index[0], offset[2] * index[0]];
    let mut q: Point<T> = std::array::from_fn(|i| p[i] - (index[i] * spacing[i] + shift[i]));
    if spacing[3] != 0.0 {
        let (s, c) = (spacing[3] * index.iter().sum::<f64>()).sin_cos();
        q = [q[0] * c - q[2] * s, q[1], q[0] * s + q[2] * c];
    }
    let flags = rows[1][3] as u32;
    std::array::from_fn(|i| {
        let odd = (index[i] - 2.0 * (index[i] * 0.5).floor()).abs() > 0.5;
        if odd && flags & (1 << i) != 0 { -q[i] } else { q[i] }
    })
}

/// Maps the point into the k-th copy.
pub fn mod_recursion_point<T: Real>(p: Point<T>, k: u32, rows: &[ParamRow]) -> Point<T> {
    let (offset, flags) = (row(rows, 0), rows[2][3] as u32);
    let mut q = p;
    for _ in 0..k {
        let folded: Point<T> = std::array::from_fn(|i| {
            let side = if flags & (8 << i) != 0 { -1.0 } else { 1.0 };
            if flags & (1 << i) != 0 { q[i].abs() * side - offset[i] } else { q[i] - offset[i] }
        });
        q = [1, 2, 3].map(|r| {
            let m = row(rows, r);
            (folded[0] * m[0] + folded[1] * m[1] + folded[2] * m[2]) * offset[3].recip()
        });
    }
    q
}

/// Counterpart of the shader function, which documents it.
pub fn mod_enclosed<T: Real>(value: T, away: T, margin: f64) -> T {
    away.max(value.min(-away + 2.0 * margin))
}

/// Maps the point into the twisted content.
pub fn mod_twist_point<T: Real>(p: Point<T>, rows: &[ParamRow]) -> Point<T> {
    let (a, b) = (row(rows, 0), row(rows, 1));
    let reach = b[1] + a[3];
    let angle = clamp(p[1], b[0] - reach, b[0] + reach) * a[0];
    let (c, s) = (angle.cos(), angle.sin());
    [c * p[0] - s * p[2], p[1], s * p[0] + c * p[2]]
}

/// The field of the twisted content.
pub fn mod_twist_value<T: Real>(f: T, p: Point<T>, rows: &[ParamRow]) -> T {
    let (a, b) = (row(rows, 0), row(rows, 1));
    let away = (length([p[0], p[2]]) - a[2]).max((p[1] - b[0]).abs() - b[1]);
    mod_enclosed(f * a[1], away, a[3])
}

/// The position along the arc, and from the arc toward the center.
fn bend_place<T: Real>(p: Point<T>, rows: &[ParamRow]) -> [T; 2] {
    let a = row(rows, 0);
    let height = p[1] * a[3];
    let down = -height + a[0];
    let r = length([p[0], down]);
    [p[0].atan2(down), (height * (2.0 * a[0]) - p[0].squared() - height.squared()) / (r + a[0])]
}

/// Maps the point into the bent content.
pub fn mod_bend_point<T: Real>(p: Point<T>, rows: &[ParamRow]) -> Point<T> {
    let a = row(rows, 0);
    let [angle, height] = bend_place(p, rows);
    [angle * a[0], height * a[3], p[2]]
}

/// The field of the bent content.
pub fn mod_bend_value<T: Real>(f: T, p: Point<T>, rows: &[ParamRow]) -> T {
    let (a, b) = (row(rows, 0), row(rows, 1));
    let [angle, height] = bend_place(p, rows);
    let quarter = std::f64::consts::FRAC_PI_2;
    let open = clamp(angle.abs() - b[0], -quarter, quarter);
    let of_arc = (height - b[2]).max(-height + b[1]).max((-height + a[0]) * open.sin());
    mod_enclosed(f * a[1], of_arc.max(chebyshev(p, row(rows, 2), row(rows, 3))), a[2])
}

/// The largest of a point's distances to the sides of a box; negative inside.
fn chebyshev<T: Real>(p: Point<T>, center: [f64; 4], half: [f64; 4]) -> T {
    let [x, y, z]: Point<T> = std::array::from_fn(|i| (p[i] - center[i]).abs() - half[i]);
    x.max(y).max(z)
}

/// Maps the point into the tapered content.
pub fn mod_taper_point<T: Real>(p: Point<T>, rows: &[ParamRow]) -> Point<T> {
    let width = clamp(p[1], row(rows, 1)[3], row(rows, 2)[3]) * row(rows, 0)[0] + 1.0;
    [p[0] / width, p[1], p[2] / width]
}

/// The field of the tapered content.
pub fn mod_taper_value<T: Real>(f: T, p: Point<T>, rows: &[ParamRow]) -> T {
    let a = row(rows, 0);
    mod_enclosed(f * a[1], chebyshev(p, row(rows, 1), row(rows, 2)), a[2])
}

/// Maps the point into the elongated content.
pub fn mod_elongate_point<T: Real>(p: Point<T>, rows: &[ParamRow]) -> Point<T> {
    let half = row(rows, 0);
    std::array::from_fn(|i| p[i] - clamp(p[i], -half[i], half[i]))
}

/// The field of the onion's walls.
pub fn mod_onion_value<T: Real>(f: T, rows: &[ParamRow]) -> T {
    let [half, walls, spacing, _] = row(rows, 0);
    let wall = (-f.value() / spacing).round_ties_even().clamp(0.0, walls - 1.0);
    (f + wall * spacing).abs() - half
}

/// The field displaced by waves.
pub fn mod_waves_value<T: Real>(f: T, p: Point<T>, rows: &[ParamRow]) -> T {
    let [amplitude, frequency, phase, slope] = row(rows, 0);
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
pub fn mod_noise_value<T: Real>(f: T, p: Point<T>, rows: &[ParamRow]) -> T {
    let ([mut amplitude, mut frequency, layers, seed], b) = (row(rows, 0), row(rows, 1));
    let mut moved = f;
    for layer in 0..layers as u32 {
        moved = moved + noise_value(p.map(|x| x * frequency), seed as u32 + layer) * amplitude;
        amplitude *= 0.5;
        frequency *= 2.0;
    }
    (moved * b[0]).max(f - b[1]).min(f + b[1])
}

/// The position of the point in the image, in tiles, mirrored at their borders.
fn displacement_place<T: Real>([x, y, z]: Point<T>, [width, length, ..]: [f64; 4], axis: f64) -> [T; 2] {
    let (across, down) = match axis as u32 {
        0 => (-z, -y),
        1 => (x, z),
        _ => (x, -y),
    };
    [across * width + 0.5, down * length + 0.5].map(|tiles| {
        let even = 2.0 * (tiles.value() * 0.5).round_ties_even();
        (tiles - even).abs()
    })
}

/// The field displaced by an image.
pub fn mod_displacement_value<T: Real>(f: T, p: Point<T>, rows: &[ParamRow], data: &[ParamRow]) -> T {
    let (a, [scale, least, greatest, axis]) = (row(rows, 0), row(rows, 1));
    let [x, y] = displacement_place(p, a, axis);
    let height = sdf_heights([x * a[2], y * a[3]], [a[2], a[3]], &|i: usize| data[i].map(f64::from));
    ((f - height) * scale).max(f - greatest).min(f - least)
}
