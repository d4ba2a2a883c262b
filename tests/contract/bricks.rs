//! A second definition of shapes of bricks: the interpolation of their samples, found by another way through the texels,
//! and a surface seen from six sides.

use std::sync::Arc;

use glam::DVec3;
use isolith::bricks::Bricks;

use super::surfaces::Patch;

/// The interpolated distance in voxels; without samples 99 with the sign of the brick or of the cell.
pub fn interpolated(bricks: &Bricks, p: DVec3) -> f64 {
    let at = (p - bricks.grid.origin) / bricks.grid.voxel;
    let low = at.floor();
    let t = at - low;
    let mut sum = 0.0;
    for corner in 0..8 {
        let offset = DVec3::new(f64::from(corner & 1), f64::from(corner >> 1 & 1), f64::from(corner >> 2));
        let weight = (DVec3::ONE - offset - t).abs();
        let Some(sample) = sample_of(bricks, low, offset) else { return side(bricks, p) };
        sum += weight.x * weight.y * weight.z * sample;
    }
    sum
}

/// The sample at a corner of the voxel at `low`.
fn sample_of(bricks: &Bricks, low: DVec3, offset: DVec3) -> Option<f64> {
    let brick = (low / 7.0).floor();
    let inner = low - brick * 7.0 + offset;
    let entry = entry_of(bricks, brick)?;
    if entry < 1 << 31 {
        return None;
    }
    let at = (inner.x + 8.0 * inner.y + 64.0 * inner.z) as usize;
    let first = bricks.first_brick as usize + 32 * (entry as usize & 0xff_ffff);
    let bytes = bricks.texels[first + at / 16][at % 16 / 4].to_le_bytes();
    Some((f64::from(bytes[at % 4]) - 128.0) / 32.0)
}

/// The entry of a brick; `None` outside of the grid and in cells without entries.
fn entry_of(bricks: &Bricks, brick: DVec3) -> Option<u32> {
    let counts = bricks.grid.cells.map(|n| n as usize);
    let index = brick.to_array().map(|v| v as i64);
    if (0..3).any(|i| index[i] < 0 || index[i] >= 2 * counts[i] as i64) {
        return None;
    }
    let [x, y, z] = index.map(|v| v as usize);
    let cell = x / 2 + counts[0] * (y / 2 + counts[1] * (z / 2));
    let cells = counts[0] * counts[1] * counts[2];
    let place = bricks.texels[cell / 4][cell % 4];
    let number = x % 2 + 2 * (y % 2) + 4 * (z % 2);
    let entries = cells.div_ceil(4) + 2 * place as usize;
    (place < u32::MAX - 1).then(|| bricks.texels[entries + number / 4][number % 4])
}

/// 99 outside of the solid and -99 inside, by the entry or the sign of the cell.
fn side(bricks: &Bricks, p: DVec3) -> f64 {
    let at = (p - bricks.grid.origin) / bricks.grid.voxel;
    if let Some(entry) = entry_of(bricks, (at / 7.0).floor()) {
        return if entry & (1 << 30) == 0 { 99.0 } else { -99.0 };
    }
    let counts = DVec3::from(bricks.grid.cells.map(f64::from));
    let cell = (at / 14.0).floor();
    if cell.min_element() < 0.0 || (counts - cell).min_element() < 1.0 {
        return 99.0;
    }
    let index = (cell.x + counts.x * (cell.y + counts.y * cell.z)) as usize;
    if bricks.texels[index / 4][index % 4] == u32::MAX { 99.0 } else { -99.0 }
}

/// What can be seen of the surface along each axis.
pub fn patches(bricks: &Arc<Bricks>) -> Vec<Patch> {
    let mut out: Vec<Patch> = Vec::new();
    for (axis, from) in (0..3).flat_map(|axis| [(axis, 0.0), (axis, 1.0)]) {
        let bricks = bricks.clone();
        out.push(Box::new(move |u, v| {
            let (low, size) = (bricks.bounds.min, bricks.bounds.max - bricks.bounds.min);
            let margin = 2.0 * bricks.grid.voxel;
            let length = size[axis] + 2.0 * margin;
            let place = |way: f64| {
                let mut p = low;
                p[(axis + 1) % 3] += u * size[(axis + 1) % 3];
                p[(axis + 2) % 3] += v * size[(axis + 2) % 3];
                p[axis] += if from == 0.0 { way - margin } else { length - margin - way };
                p
            };
            let is_inside = |way: f64| interpolated(&bricks, place(way)) < 0.0;
            let step = 0.5 * bricks.grid.voxel;
            let first = (0..(length / step) as usize).map(|i| i as f64 * step).find(|way| is_inside(*way))?;
            let (mut outside, mut inside) = (first - step, first);
            for _ in 0..40 {
                let middle = 0.5 * (outside + inside);
                if is_inside(middle) { inside = middle } else { outside = middle }
            }
            Some(place(inside))
        }));
    }
    out
}
