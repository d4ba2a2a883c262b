//! Distances as texels.

use isolith_geometry::Aabb;

use super::{
    BAND, BRICK_SAMPLES, BRICK_TEXELS, BRICK_VOLUME, BrickGrid, Bricks, CELL_BRICKS, CELL_VOXELS, INSIDE,
    MAX_BRICK_TEXELS, NO_ENTRIES, RESOLUTIONS, SAMPLE_REACH, SAMPLE_STEPS,
};

/// What is known of a brick.
#[derive(Clone, Debug, PartialEq)]
pub enum BrickContent {
    /// The surface is at least this far from all of it, in voxels; negative inside. At least [`super::BAND`].
    Far(f64),
    /// It has samples, see [`BrickContent::sample_byte`], and the interpolation of these and those of all neighbors, with samples or
    /// without, has at most this slope, in voxels per voxel.
    Near {
        /// The samples, x fastest.
        samples: Box<[u8; BRICK_VOLUME]>,
        /// The slope.
        slope: f64,
    },
}

/// Why distances cannot be bricks.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum BrickError {
    /// Too many.
    #[error(
        "needs {texels} texels of 16 bytes, and at most {MAX_BRICK_TEXELS} are available: choose a lower resolution"
    )]
    TooLarge {
        /// How many texels it would take.
        texels: usize,
    },
    /// The voxels are too small for what they measure.
    #[error("takes {voxels} voxels along its longest side, and at most {} are possible: choose larger voxels", RESOLUTIONS[1])]
    TooFine {
        /// How many it would take.
        voxels: u64,
    },
    /// There is nothing to measure.
    #[error("has nothing to measure: no triangle with an area, no solid")]
    Empty,
    /// It reaches without end.
    #[error("has no end, so that no number of voxels holds it")]
    Endless,
    /// It cannot be measured, for this reason.
    #[error("{0}")]
    Refused(String),
    /// The size of the voxels is not one.
    #[error("needs voxels whose size is a positive number")]
    Voxel,
    /// The maker stopped.
    #[error("was canceled")]
    Canceled,
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
    /// voxel.
    pub fn slope(samples: &[u8; BRICK_VOLUME]) -> f64 {
        let at = |x: usize, y: usize, z: usize| i32::from(samples[x + BRICK_SAMPLES * (y + BRICK_SAMPLES * z)]);
        let mut most = 0;
        let last = BRICK_SAMPLES - 1;
        for z in 0..=last {
            for y in 0..=last {
                for x in 0..=last {
                    let here = at(x, y, z);
                    // Each corner of each voxel takes one side along each axis; the greater sides bound all of them.
                    let side = |before: Option<i32>, after: Option<i32>| {
                        [before, after].into_iter().flatten().map(|v| (v - here).pow(2)).max().unwrap_or(0)
                    };
                    let along_x = side((x > 0).then(|| at(x - 1, y, z)), (x < last).then(|| at(x + 1, y, z)));
                    let along_y = side((y > 0).then(|| at(x, y - 1, z)), (y < last).then(|| at(x, y + 1, z)));
                    let along_z = side((z > 0).then(|| at(x, y, z - 1)), (z < last).then(|| at(x, y, z + 1)));
                    most = most.max(along_x + along_y + along_z);
                }
            }
        }
        f64::from(most).sqrt() / SAMPLE_STEPS
    }
}

/// Writes bricks. `corner` gives the distance at a corner of cells, in meters, negative inside, at most one voxel off;
/// `brick` what is known of a brick. A cell far from the surface is not asked for its bricks.
///
/// # Errors
/// There are too many, or `brick` returns an error.
pub fn encode(
    grid: BrickGrid,
    bounds: Aabb,
    corner: &mut dyn FnMut([u32; 3]) -> f64,
    brick: &mut dyn FnMut([u32; 3]) -> Result<BrickContent, BrickError>,
) -> Result<Bricks, BrickError> {
    let least = grid.cell_count().div_ceil(4);
    if least > MAX_BRICK_TEXELS {
        return Err(BrickError::TooLarge { texels: least });
    }
    let corners = Corners::new(&grid, corner);
    // The distance at a point is at most half a diagonal off from that of some corner, and the corners a voxel.
    let error = grid.voxel * (0.75_f64.sqrt() * f64::from(CELL_VOXELS) + 1.0);
    let (mut entries, mut samples) = (Vec::new(), Vec::new());
    let mut places = vec![[NO_ENTRIES; 4]; least];
    for (index, cell) in cells(grid.cells).enumerate() {
        let side = corners.side(cell);
        if side.abs() - error >= BAND * grid.voxel {
            if side < 0.0 {
                places[index / 4][index % 4] = INSIDE;
            }
            continue;
        }
        places[index / 4][index % 4] = (entries.len() / 2) as u32;
        let mut own = [0; 8];
        for (entry, [x, y, z]) in own.iter_mut().zip(cells([CELL_BRICKS; 3])) {
            let content = brick([cell[0] * CELL_BRICKS + x, cell[1] * CELL_BRICKS + y, cell[2] * CELL_BRICKS + z])?;
            *entry = written(content, &mut samples);
        }
        entries.extend([[own[0], own[1], own[2], own[3]], [own[4], own[5], own[6], own[7]]]);
        let texels = least + entries.len() + samples.len();
        if texels > MAX_BRICK_TEXELS {
            return Err(BrickError::TooLarge { texels });
        }
    }
    let mut texels = places;
    texels.extend(entries);
    let first_brick = texels.len() as u32;
    texels.extend(samples);
    Ok(Bricks { grid, bounds, first_brick, texels, looks: None })
}

/// All indices below `count`, x fastest.
pub(super) fn cells(count: [u32; 3]) -> impl Iterator<Item = [u32; 3]> {
    let [nx, ny, nz] = count;
    (0..nz).flat_map(move |z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])))
}

/// The entry of a brick; its samples are appended.
fn written(content: BrickContent, texels: &mut Vec<[u32; 4]>) -> u32 {
    match content {
        BrickContent::Far(voxels) => {
            let steps = (voxels.abs() * 16.0).floor().min(f64::from(0xff_ffff)) as u32;
            steps | if voxels < 0.0 { 1 << 30 } else { 0 }
        }
        BrickContent::Near { samples, slope } => {
            let number = (texels.len() / BRICK_TEXELS) as u32;
            let word = |bytes: &[u8]| u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
            let texel = |b: &[u8]| [word(&b[..4]), word(&b[4..8]), word(&b[8..12]), word(&b[12..])];
            texels.extend(samples.chunks(16).map(texel));
            let slope = ((slope.max(1.0) - 1.0) * 64.0).ceil().min(127.0) as u32;
            1 << 31 | slope << 24 | number
        }
    }
}

/// The distances at the corners of cells.
struct Corners {
    count: [usize; 3],
    values: Vec<f64>,
}

impl Corners {
    fn new(grid: &BrickGrid, corner: &mut dyn FnMut([u32; 3]) -> f64) -> Self {
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
