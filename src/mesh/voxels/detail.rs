//! Which bricks of a level tell more than the next coarser level.

use glam::{UVec3, Vec3};

use super::super::TriangleMesh;
use super::facets::{LevelFacets, NONE};
use super::samples::Distances;
use isolith_bricks::{BRICK_SAMPLES, BRICK_VOXELS, BrickGrid, Bricks, DETAIL};

/// Distances are looked for within this, in voxels: farther ones need not agree.
const LOOKED: f64 = 5.0;
/// Beside the surface of a brick, its looks are mixed with those within this, in voxels.
const LOOKS_REACH: f32 = 2.0;

/// What decides which bricks are left out.
pub(super) struct Detail<'a> {
    pub mesh: &'a TriangleMesh,
    pub has_looks: bool,
    pub coarser: &'a Bricks,
    /// The size of the finest voxels.
    pub finest: f64,
}

impl Detail<'_> {
    /// Whether the coarser level tells as much as a brick would: it has the distance from the surface in the middle of its
    /// own voxels, where interpolation is worst, the surface itself at all corners and middles of triangles, and no looks
    /// that change.
    pub fn is_told(&self, grid: &BrickGrid, brick: [u32; 3], distances: &Distances<'_>) -> bool {
        self.has_distances(grid, brick, distances)
            && self.has_surface(grid, brick, distances)
            && (!self.has_looks || self.looks_are_plain(brick, distances))
    }

    fn has_distances(&self, grid: &BrickGrid, brick: [u32; 3], distances: &Distances<'_>) -> bool {
        let first = brick.map(|n| n * BRICK_VOXELS);
        // Samples of the coarser level have even numbers.
        let number = (grid.origin / grid.voxel).round();
        let odd = |axis: usize| {
            let is_odd = (number[axis] + f64::from(first[axis])).rem_euclid(2.0) == 1.0;
            (u32::from(!is_odd)..BRICK_SAMPLES as u32).step_by(2).map(move |n| first[axis] + n)
        };
        odd(2).all(|z| {
            odd(1).all(|y| {
                odd(0).all(|x| {
                    let sample = [x, y, z];
                    let p = grid.sample(sample);
                    let told = self.coarser.interpolated(p).map_or(LOOKED, |told| told.abs() / grid.voxel).min(LOOKED);
                    let within = (told + 2.0 * DETAIL) as f32;
                    let distance = distances.at(UVec3::from(sample).as_vec3(), sample, within);
                    self.coarser.tells(p, f64::from(distance) * grid.voxel, self.finest)
                })
            })
        })
    }

    fn has_surface(&self, grid: &BrickGrid, brick: [u32; 3], distances: &Distances<'_>) -> bool {
        let [low, high] = extent(brick, 0.0);
        let is_on = |p: Vec3| {
            let is_within = p.cmpge(low).all() && p.cmple(high).all();
            !is_within || self.coarser.tells(grid.origin + p.as_dvec3() * grid.voxel, 0.0, self.finest)
        };
        // The surface of what is thin lies beside its triangles.
        let mut is_told = !meets(distances.thin(), extent(brick, LOOKS_REACH));
        let closed = distances.closed();
        closed.within(low, high, |triangle| {
            if is_told {
                let [a, b, c] = closed.corners(triangle);
                is_told = [a, b, c, (a + b + c) / 3.0].into_iter().all(is_on);
            }
        });
        is_told
    }

    /// Whether all triangles around a brick have one look.
    fn looks_are_plain(&self, brick: [u32; 3], distances: &Distances<'_>) -> bool {
        if !meets(distances.closed(), extent(brick, 0.0)) {
            return true;
        }
        let [low, high] = extent(brick, LOOKS_REACH);
        let (mut first, mut is_plain) = (None, true);
        let closed = distances.closed();
        closed.within(low, high, |triangle| {
            let look = Some(closed.source(triangle)).filter(|source| *source != NONE);
            let look = look.and_then(|source| self.mesh.plain_look(source));
            is_plain = is_plain && look.is_some() && *first.get_or_insert(look) == look;
        });
        is_plain
    }
}

/// The lowest and highest corner of what a brick covers, and `more` around it.
fn extent(brick: [u32; 3], more: f32) -> [Vec3; 2] {
    let first = UVec3::from(brick.map(|n| n * BRICK_VOXELS)).as_vec3();
    [first - more, first + BRICK_VOXELS as f32 + more]
}

/// Whether the boxes of triangles meet this one.
fn meets(facets: LevelFacets<'_>, [low, high]: [Vec3; 2]) -> bool {
    let mut any = false;
    facets.within(low, high, |_| any = true);
    any
}
