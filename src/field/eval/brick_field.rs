//! The field of distance bricks, see `isolith_bricks` for their texels and for why it is a lower bound. Rows of the
//! payload: the number of levels, and a number that says which bricks they are. Then for each level: origin of the voxels
//! and their size; cells along each axis, first texel; the first texel of samples after that one, how much it may exceed
//! the distance in meters, the greatest distance of its samples in voxels, one over its greatest slope.

use super::Real;
use super::sdf::{Data, length3};
use isolith_bricks::{BRICK_TEXELS, BRICK_VOXELS, CELL_BRICKS, CELL_VOXELS, SAMPLE_REACH, SAMPLE_STEPS};

/// Rows of a level.
const LEVEL_ROWS: usize = 3;

/// A model; a lower bound of the distance to where the interpolation of its finest samples is 0. Its slope is at most 1.
pub fn sdf_mesh_field<T: Real>(p: [T; 3], _: &[f64; 8], data: Data<'_>) -> T {
    let levels = data.row(1)[0] as usize;
    let (mut best, mut level, is_inside) = mesh_field_level(p, data, 0);
    while let Some(next) = level.filter(|next| *next < levels) {
        let (value, after, _) = mesh_field_level(p, data, next);
        (best, level) = (best.max(value), after);
    }
    if is_inside { -best } else { best }
}

/// A lower bound of the distance by the samples of a level, in meters; the next level if these samples reach no farther;
/// and whether the point is inside.
///
/// Outside of the grid the distance to the grid and that from there on are the sides of a right triangle or of an obtuse
/// one, since the grid is convex and holds the surface.
fn mesh_field_level<T: Real>(p: [T; 3], data: Data<'_>, level: usize) -> (T, Option<usize>, bool) {
    let row = 2 + LEVEL_ROWS * level;
    let [x, y, z, voxel] = data.row(row);
    let size = data.row(row + 1);
    let [_, error, reach, over_slope] = data.row(row + 2);
    let at = [(p[0] - x) * (1.0 / voxel), (p[1] - y) * (1.0 / voxel), (p[2] - z) * (1.0 / voxel)];
    let most = [0, 1, 2].map(|i| T::constant(size[i] * f64::from(CELL_VOXELS)));
    let within = [0, 1, 2].map(|i| at[i].max(T::constant(0.0)).min(most[i]));
    let raw = mesh_field_within(within, data, row);
    let next = (raw.value().abs() >= reach).then_some(level + 1);
    let value = (raw.abs() * voxel - error) * over_slope;
    let beside = [0, 1, 2].map(|i| (at[i] - within[i]) * voxel);
    let is_within = beside.iter().all(|v| v.value() == 0.0);
    let value = if is_within { value } else { length3([length3(beside), value.positive(), T::constant(0.0)]) };
    (value, next, raw.value() < 0.0)
}

/// The distance that samples tell at a point within the grid, both in voxels, from the origin of the grid.
fn mesh_field_within<T: Real>(at: [T; 3], data: Data<'_>, row: usize) -> T {
    let [nx, ny, nz, first] = data.row(row + 1);
    let counts = [nx, ny, nz];
    let cell = [0, 1, 2].map(|i| (at[i].value() / f64::from(CELL_VOXELS)).floor().min(counts[i] - 1.0));
    let index = (cell[0] + nx * (cell[1] + ny * cell[2])) as usize;
    let places = first as usize;
    let place = data.texel(places + index / 4)[index % 4];
    if place >= isolith_bricks::INSIDE {
        return T::constant(if place == isolith_bricks::INSIDE { -SAMPLE_REACH } else { SAMPLE_REACH });
    }
    let inner = [0, 1, 2].map(|i| at[i] - cell[i] * f64::from(CELL_VOXELS));
    let last = f64::from(CELL_BRICKS - 1);
    let brick = [0, 1, 2].map(|i| (inner[i].value() / f64::from(BRICK_VOXELS)).floor().clamp(0.0, last));
    let number = (brick[0] + 2.0 * brick[1] + 4.0 * brick[2]) as usize;
    let entries = places + ((nx * ny * nz) as usize).div_ceil(4);
    let entry = data.texel(entries + 2 * place as usize + number / 4)[number % 4];
    if entry >> 31 == 0 {
        return T::constant(if entry & (1 << 30) == 0 { SAMPLE_REACH } else { -SAMPLE_REACH });
    }
    let samples = first as usize + data.row(row + 2)[0] as usize + (entry & 0xff_ffff) as usize * BRICK_TEXELS;
    let within = [0, 1, 2].map(|i| inner[i] - brick[i] * f64::from(BRICK_VOXELS));
    mesh_field_samples(within, samples, data)
}

/// The interpolation of a brick's samples at a point, in voxels from its first sample.
fn mesh_field_samples<T: Real>(at: [T; 3], first: usize, data: Data<'_>) -> T {
    let last = f64::from(BRICK_VOXELS - 1);
    let low = at.map(|v| v.value().floor().clamp(0.0, last));
    let [x, y, z] = low.map(|v| v as usize);
    let pair = |y: usize, z: usize| {
        let texel = data.texel(first + 4 * z + y / 2);
        [x, x + 1].map(|x| f64::from(texel[y % 2 * 2 + x / 4] >> (x % 4 * 8) & 0xff))
    };
    let samples = [pair(y, z), pair(y + 1, z), pair(y, z + 1), pair(y + 1, z + 1)];
    (trilinear(samples, [0, 1, 2].map(|i| at[i] - low[i])) - 128.0) * (1.0 / SAMPLE_STEPS)
}

/// Values at the corners of a cube, interpolated: pairs along x, at (y, z) = (0, 0), (1, 0), (0, 1), (1, 1).
fn trilinear<T: Real>(pairs: [[f64; 2]; 4], [x, y, z]: [T; 3]) -> T {
    let [a, b, c, d] = pairs.map(|[low, high]| x * (high - low) + low);
    let (front, back) = (a + (b - a) * y, c + (d - c) * y);
    front + (back - front) * z
}
