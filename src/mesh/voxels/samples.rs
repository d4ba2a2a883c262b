//! The samples of a brick.

use glam::{UVec3, Vec3};

use super::columns::Columns;
use super::facets::{LevelFacets, LevelScale, NONE};
use super::solid::Solid;
use isolith_bricks::{BRICK_SAMPLES, BRICK_VOLUME, BRICK_VOXELS, BrickContent, BrickGrid, SAMPLE_REACH};

/// Half the thickness of sheets, in the finest voxels. With only half a voxel one could lie between two layers of samples, and both
/// would measure 0.
pub(super) const SHEET_HALF: f32 = 0.75;
/// Half the diagonal of a brick, in voxels.
pub(super) const HALF_DIAGONAL: f32 = 6.062_178;
/// Up to this far from a triangle all samples around it are compared with it: the corners of the voxels that the surface
/// passes. Those farther away look for the nearest in the hierarchy, from what their neighbors found.
const EXACT: f32 = 1.75;
/// Beyond this many triangles in a brick none is compared with all samples around it.
const CROWDED: usize = 1_500;
const SIDE: usize = BRICK_SAMPLES;

/// The distances of a solid in the voxels of a level.
pub(super) struct Distances<'a> {
    solid: &'a Solid,
    columns: &'a Columns,
    scale: LevelScale,
    /// Half the thickness of sheets, in voxels.
    sheet_half: f32,
}

/// A brick with samples.
pub(super) struct Sampled {
    pub samples: Box<[u8; BRICK_VOLUME]>,
    /// The least distance at a sample, without sign, in voxels.
    pub least: f32,
}

/// A brick's distances without sign; infinite where they are beyond what samples hold.
type Band = [f32; BRICK_VOLUME];

impl<'a> Distances<'a> {
    pub fn new(solid: &'a Solid, columns: &'a Columns, scale: LevelScale) -> Self {
        Self { solid, columns, scale, sheet_half: SHEET_HALF / scale.step as f32 }
    }

    /// The triangles of closed pieces.
    pub fn closed(&self) -> LevelFacets<'_> {
        LevelFacets::new(&self.solid.closed, self.scale)
    }

    /// Those of sheets and of what is thin.
    pub fn thin(&self) -> LevelFacets<'_> {
        LevelFacets::new(&self.solid.thin, self.scale)
    }

    /// Half the thickness of sheets, in voxels.
    pub fn sheet_half(&self) -> f32 {
        self.sheet_half
    }

    /// Whether anything is thin.
    pub fn has_thin(&self) -> bool {
        !self.solid.thin.is_empty()
    }

    /// Whether a sample lies inside a closed piece.
    pub fn is_inside(&self, sample: [i32; 3]) -> bool {
        self.columns.is_inside(self.scale.sample(sample))
    }

    /// The distance at a point, in voxels, that lies on the same side as this sample and is at most `within` far from the
    /// surface; infinite if that is not known.
    pub fn at(&self, p: Vec3, sample: [u32; 3], within: f32) -> f32 {
        let away = |facets: LevelFacets<'_>, within: f32| {
            facets.nearest(p, within * within).map_or(f32::INFINITY, |(squared, _)| squared.sqrt())
        };
        let closed = away(self.closed(), within);
        let closed = if self.is_inside(sample.map(|n| n as i32)) { -closed } else { closed };
        let thin = away(self.thin(), within.min(closed.abs()) + 2.0 * self.sheet_half) - self.sheet_half;
        closed.min(thin)
    }

    /// The samples of a brick.
    pub fn sampled(&self, brick: [u32; 3]) -> Sampled {
        let first = brick.map(|n| n * BRICK_VOXELS);
        let reach = SAMPLE_REACH as f32;
        let mut values = band(self.closed(), first, reach);
        self.sign(first, &mut values);
        if self.has_thin() {
            let thin = band(self.thin(), first, reach + self.sheet_half);
            values.iter_mut().zip(thin).for_each(|(value, thin)| *value = value.min(thin - self.sheet_half));
        }
        let least = values.iter().fold(reach, |least, value| least.min(value.abs()));
        Sampled { samples: Box::new(values.map(|value| BrickContent::sample_byte(f64::from(value)))), least }
    }

    /// Gives distances their signs. A sample has a surface within a voxel if and only if a neighbor lies on the other
    /// side: walls within the solid are none.
    fn sign(&self, first: [u32; 3], values: &mut Band) {
        const WIDE: usize = SIDE + 2;
        let around = first.map(|n| n as i32 - 1);
        let mut inside = [[0_u16; WIDE]; WIDE];
        let (mut any, mut all) = (0, u16::MAX);
        for (y, row) in inside.iter_mut().enumerate() {
            for (x, bits) in row.iter_mut().enumerate() {
                let (column_x, column_y) = (around[0] + x as i32, around[1] + y as i32);
                let [x, y, _] = self.scale.sample([column_x, column_y, 0]);
                if !self.columns.is_empty(x, y) {
                    let is_inside = |z: usize| self.is_inside([column_x, column_y, around[2] + z as i32]);
                    *bits = (0..WIDE).fold(0, |bits, z| bits | u16::from(is_inside(z)) << z);
                }
                (any, all) = (any | *bits, all & *bits);
            }
        }
        let is_mixed = any != 0 && all & ((1 << WIDE) - 1) != (1 << WIDE) - 1;
        for (i, value) in values.iter_mut().enumerate() {
            let (x, y, z) = (i % SIDE, i / SIDE % SIDE, i / (SIDE * SIDE));
            let own = inside[y + 1][x + 1] >> (z + 1) & 1;
            if is_mixed && *value < EXACT {
                let near = 0b111 << z;
                let rows = inside[y..y + 3].iter().flat_map(|row| &row[x..x + 3]);
                let is_alone = rows.clone().all(|bits| bits & near == if own == 1 { near } else { 0 });
                let beside = [[x, y + 1], [x + 2, y + 1], [x + 1, y], [x + 1, y + 2]];
                let is_beside = beside.iter().any(|[x, y]| inside[*y][*x] >> (z + 1) & 1 != own)
                    || [z, z + 2].iter().any(|z| inside[y + 1][x + 1] >> z & 1 != own);
                if is_alone {
                    *value = value.max(1.0);
                } else if is_beside {
                    *value = value.min(1.0);
                }
            } else if !is_mixed {
                *value = value.max(1.0);
            }
            if own == 1 {
                *value = -*value;
            }
        }
    }
}

/// The distances of a brick's samples from the triangles, up to `reach`.
fn band(facets: LevelFacets<'_>, first: [u32; 3], reach: f32) -> Band {
    let mut band = [f32::INFINITY; BRICK_VOLUME];
    let origin = UVec3::from(first).as_vec3();
    let middle = Vec3::splat(0.5 * BRICK_VOXELS as f32);
    let Some((squared, seed)) = facets.nearest(origin + middle, (HALF_DIAGONAL + reach).powi(2)) else { return band };
    let away = squared.sqrt();
    let mut nearest = Nearest { facets, origin, squared: [f32::INFINITY; BRICK_VOLUME], ids: [NONE; BRICK_VOLUME] };
    nearest.compare_all();
    // The distance changes at most as much as the place.
    let is_wanted: [bool; BRICK_VOLUME] = std::array::from_fn(|i| away - place(i).distance(middle) < reach);
    for half in 0..8 {
        nearest.compare(index([half & 1, half >> 1 & 1, half >> 2].map(|side| 3 + side)), seed);
    }
    nearest.complete(reach, &is_wanted);
    for (value, squared) in band.iter_mut().zip(nearest.squared) {
        *value = squared.sqrt();
    }
    band
}

/// The nearest triangles found so far.
struct Nearest<'a> {
    facets: LevelFacets<'a>,
    origin: Vec3,
    squared: [f32; BRICK_VOLUME],
    ids: [u32; BRICK_VOLUME],
}

impl Nearest<'_> {
    /// Compares the samples around each triangle with it, if there are not too many.
    fn compare_all(&mut self) {
        let mut found = Vec::new();
        let high = self.origin + BRICK_VOXELS as f32 + EXACT;
        self.facets.within(self.origin - EXACT, high, |triangle| found.push(triangle));
        // Of so many a search for each sample finds the nearest sooner.
        if found.len() > CROWDED {
            return;
        }
        let last = (SIDE - 1) as f32;
        for triangle in found {
            let [low, high] = self.facets.extent(triangle);
            let low = (low - self.origin - EXACT).ceil().clamp(Vec3::ZERO, Vec3::splat(last + 1.0)).as_uvec3();
            let high = (high - self.origin + EXACT).floor().min(Vec3::splat(last)).as_ivec3();
            for z in low.z as i32..=high.z {
                for y in low.y as i32..=high.y {
                    for x in low.x as i32..=high.x {
                        self.compare(index([x, y, z].map(|n| n as usize)), triangle);
                    }
                }
            }
        }
    }

    fn compare(&mut self, i: usize, triangle: u32) {
        let squared = self.facets.distance_squared(triangle, self.origin + place(i));
        if squared < self.squared[i] {
            (self.squared[i], self.ids[i]) = (squared, triangle);
        }
    }

    /// Finds the nearest triangles of all others, no farther than what their neighbors found.
    fn complete(&mut self, reach: f32, is_wanted: &[bool; BRICK_VOLUME]) {
        for i in 0..BRICK_VOLUME {
            if self.squared[i] <= EXACT * EXACT || !is_wanted[i] {
                continue;
            }
            for stride in [1, SIDE, SIDE * SIDE] {
                let id = if i / stride % SIDE > 0 { self.ids[i - stride] } else { NONE };
                if id != NONE && id != self.ids[i] {
                    self.compare(i, id);
                }
            }
            let within = self.squared[i].min(reach * reach);
            if let Some((squared, id)) = self.facets.nearest(self.origin + place(i), within) {
                (self.squared[i], self.ids[i]) = (squared, id);
            }
        }
    }
}

fn index([x, y, z]: [usize; 3]) -> usize {
    x + SIDE * (y + SIDE * z)
}

fn place(i: usize) -> Vec3 {
    Vec3::new((i % SIDE) as f32, (i / SIDE % SIDE) as f32, (i / (SIDE * SIDE)) as f32)
}

/// A place in the grid, in voxels from its first sample.
pub(super) fn voxels(grid: &BrickGrid, p: glam::DVec3) -> Vec3 {
    ((p - grid.origin) / grid.voxel).as_vec3()
}
