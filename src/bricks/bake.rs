//! Bricks of a field that is known everywhere.

use std::collections::HashMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use glam::DVec3;
use rayon::prelude::*;

use isolith_geometry::Aabb;

use super::encode::{BrickSource, cells};
use super::{
    BAND, BRICK_SAMPLES, BRICK_VOLUME, BRICK_VOXELS, BrickContent, BrickError, BrickGrid, Bricks, CELL_BRICKS,
    CELL_VOXELS, Looks, VoxelLook, encode, in_levels, surface_samples,
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

/// Bricks of the solid with these distances, in meters, in one size of voxels. `bounds` hold its surface.
///
/// # Errors
/// As [`bake_levels`].
pub fn bake(bounds: Aabb, voxel: f64, distance: &(dyn Fn(DVec3) -> f64 + Sync)) -> Result<Bricks, BrickError> {
    bake_field(&BakedField { bounds, distance: &|p, _| distance(p), look: None }, [voxel; 2], None, &|_| true)
}

/// Bricks of a field in voxels of this size and all coarser ones, made on all cores.
///
/// # Errors
/// There are too many, the field has no bounds, or `progress` returned false.
pub fn bake_levels(field: &BakedField<'_>, voxel: f64, progress: BakeProgress<'_>) -> Result<Arc<Bricks>, BrickError> {
    let mut done = 0.0;
    in_levels(&field.bounds, voxel, &mut |own, coarser| {
        // A level takes about four times as long as the next coarser one.
        let share = 0.75 * (voxel / own).powi(2) as f32;
        let before = done;
        done += share;
        bake_field(field, [own, voxel], coarser, &|own| progress((before + share * own).min(1.0)))
    })
}

/// The bricks of one level, with voxels of its own size and of that of the finest level.
fn bake_field(
    field: &BakedField<'_>,
    [voxel, finest]: [f64; 2],
    coarser: Option<Arc<Bricks>>,
    progress: BakeProgress<'_>,
) -> Result<Bricks, BrickError> {
    let grid = BrickGrid::checked(&field.bounds, voxel)?;
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
    let maker = Maker { field, grid, coarser: coarser.as_deref(), finest, value: &value };
    let known = maker.measured(&near, progress)?;
    let brick = |brick: [u32; 3]| known.get(&brick).cloned().unwrap_or(BrickContent::Empty { is_inside: false });
    let bounds = field.bounds;
    let source = BrickSource { grid, bounds, coarser: coarser.clone(), corner: &corner, brick: &brick };
    let (mut bricks, order) = encode(source)?;
    if field.look.is_some() {
        let of = |brick: &[u32; 3]| match bricks.content(*brick) {
            Some(BrickContent::Samples(samples)) => maker.looks(*brick, &samples),
            _ => ([false; BRICK_VOLUME], Vec::new()),
        };
        let all: Vec<([bool; BRICK_VOLUME], Vec<VoxelLook>)> = order.par_iter().map(of).collect();
        bricks.looks = Some(Looks::new(all.into_iter()));
    }
    Ok(bricks)
}

/// What the bricks of a level are made of.
struct Maker<'a> {
    field: &'a BakedField<'a>,
    grid: BrickGrid,
    coarser: Option<&'a Bricks>,
    /// The size of the finest voxels.
    finest: f64,
    /// The distance at a point, in meters.
    value: &'a (dyn Fn(DVec3) -> f64 + Sync),
}

impl Maker<'_> {
    /// What is known of the bricks of these cells.
    fn measured(
        &self,
        near: &[[u32; 3]],
        progress: BakeProgress<'_>,
    ) -> Result<HashMap<[u32; 3], BrickContent>, BrickError> {
        let done = AtomicUsize::new(0);
        let of_cell = |cell: &[u32; 3]| {
            let share = done.fetch_add(1, Ordering::Relaxed) as f32 / near.len() as f32;
            if !progress(share) {
                return Err(BrickError::Canceled);
            }
            let bricks = cells([CELL_BRICKS; 3]).map(|at| [0, 1, 2].map(|i| cell[i] * CELL_BRICKS + at[i]));
            Ok(bricks.map(|brick| (brick, self.content(brick))).collect::<Vec<_>>())
        };
        let all: Vec<_> = near.par_iter().map(of_cell).collect::<Result<_, BrickError>>()?;
        Ok(all.into_iter().flatten().collect())
    }

    fn content(&self, brick: [u32; 3]) -> BrickContent {
        let Self { grid, value, .. } = self;
        let away = value(grid.middle(brick)) / grid.voxel;
        if away.abs() - HALF_DIAGONAL >= BAND {
            return BrickContent::Empty { is_inside: away < 0.0 };
        }
        let mut samples = Box::new([0; BRICK_VOLUME]);
        let mut is_told = self.coarser.is_some();
        for (sample, p) in samples.iter_mut().zip(self.places(brick)) {
            let distance = value(p);
            *sample = BrickContent::sample_byte(distance / grid.voxel);
            is_told = is_told && self.coarser.is_some_and(|coarser| coarser.tells(p, distance, self.finest));
        }
        if is_told && self.is_plain(brick, &samples) { BrickContent::Coarser } else { BrickContent::Samples(samples) }
    }

    /// The places of a brick's samples.
    fn places(&self, brick: [u32; 3]) -> impl Iterator<Item = DVec3> {
        let (grid, first) = (self.grid, brick.map(|n| n * BRICK_VOXELS));
        cells([BRICK_SAMPLES as u32; 3]).map(move |at| grid.sample([0, 1, 2].map(|i| first[i] + at[i])))
    }

    /// The looks of a brick: which samples have some, and these.
    fn looks(&self, brick: [u32; 3], samples: &[u8; BRICK_VOLUME]) -> ([bool; BRICK_VOLUME], Vec<VoxelLook>) {
        let marks = surface_samples(samples);
        let places = self.places(brick).zip(marks).filter(|(_, is_marked)| *is_marked);
        (marks, places.filter_map(|(p, _)| self.field.look.map(|look| look(p))).collect())
    }

    /// Whether the surface looks the same all over a brick.
    fn is_plain(&self, brick: [u32; 3], samples: &[u8; BRICK_VOLUME]) -> bool {
        let (_, looks) = self.looks(brick, samples);
        looks.windows(2).all(|pair| pair[0].packed() == pair[1].packed())
    }
}
