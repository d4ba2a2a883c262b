//! What is known of all bricks near the surface.

use rayon::prelude::*;

use super::samples::{Distances, HALF_DIAGONAL, Sampled, voxels};
use super::watch::Watch;
use isolith_bricks::{
    BAND, BRICK_SAMPLES, BRICK_TEXELS, BRICK_VOLUME, BRICK_VOXELS, BrickContent, BrickError, BrickGrid, CELL_BRICKS,
    CELL_VOXELS, MAX_BRICK_TEXELS,
};

/// Cells farther than this from the surface have no entries, in voxels: half a diagonal of a cell and more.
const ASKED: f32 = 20.0;
/// Bricks of a cell.
const IN_CELL: usize = (CELL_BRICKS * CELL_BRICKS * CELL_BRICKS) as usize;
/// The nearest triangles that neighbors know are this far from the best at most, in voxels.
const SPREAD_ERROR: f64 = 0.1;
/// Of all bricks with samples, about half are near enough to keep them.
const SAMPLED_PER_KEPT: usize = 4;

/// What is known of a brick.
enum Known {
    /// At least this far from the surface, in voxels.
    Far(f32),
    /// Where its samples are.
    Sampled { samples: Box<[u8; BRICK_VOLUME]>, slope: f64, far: Option<f64> },
}

/// What is known of all bricks near the surface, and the distances at the corners of cells.
pub(super) struct Contents {
    /// Corners along each axis.
    size: [usize; 3],
    corners: Vec<f32>,
    /// The place of each cell in the list.
    slots: Vec<u32>,
    bricks: Vec<Known>,
    grid: BrickGrid,
}

impl Contents {
    /// Measures all of it.
    pub fn new(grid: BrickGrid, distances: &Distances<'_>, watch: &Watch) -> Result<Self, BrickError> {
        let size = grid.cells.map(|n| n as usize + 1);
        let corners = measured(&grid, size, distances, watch)?;
        let mut out = Self { size, corners, slots: vec![u32::MAX; grid.cell_count()], bricks: Vec::new(), grid };
        let mut asked = Vec::new();
        for (index, slot) in out.slots.iter_mut().enumerate() {
            let cell = split(index, grid.cells);
            let corner = |i: usize| out.corners[joined([0, 1, 2].map(|a| cell[a] as usize + (i >> a & 1)), size)];
            if (0..8).any(|i| corner(i).abs() < ASKED) {
                *slot = asked.len() as u32;
                asked.push(cell);
            }
        }
        out.bricks = out.sampled(&asked, distances, watch)?;
        out.share(&asked, watch)?;
        Ok(out)
    }

    /// The distance at a corner of cells, in voxels.
    pub fn corner(&self, corner: [u32; 3]) -> f64 {
        f64::from(self.corners[joined(corner.map(|n| n as usize), self.size)])
    }

    /// What is known of a brick; its cell has a corner near the surface.
    pub fn brick(&self, brick: [u32; 3]) -> BrickContent {
        match self.known(brick) {
            Some(Known::Sampled { samples, far: None, .. }) => {
                let mut slope = 0.0_f64;
                for at in around() {
                    let neighbor = [0, 1, 2].map(|i| brick[i].wrapping_add_signed(at[i]));
                    if let Some(Known::Sampled { slope: own, .. }) = self.known(neighbor) {
                        slope = slope.max(*own);
                    }
                }
                BrickContent::Near { samples: samples.clone(), slope }
            }
            Some(Known::Sampled { far: Some(far), .. }) => BrickContent::Far(*far),
            Some(Known::Far(far)) => BrickContent::Far(f64::from(*far)),
            // Nobody asks for bricks of other cells.
            None => BrickContent::Far(BAND),
        }
    }

    fn known(&self, brick: [u32; 3]) -> Option<&Known> {
        self.place(brick).map(|place| &self.bricks[place])
    }

    fn place(&self, brick: [u32; 3]) -> Option<usize> {
        let cell = brick.map(|n| n / CELL_BRICKS);
        if (0..3).any(|i| cell[i] >= self.grid.cells[i]) {
            return None;
        }
        let slot = self.slots[joined(cell.map(|n| n as usize), self.grid.cells.map(|n| n as usize))];
        let own = joined(brick.map(|n| (n % CELL_BRICKS) as usize), [CELL_BRICKS as usize; 3]);
        (slot != u32::MAX).then_some(slot as usize * IN_CELL + own)
    }

    /// Samples the bricks of these cells.
    fn sampled(&self, cells: &[[u32; 3]], distances: &Distances<'_>, watch: &Watch) -> Result<Vec<Known>, BrickError> {
        let share = 0.4 / cells.len().max(1) as f64;
        let of_cell = |cell: &[u32; 3]| {
            watch.check()?;
            let bricks = bricks_of_cell(*cell).map(|brick| self.measure(brick, distances));
            watch.advance(share);
            Ok(bricks.collect::<Vec<_>>())
        };
        let mut out = Vec::with_capacity(cells.len() * IN_CELL);
        // In runs, so that far too many bricks are noticed before they fill the memory.
        let mut sampled = 0;
        for run in cells.chunks(4_096) {
            let known: Vec<_> = run.par_iter().map(of_cell).collect::<Result<_, BrickError>>()?;
            out.extend(known.into_iter().flatten());
            let added = out[out.len() - run.len() * IN_CELL..].iter();
            sampled += added.filter(|known| matches!(known, Known::Sampled { .. })).count();
            if sampled > SAMPLED_PER_KEPT * MAX_BRICK_TEXELS / BRICK_TEXELS {
                return Err(BrickError::TooLarge { texels: sampled / SAMPLED_PER_KEPT * BRICK_TEXELS });
            }
        }
        Ok(out)
    }

    fn measure(&self, brick: [u32; 3], distances: &Distances<'_>) -> Known {
        let first = brick.map(|n| n * BRICK_VOXELS);
        // A corner of the cell is at most a cell away.
        let corner = self.corners[joined(brick.map(|n| (n / CELL_BRICKS) as usize), self.size)].abs();
        let away = distances.at(voxels(&self.grid, self.grid.middle(brick)), first, corner + 25.0);
        let beyond = away.abs() - HALF_DIAGONAL - 0.01;
        if beyond >= BAND as f32 {
            return Known::Far(beyond.copysign(away));
        }
        let Sampled { samples, least } = distances.sampled(brick);
        // The square of a distance, less that of the place, is concave: between samples it is at most 1/4 for each axis
        // below the least of theirs.
        let least = f64::from(least) - SPREAD_ERROR;
        let between =
            if distances.solid.thin.is_empty() { (least * least - 0.75).max(0.0).sqrt() } else { least - 0.87 };
        let far = between.max(f64::from(beyond));
        let sign = if samples[0] < 128 { -1.0 } else { 1.0 };
        Known::Sampled { samples, slope: 0.0, far: (far >= BAND).then_some(far.copysign(sign)) }
    }

    /// Gives neighbors the same samples on their common face, and measures slopes.
    fn share(&mut self, cells: &[[u32; 3]], watch: &Watch) -> Result<(), BrickError> {
        let bricks: Vec<[u32; 3]> = cells.iter().flat_map(|cell| bricks_of_cell(*cell)).collect();
        let common: Vec<Vec<(usize, u8)>> = bricks.par_iter().map(|brick| self.common(*brick)).collect();
        watch.check()?;
        self.bricks.par_iter_mut().zip(common).for_each(|(known, common)| {
            if let Known::Sampled { samples, slope, .. } = known {
                common.iter().for_each(|(index, sample)| samples[*index] = *sample);
                *slope = BrickContent::slope(samples);
            }
        });
        watch.advance(0.05);
        watch.check()
    }

    /// The samples on the upper faces of a brick that differ from those of the neighbors to which they belong.
    fn common(&self, brick: [u32; 3]) -> Vec<(usize, u8)> {
        let Some(Known::Sampled { samples, .. }) = self.known(brick) else { return Vec::new() };
        let side = BRICK_SAMPLES;
        let mut out = Vec::new();
        for upper in 1..8_usize {
            let neighbor = [0, 1, 2].map(|i| brick[i] + (upper >> i & 1) as u32);
            let Some(Known::Sampled { samples: theirs, .. }) = self.known(neighbor) else { continue };
            let run = |axis: usize| if upper >> axis & 1 == 1 { side - 1..side } else { 0..side - 1 };
            for (z, y) in run(2).flat_map(|z| run(1).map(move |y| (z, y))) {
                for x in run(0) {
                    let own = joined([x, y, z], [side; 3]);
                    let their = joined([x, y, z].map(|n| n % (side - 1)), [side; 3]);
                    if samples[own] != theirs[their] {
                        out.push((own, theirs[their]));
                    }
                }
            }
        }
        out
    }
}

/// The distances at the corners of cells.
fn measured(
    grid: &BrickGrid,
    size: [usize; 3],
    distances: &Distances<'_>,
    watch: &Watch,
) -> Result<Vec<f32>, BrickError> {
    let share = 0.05 / (size[1] * size[2]) as f64;
    let rows: Vec<Vec<f32>> = (0..size[1] * size[2])
        .into_par_iter()
        .map(|row| {
            watch.check()?;
            let mut last = f32::INFINITY;
            let along = (0..size[0]).map(|x| {
                let corner = [x, row % size[1], row / size[1]].map(|n| n as u32);
                let sample = corner.map(|n| n * CELL_VOXELS);
                // No more than one step farther than the last corner.
                let within = last.abs() + CELL_VOXELS as f32 + 0.1;
                last = distances.at(voxels(grid, grid.corner(corner)), sample, within);
                last
            });
            let along = along.collect();
            watch.advance(share);
            Ok(along)
        })
        .collect::<Result<_, BrickError>>()?;
    Ok(rows.into_iter().flatten().collect())
}

fn bricks_of_cell(cell: [u32; 3]) -> impl Iterator<Item = [u32; 3]> {
    let side = CELL_BRICKS as usize;
    (0..IN_CELL).map(move |i| {
        let own = [i % side, i / side % side, i / (side * side)];
        [0, 1, 2].map(|axis| cell[axis] * CELL_BRICKS + own[axis] as u32)
    })
}

/// The steps to all neighbors, and none.
fn around() -> impl Iterator<Item = [i32; 3]> {
    (0..27).map(|i| [i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1])
}

fn joined([x, y, z]: [usize; 3], size: [usize; 3]) -> usize {
    x + size[0] * (y + size[1] * z)
}

fn split(index: usize, size: [u32; 3]) -> [u32; 3] {
    let [nx, ny, _] = size.map(|n| n as usize);
    [index % nx, index / nx % ny, index / (nx * ny)].map(|n| n as u32)
}
