//! The field of distance bricks, see `isolith_bricks` for their texels. Rows of the payload: origin of the voxels and
//! their size; cells along each axis, first texel; what a coarse distance of 1 stands for, its greatest error, the first
//! texel of samples after the first of all, and a number that says which bricks they are.

use super::Real;
use super::sdf::{Data, length3};
use isolith_bricks::{BAND, BRICK_TEXELS, BRICK_VOXELS, CELL_BRICKS, CELL_VOXELS, SAMPLE_REACH, SAMPLE_STEPS};

/// A model; a lower bound of the distance to where the interpolation of its samples is 0.
///
/// Outside of the grid the distance to the grid and that from there on are the sides of a right triangle or of an obtuse
/// one, since the grid is convex and holds the surface.
pub fn sdf_mesh_field<T: Real>(p: [T; 3], _: &[f64; 8], data: Data<'_>) -> T {
    let [x, y, z, voxel] = data.row(1);
    let size = data.row(2);
    let at = [(p[0] - x) * (1.0 / voxel), (p[1] - y) * (1.0 / voxel), (p[2] - z) * (1.0 / voxel)];
    let most = [0, 1, 2].map(|i| T::constant(size[i] * f64::from(CELL_VOXELS)));
    let within = [0, 1, 2].map(|i| at[i].max(T::constant(0.0)).min(most[i]));
    let value = mesh_field_within(within, data, voxel);
    let beside = [0, 1, 2].map(|i| (at[i] - within[i]) * voxel);
    if beside.iter().all(|v| v.value() == 0.0) { value } else { length3([length3(beside), value, T::constant(0.0)]) }
}

/// The same at a point within the grid, in voxels from its origin.
fn mesh_field_within<T: Real>(at: [T; 3], data: Data<'_>, voxel: f64) -> T {
    let [nx, ny, nz, first] = data.row(2);
    let [scale, error, first_brick, _] = data.row(3);
    let counts = [nx, ny, nz];
    let cell = [0, 1, 2].map(|i| (at[i].value() / f64::from(CELL_VOXELS)).floor().min(counts[i] - 1.0));
    let index = (cell[0] + nx * (cell[1] + ny * cell[2])) as usize;
    let (first, cells) = (first as usize, (nx * ny * nz) as usize);
    let corners = data.texel(first + index).map(snorm_pair);
    let t = [0, 1, 2].map(|i| at[i] * (1.0 / f64::from(CELL_VOXELS)) - cell[i]);
    let coarse = trilinear(corners, t) * scale;
    let far = coarse.abs() - error;
    if far.value() >= SAMPLE_REACH * voxel {
        return if coarse.value() < 0.0 { -far } else { far };
    }
    let entries = first + cells + cells.div_ceil(4);
    let place = data.texel(first + cells + index / 4)[index % 4] as usize;
    let last = f64::from(CELL_BRICKS - 1);
    let brick = [0, 1, 2].map(|i| {
        let before = f64::from(CELL_BRICKS) * cell[i];
        ((at[i].value() / f64::from(BRICK_VOXELS)).floor() - before).clamp(0.0, last)
    });
    let number = (brick[0] + 2.0 * brick[1] + 4.0 * brick[2]) as usize;
    let entry = data.texel(entries + 2 * place + number / 4)[number % 4];
    if entry >> 31 == 0 {
        let least = T::constant(f64::from(entry & 0xff_ffff) / 16.0 * voxel).max(far);
        return if entry & (1 << 30) == 0 { least } else { -least };
    }
    let slope = 1.0 + f64::from(entry >> 24 & 0x7f) / 64.0;
    let samples = first + first_brick as usize + (entry & 0xff_ffff) as usize * BRICK_TEXELS;
    let within = [0, 1, 2].map(|i| at[i] - (f64::from(CELL_BRICKS) * cell[i] + brick[i]) * f64::from(BRICK_VOXELS));
    let value = mesh_field_samples(within, samples, data) * (voxel / slope);
    let depth = value.abs().max(far);
    if value.value() < 0.0 { -depth } else { depth }
}

/// The interpolation of a brick's samples at a point, in voxels from its first sample.
fn mesh_field_samples<T: Real>(at: [T; 3], first: usize, data: Data<'_>) -> T {
    debug_assert!(BAND < SAMPLE_REACH);
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

/// Two 16-bit numbers from -1 to 1.
fn snorm_pair(word: u32) -> [f64; 2] {
    [word & 0xffff, word >> 16].map(|half| (f64::from(half as u16 as i16) / 32_767.0).max(-1.0))
}
