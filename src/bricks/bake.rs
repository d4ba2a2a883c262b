//! Bricks of a field that is known everywhere.

use glam::DVec3;
use std::collections::HashMap;

use isolith_geometry::Aabb;

use super::encode::cells;
use super::{
    BAND, BRICK_SAMPLES, BRICK_VOLUME, BRICK_VOXELS, BrickContent, BrickError, BrickGrid, Bricks, MAX_BRICK_TEXELS,
    encode,
};

/// Half the diagonal of a brick, in voxels.
const HALF_DIAGONAL: f64 = 6.062_178;

/// Bricks of the solid with these distances, in meters, exact to a tenth of a voxel. `bounds` hold its surface.
///
/// # Errors
/// There are too many.
pub fn bake(bounds: Aabb, voxel: f64, distance: &dyn Fn(DVec3) -> f64) -> Result<Bricks, BrickError> {
    let grid = BrickGrid::around(&bounds, voxel);
    let least = grid.cell_count().div_ceil(4);
    if least > MAX_BRICK_TEXELS {
        return Err(BrickError::TooLarge { texels: least });
    }
    let mut near: HashMap<[u32; 3], (Box<[u8; BRICK_VOLUME]>, f64)> = HashMap::new();
    for brick in cells(grid.bricks()) {
        let away = distance(grid.middle(brick)).abs() / voxel;
        // Neighbors of those with samples, for their slopes.
        if away < HALF_DIAGONAL + BAND + 2.0 * f64::from(BRICK_VOXELS) {
            let samples = sampled(&grid, brick, distance);
            let slope = BrickContent::slope(&samples);
            near.insert(brick, (samples, slope));
        }
    }
    let content = |brick: [u32; 3]| {
        let away = distance(grid.middle(brick)) / voxel;
        let least = away.abs() - HALF_DIAGONAL;
        if least >= BAND {
            return BrickContent::Far(least.copysign(away));
        }
        let around = cells([3; 3]).filter_map(|[x, y, z]| {
            let at = |i: usize, n: u32| (brick[i] + n).checked_sub(1);
            near.get(&[at(0, x)?, at(1, y)?, at(2, z)?])
        });
        let slope = around.fold(0.0_f64, |most, (_, slope)| most.max(*slope));
        BrickContent::Near { samples: near[&brick].0.clone(), slope }
    };
    encode(grid, bounds, &mut |corner| distance(grid.corner(corner)), &mut |brick| Ok(content(brick)))
}

fn sampled(grid: &BrickGrid, brick: [u32; 3], distance: &dyn Fn(DVec3) -> f64) -> Box<[u8; BRICK_VOLUME]> {
    let first = brick.map(|n| n * BRICK_VOXELS);
    let mut out = Box::new([0; BRICK_VOLUME]);
    for (sample, [x, y, z]) in out.iter_mut().zip(cells([BRICK_SAMPLES as u32; 3])) {
        let voxels = distance(grid.sample([first[0] + x, first[1] + y, first[2] + z])) / grid.voxel;
        *sample = BrickContent::sample_byte(voxels);
    }
    out
}
