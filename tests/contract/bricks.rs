//! A second definition of shapes of bricks: the interpolation of their samples, found by another way through the texels,
//! and a surface seen from six sides.

use std::sync::Arc;

use glam::DVec3;
use isolith::bricks::{BakedField, BrickLevels, Bricks, bake_levels};
use isolith::field::PreparedShape;
use isolith::field::eval::{Dual, Real};
use isolith::geometry::Aabb;
use isolith::scene::{ModelFile, Shape, ShapeKind};

use super::samples::{Random, evaluate};

use super::surfaces::Patch;

/// The interpolated distance in voxels; without samples 99 with the sign of the brick or of the cell.
pub fn interpolated(bricks: &Bricks, p: DVec3) -> f64 {
    let at = (p - bricks.grid.origin) / bricks.grid.voxel;
    let low = at.floor();
    let t = at - low;
    if let Some(coarser) = bricks.coarser.as_ref().filter(|_| is_left_out(bricks, (low / 7.0).floor())) {
        return 2.0 * interpolated(coarser, p);
    }
    let mut sum = 0.0;
    for corner in 0..8 {
        let offset = DVec3::new(f64::from(corner & 1), f64::from(corner >> 1 & 1), f64::from(corner >> 2));
        let weight = (DVec3::ONE - offset - t).abs();
        let Some(sample) = sample_of(bricks, low, offset) else { return side(bricks, p) };
        sum += weight.x * weight.y * weight.z * sample;
    }
    sum
}

/// Whether a brick has no samples because the coarser level tells as much.
fn is_left_out(bricks: &Bricks, brick: DVec3) -> bool {
    entry_of(bricks, brick).map_or(place_of(bricks, brick) == Some(u32::MAX - 2), |entry| entry == 1 << 29)
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

/// The place of the cell of a brick; `None` outside of the grid.
fn place_of(bricks: &Bricks, brick: DVec3) -> Option<u32> {
    let counts = bricks.grid.cells.map(|n| n as usize);
    let index = brick.to_array().map(|v| v as i64);
    if (0..3).any(|i| index[i] < 0 || index[i] >= 2 * counts[i] as i64) {
        return None;
    }
    let [x, y, z] = index.map(|v| v as usize / 2);
    let cell = x + counts[0] * (y + counts[1] * z);
    Some(bricks.texels[cell / 4][cell % 4])
}

/// The entry of a brick; `None` outside of the grid and in cells without entries.
fn entry_of(bricks: &Bricks, brick: DVec3) -> Option<u32> {
    let place = place_of(bricks, brick).filter(|place| *place < u32::MAX - 2)?;
    let [x, y, z] = brick.to_array().map(|v| v as usize % 2);
    let number = x + 2 * y + 4 * z;
    let entries = bricks.grid.cell_count().div_ceil(4) + 2 * place as usize;
    Some(bricks.texels[entries + number / 4][number % 4])
}

/// 99 outside of the solid and -99 inside, by the entry or the sign of the cell.
fn side(bricks: &Bricks, p: DVec3) -> f64 {
    let at = (p - bricks.grid.origin) / bricks.grid.voxel;
    if let Some(entry) = entry_of(bricks, (at / 7.0).floor()) {
        return if entry & (1 << 30) == 0 { 99.0 } else { -99.0 };
    }
    if place_of(bricks, (at / 7.0).floor()) == Some(u32::MAX - 1) { -99.0 } else { 99.0 }
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

/// A ball of this radius as a model.
fn ball(radius: f64, voxel: f64) -> Shape {
    let bounds = Aabb::from_center_half(DVec3::ZERO, DVec3::splat(radius));
    let field = BakedField { bounds, distance: &|p, _| p.length() - radius, look: None };
    let levels = Arc::new(BrickLevels::new(&bake_levels(&field, voxel, &|_| true).unwrap()));
    let mut shape = ShapeKind::MeshField.default_shape();
    if let Shape::MeshField { file, .. } = &mut shape {
        *file = ModelFile::new("ball.glb").with_bricks(levels);
    }
    shape
}

#[test]
fn normals_of_a_ball_in_voxels_are_those_of_a_ball() {
    let prepared = PreparedShape::new(&ball(0.5, 0.02));
    let mut random = Random::new(3);
    let mut worst = 0.0_f64;
    for _ in 0..500 {
        let out = random.direction();
        let p = out * random.range(0.49, 0.51);
        let Dual { v, d } = evaluate(&prepared, DVec3::AXES.map(|axis| Dual::coordinate(axis, 0.0, p)));
        assert!(v.abs() <= (p.length() - 0.5).abs() + 0.02 * 0.1 && d.length() <= 1.0 + 1e-12, "{v} {d} at {p}");
        worst = worst.max(d.angle_between(out).to_degrees());
    }
    // The samples are rounded to 1/32 of a voxel, which is 1.2 degrees over a voxel and a half.
    assert!(worst < 2.0, "{worst} degrees");
}

#[test]
fn the_field_of_a_ball_in_voxels_stays_near_its_distance_everywhere() {
    let prepared = PreparedShape::new(&ball(0.5, 0.02));
    let mut random = Random::new(4);
    let mut least = f64::INFINITY;
    for _ in 0..3_000 {
        let p = random.point(3.0);
        let (value, exact) = (evaluate(&prepared, p.to_array()), p.length() - 0.5);
        assert!(
            value.abs() <= exact.abs() + 1e-9 + 0.02 * 0.1 && (value < 0.0) == (exact < 0.0),
            "{value}, {exact} at {p}"
        );
        least = least.min(value / exact);
    }
    assert!(least > 0.3, "{least} of the distance");
}
