//! Bricks of one solid in voxels of several sizes.
//!
//! Samples reach only as far as four voxels. Farther from the surface coarser bricks take over, each level with voxels
//! twice as large. From two voxels to the end of its samples, the distance by one level fades into that by the next, so
//! that the field is continuous, and times [`BrickLevels::scale`] it is a lower bound of the distance to the surface of
//! the finest, exact in sign and zeros.
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

use super::encode::cells;
use super::{BRICK_SAMPLES, BRICK_VOXELS, BrickContent, BrickError, Bricks, SAMPLE_REACH, SAMPLE_STEPS};

/// Most levels: at twice the size each, the last reaches 512 voxels of the first.
pub const MAX_LEVELS: usize = 8;
/// The size of a voxel in voxels of the next finer level.
pub const LEVEL_RATIO: f64 = 2.0;
/// From this distance on a level fades into the next, in voxels.
pub const FADE_START: f64 = 2.0;
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

impl BrickLevels {
    /// These levels, the finest first; `None` if there are none.
    pub fn new(all: Vec<Arc<Bricks>>) -> Option<Self> {
        (!all.is_empty() && all.len() <= MAX_LEVELS).then(|| Self::of(all))
    }

    /// The levels that `make` makes for each size of voxels.
    ///
    /// # Errors
    /// `make` returns one.
    pub fn made(voxel: f64, make: &mut dyn FnMut(f64) -> Result<Bricks, BrickError>) -> Result<Self, BrickError> {
        let mut all = vec![Arc::new(make(voxel)?)];
        while let Some(next) = Self::coarser(&all[all.len() - 1], all.len()) {
            all.push(Arc::new(make(next)?));
        }
        Ok(Self::of(all))
    }

    /// Measures these levels, once: both numbers take a look at every texel.
    fn of(all: Vec<Arc<Bricks>>) -> Self {
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

    /// The size of the voxels of the level after `levels` levels, whose last one is this; `None` if none is needed.
    pub fn coarser(last: &Bricks, levels: usize) -> Option<f64> {
        let is_small = last.grid.cells.iter().all(|n| *n <= 1);
        (levels < MAX_LEVELS && !is_small).then_some(last.grid.voxel * LEVEL_RATIO)
    }

    /// All of them, the finest first.
    pub fn all(&self) -> &[Arc<Bricks>] {
        &self.all
    }

    /// The finest.
    pub fn finest(&self) -> &Bricks {
        &self.all[0]
    }

    /// The factor on interpolated distances. Two reasons bound it. The interpolation of samples of a function with slopes
    /// of at most 1 is off by at most half a diagonal of a voxel, and half a step of the samples; a level after the first
    /// counts where the distance is at least one and a half of its voxels. And the slope of the field is at most 1, where
    /// a level fades into the next, too.
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
    let off = 0.75_f64.sqrt() + 0.5 / SAMPLE_STEPS;
    let nearest = FADE_START / LEVEL_RATIO + 0.5;
    let steepest = all.iter().fold(1.0_f64, |most, bricks| most.max(bricks.slope()));
    let apart = all.windows(2).fold(0.0_f64, |most, pair| most.max(apart(&pair[0], &pair[1])));
    let fading = steepest * apart / (SAMPLE_REACH - FADE_START);
    (nearest / (nearest + off)).min(1.0 / (steepest + fading))
}

/// How far apart two levels are where one fades into the other, in voxels of the finer: at every other sample, with a
/// tenth more for those between.
fn apart(finer: &Bricks, coarser: &Bricks) -> f64 {
    let voxel = finer.grid.voxel;
    let mut most = 0.0_f64;
    for brick in cells(finer.grid.bricks()) {
        let Some(BrickContent::Near { samples, .. }) = finer.content(brick) else { continue };
        for [x, y, z] in cells([BRICK_SAMPLES as u32 / 2; 3]).map(|at| at.map(|n| 2 * n)) {
            let side = BRICK_SAMPLES as u32;
            let own = BrickContent::sample_voxels(samples[(x + side * (y + side * z)) as usize]).abs();
            if own <= FADE_START || own >= SAMPLE_REACH {
                continue;
            }
            let p = finer.grid.sample([0, 1, 2].map(|i| brick[i] * BRICK_VOXELS + [x, y, z][i]));
            let other = coarser.interpolated(p).map_or(SAMPLE_REACH * LEVEL_RATIO, |d| d.abs() / voxel);
            most = most.max((other - own).abs());
        }
    }
    1.1 * most
}
