//! Distances as texels.

use std::sync::Arc;

use isolith_geometry::Aabb;

use super::{
    BAND, BRICK_COARSER, BRICK_INSIDE, BRICK_SAMPLES, BRICK_TEXELS, BRICK_VOLUME, BRICK_VOXELS, BrickError, BrickGrid,
    Bricks, CELL_BRICKS, CELL_VOXELS, COARSER, HAS_SAMPLES, INSIDE, MAX_BRICK_TEXELS, NO_ENTRIES, SAMPLE_REACH,
    SAMPLE_STEPS,
};

/// What is known of a brick.
#[derive(Clone, Debug, PartialEq)]
pub enum BrickContent {
    /// The surface is at least [`super::BAND`] voxels from all of it.
    Empty {
        /// On which side it lies.
        is_inside: bool,
    },
    /// Its samples, x fastest, see [`BrickContent::sample_byte`].
    Samples(Box<[u8; BRICK_VOLUME]>),
    /// The next coarser level tells as much.
    Coarser,
}

impl BrickContent {
    /// A sample for a distance in voxels.
    pub fn sample_byte(voxels: f64) -> u8 {
        (voxels.clamp(-SAMPLE_REACH, SAMPLE_REACH) * SAMPLE_STEPS + 128.0).round().clamp(0.0, 255.0) as u8
    }

    /// The distance that a sample holds, in voxels.
    pub fn sample_voxels(byte: u8) -> f64 {
        (f64::from(byte) - 128.0) / SAMPLE_STEPS
    }

    /// The greatest slope of the interpolation of these samples: that of a trilinear function stands at a corner of its
    /// voxel, since the square of each of its derivatives is convex along each axis.
    pub fn slope(samples: &[u8; BRICK_VOLUME]) -> f64 {
        const STRIDES: [usize; 3] = [1, BRICK_SAMPLES, BRICK_SAMPLES * BRICK_SAMPLES];
        let mut most = 0;
        for [x, y, z] in cells([BRICK_VOXELS; 3]) {
            let first = x as usize * STRIDES[0] + y as usize * STRIDES[1] + z as usize * STRIDES[2];
            let at = |corner: usize| {
                let offset: usize = (0..3).map(|axis| (corner >> axis & 1) * STRIDES[axis]).sum();
                i32::from(samples[first + offset])
            };
            let corners: [i32; 8] = std::array::from_fn(at);
            for (corner, own) in corners.iter().enumerate() {
                let squared = (0..3).map(|axis| (corners[corner ^ 1 << axis] - own).pow(2)).sum();
                most = most.max(squared);
            }
        }
        f64::from(most).sqrt() / SAMPLE_STEPS
    }
}

/// What bricks are written of.
pub struct BrickSource<'a> {
    /// Where they lie.
    pub grid: BrickGrid,
    /// A box around the surface.
    pub bounds: Aabb,
    /// The next level, if there is one.
    pub coarser: Option<Arc<Bricks>>,
    /// The distance at a corner of cells, in meters, negative inside, at most one voxel off.
    pub corner: &'a dyn Fn([u32; 3]) -> f64,
    /// What is known of a brick. Those of a cell far from the surface are not asked for.
    pub brick: &'a dyn Fn([u32; 3]) -> BrickContent,
}

/// Writes bricks, and returns those with samples in their order.
///
/// # Errors
/// There are too many.
pub fn encode(source: BrickSource<'_>) -> Result<(Bricks, Vec<[u32; 3]>), BrickError> {
    let BrickSource { grid, bounds, coarser, corner, brick } = source;
    let least = grid.cell_count().div_ceil(4);
    if least > MAX_BRICK_TEXELS {
        return Err(BrickError::TooLarge { texels: least });
    }
    let corners = Corners::new(&grid, corner);
    // The distance at a point is at most half a diagonal off from that of some corner, and the corners a voxel.
    let error = grid.voxel * (0.75_f64.sqrt() * f64::from(CELL_VOXELS) + 1.0);
    let (mut entries, mut samples, mut order) = (Vec::new(), Vec::new(), Vec::new());
    let mut places = vec![[NO_ENTRIES; 4]; least];
    for (index, cell) in cells(grid.cells).enumerate() {
        let place = &mut places[index / 4][index % 4];
        let side = corners.side(cell);
        if side.abs() - error >= BAND * grid.voxel {
            *place = if side < 0.0 { INSIDE } else { NO_ENTRIES };
            continue;
        }
        let mut own = [0; 8];
        for (entry, [x, y, z]) in own.iter_mut().zip(cells([CELL_BRICKS; 3])) {
            let at = [cell[0] * CELL_BRICKS + x, cell[1] * CELL_BRICKS + y, cell[2] * CELL_BRICKS + z];
            let content = brick(at);
            order.extend(matches!(content, BrickContent::Samples(_)).then_some(at));
            *entry = written(content, &mut samples);
        }
        let common = own.iter().all(|entry| *entry == own[0]).then_some(own[0]);
        *place = match common {
            Some(0) => NO_ENTRIES,
            Some(BRICK_INSIDE) => INSIDE,
            Some(BRICK_COARSER) => COARSER,
            _ => {
                entries.extend([[own[0], own[1], own[2], own[3]], [own[4], own[5], own[6], own[7]]]);
                (entries.len() / 2 - 1) as u32
            }
        };
        let texels = least + entries.len() + samples.len();
        if texels > MAX_BRICK_TEXELS {
            return Err(BrickError::TooLarge { texels });
        }
    }
    let mut texels = places;
    texels.extend(entries);
    let first_brick = texels.len() as u32;
    texels.extend(samples);
    let mut bricks = Bricks { grid, bounds, first_brick, texels, looks: None, coarser };
    bricks.meet_coarser(&order);
    Ok((bricks, order))
}

/// All indices below `count`, x fastest.
pub(super) fn cells(count: [u32; 3]) -> impl Iterator<Item = [u32; 3]> {
    let [nx, ny, nz] = count;
    (0..nz).flat_map(move |z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])))
}

/// The entry of a brick; its samples are appended.
fn written(content: BrickContent, texels: &mut Vec<[u32; 4]>) -> u32 {
    match content {
        BrickContent::Empty { is_inside } => u32::from(is_inside) * BRICK_INSIDE,
        BrickContent::Coarser => BRICK_COARSER,
        BrickContent::Samples(samples) => {
            let number = (texels.len() / BRICK_TEXELS) as u32;
            let word = |bytes: &[u8]| u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
            let texel = |b: &[u8]| [word(&b[..4]), word(&b[4..8]), word(&b[8..12]), word(&b[12..])];
            texels.extend(samples.chunks(16).map(texel));
            HAS_SAMPLES | number
        }
    }
}

/// The distances at the corners of cells.
struct Corners {
    count: [usize; 3],
    values: Vec<f64>,
}

impl Corners {
    fn new(grid: &BrickGrid, corner: &dyn Fn([u32; 3]) -> f64) -> Self {
        let count = grid.cells.map(|n| n + 1);
        Self { count: count.map(|n| n as usize), values: cells(count).map(corner).collect() }
    }

    /// The distance of least size at the corners of a cell; 0 if the signs differ.
    fn side(&self, cell: [u32; 3]) -> f64 {
        let [x, y, z] = cell.map(|n| n as usize);
        let at = |i: usize| x + (i & 1) + self.count[0] * (y + (i >> 1 & 1) + self.count[1] * (z + (i >> 2)));
        let corners = [0, 1, 2, 3, 4, 5, 6, 7].map(|i| self.values[at(i)]);
        let least = corners.iter().fold(f64::INFINITY, |least, v| least.min(v.abs()));
        if corners.iter().all(|v| *v > 0.0) {
            least
        } else if corners.iter().all(|v| *v < 0.0) {
            -least
        } else {
            0.0
        }
    }
}
