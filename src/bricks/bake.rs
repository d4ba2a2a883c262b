//! Bricks of a field that is known everywhere.

use std::collections::HashMap;
use std::sync::atomic::{AtomicUsize, Ordering};

use glam::DVec3;
use rayon::prelude::*;

use isolith_geometry::Aabb;

use super::encode::cells;
use super::{
    BAND, BRICK_SAMPLES, BRICK_VOLUME, BRICK_VOXELS, BrickContent, BrickError, BrickGrid, Bricks, CELL_BRICKS,
    CELL_VOXELS, Looks, MAX_BRICK_TEXELS, RESOLUTIONS, VoxelLook, encode, surface_samples,
};

/// Half the diagonal of a brick, in voxels.
const HALF_DIAGONAL: f64 = 6.062_178;
/// How far from the surface values are asked for, in voxels: more than the diagonal of a cell and the band.
const ASKED: f64 = 40.0;

/// A field that becomes bricks.
pub struct BakedField<'a> {
    /// They hold its surface.
    pub bounds: Aabb,
    /// The value at a point, in meters: its sign is exact, its slope at most 1. Where it is at least the second number,
    /// any value of at least that number may stand for it.
    pub distance: &'a (dyn Fn(DVec3, f64) -> f64 + Sync),
    /// The look of the surface near a point, if it has one.
    pub look: Option<&'a (dyn Fn(DVec3) -> VoxelLook + Sync)>,
}

/// Told the share that is done; stops the work by returning false.
pub type BakeProgress<'a> = &'a (dyn Fn(f32) -> bool + Sync);

/// Bricks of the solid with these distances, in meters. `bounds` hold its surface.
///
/// # Errors
/// As [`bake_field`].
pub fn bake(bounds: Aabb, voxel: f64, distance: &(dyn Fn(DVec3) -> f64 + Sync)) -> Result<Bricks, BrickError> {
    bake_field(&BakedField { bounds, distance: &|p, _| distance(p), look: None }, voxel, &|_| true)
}

/// Bricks of a field, made on all cores.
///
/// # Errors
/// There are too many, the field has no bounds, or `progress` returned false.
pub fn bake_field(field: &BakedField<'_>, voxel: f64, progress: BakeProgress<'_>) -> Result<Bricks, BrickError> {
    let bounds = field.bounds;
    if !(voxel > 0.0 && voxel.is_finite()) {
        return Err(BrickError::Voxel);
    }
    if bounds.is_empty() {
        return Err(BrickError::Empty);
    }
    if !bounds.is_finite() {
        return Err(BrickError::Endless);
    }
    let grid = BrickGrid::around(&bounds, voxel);
    let least = grid.cell_count().div_ceil(4);
    if least > MAX_BRICK_TEXELS {
        return Err(BrickError::TooLarge { texels: least });
    }
    // A little more than the limit, for sizes that were rounded.
    let across = (2.0 * bounds.half()).max_element() / voxel;
    if across > f64::from(RESOLUTIONS[1]) * 1.001 {
        return Err(BrickError::TooFine { voxels: across.min(1e18) as u64 });
    }
    let value = |p: DVec3| (field.distance)(p, ASKED * voxel);
    let size = grid.cells.map(|n| n + 1);
    let corner_list: Vec<[u32; 3]> = cells(size).collect();
    let corners: Vec<f64> = corner_list.par_iter().map(|corner| value(grid.corner(*corner))).collect();
    let corner = |[x, y, z]: [u32; 3]| corners[(x + size[0] * (y + size[1] * z)) as usize];
    let is_near = |cell: &[u32; 3]| {
        let reach = ASKED.min(BAND + 2.0 * f64::from(CELL_VOXELS)) * voxel;
        cells([2; 3]).any(|[x, y, z]| corner([cell[0] + x, cell[1] + y, cell[2] + z]).abs() < reach)
    };
    let near: Vec<[u32; 3]> = cells(grid.cells).filter(is_near).collect();
    let known = measured(&grid, &near, &value, progress)?;
    let content = |brick: &[u32; 3]| known.get(brick).cloned().unwrap_or(BrickContent::Far(BAND));
    let mut order = Vec::new();
    let mut bricks = encode(grid, bounds, &mut |at| corner(at), &mut |brick| {
        let content = content(&brick);
        if let BrickContent::Near { samples, .. } = &content {
            order.push((brick, samples.clone()));
        }
        Ok(content)
    })?;
    if let Some(look) = field.look {
        bricks.looks = Some(painted(&grid, &order, look));
    }
    Ok(bricks)
}

/// What is known of the bricks of these cells.
fn measured(
    grid: &BrickGrid,
    near: &[[u32; 3]],
    value: &(dyn Fn(DVec3) -> f64 + Sync),
    progress: BakeProgress<'_>,
) -> Result<HashMap<[u32; 3], BrickContent>, BrickError> {
    let done = AtomicUsize::new(0);
    let of_cell = |cell: &[u32; 3]| {
        let share = done.fetch_add(1, Ordering::Relaxed) as f32 / near.len() as f32;
        if !progress(share) {
            return Err(BrickError::Canceled);
        }
        let bricks = cells([CELL_BRICKS; 3]).map(|at| [0, 1, 2].map(|i| cell[i] * CELL_BRICKS + at[i]));
        Ok(bricks.map(|brick| (brick, content(grid, brick, value))).collect::<Vec<_>>())
    };
    let all: Vec<_> = near.par_iter().map(of_cell).collect::<Result<_, BrickError>>()?;
    Ok(all.into_iter().flatten().collect())
}

fn content(grid: &BrickGrid, brick: [u32; 3], value: &dyn Fn(DVec3) -> f64) -> BrickContent {
    let away = value(grid.middle(brick)) / grid.voxel;
    let least = away.abs() - HALF_DIAGONAL;
    if least >= BAND {
        return BrickContent::Far(least.copysign(away));
    }
    let first = brick.map(|n| n * BRICK_VOXELS);
    let mut samples = Box::new([0; BRICK_VOLUME]);
    for (sample, at) in samples.iter_mut().zip(cells([BRICK_SAMPLES as u32; 3])) {
        let p = grid.sample([0, 1, 2].map(|i| first[i] + at[i]));
        *sample = BrickContent::sample_byte(value(p) / grid.voxel);
    }
    let slope = BrickContent::slope(&samples);
    BrickContent::Near { samples, slope }
}

/// The looks of these bricks, which are all with samples, in their order.
fn painted(
    grid: &BrickGrid,
    order: &[([u32; 3], Box<[u8; BRICK_VOLUME]>)],
    look: &(dyn Fn(DVec3) -> VoxelLook + Sync),
) -> Looks {
    let of = |(brick, samples): &([u32; 3], Box<[u8; BRICK_VOLUME]>)| {
        let marks = surface_samples(samples);
        let first = brick.map(|n| n * BRICK_VOXELS);
        let places = cells([BRICK_SAMPLES as u32; 3]).zip(marks).filter(|(_, is_marked)| *is_marked);
        let looks = places.map(|(at, _)| look(grid.sample([0, 1, 2].map(|i| first[i] + at[i]))));
        (marks, looks.collect())
    };
    let all: Vec<([bool; BRICK_VOLUME], Vec<VoxelLook>)> = order.par_iter().map(of).collect();
    Looks::new(all.into_iter())
}
