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

use super::shadow::cone_share;
use crate::copies::{copy_ray, visit_copies};
use crate::eval::field;
use crate::reference::trace::TraceError;
use crate::scene_eval::{RayLimits, SceneCounts, SceneEvaluator};
use crate::{Component, FlatScene};
use isolith_geometry::Ray;

/// Number of cones.
pub const OCCLUSION_CONES: u32 = 6;
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

/// The occlusion of a point above a surface by everything within `radius`. `least` is the least distance of an
/// evaluation.
pub fn scene_occlusion(
    evaluator: &mut SceneEvaluator<'_>,
    origin: DVec3,
    normal: DVec3,
    radius: f64,
    least: f64,
) -> Occlusion {
    let limits = RayLimits { near: (OCCLUSION_NEAR * radius).max(least), far: OCCLUSION_FAR * radius };
    let (mut bent, mut visibility) = (DVec3::ZERO, 0.0);
    for index in 0..OCCLUSION_CONES {
        let (direction, weight) = occlusion_cone(normal, index);
        let free = weight * cone_share(least_ratio(evaluator, &Ray { origin, direction }, limits, normal));
        visibility += free;
        bent += direction * free;
    }
    Occlusion { bent: bent.normalize_or(normal), visibility }
}

/// The least ratio of the field of any component, along the axis of a cone, and the radius of a sphere in it.
fn least_ratio(evaluator: &mut SceneEvaluator<'_>, axis: &Ray, limits: RayLimits, normal: DVec3) -> f64 {
    let flat = evaluator.flat();
    let mut ratio = 1.0_f64;
    for visit in evaluator.visits(axis, limits, OCCLUSION_TANGENT) {
        let component = &flat.components[visit.component as usize];
        if component.instanced.is_some() {
            let counts = &mut evaluator.counts;
            visit_copies(flat, component, axis, limits, OCCLUSION_TANGENT, &mut |copy, _| {
                let inner = copy_ray(flat, component, copy, axis);
                let stretch = inner.stretch;
                let range = RayLimits { near: limits.near * stretch, far: limits.far * stretch };
                // What is parallel to the receiver, as the receiver itself, is as far away as elsewhere.
                let sine = OCCLUSION_SINE * inner.across(normal) / stretch;
                ratio = ratio.min(ratio_of(flat, component, &inner.ray, range, sine, counts));
                ControlFlow::Continue(limits.far)
            });
            continue;
        }
        ratio = ratio.min(ratio_of(flat, component, axis, limits, OCCLUSION_SINE, &mut evaluator.counts));
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
    origin: DVec3,
    normal: DVec3,
    radius: f64,
    count: u32,
) -> Result<Occlusion, TraceError> {
    let (right, up) = normal.any_orthonormal_pair();
    let (mut bent, mut seen) = (DVec3::ZERO, 0);
    for i in 0..count {
        let share = (f64::from(i) + 0.5) / f64::from(count);
        let (sin, cos) = (TAU * 0.618_033_988_75 * f64::from(i)).sin_cos();
        let direction = (right * cos + up * sin) * share.sqrt() + normal * (1.0 - share).sqrt();
        let limits = RayLimits { near: 0.0, far: radius };
        if evaluator.ray(&Ray { origin, direction }, limits)?.is_none() {
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
}
