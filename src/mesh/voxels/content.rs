//! What is known of all bricks near the surface.

use rayon::prelude::*;

use super::detail::Detail;
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
/// More than distances in 32 bits are off, in voxels.
const ROUNDING: f64 = 0.01;
/// Of all bricks with samples, at least a third are near enough to keep them.
const SAMPLED_PER_KEPT: usize = 4;

/// What is known of a brick.
enum Known {
    /// Nothing of it is near the surface.
    Empty { is_inside: bool },
    /// The next coarser level tells as much.
    Coarser,
    /// Its samples, and on which side it lies if it turned out to be empty.
    Sampled { samples: Box<[u8; BRICK_VOLUME]>, empty: Option<bool> },
}

/// What is known of all bricks near the surface, and the distances at the corners of cells.
pub(super) struct Contents<'a> {
    /// Corners along each axis.
    size: [usize; 3],
    corners: Vec<f32>,
    /// The place of each cell in the list.
    slots: Vec<u32>,
    bricks: Vec<Known>,
    grid: BrickGrid,
    distances: &'a Distances<'a>,
    detail: Option<Detail<'a>>,
}

impl<'a> Contents<'a> {
    /// Measures all of it; bricks that `detail` does not ask for are left out.
    pub fn new(
        grid: BrickGrid,
        distances: &'a Distances<'a>,
        detail: Option<Detail<'a>>,
        watch: &Watch,
    ) -> Result<Self, BrickError> {
        let size = grid.cells.map(|n| n as usize + 1);
        let corners = measured(&grid, size, distances, watch)?;
        let (slots, bricks) = (vec![u32::MAX; grid.cell_count()], Vec::new());
        let mut out = Self { size, corners, slots, bricks, grid, distances, detail };
        let mut asked = Vec::new();
        for (index, slot) in out.slots.iter_mut().enumerate() {
            let cell = split(index, grid.cells);
            let corner = |i: usize| out.corners[joined([0, 1, 2].map(|a| cell[a] as usize + (i >> a & 1)), size)];
            if (0..8).any(|i| corner(i).abs() < ASKED) {
                *slot = asked.len() as u32;
                asked.push(cell);
            }
        }
        out.bricks = out.sampled(&asked, watch)?;
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
            Some(Known::Sampled { samples, empty: None }) => BrickContent::Samples(samples.clone()),
            Some(Known::Sampled { empty: Some(is_inside), .. } | Known::Empty { is_inside }) => {
                BrickContent::Empty { is_inside: *is_inside }
            }
            Some(Known::Coarser) => BrickContent::Coarser,
            // Nobody asks for bricks of other cells.
            None => BrickContent::Empty { is_inside: false },
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
    fn sampled(&self, cells: &[[u32; 3]], watch: &Watch) -> Result<Vec<Known>, BrickError> {
        let share = 0.4 / cells.len().max(1) as f64;
        let of_cell = |cell: &[u32; 3]| {
            watch.check()?;
            let bricks = bricks_of_cell(*cell).map(|brick| self.measure(brick));
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

    fn measure(&self, brick: [u32; 3]) -> Known {
        let first = brick.map(|n| n * BRICK_VOXELS);
        // A corner of the cell is at most a cell away.
        let corner = self.corners[joined(brick.map(|n| (n / CELL_BRICKS) as usize), self.size)].abs();
        let away = self.distances.at(voxels(&self.grid, self.grid.middle(brick)), first, corner + 25.0);
        let beyond = away.abs() - HALF_DIAGONAL - 0.01;
        if beyond >= BAND as f32 {
            return Known::Empty { is_inside: away < 0.0 };
        }
        if self.detail.as_ref().is_some_and(|detail| detail.is_told(&self.grid, brick, self.distances)) {
            return Known::Coarser;
        }
        let Sampled { samples, least } = self.distances.sampled(brick);
        // The square of a distance, less that of the place, is concave: between samples it is at most 1/4 for each axis
        // below the least of theirs.
        let least = f64::from(least) - ROUNDING;
        let between = if self.distances.has_thin() { least - 0.87 } else { (least * least - 0.75).max(0.0).sqrt() };
        let is_inside = samples[0] < 128;
        Known::Sampled { samples, empty: (between.max(f64::from(beyond)) >= BAND).then_some(is_inside) }
    }

    /// Gives neighbors the same samples on their common face.
    fn share(&mut self, cells: &[[u32; 3]], watch: &Watch) -> Result<(), BrickError> {
        let bricks: Vec<[u32; 3]> = cells.iter().flat_map(|cell| bricks_of_cell(*cell)).collect();
        let common: Vec<Vec<(usize, u8)>> = bricks.par_iter().map(|brick| self.common(*brick)).collect();
        watch.check()?;
        self.bricks.par_iter_mut().zip(common).for_each(|(known, common)| {
            if let Known::Sampled { samples, .. } = known {
                common.iter().for_each(|(index, sample)| samples[*index] = *sample);
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

fn joined([x, y, z]: [usize; 3], size: [usize; 3]) -> usize {
    x + size[0] * (y + size[1] * z)
}

fn split(index: usize, size: [u32; 3]) -> [u32; 3] {
    let [nx, ny, _] = size.map(|n| n as usize);
    [index % nx, index / nx % ny, index / (nx * ny)].map(|n| n as u32)
}
