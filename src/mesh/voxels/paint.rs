//! The looks of a mesh, for the samples around its surface.

use glam::{DMat3, DVec3, DVec4, Vec3};
use rayon::prelude::*;

use super::super::TriangleMesh;
use super::facets::{LevelFacets, NONE};
use super::samples::Distances;
use super::watch::Watch;
use isolith_bricks::{
    BRICK_SAMPLES, BRICK_VOLUME, BRICK_VOXELS, BrickContent, BrickError, Bricks, Looks, VoxelLook, linear_from_srgb,
    surface_samples,
};

/// Corners of voxels that the surface passes are nearer than this, in voxels.
const NEAR: f32 = 2.5;

/// The second word of a look with a smooth normal.
const NO_BEND: u32 = 64 | 64 << 7 | 64 << 14;

type Painted = ([bool; BRICK_VOLUME], Vec<VoxelLook>);

/// The looks of these bricks, which are all with samples, in their order.
pub(super) fn painted(
    mesh: &TriangleMesh,
    bricks: &Bricks,
    order: &[[u32; 3]],
    distances: &Distances<'_>,
    watch: &Watch,
) -> Result<Looks, BrickError> {
    let linear: Vec<f64> = (0..=255).map(|byte| linear_from_srgb(f64::from(byte) / 255.0)).collect();
    let painter = Painter { mesh, distances, linear, voxel: bricks.voxel() };
    let share = 0.3 / order.len().max(1) as f64;
    let of = |brick: &[u32; 3]| {
        watch.check()?;
        watch.advance(share);
        let Some(BrickContent::Samples(samples)) = bricks.content(*brick) else {
            return Ok(([false; BRICK_VOLUME], Vec::new()));
        };
        Ok(painter.brick(*brick, &samples))
    };
    let all: Vec<Painted> = order.par_iter().map(of).collect::<Result<_, BrickError>>()?;
    Ok(Looks::new(all.into_iter()))
}

struct Painter<'a> {
    mesh: &'a TriangleMesh,
    distances: &'a Distances<'a>,
    /// The linear values of bytes.
    linear: Vec<f64>,
    /// Looks are means over this width, in meters.
    voxel: f64,
}

/// A point of a triangle.
struct Foot {
    triangle: u32,
    weights: [f64; 3],
    /// From the point to the sample.
    to_sample: Vec3,
    squared: f32,
}

impl Painter<'_> {
    fn brick(&self, brick: [u32; 3], samples: &[u8; BRICK_VOLUME]) -> Painted {
        let marks = surface_samples(samples);
        let first = brick.map(|n| n * BRICK_VOXELS);
        let marked = (0..BRICK_VOLUME).filter(|i| marks[*i]);
        let looks = marked.map(|i| {
            let own = [i % BRICK_SAMPLES, i / BRICK_SAMPLES % BRICK_SAMPLES, i / (BRICK_SAMPLES * BRICK_SAMPLES)];
            self.sample([0, 1, 2].map(|axis| first[axis] + own[axis] as u32))
        });
        (marks, looks.collect())
    }

    /// The look of the nearest point of the mesh, which lids are no part of.
    fn sample(&self, sample: [u32; 3]) -> VoxelLook {
        let p = Vec3::from(sample.map(|n| n as f32));
        let is_inside = self.distances.is_inside(sample.map(|n| n as i32));
        let side = if is_inside { -1.0 } else { 1.0 };
        let value = |foot: &Option<Foot>| foot.as_ref().map_or(f32::INFINITY, |foot| foot.squared.sqrt());
        let (closed, thin) = (foot(self.distances.closed(), p), foot(self.distances.thin(), p));
        // As distances are: the lesser of the two.
        let is_thin =
            thin.is_some() && (closed.is_none() || value(&thin) - self.distances.sheet_half() < side * value(&closed));
        let side = if is_thin { 1.0 } else { side };
        // Nothing but lids.
        let Some(foot) = (if is_thin { thin } else { closed }) else {
            return VoxelLook::unpacked([0xff_ffff, NO_BEND]);
        };
        self.at(&foot, foot.to_sample.as_dvec3() * f64::from(side))
    }

    /// The look at a foot; the solid's outside is where `outward` leads, if the point is not on the surface.
    fn at(&self, foot: &Foot, outward: DVec3) -> VoxelLook {
        let decode = |[r, g, b, a]: [u8; 4]| {
            let [r, g, b] = [r, g, b].map(|byte| self.linear[usize::from(byte)]);
            DVec4::new(r, g, b, f64::from(a) / 255.0)
        };
        let look = self.mesh.look_over(foot.triangle, foot.weights, self.voxel, decode);
        let smooth = self.mesh.normal_at(foot.triangle, foot.weights);
        let is_turned = outward.length_squared() > 1e-6 && smooth.dot(outward) < -0.3 * outward.length();
        let normal = if is_turned { -smooth } else { smooth };
        let (triangle, weights, width) = (foot.triangle, foot.weights, self.voxel);
        let bend = self.mesh.mapped_normal_over(triangle, weights, width, normal, &DMat3::IDENTITY) - normal;
        let light = look.emission.max_element();
        let brightest = look.color.truncate().max_element();
        // The color of an emitter is that of its light: looks have one color.
        let color = if light > brightest { look.emission / light } else { look.color.truncate() };
        let emission = if light > 0.0 { light / color.max_element() } else { 0.0 };
        VoxelLook { color, metalness: look.metalness, roughness: look.roughness, emission, bend }
    }
}

fn foot(facets: LevelFacets<'_>, p: Vec3) -> Option<Foot> {
    let is_mesh = |triangle: u32| facets.source(triangle) != NONE;
    let near = facets.nearest_of(p, NEAR * NEAR, is_mesh);
    let (squared, triangle) = near.or_else(|| facets.nearest_of(p, f32::INFINITY, is_mesh))?;
    let (weights, point) = facets.foot(triangle, p);
    Some(Foot { triangle: facets.source(triangle), weights: weights.map(f64::from), to_sample: p - point, squared })
}
