//! Bricks of one solid in voxels of several sizes.
//!
//! Bricks reach only as far as three voxels. Farther from the surface coarser bricks take over, each level with voxels
//! twice as large. From one and a half voxels to three, the distance by one level fades into that by the next, so
//! that the field is continuous, and times [`BrickLevels::scale`] it is a lower bound of the distance to the surface of
//! the finest, exact in sign and zeros. Where a level has no bricks because the next one tells as much (see `detail`),
//! the next one is the first.
//!
//! The looks of all levels stand behind the texels of all distances, after a header of one texel, and three for each level:
//!
//! | texel | holds |
//! |---|---|
//! | first | the number of levels |
//! | then | as bits of floats: the voxels, counted from the first sample, at the origin of the space of looks, and how many one of its units has |
//! | | cells along each axis, and the first texel of the distances, counted from the first of all levels |
//! | | the first texel of the looks of bricks, and that of the looks themselves, counted in the same way |
//!
//! The space of looks has the middle of the surface as its origin, and half of its longest side as its unit.

use std::sync::Arc;

use glam::DVec3;
use isolith_geometry::Aabb;

use rayon::prelude::*;

use super::encode::cells;
use super::{
    BRICK_SAMPLES, BRICK_VOXELS, BrickContent, BrickError, BrickGrid, Bricks, FADE_END, FADE_START, LEVEL_RATIO,
};

/// Most levels: at twice the size each, the last reaches 512 voxels of the first.
pub const MAX_LEVELS: usize = 8;
/// Bricks in voxels of several sizes, the finest first; never empty.
#[derive(Clone, Debug, PartialEq)]
pub struct BrickLevels {
    all: Vec<Arc<Bricks>>,
    scale: f64,
    mark: u32,
    /// Empty if any level has no looks.
    look_header: Vec<[u32; 4]>,
}

/// Texels of a level in the header of looks, and those before the first.
pub const LOOK_LEVEL: usize = 3;

/// Makes the bricks of a solid within `bounds` in voxels of this size, and before them all coarser ones: `make` gets the
/// size of voxels and the level that is coarser by one.
///
/// # Errors
/// There cannot be such bricks, or `make` returns an error.
pub fn in_levels(
    bounds: &Aabb,
    voxel: f64,
    make: &mut dyn FnMut(f64, Option<Arc<Bricks>>) -> Result<Bricks, BrickError>,
) -> Result<Arc<Bricks>, BrickError> {
    BrickGrid::checked(bounds, voxel)?;
    let is_large = |voxel: &f64| BrickGrid::around(bounds, *voxel).cells.iter().any(|n| *n > 1);
    let coarser = |voxel: &f64| Some(LEVEL_RATIO * voxel).filter(|_| is_large(voxel));
    let sizes: Vec<f64> = std::iter::successors(Some(voxel), coarser).take(MAX_LEVELS).collect();
    let (finest, others) = sizes.split_first().ok_or(BrickError::Empty)?;
    let mut coarser = None;
    for voxel in others.iter().rev() {
        coarser = Some(Arc::new(make(*voxel, coarser)?));
    }
    Ok(Arc::new(make(*finest, coarser)?))
}

impl BrickLevels {
    /// These bricks, and all coarser ones. Measures them, once: its numbers take a look at every texel.
    pub fn new(finest: &Arc<Bricks>) -> Self {
        let all: Vec<Arc<Bricks>> = finest.levels().collect();
        let (scale, mark) = (scale_of(&all), mark_of(&all));
        let mut made = Self { all, scale, mark, look_header: Vec::new() };
        if made.all.iter().all(|bricks| bricks.looks.is_some()) {
            made.look_header = look_header(&made);
        }
        made
    }

    /// The same without looks.
    pub fn without_looks(&self) -> Self {
        Self { look_header: Vec::new(), ..self.clone() }
    }

    /// Whether they have looks.
    pub fn has_looks(&self) -> bool {
        !self.look_header.is_empty()
    }

    /// The first texel of the header of looks.
    pub fn first_look(&self) -> usize {
        self.all.iter().map(|bricks| bricks.texels.len()).sum()
    }

    /// The origin of the space of looks, and its unit in meters.
    pub fn look_space(&self) -> (DVec3, f64) {
        let bounds = self.bounds();
        (bounds.center(), bounds.half().max_element())
    }

    /// All texels, one run after the other.
    pub fn runs(&self) -> impl Iterator<Item = &[[u32; 4]]> {
        let looks = self.all.iter().filter(|_| self.has_looks()).filter_map(|bricks| bricks.looks.as_ref());
        let distances = self.all.iter().map(|bricks| &*bricks.texels);
        distances.chain([&*self.look_header]).chain(looks.map(|looks| &*looks.texels))
    }

    /// All of them, the finest first.
    pub fn all(&self) -> &[Arc<Bricks>] {
        &self.all
    }

    /// The finest.
    pub fn finest(&self) -> &Bricks {
        &self.all[0]
    }

    /// The factor on the distances that levels tell, with which the slope of the field is at most 1, also where a level
    /// fades into the next. So it is a lower bound of the distance from its zeros.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// A number of 24 bits that other bricks rarely have.
    pub fn mark(&self) -> u32 {
        self.mark
    }

    /// A box around the surface of the finest, which is at most a voxel from that of the solid.
    pub fn bounds(&self) -> Aabb {
        let finest = self.finest();
        finest.bounds.expanded(finest.grid.voxel)
    }

    /// Texels of all levels, with those of their looks.
    pub fn texels(&self) -> usize {
        self.runs().map(<[_]>::len).sum()
    }
}

/// See the module.
fn look_header(levels: &BrickLevels) -> Vec<[u32; 4]> {
    let (center, unit) = levels.look_space();
    let mut first = 0;
    let mut looks_at = levels.first_look() + 1 + LOOK_LEVEL * levels.all.len();
    let mut out = vec![[levels.all.len() as u32, 0, 0, 0]];
    for bricks in &levels.all {
        let Some(looks) = &bricks.looks else { continue };
        let voxel = bricks.grid.voxel;
        let bits = |v: f64| (v as f32).to_bits();
        let [x, y, z] = ((center - bricks.grid.origin) / voxel).to_array().map(bits);
        let [nx, ny, nz] = bricks.grid.cells;
        out.push([x, y, z, bits(unit / voxel)]);
        out.push([nx, ny, nz, first as u32]);
        out.push([looks_at as u32, looks_at as u32 + looks.first_look, 0, 0]);
        first += bricks.texels.len();
        looks_at += looks.texels.len();
    }
    out
}

/// See [`BrickLevels::mark`]; by FNV-1a (Fowler, Noll, Vo).
fn mark_of(all: &[Arc<Bricks>]) -> u32 {
    let step = |hash: u64, word: &u32| (hash ^ u64::from(*word)).wrapping_mul(0x100_0000_01b3);
    let words = all.iter().flat_map(|bricks| bricks.texels.iter().flatten());
    (words.fold(0xcbf2_9ce4_8422_2325, step) >> 40) as u32
}

/// See [`BrickLevels::scale`].
fn scale_of(all: &[Arc<Bricks>]) -> f64 {
    let steepest = all.iter().fold(1.0_f64, |most, bricks| most.max(bricks.slope()));
    let fading = all.windows(2).fold(0.0_f64, |most, pair| most.max(fading_slope(&pair[0], &pair[1])));
    1.0 / steepest.max(fading)
}

/// The greatest slope of the field where a level fades into the next: over half a voxel at every other sample, with a tenth
/// more for those between.
fn fading_slope(finer: &Bricks, coarser: &Bricks) -> f64 {
    let voxel = finer.voxel();
    let faded = |p: DVec3| {
        let own = finer.value(p).abs() / voxel;
        let share = ((own - FADE_START) / (FADE_END - FADE_START)).clamp(0.0, 1.0);
        if share > 0.0 { own + share * (coarser.value(p).abs() / voxel - own) } else { own }
    };
    let all: Vec<[u32; 3]> = cells(finer.grid.bricks()).collect();
    let of_brick = |brick: &[u32; 3]| {
        let Some(BrickContent::Samples(samples)) = finer.content(*brick) else { return 0.0 };
        let mut most = 0.0_f64;
        for [x, y, z] in cells([BRICK_SAMPLES as u32 / 2; 3]).map(|at| at.map(|n| 2 * n)) {
            let side = BRICK_SAMPLES as u32;
            let own = BrickContent::sample_voxels(samples[(x + side * (y + side * z)) as usize]).abs();
            if own > FADE_START - 0.5 && own < FADE_END + 0.5 {
                let p = finer.grid.sample([0, 1, 2].map(|i| brick[i] * BRICK_VOXELS + [x, y, z][i]));
                let rise = DVec3::AXES.map(|axis| faded(p + 0.25 * voxel * axis) - faded(p - 0.25 * voxel * axis));
                most = most.max(2.0 * DVec3::from(rise).length());
            }
        }
        most
    };
    1.1 * all.par_iter().map(of_brick).reduce(|| 0.0, f64::max)
}
