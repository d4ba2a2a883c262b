//! Heightfields: heights over a rectangle, solid down to a flat bottom.
//!
//! Parameters: half the width, depth of the ground, half the length, greatest height; then one over √(1 + L²) for the
//! greatest slope L, the number of rows, seed or sharpness. Rows: frequency, height and salt of each layer of noise;
//! or the waves per meter along X and along Z, height and phase (in turns) of each wave; or each height of an image
//! with its neighbors along X, line by line, in which case the counts are columns and lines, the last parameter is 0
//! or, where fields need only be lower bounds, the side of a cell, and the fourth number of a height holds the scales
//! around it, see [`scales_around`].

use std::f64::consts::{PI, TAU};

use super::prepared_params::PreparedParams;
use crate::eval::RADII;
use isolith_scene::Heights;

/// The steepest slope of one layer of noise with heights and cells of 1: the heights of two corners differ by at most
/// 2, and the slope of the curve between them is at most 3/2.
pub const NOISE_SLOPE: f64 = 3.0;

/// The least side of an image cell, in meters; thinner cells count as this.
const LEAST_CELL: f64 = 1e-9;

fn prepared([width, depth, length]: [f64; 3], top: f64, slope: f64, last: f64, rows: Vec<[f64; 4]>) -> PreparedParams {
    let count = rows.len() as f64;
    let scale = 1.0 / 1.0_f64.hypot(slope);
    PreparedParams::new([0.5 * width, depth, 0.5 * length, top], [scale, count, last, 0.0], rows)
}

/// Fractal noise: the cells of each layer are half as wide as those of the layer before.
pub fn terrain(
    size: [f64; 3],
    amplitude: f64,
    wavelength: f64,
    octaves: f64,
    roughness: f64,
    seed: f64,
) -> PreparedParams {
    let octaves = octaves.floor() as i32;
    let sum: f64 = (0..octaves).map(|i| roughness.powi(i)).sum();
    let row = |i: i32| [2.0_f64.powi(i) / wavelength, amplitude * roughness.powi(i) / sum, f64::from(i), 0.0];
    let rows: Vec<_> = (0..octaves).map(row).collect();
    let slope = rows.iter().map(|[frequency, height, ..]| NOISE_SLOPE * frequency * height).sum();
    prepared(size, amplitude, slope, seed.floor(), rows)
}

/// Waves with crests to the second order of Stokes' theory (1847): cos x + s/2 cos 2x, with a slope of at most 1 + s
/// and an absolute value of at most 1 + s/2. `run` holds direction, spread and phase, in radians. Shorter waves are
/// slower, as in deep water.
pub fn ocean(
    size: [f64; 3],
    amplitude: f64,
    wavelength: f64,
    waves: f64,
    [direction, spread, phase]: [f64; 3],
    sharpness: f64,
) -> PreparedParams {
    const SHORTER: f64 = 0.68;
    /// The golden angle spreads directions and phases evenly for any count.
    const GOLDEN: f64 = 2.399_963_229_728_653;
    let count = waves.floor() as i32;
    // Long waves are higher.
    let sum: f64 = (0..count).map(|i| SHORTER.powi(i)).sum();
    let sharp = 0.5 * sharpness;
    let row = |i: i32| {
        let frequency = 1.0 / (wavelength * SHORTER.powi(i));
        let turned = direction + spread * (GOLDEN * f64::from(i)).sin();
        let height = amplitude * SHORTER.powi(i) / (sum * (1.0 + 0.5 * sharp));
        let moved = phase / TAU * SHORTER.powi(-i).sqrt() + GOLDEN * f64::from(i) / PI;
        [frequency * turned.cos(), frequency * turned.sin(), height, moved.rem_euclid(1.0)]
    };
    let rows: Vec<_> = (0..count).map(row).collect();
    let slope = rows.iter().map(|[x, z, height, _]| TAU * x.hypot(*z) * height * (1.0 + sharp)).sum();
    prepared(size, amplitude, slope, sharp, rows)
}

/// A landscape from an image.
pub fn heightmap(image: &Heights, size: [f64; 3], height: f64) -> PreparedParams {
    let [columns, lines] = image.size.map(|n| n as f64);
    let cell = [size[0] / columns, size[2] / lines];
    let (mut rows, steepest) = spline(image, cell, height);
    scales_around(&mut rows, image.size, cell);
    let mut out = prepared(size, height, steepest, lines, rows);
    out.parameters[5] = columns;
    out
}

/// Puts one over √(1 + L²) into the fourth number of each height, for the steepest slope L within each of [`RADII`]
/// cells around: in 255ths, rounded down, as three bytes of a whole number. Maxima over ever larger squares, one axis
/// after the other (Tevs, Ihrke and Seidel, "Maximum mipmaps", 2008, in a form without look-ups in levels).
fn scales_around(rows: &mut [[f64; 4]], [columns, lines]: [usize; 2], cell: [f64; 2]) {
    let cell = cell.map(|side| side.max(LEAST_CELL));
    let slope = |column: usize, line: usize| {
        let along_z = |at: usize, column: usize| {
            let [above, below] = [at, (at + 1).min(lines - 1)].map(|line| rows[line * columns + column][1]);
            (below - above).abs()
        };
        let around = |at: usize, count: usize| at.saturating_sub(1)..=(at + 1).min(count - 1);
        let along_x = around(line, lines).map(|line| {
            let [a, b, c, _] = rows[line * columns + column];
            (b - a).abs().max((c - b).abs())
        });
        let along_z =
            around(column, columns).flat_map(|column| [along_z(line.saturating_sub(1), column), along_z(line, column)]);
        let most = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
        let (mut along_x, mut along_z) = (along_x, along_z);
        (most(&mut along_x) / cell[0]).hypot(most(&mut along_z) / cell[1])
    };
    let cells = (0..lines).flat_map(|line| (0..columns).map(move |column| (column, line)));
    let slopes: Vec<f64> = cells.map(|(column, line)| slope(column, line)).collect();
    let mut bytes = vec![0_u32; slopes.len()];
    for radius in RADII {
        let along_x = greatest_around(&slopes, [columns, lines], radius as usize, 1);
        let steepest = greatest_around(&along_x, [columns, lines], radius as usize, columns);
        for (bytes, steepest) in bytes.iter_mut().zip(steepest) {
            *bytes = *bytes << 8 | (255.0 / 1.0_f64.hypot(steepest)).floor() as u32;
        }
    }
    for (row, bytes) in rows.iter_mut().zip(bytes) {
        row[3] = f64::from(bytes);
    }
}

/// The greatest value up to `radius` cells away along one axis: along X for a `stride` of 1, else along Z.
fn greatest_around(values: &[f64], [columns, lines]: [usize; 2], radius: usize, stride: usize) -> Vec<f64> {
    let mut out = vec![0.0; values.len()];
    let (rows, length, step) = if stride == 1 { (lines, columns, columns) } else { (columns, lines, 1) };
    for row in 0..rows {
        let at = |i: usize| row * step + i * stride;
        // The places of what may still become the greatest: falling values.
        let mut open: std::collections::VecDeque<usize> = std::collections::VecDeque::new();
        for next in 0..length + radius {
            if next < length {
                while open.back().is_some_and(|last| values[at(*last)] <= values[at(next)]) {
                    open.pop_back();
                }
                open.push_back(next);
            }
            let Some(middle) = next.checked_sub(radius) else { continue };
            while open.front().is_some_and(|first| first + radius < middle) {
                open.pop_front();
            }
            out[at(middle)] = open.front().map_or(0.0, |first| values[at(*first)]);
        }
    }
    out
}

/// The heights of an image as a quadratic B-spline (de Boor, "A practical guide to splines", 1978): its values stay
/// within the surrounding heights, and its slope along an axis within their differences. Returns its rows, and its
/// steepest slope for cells with these sides, in meters, where white is `height` meters above black.
pub fn spline(image: &Heights, cell: [f64; 2], height: f64) -> (Vec<[f64; 4]>, f64) {
    let [columns, lines] = image.size.map(|n| n as isize);
    let cell = cell.map(|side| side.max(LEAST_CELL));
    let mut rows = Vec::with_capacity(image.values.len());
    let mut steepest: f64 = 0.0;
    for line in 0..lines {
        for column in 0..columns {
            let at = |x: isize, z: isize| height * image.at(column + x, line + z);
            rows.push([at(-1, 0), at(0, 0), at(1, 0), 0.0]);
            let (mut along_x, mut along_z): (f64, f64) = (0.0, 0.0);
            for i in -1..=1 {
                for j in [-1, 0] {
                    along_x = along_x.max((at(j + 1, i) - at(j, i)).abs());
                    along_z = along_z.max((at(i, j + 1) - at(i, j)).abs());
                }
            }
            steepest = steepest.max((along_x / cell[0]).hypot(along_z / cell[1]));
        }
    }
    (rows, steepest)
}
