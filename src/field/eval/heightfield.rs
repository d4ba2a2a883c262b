//! Heightfields: solids below heights over a rectangle. `crate::prepare::heightfield` defines their payload rows.

use std::f64::consts::TAU;

use super::Real;
use super::sdf::{Data, length3};
use isolith_scene::shape_params::{HeightmapParams, OceanParams, TerrainParams};

/// Hills; a lower bound of the distance.
pub fn sdf_terrain<T: Real>(p: [T; 3], q: &TerrainParams, rows: Data<'_>) -> T {
    heightfield(p, terrain_height(p[0], p[2], q, rows), q.half, q.depth, q.top, q.slope)
}

/// Waves; a lower bound of the distance.
pub fn sdf_ocean<T: Real>(p: [T; 3], q: &OceanParams, rows: Data<'_>) -> T {
    heightfield(p, ocean_height(p[0], p[2], q, rows), q.half, q.depth, q.top, q.slope)
}

/// A landscape from an image; a lower bound of the distance.
pub fn sdf_heightmap<T: Real>(p: [T; 3], q: &HeightmapParams, rows: Data<'_>) -> T {
    heightfield(p, heightmap_height(p[0], p[2], q, rows), q.half, q.depth, q.top, q.slope)
}

/// The solid below the heights and within the box. The height above the surface times `slope`, which is
/// one over √(1 + L²) for the steepest slope L, never exceeds the distance to the surface.
fn heightfield<T: Real>(p: [T; 3], height: T, half: [f64; 2], depth: f64, top: f64, slope: f64) -> T {
    let above = (p[1] - height) * slope;
    let (middle, half_height) = (0.5 * (top - depth), 0.5 * (top + depth));
    let d = [p[0].abs() - half[0], (p[1] - middle).abs() - half_height, p[2].abs() - half[1]];
    let most = d[0].max(d[1].max(d[2]));
    let outside = if most.value() > 0.0 { length3(d.map(T::positive)) } else { most };
    above.max(outside)
}

/// The height of hills at (x, z), in meters: a sum of layers of noise.
pub fn terrain_height<T: Real>(x: T, z: T, q: &TerrainParams, rows: Data<'_>) -> T {
    let mut sum = T::constant(0.0);
    for row in 0..q.layers as usize {
        let [frequency, height, salt, _] = rows.row(1 + row);
        sum = sum + noise(x * frequency, z * frequency, q.seed, salt as u32) * height;
    }
    sum
}

/// Smooth noise between -1 and 1: random values at integer coordinates, interpolated by t² (3 - 2 t) (value noise,
/// Perlin, "An image synthesizer", 1985).
fn noise<T: Real>(x: T, z: T, seed: u32, salt: u32) -> T {
    let (cx, cz) = (x.value().floor(), z.value().floor());
    let (tx, tz) = (x - cx, z - cz);
    let (sx, sz) = (ease(tx), ease(tz));
    let at = |i: i64, j: i64| lattice((cx as i64 + i) as u32, (cz as i64 + j) as u32, seed, salt);
    let mix = |a: T, b: T, s: T| a + (b - a) * s;
    let side = |j: i64| mix(T::constant(at(0, j)), T::constant(at(1, j)), sx);
    mix(side(0), side(1), sz)
}

fn ease<T: Real>(t: T) -> T {
    t * t * (t * -2.0 + 3.0)
}

/// A random number between -1 and 1 (mixing as in Wellons, "Prospecting for hash functions", 2018).
fn lattice(i: u32, j: u32, seed: u32, salt: u32) -> f64 {
    let mut h = i.wrapping_mul(0x9e37_79b9) ^ j.wrapping_mul(0x85eb_ca6b);
    h ^= seed.wrapping_mul(0xc2b2_ae35).wrapping_add(salt.wrapping_mul(0x27d4_eb2f));
    h = (h ^ (h >> 16)).wrapping_mul(0x7feb_352d);
    h = (h ^ (h >> 15)).wrapping_mul(0x846c_a68b);
    h ^= h >> 16;
    f64::from(h >> 8) * (2.0 / 16_777_215.0) - 1.0
}

/// The height of waves at (x, z), in meters.
pub fn ocean_height<T: Real>(x: T, z: T, q: &OceanParams, rows: Data<'_>) -> T {
    let mut sum = T::constant(0.0);
    for row in 0..q.waves as usize {
        let [along_x, along_z, height, phase] = rows.row(1 + row);
        let turns = x * along_x + z * along_z + phase;
        sum = sum + (cosine(turns) + cosine(turns * 2.0_f64) * (0.5 * q.harmonic)) * height;
    }
    sum
}

/// The cosine of an angle in turns, with its derivative.
fn cosine<T: Real>(turns: T) -> T {
    let angle = TAU * turns.value().fract();
    (turns - turns.value()) * (-TAU * angle.sin()) + angle.cos()
}

/// The height of an image's surface at (x, z), in meters: a quadratic B-spline over its cells. Beyond the border the
/// height of the border continues.
pub fn heightmap_height<T: Real>(x: T, z: T, q: &HeightmapParams, rows: Data<'_>) -> T {
    let [columns, lines] = q.cells;
    let cells = |v: T, half: f64, count: f64| {
        v.max(T::constant(-half)).min(T::constant(half)) * (0.5 * count / half.max(1e-9)) + 0.5 * count
    };
    sdf_heights([cells(x, q.half[0], columns), cells(z, q.half[1], lines)], [columns, lines], &|row: usize| {
        rows.row(1 + row)
    })
}

/// The height of a grid at a position, in cells from its first corner: a quadratic B-spline.
pub fn sdf_heights<T: Real>(place: [T; 2], [columns, lines]: [f64; 2], rows: Data<'_>) -> T {
    // The position relative to the middle of the cell, in cells.
    let within = |cells: T, count: f64| {
        let cell = cells.value().floor().min(count - 1.0);
        (cell, cells - (cell + 0.5))
    };
    let ((column, tx), (line, tz)) = (within(place[0], columns), within(place[1], lines));
    let weights = |t: T| {
        let (below, above) = (t * -1.0 + 0.5, t + 0.5);
        [below * below * 0.5, t * t * -1.0 + 0.75, above * above * 0.5]
    };
    let (wx, wz) = (weights(tx), weights(tz));
    let mut sum = T::constant(0.0);
    for (side, weight) in [-1.0, 0.0, 1.0].into_iter().zip(wz) {
        let near = (line + side).clamp(0.0, lines - 1.0);
        let [a, b, c, _] = rows.row((near * columns + column) as usize);
        sum = sum + (wx[0] * a + wx[1] * b + wx[2] * c) * weight;
    }
    sum
}
