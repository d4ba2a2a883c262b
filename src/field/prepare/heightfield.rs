//! Heightfields: heights over a rectangle, solid down to a flat bottom.
//!
//! Rows: frequency, height and salt of each layer of noise; or the waves per meter along X and along Z, height and
//! phase (in turns) of each wave; or each height of an image with its neighbors along X, line by line.

use std::f64::consts::{PI, TAU};

use super::prepared_params::PreparedParams;
use isolith_scene::Heights;
use isolith_scene::shape_params::{HeightmapParams, OceanParams, TerrainParams};

/// The steepest slope of one layer of noise with heights and cells of 1: the heights of two corners differ by at most
/// 2, and the slope of the curve between them is at most 3/2.
pub const NOISE_SLOPE: f64 = 3.0;

/// The least side of an image cell, in meters; thinner cells count as this.
const LEAST_CELL: f64 = 1e-9;

/// The factor that makes a height above a surface of this steepest slope a lower bound of the distance to it.
fn bound_of(steepest: f64) -> f64 {
    1.0 / 1.0_f64.hypot(steepest)
}

/// Fractal noise: the cells of each layer are half as wide as those of the layer before.
pub fn terrain(
    [width, depth, length]: [f64; 3],
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
    let steepest = rows.iter().map(|[frequency, height, ..]| NOISE_SLOPE * frequency * height).sum();
    let half = [0.5 * width, 0.5 * length];
    let (slope, layers, seed) = (bound_of(steepest), rows.len() as u32, seed.floor() as u32);
    PreparedParams::new(&TerrainParams { half, depth, top: amplitude, slope, layers, seed }, rows)
}

/// Waves with crests to the second order of Stokes' theory (1847): cos x + s/2 cos 2x, with a slope of at most 1 + s
/// and an absolute value of at most 1 + s/2. `run` holds direction, spread and phase, in radians. Shorter waves are
/// slower, as in deep water.
pub fn ocean(
    [width, depth, length]: [f64; 3],
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
    let steepest = rows.iter().map(|[x, z, height, _]| TAU * x.hypot(*z) * height * (1.0 + sharp)).sum();
    let half = [0.5 * width, 0.5 * length];
    let (slope, waves) = (bound_of(steepest), rows.len() as u32);
    PreparedParams::new(&OceanParams { half, depth, top: amplitude, slope, waves, harmonic: sharp }, rows)
}

/// A landscape from an image.
pub fn heightmap(image: &Heights, [width, depth, length]: [f64; 3], height: f64) -> PreparedParams {
    let cells = image.size.map(|n| n as f64);
    let (rows, steepest) = spline(image, [width / cells[0], length / cells[1]], height);
    let half = [0.5 * width, 0.5 * length];
    PreparedParams::new(&HeightmapParams { half, depth, top: height, slope: bound_of(steepest), cells }, rows)
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
