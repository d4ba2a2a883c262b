//! Bricks are left out where the next coarser level tells as much.

use std::collections::HashMap;
use std::sync::Arc;

use glam::DVec3;
use isolith::bricks::{
    BRICK_SAMPLES, BRICK_VOXELS, BrickContent, BrickLevels, Bricks, DETAIL, MAX_LEVELS, SAMPLE_STEPS,
};
use isolith::field::PreparedShape;
use isolith::mesh::bricks_of;
use isolith::scene::{ModelFile, Shape, ShapeKind};

use super::shapes::{Soup, ten};
use super::{Dice, all_bricks, errors, levels, near, on_surface};
use crate::contract::samples::evaluate;

fn left_out(bricks: &Bricks) -> Vec<[u32; 3]> {
    all_bricks(bricks).filter(|brick| bricks.content(*brick) == Some(BrickContent::Coarser)).collect()
}

/// Half a step of a sample, in voxels.
const ROUNDING: f64 = 0.5 / SAMPLE_STEPS;

#[test]
fn what_is_left_out_is_told_by_the_coarser_level() {
    let mut dice = Dice(21);
    let mut spared = Vec::new();
    for (name, soup, is_smooth) in ten() {
        let finest = levels(&soup, 128.0);
        assert!((3..=MAX_LEVELS).contains(&finest.levels().count()) && finest.check().is_ok(), "{name}");
        let mesh = soup.mesh();
        let whole = bricks_of(&mesh, finest.voxel(), &mut |_| true).unwrap();
        let points = on_surface(&soup, 300, &mut dice);
        let ([_, own, worst], [_, all, most]) = (errors(&finest, &points), errors(&whole, &points));
        let told = format!("{name}: p99 {own:.3} and {all:.3} voxels, max {worst:.3} and {most:.3}");
        let counts = [&finest, &Arc::new(whole.clone())].map(|level| level.count());
        println!("{told}, bricks {counts:?}, factor {:.2}", BrickLevels::new(&finest).scale());
        assert!(own < (all + DETAIL).max(DETAIL + ROUNDING) && worst < most + 2.0 * DETAIL, "{told}");
        assert!(finest.count() <= whole.count(), "{name}");
        if is_smooth {
            spared.push(finest.count() as f64 / whole.count() as f64);
        }
    }
    assert!(spared.iter().all(|share| *share < 1.0) && spared.iter().any(|share| *share < 0.4), "{spared:?}");
}

#[test]
fn detail_is_kept_where_it_is() {
    // A ball with a little box on top.
    let ball = Soup::sphere(96, 1.0);
    let size = DVec3::splat(0.05);
    let both = ball.clone().with(Soup::cuboid(size).moved(DVec3::Y * 1.01));
    let bricks = levels(&both, 256.0);
    let near_box = |brick: [u32; 3]| {
        let middle = bricks.grid.middle(brick);
        middle.distance(DVec3::Y * 1.03) < 0.2
    };
    let all = near(&bricks);
    let (at_box, elsewhere): (Vec<_>, Vec<_>) = all.into_iter().partition(|(brick, _)| near_box(*brick));
    let whole = near(&bricks_of(&both.mesh(), bricks.voxel(), &mut |_| true).unwrap());
    let share = elsewhere.len() as f64 / whole.iter().filter(|(brick, _)| !near_box(*brick)).count() as f64;
    assert!(at_box.len() > 20 && share < 0.1, "{} and {share} of the others", at_box.len());
    // Whatever a coarser level misses is there: a needle as thin as a voxel.
    let needle = Soup::cuboid(DVec3::new(0.012, 0.3, 0.012)).moved(DVec3::Y * 1.1);
    let bricks = levels(&ball.with(needle), 256.0);
    let tip = DVec3::Y * 1.2;
    assert!(bricks.interpolated(tip).unwrap() < 0.0, "{:?}", bricks.interpolated(tip));
    assert!(
        !left_out(&bricks).contains(&((tip - bricks.origin()) / bricks.voxel() / 7.0).to_array().map(|v| v as u32))
    );
}

/// The field steps from a brick to one that is left out by no more than the rounding of samples.
#[test]
fn the_field_is_continuous_where_bricks_are_left_out() {
    let mut dice = Dice(22);
    for (name, soup, _) in ten() {
        let finest = levels(&soup, 128.0);
        let voxel = finest.voxel();
        let mut shape = ShapeKind::MeshField.default_shape();
        let Shape::MeshField { file, .. } = &mut shape else { unreachable!() };
        *file = ModelFile::new("soup.glb").with_bricks(Arc::new(BrickLevels::new(&finest)));
        let prepared = PreparedShape::new(&shape);
        let whole = bricks_of(&soup.mesh(), voxel, &mut |_| true).unwrap();
        let known: HashMap<[u32; 3], ()> = near(&finest).into_iter().map(|(brick, _)| (brick, ())).collect();
        let (mut checked, mut worst, mut without) = (0, 0.0_f64, 0.0_f64);
        for brick in left_out(&finest) {
            for axis in 0..3 {
                for side in [0, 1] {
                    let mut neighbor = brick;
                    neighbor[axis] = if side == 1 { brick[axis] + 1 } else { brick[axis].wrapping_sub(1) };
                    if !known.contains_key(&neighbor) {
                        continue;
                    }
                    let mut at = dice.point() * f64::from(BRICK_VOXELS);
                    at[axis] = f64::from(side * BRICK_VOXELS);
                    let p = finest.grid.sample(brick.map(|n| n * BRICK_VOXELS)) + at * voxel;
                    let step = DVec3::AXES[axis] * 1e-6 * voxel;
                    let [a, b] = [p - step, p + step].map(|p| evaluate(&prepared, p.to_array()) / voxel);
                    worst = worst.max((a - b).abs());
                    let own = whole.interpolated(p).map(|own| (own / voxel, finest.coarser.as_ref().unwrap()));
                    let other = own.and_then(|(own, coarser)| Some((own - coarser.interpolated(p)? / voxel).abs()));
                    without = without.max(other.unwrap_or(0.0));
                    checked += 1;
                }
            }
        }
        println!("{name}: steps of {worst:.4} voxels at {checked} faces, {without:.4} without care");
        assert!(worst < ROUNDING, "{name}: {worst}");
        // As its own samples have it, there would be a larger step: the test sees it.
        assert!(checked < 200 || without > ROUNDING, "{name}: {without}");
    }
}

#[test]
fn bricks_left_out_need_a_coarser_level() {
    let bricks = Bricks::clone(&levels(&Soup::torus(64), 128.0));
    assert!(bricks.check().is_ok() && !left_out(&bricks).is_empty());
    assert!(Bricks { coarser: None, ..bricks.clone() }.check().is_err());
    assert_eq!(BRICK_SAMPLES as u32, BRICK_VOXELS + 1);
}
