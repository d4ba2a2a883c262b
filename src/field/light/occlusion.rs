//! Ambient occlusion by six signed cones, with the mean free direction. Counterpart of `shaders/light/occlusion.wgsl`
//! and of the second entry point of `shaders/shadow.wgsl`.
//!
//! The cones have a half angle of 30 degrees. One stands along the normal, five lean by 60 degrees: they touch the
//! tangent plane. A sphere that fits into the cone has the radius `t * sin(30 degrees)`, and so far from the plane is
//! its middle. Measured by this radius a flat surface never occludes itself, whichever component it belongs to; a
//! convex one even less; and in a hollow the surface occludes itself as it should.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use glam::DVec3;

use super::shadow::{cone_share, disc_spiral};
use crate::copies::{copy_ray, visit_copies};
use crate::eval::field;
use crate::mesh_rays::{Meshes, mesh_rays_blocked, mesh_rays_distance, mesh_rays_hit};
use crate::reference::trace::TraceError;
use crate::scene_eval::{RayLimits, SceneCounts, SceneEvaluator};
use crate::{Component, FlatScene};
use isolith_geometry::Ray;

/// Number of cones.
pub const OCCLUSION_CONES: u32 = 6;
/// Rays of a sample of a still picture.
pub const OCCLUSION_RAYS: u32 = 2;
/// Sine and tangent of their half angle.
const OCCLUSION_SINE: f64 = 0.5;
const OCCLUSION_TANGENT: f64 = 0.577_350_269;
/// Share of the light of a uniform sky that comes through the cone along the normal: sin² of the half angle; the others
/// have the rest.
const MIDDLE_WEIGHT: f64 = 0.25;
/// The first evaluation of a cone, as a share of the radius.
const OCCLUSION_NEAR: f64 = 0.083_333_3;
/// The end of a cone, as a share of the radius: the last sphere ends behind it.
const OCCLUSION_FAR: f64 = 0.76;
/// From one distance to the next: up to 3 the spheres touch.
const OCCLUSION_GROWTH: f64 = 3.0;

/// What a point sees of its surroundings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Occlusion {
    /// Mean free direction, of unit length.
    pub bent: DVec3,
    /// Visible share of the hemisphere, weighted by the cosine.
    pub visibility: f64,
}

impl Occlusion {
    /// That of these visible shares of the cones.
    pub fn of_shares(normal: DVec3, shares: &[f64]) -> Self {
        let (mut bent, mut visibility) = (DVec3::ZERO, 0.0);
        for (index, share) in (0..).zip(shares) {
            let (direction, weight) = occlusion_cone(normal, index);
            visibility += weight * share;
            bent += direction * (weight * share);
        }
        Self { bent: bent.normalize_or(normal), visibility }
    }

    /// A point that sees all.
    pub fn none(normal: DVec3) -> Self {
        Self { bent: normal, visibility: 1.0 }
    }
}

/// Direction and weight of a cone around a unit normal.
pub fn occlusion_cone(normal: DVec3, index: u32) -> (DVec3, f64) {
    if index == 0 {
        return (normal, MIDDLE_WEIGHT);
    }
    let others = f64::from(OCCLUSION_CONES - 1);
    let (right, up) = normal.any_orthonormal_pair();
    let (sin, cos) = (TAU * f64::from(index - 1) / others).sin_cos();
    let around = right * cos + up * sin;
    (normal * 0.5 + around * 0.75_f64.sqrt(), (1.0 - MIDDLE_WEIGHT) / others)
}

/// The direction around a unit normal of a ray to a point of the unit disc below: as likely as the cosine.
pub fn occlusion_ray(normal: DVec3, [x, y]: [f64; 2]) -> DVec3 {
    let (right, up) = normal.any_orthonormal_pair();
    (right * x + up * y + normal * (1.0 - x * x - y * y).max(1e-6).sqrt()).normalize()
}

/// The occlusion of a point above a surface by everything within `radius`. `least` is the least distance of an
/// evaluation.
pub fn scene_occlusion(
    evaluator: &mut SceneEvaluator<'_>,
    meshes: &Meshes,
    origin: DVec3,
    normal: DVec3,
    [radius, least]: [f64; 2],
) -> Occlusion {
    Occlusion::of_shares(normal, &occlusion_shares(evaluator, meshes, origin, normal, [radius, least]))
}

/// The visible share of each cone.
pub fn occlusion_shares(
    evaluator: &mut SceneEvaluator<'_>,
    meshes: &Meshes,
    origin: DVec3,
    normal: DVec3,
    [radius, least]: [f64; 2],
) -> [f64; OCCLUSION_CONES as usize] {
    let limits = RayLimits { near: (OCCLUSION_NEAR * radius).max(least), far: OCCLUSION_FAR * radius };
    std::array::from_fn(|index| {
        let axis = Ray { origin, direction: occlusion_cone(normal, index as u32).0 };
        let of_fields = least_ratio(evaluator, &axis, limits, normal);
        cone_share(of_fields.min(least_mesh_ratio(evaluator.flat(), meshes, &axis, limits)))
    })
}

/// How much a ray in the part of a cone is expected to tell: the deviation of what it finds, if this share is visible.
/// Never 0, for cones err.
fn occlusion_doubt(share: f64) -> f64 {
    (share * (1.0 - share)).sqrt().max(0.2)
}

/// A point of the unit disc, above which lies the part of a cone in the hemisphere; from one of the unit square. The
/// parts are as likely as the weights of the cones.
fn occlusion_place(cone: usize, [x, y]: [f64; 2]) -> [f64; 2] {
    let others = f64::from(OCCLUSION_CONES - 1);
    let (square, turn) = match cone {
        0 => (MIDDLE_WEIGHT * x, y),
        _ => (MIDDLE_WEIGHT + (1.0 - MIDDLE_WEIGHT) * x, (cone as f64 - 1.5 + y) / others),
    };
    let (radius, (sin, cos)) = (square.sqrt(), (TAU * turn).sin_cos());
    [radius * cos, radius * sin]
}

/// The ray of a sample to the environment, and what it tells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AmbientRay {
    /// Its direction.
    pub direction: DVec3,
    /// The visible share of the hemisphere if the ray meets something, and if it meets nothing: the mean over all samples
    /// is that of the rays.
    pub shares: [f64; 2],
}

/// What the cones of occlusion are worth, in samples of rays: after as many, both count the same.
const OCCLUSION_WORTH: f64 = 8.0;

/// How much the rays of n samples together tell, in samples: those of few are believed little and have little noise,
/// those of many all, without bias.
fn occlusion_believed(n: f64) -> f64 {
    n.powi(3) / (n * n + OCCLUSION_WORTH * OCCLUSION_WORTH)
}

/// How much of what the ray of a sample tells is believed; the first sample, 0, has none.
pub fn occlusion_trust(sample: u32) -> f64 {
    occlusion_believed(f64::from(sample)) - occlusion_believed((f64::from(sample) - 1.0).max(0.0))
}

impl AmbientRay {
    /// The ray for a point of the unit square, around a unit normal, if the cones have these shares. It goes to the part
    /// of a cone as often as that weighs and is in doubt.
    pub fn new(normal: DVec3, of_cones: &[f64; OCCLUSION_CONES as usize], [x, y]: [f64; 2]) -> Self {
        let parts: Vec<f64> = (0..)
            .zip(of_cones)
            .map(|(index, share)| occlusion_cone(normal, index).1 * occlusion_doubt(*share))
            .collect();
        let all: f64 = parts.iter().sum();
        let (mut left, mut cone) = (x * all, 0);
        while left >= parts[cone] && cone + 1 < parts.len() {
            left -= parts[cone];
            cone += 1;
        }
        let place = occlusion_place(cone, [(left / parts[cone]).clamp(0.0, 1.0), y]);
        let visible = Occlusion::of_shares(normal, of_cones).visibility;
        let factor = all / occlusion_doubt(of_cones[cone]);
        let shares = [0.0, 1.0].map(|found| visible + (found - of_cones[cone]) * factor);
        Self { direction: occlusion_ray(normal, place), shares }
    }
}

/// The least ratio of the field of any component, along the axis of a cone, and the radius of a sphere in it.
fn least_ratio(evaluator: &mut SceneEvaluator<'_>, axis: &Ray, limits: RayLimits, normal: DVec3) -> f64 {
    let flat = evaluator.flat();
    let mut ratio = 1.0_f64;
    for visit in evaluator.visits(axis, limits, OCCLUSION_TANGENT) {
        let component = &flat.components[visit.component as usize];
        let translucency = evaluator.translucency(visit.component);
        if component.instanced.is_some() {
            let counts = &mut evaluator.counts;
            visit_copies(flat, component, axis, limits, OCCLUSION_TANGENT, &mut |copy, _| {
                let inner = copy_ray(flat, component, copy, axis);
                let stretch = inner.stretch;
                let range = RayLimits { near: limits.near * stretch, far: limits.far * stretch };
                // What is parallel to the receiver, as the receiver itself, is as far away as elsewhere.
                let sine = OCCLUSION_SINE * inner.across(normal) / stretch;
                let one = ratio_of(flat, component, &inner.ray, range, sine, counts);
                ratio = ratio.min(one.max(-1.0) + (1.0 - one.max(-1.0)) * translucency);
                ControlFlow::Continue(limits.far)
            });
            continue;
        }
        let one = ratio_of(flat, component, axis, limits, OCCLUSION_SINE, &mut evaluator.counts);
        ratio = ratio.min(one.max(-1.0) + (1.0 - one.max(-1.0)) * translucency);
    }
    ratio
}

/// The least ratio of the distance from meshes and the radius of a sphere. Behind the first triangle on the axis the
/// distance counts as that within a solid.
fn least_mesh_ratio(flat: &FlatScene, meshes: &Meshes, axis: &Ray, limits: RayLimits) -> f64 {
    let mut ratio = 1.0_f64;
    if meshes.iter().all(Option::is_none) {
        return ratio;
    }
    let stop = mesh_rays_hit(flat, meshes, axis, 0.0, limits.far).map_or(f64::INFINITY, |(_, hit)| hit.t);
    let mut t = limits.near;
    while t <= limits.far {
        let size = OCCLUSION_SINE * t;
        let away = mesh_rays_distance(flat, meshes, axis.at(t), size) / size;
        ratio = ratio.min(if t > stop { -away } else { away });
        t *= OCCLUSION_GROWTH;
    }
    ratio
}

/// The same for one component, or one copy, in whose space the axis is. `sine`: radius of a sphere per distance.
fn ratio_of(
    flat: &FlatScene,
    component: &Component,
    axis: &Ray,
    limits: RayLimits,
    sine: f64,
    counts: &mut SceneCounts,
) -> f64 {
    let mut ratio = 1.0_f64;
    let mut t = limits.near;
    while t <= limits.far && ratio > -1.0 {
        let (p, size) = (axis.at(t) - component.origin, sine * t);
        let plane = component.half_space.map_or(0.0, |[x, y, z, d]| DVec3::new(x, y, z).dot(p) + d);
        let mut f = component.bounds.distance(p).max(plane);
        // Otherwise the bounds are outside of the sphere, and so is the component.
        if f < size * 0.999 {
            counts.evaluations += 1;
            f = field(flat, component, p);
        }
        ratio = ratio.min(f / size);
        // At the same distances for all: steps by the field would show the bounds.
        t *= OCCLUSION_GROWTH;
    }
    ratio
}

/// The same by `count` rays, as many in each direction as the cosine.
///
/// # Errors
/// A ray could not be followed to its end.
pub fn occlusion_by_rays(
    evaluator: &mut SceneEvaluator<'_>,
    meshes: &Meshes,
    origin: DVec3,
    normal: DVec3,
    radius: f64,
    count: u32,
) -> Result<Occlusion, TraceError> {
    let (mut bent, mut seen) = (DVec3::ZERO, 0);
    for i in 0..count {
        let direction = occlusion_ray(normal, disc_spiral(i, count));
        let (ray, limits) = (Ray { origin, direction }, RayLimits { near: 0.0, far: radius });
        if evaluator.ray(&ray, limits)?.is_none() && !mesh_rays_blocked(evaluator.flat(), meshes, &ray, 0.0, radius) {
            seen += 1;
            bent += direction;
        }
    }
    Ok(Occlusion { bent: bent.normalize_or(normal), visibility: f64::from(seen) / f64::from(count) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cones_touch_the_tangent_plane_and_weigh_one() {
        let normal = DVec3::new(0.6, 0.0, 0.8);
        let cones: Vec<_> = (0..OCCLUSION_CONES).map(|i| occlusion_cone(normal, i)).collect();
        assert!((cones.iter().map(|cone| cone.1).sum::<f64>() - 1.0).abs() < 1e-12);
        for (direction, _) in &cones[1..] {
            assert!((direction.length() - 1.0).abs() < 1e-12);
            assert!((direction.dot(normal) - OCCLUSION_SINE).abs() < 1e-12);
        }
        let middle = cones.iter().map(|cone| cone.0 * cone.1).sum::<DVec3>();
        assert!(middle.normalize().dot(normal) > 1.0 - 1e-12);
    }

    #[test]
    fn few_samples_trust_cones_and_many_trust_rays() {
        let mean = |samples: u32| (0..samples).map(occlusion_trust).sum::<f64>() / f64::from(samples);
        assert_eq!(mean(1), 0.0, "the first sample has no ray");
        assert!(mean(3) < 0.1 && (0.7..0.8).contains(&mean(17)) && mean(257) > 0.99, "{} {}", mean(3), mean(17));
        assert!((1..300).all(|sample| (0.0..1.2).contains(&occlusion_trust(sample))));
    }

    /// The parts of cones cover the hemisphere: the mean of what rays tell is that of many rays, whatever the cones say.
    #[test]
    fn rays_tell_the_truth_whatever_cones_say() {
        let (normal, count) = (DVec3::new(0.6, 0.0, 0.8), 40_000);
        let is_free = |direction: DVec3| direction.dot(DVec3::new(0.3, 0.9, 0.1)) < 0.2;
        let unit = |i: u32| [(f64::from(i) + 0.5) / f64::from(count), (0.618_033_988_75 * f64::from(i)).fract()];
        let truth = (0..count).filter(|i| is_free(occlusion_ray(normal, disc_spiral(*i, count)))).count();
        let truth = truth as f64 / f64::from(count);
        let mut deviations = Vec::new();
        for shares in [[0.5; 6], [1.0, 0.2, 0.0, 0.0, 0.9, 1.0], [1.0, 0.0, 0.4, 1.0, 1.0, 0.5]] {
            let told: Vec<f64> = (0..count)
                .map(|i| AmbientRay::new(normal, &shares, unit(i)))
                .map(|ray| ray.shares[usize::from(is_free(ray.direction))])
                .collect();
            let mean = told.iter().sum::<f64>() / f64::from(count);
            assert!((mean - truth).abs() < 4e-3, "{shares:?}: {mean} {truth}");
            deviations.push((told.iter().map(|one| (one - mean).powi(2)).sum::<f64>() / f64::from(count)).sqrt());
        }
        assert!(deviations.iter().all(|deviation| *deviation < 1.0), "{deviations:?}");
    }
}
