//! The field of distance bricks, see `isolith_bricks` for their texels and for why it is a lower bound. Rows of the
//! payload: the number of levels, the factor on distances, and a number that says which bricks they are; the middle and half
//! the size of a box around the surface. Then for each level: origin of the voxels and their size; cells along each axis, first
//! texel; the first texel of samples after that one.

use super::Real;
use super::sdf::Data;
use glam::DVec3;
use isolith_bricks::{
    BRICK_COARSER, BRICK_INSIDE, BRICK_TEXELS, BRICK_VOXELS, CELL_BRICKS, CELL_VOXELS, COARSER, FADE_END, FADE_START,
    INSIDE, NO_ENTRIES, SAMPLE_REACH, SAMPLE_STEPS,
};
use isolith_scene::shape_params::MeshFieldParams;

/// Rows of a level.
const LEVEL_ROWS: usize = 3;

/// Half of the way over which its slope is taken, in voxels.
pub const MESH_FIELD_SPREAD: f64 = 0.75;

/// A model; a lower bound of the distance to where the interpolation of its finest samples is 0. Its slope is at most 1.
///
/// Samples are rounded, and their interpolation has kinks at every voxel: its gradient is taken over a voxel and a half,
/// where it is smooth.
pub fn sdf_mesh_field<T: Real>(p: [T; 3], _: &MeshFieldParams, data: Data<'_>) -> T {
    let at = DVec3::from(p.map(T::value));
    T::known(mesh_field(at, data), p, || {
        let step = MESH_FIELD_SPREAD * mesh_field_voxel(at, data);
        let rise = |axis: DVec3| mesh_field(at + axis * step, data) - mesh_field(at - axis * step, data);
        (DVec3::from(DVec3::AXES.map(rise)) / (2.0 * step)).clamp_length_max(1.0)
    })
}

/// The size of the voxels of the finest level that tells anything of a point, in meters.
fn mesh_field_voxel(p: DVec3, data: Data<'_>) -> f64 {
    let levels = data.row(1)[0] as usize;
    // The last level always tells something.
    let told = (0..levels - 1).find(|level| mesh_field_level(p, data, *level).is_some()).unwrap_or(levels - 1);
    data.row(4 + LEVEL_ROWS * told)[3]
}

fn mesh_field(p: DVec3, data: Data<'_>) -> f64 {
    let levels = data.row(1)[0] as usize;
    // The sign is that of the first level that tells anything.
    let (mut sum, mut rest, mut sign) = (0.0, 1.0, 0.0);
    for level in 0..levels {
        let Some((value, raw)) = mesh_field_level(p, data, level) else { continue };
        if sign == 0.0 {
            sign = if raw < 0.0 { -1.0 } else { 1.0 };
        }
        let fade = ((raw.abs() - FADE_START) / (FADE_END - FADE_START)).clamp(0.0, 1.0);
        let fade = if level + 1 == levels { 0.0 } else { fade };
        sum += rest * (1.0 - fade) * value;
        rest *= fade;
        if rest == 0.0 {
            break;
        }
    }
    let [center, half] = [2, 3].map(|row| DVec3::from_slice(&data.row(row)));
    let beyond = ((p - center).abs() - half).max(DVec3::ZERO).length();
    if sign < 0.0 { -sum } else { sum.max(beyond) }
}

/// A lower bound of the distance by the samples of a level, in meters, and what they tell, in voxels; `None` where the next
/// level tells as much.
///
/// Outside of the grid the distance to the grid and that from there on are the sides of a right triangle or of an obtuse
/// one, since the grid is convex and holds the surface.
fn mesh_field_level(p: DVec3, data: Data<'_>, level: usize) -> Option<(f64, f64)> {
    let row = 4 + LEVEL_ROWS * level;
    let [x, y, z, voxel] = data.row(row);
    let size = data.row(row + 1);
    let at = (p - DVec3::new(x, y, z)) / voxel;
    let within = at.clamp(DVec3::ZERO, DVec3::new(size[0], size[1], size[2]) * f64::from(CELL_VOXELS));
    let raw = mesh_field_within(within.to_array(), data, row)?;
    let (value, beside) = (raw.abs() * voxel * data.row(1)[1], (at - within) * voxel);
    Some((if beside == DVec3::ZERO { value } else { beside.length().hypot(value) }, raw))
}

/// The distance that samples tell at a point within the grid, both in voxels, from the origin of the grid.
fn mesh_field_within(at: [f64; 3], data: Data<'_>, row: usize) -> Option<f64> {
    let [nx, ny, nz, first] = data.row(row + 1);
    let counts = [nx, ny, nz];
    let cell = [0, 1, 2].map(|i| (at[i] / f64::from(CELL_VOXELS)).floor().min(counts[i] - 1.0));
    let index = (cell[0] + nx * (cell[1] + ny * cell[2])) as usize;
    let places = first as usize;
    let place = data.texel(places + index / 4)[index % 4];
    match place {
        COARSER => return None,
        INSIDE => return Some(-SAMPLE_REACH),
        NO_ENTRIES => return Some(SAMPLE_REACH),
        _ => {}
    }
    let inner = [0, 1, 2].map(|i| at[i] - cell[i] * f64::from(CELL_VOXELS));
    let last = f64::from(CELL_BRICKS - 1);
    let brick = [0, 1, 2].map(|i| (inner[i] / f64::from(BRICK_VOXELS)).floor().clamp(0.0, last));
    let number = (brick[0] + 2.0 * brick[1] + 4.0 * brick[2]) as usize;
    let entries = places + ((nx * ny * nz) as usize).div_ceil(4);
    let entry = data.texel(entries + 2 * place as usize + number / 4)[number % 4];
    match entry {
        BRICK_COARSER => return None,
        BRICK_INSIDE => return Some(-SAMPLE_REACH),
        0 => return Some(SAMPLE_REACH),
        _ => {}
    }
    let samples = first as usize + data.row(row + 2)[0] as usize + (entry & 0xff_ffff) as usize * BRICK_TEXELS;
    let within = [0, 1, 2].map(|i| inner[i] - brick[i] * f64::from(BRICK_VOXELS));
    Some(mesh_field_samples(within, samples, data))
}

/// The interpolation of a brick's samples at a point, in voxels from its first sample.
fn mesh_field_samples(at: [f64; 3], first: usize, data: Data<'_>) -> f64 {
    let last = f64::from(BRICK_VOXELS - 1);
    let low = at.map(|v| v.floor().clamp(0.0, last));
    let [x, y, z] = low.map(|v| v as usize);
    let pair = |y: usize, z: usize| {
        let texel = data.texel(first + 4 * z + y / 2);
        [x, x + 1].map(|x| f64::from(texel[y % 2 * 2 + x / 4] >> (x % 4 * 8) & 0xff))
    };
    let samples = [pair(y, z), pair(y + 1, z), pair(y, z + 1), pair(y + 1, z + 1)];
    (trilinear(samples, [0, 1, 2].map(|i| at[i] - low[i])) - 128.0) * (1.0 / SAMPLE_STEPS)
}

/// Values at the corners of a cube, interpolated: pairs along x, at (y, z) = (0, 0), (1, 0), (0, 1), (1, 1).
fn trilinear(pairs: [[f64; 2]; 4], [x, y, z]: [f64; 3]) -> f64 {
    let [a, b, c, d] = pairs.map(|[low, high]| x * (high - low) + low);
    let (front, back) = (a + (b - a) * y, c + (d - c) * y);
    front + (back - front) * z
}
