//! Bricks of one solid in voxels of several sizes.
//!
//! Bricks reach only as far as three voxels. Farther from the surface coarser bricks take over, each level with voxels
//! twice as large. From one and a half voxels to three, the distance by one level fades into that by the next, so
//! that the field is continuous, and times [`BrickLevels::scales`] it is a lower bound of the distance to the surface of
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
/// Most by which the factor of a level may be greater than that of the next: the field keeps growing where it fades.
const MOST_STEP: f64 = 1.25;

/// Bricks in voxels of several sizes, the finest first; never empty.
#[derive(Clone, Debug, PartialEq)]
pub struct BrickLevels {
    all: Vec<Arc<Bricks>>,
    scales: Vec<f64>,
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
        let (scales, mark) = (scales_of(&all), mark_of(&all));
        let mut made = Self { all, scales, mark, look_header: Vec::new() };
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

    /// The factors on the distances that levels tell, with which the slope of the field is at most 1, also where a level
    /// fades into the next. So it is a lower bound of the distance from its zeros. Coarser levels are steeper, and farther
    /// apart: their factors are smaller.
    pub fn scales(&self) -> &[f64] {
        &self.scales
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

/// See [`BrickLevels::scales`].
///
/// Let k and k' be the slopes of a level and of the next one, s and s' their factors, a how far they are apart where they
/// fade, and w the width of the fade from f to f + w. At its share t, where the level tells a distance v = f + w t, the slope
/// of (1 - t) s v + t s' v' is at most |(1 - t) s - (s - s') v / w| k + t s' k' + s' a k / w. With f = w that is greatest
/// at t = 0 or 1: s' (k + a k / w), and 2 (s - s') k + s' (k' + a k / w).
fn scales_of(all: &[Arc<Bricks>]) -> Vec<f64> {
    const WIDTH: f64 = FADE_END - FADE_START;
    const { assert!(WIDTH == FADE_START) };
    let slopes: Vec<f64> = all.iter().map(|bricks| bricks.slope()).collect();
    let mut scales = vec![1.0; all.len()];
    for level in (0..all.len()).rev() {
        let own = slopes[level];
        let Some(next) = all.get(level + 1) else {
            scales[level] = 1.0 / own;
            continue;
        };
        let fading = apart(&all[level], next) * own / WIDTH;
        let most = 1.0 / (own.max(slopes[level + 1]) + fading);
        let shrink = (most / scales[level + 1]).min(1.0);
        scales[level + 1..].iter_mut().for_each(|scale| *scale *= shrink);
        let coarser = scales[level + 1];
        let room = (1.0 - coarser * (slopes[level + 1] + fading)) / (2.0 * own);
        scales[level] = (1.0 / own).min(coarser + room).min(MOST_STEP * coarser);
    }
    scales
}

/// How far apart two levels are where one fades into the other, in voxels of the finer: at every other sample, with a
/// tenth more for those between.
fn apart(finer: &Bricks, coarser: &Bricks) -> f64 {
    let all: Vec<[u32; 3]> = cells(finer.grid.bricks()).collect();
    let of_brick = |brick: &[u32; 3]| {
        let Some(BrickContent::Samples(samples)) = finer.content(*brick) else { return 0.0 };
        let mut most = 0.0_f64;
        for [x, y, z] in cells([BRICK_SAMPLES as u32 / 2; 3]).map(|at| at.map(|n| 2 * n)) {
            let side = BRICK_SAMPLES as u32;
            let own = BrickContent::sample_voxels(samples[(x + side * (y + side * z)) as usize]).abs();
            if own > FADE_START && own < FADE_END {
                let p = finer.grid.sample([0, 1, 2].map(|i| brick[i] * BRICK_VOXELS + [x, y, z][i]));
                most = most.max((coarser.value(p).abs() / finer.grid.voxel - own).abs());
            }
        }
        most
    };
    1.1 * all.par_iter().map(of_brick).reduce(|| 0.0, f64::max)
}
