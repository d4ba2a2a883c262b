//! The looks of a model at a point. Counterpart of `shaders/light/model_look.wgsl`.

use glam::DVec3;

use isolith_bricks::{BrickLevels, LookSum};

/// What is left to be looked up in coarser levels when it does not change a color any more.
const MODEL_LOOK_LEAST: f64 = 1.0 / 256.0;

/// The looks at a point of the space of looks, over this width: of the two levels whose voxels are next to the width.
/// Where they have none, beside the surface, those of the next coarser levels stand in, so that blends and modifiers find
/// some. The share is less than 1 where none has.
pub fn model_look(levels: &BrickLevels, at: DVec3, width: f64) -> LookSum {
    let (center, unit) = levels.look_space();
    let last = levels.all().len() - 1;
    let detail = (width * unit / levels.finest().voxel()).max(1.0).log2().min(last as f64);
    let (fine, blur) = (detail as usize, detail.fract());
    let (mut sum, mut rest) = (LookSum::default(), 1.0);
    for (level, bricks) in levels.all().iter().enumerate().skip(fine) {
        let weight = if level == fine { rest * (1.0 - blur) } else { rest };
        let found = bricks.looks_at(center + at * unit);
        sum.add(&found, weight);
        rest -= weight * found.share;
        if rest < MODEL_LOOK_LEAST {
            break;
        }
    }
    sum
}
