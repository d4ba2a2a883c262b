//! Soft shadows by signed cones. Counterpart of `shaders/scene/cone.wgsl`.
//!
//! A cone goes from a point of a surface to the disc of a light. Its axis is marched through one component after the
//! other, and through the solids as well: there the field is negative. The least ratio of the field and the cone's
//! radius tells where a straight edge would cut the disc. Where no edge exists there are proofs: the spheres that the
//! field vouches for hold the whole cone, or one of them, inside a solid, holds a whole cross section of it.

use std::f64::consts::{PI, TAU};
use std::ops::ControlFlow;

use glam::DVec3;

use crate::copies::{copy_ray, visit_copies};
use crate::eval::field;
use crate::lights::GpuLight;
use crate::reference::trace::TraceError;
use crate::scene_eval::{RayLimits, SceneCounts, SceneEvaluator, SceneVisit};
use crate::{Component, FlatScene};
use isolith_geometry::{Ray, radical_inverse};

/// Least tangent of a cone, 0.06 degrees: a narrower one could not be marched by its radius.
pub const LEAST_SPREAD: f64 = 1e-3;
/// Greatest tangent of a cone, 45 degrees: a lamp that nearly touches the surface.
const GREATEST_SPREAD: f64 = 1.0;
/// Radius of a cone where it begins.
const LEAST_RADIUS: f64 = 1e-12;
/// Tangent of about 6 degrees. In narrower cones the shares of components are multiplied: their edges lie anywhere. In
/// wider ones the least counts.
pub const WIDE_SPREAD: f64 = 0.105;
/// Length of the cone to a directional light, in meters.
pub const SHADOW_REACH: f64 = 1e6;
/// Copies that leave less of a light count as leaving nothing, so that cones through endless lattices end: half of what
/// a byte resolves.
const LEAST_SHARE: f64 = 0.002;
/// The ratio of field and radius once a cone is wholly within a solid; others are at least -1.
const PROVEN_DARK: f64 = -2.0;
/// Least step in the cone's radius, by quality.
pub const CONE_STEPS: [f64; 3] = [0.5, 0.25, 0.125];

/// A cone from a point toward a light, or in which something may occlude the point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadowCone {
    /// From the point along the middle of the cone.
    pub axis: Ray,
    /// Distance of the first evaluation.
    pub near: f64,
    /// Distance of the end.
    pub far: f64,
    /// Radius of the cone at distance 1.
    pub spread: f64,
    /// Radius at distance 1 by which the field is measured.
    pub size: f64,
    /// Least step, in meters.
    pub least_step: f64,
    /// Least step, in radii.
    pub fineness: f64,
}

/// Least step of a cone in radii, at this quality.
pub fn cone_fineness(quality: f64) -> f64 {
    CONE_STEPS[(quality.round() as usize).clamp(1, CONE_STEPS.len()) - 1]
}

/// What a cone knows for certain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShadowProof {
    /// Nothing.
    None,
    /// Nothing is between the point and any point of the light.
    Lit,
    /// A solid is between the point and each point of the light.
    Dark,
}

/// The visible share of a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadowShare {
    /// 1 for the whole light, 0 for none of it.
    pub share: f64,
    /// Whether it is certain.
    pub proof: ShadowProof,
}

impl ShadowShare {
    /// The same if this share of the light passes what is in the way.
    fn through(self, translucency: f64) -> Self {
        let is_dark = self.proof == ShadowProof::Dark && translucency > 0.0;
        let proof = if is_dark { ShadowProof::None } else { self.proof };
        Self { share: self.share + (1.0 - self.share) * translucency, proof }
    }

    /// What both leave: see [`WIDE_SPREAD`].
    fn and(self, other: Self, spread: f64) -> Self {
        let share = if spread < WIDE_SPREAD { self.share * other.share } else { self.share.min(other.share) };
        let either = |proof: ShadowProof| self.proof == proof || other.proof == proof;
        let uncertain = if either(ShadowProof::None) { ShadowProof::None } else { ShadowProof::Lit };
        let proof = if either(ShadowProof::Dark) { ShadowProof::Dark } else { uncertain };
        Self { share, proof }
    }
}

/// Tangent of the angular radius of a directional light, radius of others.
pub fn light_extent(light: &GpuLight) -> f64 {
    let length = |v: [f32; 3]| DVec3::from(v.map(f64::from)).length();
    match light.kind {
        // The disc of the same area.
        GpuLight::RECTANGLE => (length(light.right) * length(light.up) * 4.0 / PI).sqrt(),
        _ => light.radius.into(),
    }
}

impl ShadowCone {
    /// The cone to a light of this extent in the direction `to_light`, `distance` away; infinite for a directional
    /// light. `footprint` is the width of a pixel at the point.
    pub fn new(origin: DVec3, to_light: DVec3, distance: f64, extent: f64, footprint: f64) -> Self {
        let spread = if distance.is_finite() { extent / distance.max(1e-6) } else { extent };
        let spread = spread.clamp(LEAST_SPREAD, GREATEST_SPREAD);
        Self {
            axis: Ray { origin, direction: to_light },
            near: 0.0,
            far: distance.min(SHADOW_REACH),
            spread,
            size: spread,
            least_step: 0.25 * footprint,
            fineness: CONE_STEPS[1],
        }
    }

    /// The step from `t`, where the field is `f`.
    fn plain_step(&self, t: f64, f: f64) -> f64 {
        f.abs().max(self.least_step).max(self.fineness * self.size * t)
    }

    /// The ray to a point of the light's disc of radius 1.
    pub fn ray_to(&self, [x, y]: [f64; 2]) -> Ray {
        let (right, up) = self.axis.direction.any_orthonormal_pair();
        let direction = self.axis.direction + (right * x + up * y) * self.spread;
        Ray { direction: direction.normalize(), ..self.axis }
    }
}

/// The visible share of a disc if a straight edge cuts it at `ratio` radii from its middle: the area of a segment of a
/// circle.
pub fn cone_share(ratio: f64) -> f64 {
    let s = ratio.clamp(-1.0, 1.0);
    0.5 + (s * (1.0 - s * s).max(0.0).sqrt() + s.asin()) / PI
}

/// The share of the light that all components leave.
pub fn shadow_share(evaluator: &mut SceneEvaluator<'_>, cone: &ShadowCone) -> ShadowShare {
    let mut all = ShadowShare { share: 1.0, proof: ShadowProof::Lit };
    let limits = RayLimits { near: cone.near, far: cone.far };
    for visit in evaluator.visits(&cone.axis, limits, cone.spread) {
        let one = shadow_of(evaluator, cone, &visit).through(evaluator.translucency(visit.component));
        if one.proof == ShadowProof::Dark {
            return one;
        }
        all = all.and(one, cone.spread);
    }
    all
}

/// The share of the light that one component leaves.
pub fn shadow_of(evaluator: &mut SceneEvaluator<'_>, cone: &ShadowCone, visit: &SceneVisit) -> ShadowShare {
    let flat = evaluator.flat();
    let component = &flat.components[visit.component as usize];
    let counts = &mut evaluator.counts;
    if component.instanced.is_none() {
        return shadow_along(flat, component, cone, [visit.entry, visit.exit], counts);
    }
    let mut all = ShadowShare { share: 1.0, proof: ShadowProof::Lit };
    let limits = RayLimits { near: visit.entry, far: visit.exit };
    visit_copies(flat, component, &cone.axis, limits, cone.spread, &mut |copy, range| {
        // In the space of the copy, whose lengths differ by `stretch`; angles stay if it is scaled evenly.
        let inner = copy_ray(flat, component, copy, &cone.axis);
        let stretch = inner.stretch;
        let of_copy = ShadowCone {
            axis: inner.ray,
            near: cone.near * stretch,
            far: cone.far * stretch,
            spread: inner.widened(cone.spread),
            size: cone.size * inner.mean_size(),
            least_step: cone.least_step * stretch,
            ..*cone
        };
        let one = shadow_along(flat, component, &of_copy, [range.near * stretch, range.far * stretch], counts);
        all = all.and(one, cone.spread);
        let is_dark = one.proof == ShadowProof::Dark || all.share < LEAST_SHARE;
        if is_dark { ControlFlow::Break(()) } else { ControlFlow::Continue(visit.exit) }
    });
    all
}

/// The share of the light that a component leaves, or one copy, in whose space the cone is; between two distances.
fn shadow_along(
    flat: &FlatScene,
    component: &Component,
    cone: &ShadowCone,
    [entry, exit]: [f64; 2],
    counts: &mut SceneCounts,
) -> ShadowShare {
    let local = Ray { origin: cone.axis.origin - component.origin, ..cone.axis };
    let mut march = ConeMarch::new(entry);
    if cone_passes_half_space(component.half_space, &local, cone.spread, exit) {
        return march.share();
    }
    while !march.ended {
        let p = local.at(march.t);
        // Where the bounds are outside of the cone, so is the component.
        let bound = component.bounds.distance(p);
        let f = if bound > cone.spread * march.t {
            bound
        } else {
            counts.evaluations += 1;
            field(flat, component, p)
        };
        march.step(f, cone, exit);
    }
    march.share()
}

/// Whether the whole cone stays outside of the half space that holds a component.
fn cone_passes_half_space(half_space: Option<[f64; 4]>, local: &Ray, spread: f64, exit: f64) -> bool {
    let Some([x, y, z, d]) = half_space else { return false };
    let normal = DVec3::new(x, y, z);
    let (height, climb) = (normal.dot(local.origin) + d, normal.dot(local.direction));
    // Along the side of the cone that is nearest to the plane.
    let lowest = climb - spread * (1.0 - climb * climb).max(0.0).sqrt();
    height >= 0.0 && (lowest >= 0.0 || height + lowest * exit >= 0.0)
}

/// A field that grows by less than this per distance allows no wide step.
const LEAST_CLIMB: f64 = 0.2;
/// The greatest growth that a wide step expects.
const MOST_CLIMB: f64 = 0.8;
/// A wide step, in the step after which the next sphere would just touch this one.
const WIDE_STEP: f64 = 0.9;

/// The march of a cone through one component.
#[derive(Clone, Copy, Debug, PartialEq)]
struct ConeMarch {
    /// Distance of the next evaluation.
    t: f64,
    /// Distance of the last one, and the field there.
    last: [f64; 2],
    /// Least ratio of field and radius.
    ratio: f64,
    /// Whether the spheres so far hold the cone.
    lit: bool,
    /// Whether the step to `t` is longer than the field vouches for.
    wide: bool,
    ended: bool,
}

impl ConeMarch {
    fn new(entry: f64) -> Self {
        Self { t: entry, last: [entry, f64::INFINITY], ratio: f64::INFINITY, lit: true, wide: false, ended: false }
    }

    /// Takes the field at `t` into account and moves on. Where the field grows, as above the surface that the cone
    /// leaves, a step is so wide that the next sphere reaches back to this one, or it is taken back.
    fn step(&mut self, f: f64, cone: &ShadowCone, exit: f64) {
        let t = self.t;
        let [last_t, last_f] = self.last;
        self.ratio = self.ratio.min(f / (cone.size * t).max(LEAST_RADIUS)).max(-1.0);
        // In a stretched copy the size is that of the section on average, and the spread holds all of it.
        if f <= -(cone.size.max(cone.spread) * t).max(LEAST_RADIUS) {
            (self.ratio, self.lit, self.ended) = (PROVEN_DARK, false, true);
            return;
        }
        let holds = spheres_hold(self.last, [t, f], cone.spread);
        if self.wide && !holds {
            self.wide = false;
            self.last = [last_t, last_f];
            self.t = (last_t + cone.plain_step(last_t, last_f)).min(exit);
            return;
        }
        self.lit = self.lit && f >= cone.spread * t && holds;
        let left = exit - t;
        let end = cone.spread * exit;
        let is_past = f > 0.0 && f * f >= left * left + end * end;
        self.ended = left <= 0.0 || is_past;
        let plain = cone.plain_step(t, f);
        let climb = if t > last_t { (f - last_f) / (t - last_t) } else { 0.0 };
        let wide = WIDE_STEP * 2.0 * f / (1.0 - climb.min(MOST_CLIMB));
        self.wide = f > 0.0 && climb > LEAST_CLIMB && wide > plain;
        self.last = [t, f];
        self.t = (t + if self.wide { wide } else { plain }).min(exit);
    }

    fn share(&self) -> ShadowShare {
        let proof = match () {
            () if self.ratio == PROVEN_DARK => ShadowProof::Dark,
            () if self.lit => ShadowProof::Lit,
            () => ShadowProof::None,
        };
        ShadowShare { share: if self.lit { 1.0 } else { cone_share(self.ratio) }, proof }
    }
}

/// Whether two spheres around points of the axis hold the cone between these points. Both hold the cross section at
/// their own middle; so do they together if that holds where they meet.
fn spheres_hold([t, f]: [f64; 2], [u, g]: [f64; 2], spread: f64) -> bool {
    let step = u - t;
    if f.is_infinite() {
        return true;
    }
    // Where the spheres meet; before or behind the two points, one of them holds the whole stretch.
    let meet = (step * step + f * f - g * g) / (2.0 * step).max(LEAST_RADIUS);
    let radius = spread * (t + meet);
    meet <= 0.0 || meet >= step || f * f - meet * meet >= radius * radius
}

/// Direction and distance of the middle of a light; `None` if none of its light reaches the point.
pub fn light_toward(light: &GpuLight, position: DVec3) -> Option<(DVec3, f64)> {
    let vector = |v: [f32; 3]| DVec3::from(v.map(f64::from));
    if light.kind == GpuLight::DIRECTIONAL {
        return Some((-vector(light.direction), f64::INFINITY));
    }
    let offset = vector(light.position) - position;
    let distance = offset.length();
    let to_light = offset / distance.max(1e-6);
    let is_outside =
        light.kind == GpuLight::SPOT && -to_light.dot(vector(light.direction)) < f64::from(light.cos_outer);
    (distance < light.range.into() && !is_outside).then_some((to_light, distance))
}

/// A point of a light's disc of radius 1 for a ray of a still picture: the sequence R2 (Roberts, "The Unreasonable
/// Effectiveness of Quasirandom Sequences", 2018), shifted for each pixel and light. Counterpart of
/// `shaders/light/sample.wgsl`.
pub fn light_sample(pixel: [u32; 2], light: u32, sample: u32) -> [f64; 2] {
    let [x, y] = unit_sample(pixel, light, sample);
    let (radius, (sin, cos)) = (x.sqrt(), (TAU * y).sin_cos());
    [radius * cos, radius * sin]
}

/// The same in the unit square.
fn unit_sample([x, y]: [u32; 2], light: u32, sample: u32) -> [f64; 2] {
    let hash = sample_hash([x, y, light]);
    let place =
        |hash: u32, step: u32| f64::from(hash.wrapping_add(step.wrapping_mul(sample)) >> 8) / f64::from(1 << 24);
    [place(hash[0], 0xc13f_a9a9), place(hash[1], 0x91e1_0da5)]
}

/// A point of the unit square for a ray to the environment: Halton's sequence with the bases 5 and 7, for the places in the
/// pixel are that with 2 and 3; all rays of a pixel are of one sequence. Rays of two sequences by R2 left a 99th percentile
/// of the error of 0.025 after 256 samples, these 0.019.
pub fn around_sample([x, y]: [u32; 2], key: u32, ray: u32) -> [f64; 2] {
    let [a, b, _] = sample_hash([x, y, key]);
    [(a, 5), (b, 7)].map(|(hash, base)| {
        let shift = f64::from(hash >> 8) / f64::from(1 << 24);
        (shift + radical_inverse(ray, base)).fract()
    })
}

/// Hash of three words (Jarzynski and Olano, "Hash Functions for GPU Rendering", 2020).
fn sample_hash(seed: [u32; 3]) -> [u32; 3] {
    let mut v = seed.map(|word| word.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    for round in 0..2 {
        for i in 0..3 {
            v[i] = v[i].wrapping_add(v[(i + 1) % 3].wrapping_mul(v[(i + 2) % 3]));
        }
        if round == 0 {
            v = v.map(|word| word ^ (word >> 16));
        }
    }
    v
}

/// The visible share of the light by `count` rays to points that are spread evenly over its disc.
///
/// # Errors
/// A ray could not be followed to its end.
pub fn shadow_by_rays(evaluator: &mut SceneEvaluator<'_>, cone: &ShadowCone, count: u32) -> Result<f64, TraceError> {
    let mut seen = 0;
    for i in 0..count {
        seen += u32::from(light_is_seen(evaluator, cone, disc_spiral(i, count))?);
    }
    Ok(f64::from(seen) / f64::from(count))
}

/// Whether nothing is between the point and a point of the light's disc.
///
/// # Errors
/// The ray could not be followed to its end.
pub fn light_is_seen(
    evaluator: &mut SceneEvaluator<'_>,
    cone: &ShadowCone,
    place: [f64; 2],
) -> Result<bool, TraceError> {
    let limits = RayLimits { near: 0.0, far: cone.far };
    Ok(evaluator.ray(&cone.ray_to(place), limits)?.is_none())
}

/// The share of the light of a point of the light's disc that what is between lets pass.
///
/// # Errors
/// A ray could not be followed to its end.
pub fn light_passed(evaluator: &mut SceneEvaluator<'_>, cone: &ShadowCone, place: [f64; 2]) -> Result<f64, TraceError> {
    evaluator.passed(&cone.ray_to(place), RayLimits { near: 0.0, far: cone.far })
}

/// Point `i` of `count` that cover the unit disc evenly (Vogel, "A better way to construct the sunflower head", 1979).
pub fn disc_spiral(i: u32, count: u32) -> [f64; 2] {
    let radius = ((f64::from(i) + 0.5) / f64::from(count)).sqrt();
    let (sin, cos) = (TAU * 0.618_033_988_75 * f64::from(i)).sin_cos();
    [radius * cos, radius * sin]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_share_of_a_disc_is_the_area_of_a_segment() {
        for (ratio, share) in [(-2.0, 0.0), (-1.0, 0.0), (0.0, 0.5), (1.0, 1.0), (3.0, 1.0)] {
            assert!((cone_share(ratio) - share).abs() < 1e-12, "{ratio}");
        }
        let count = 4000;
        let seen = (0..count).filter(|i| disc_spiral(*i, count)[0] < 0.3).count();
        assert!((cone_share(0.3) - seen as f64 / f64::from(count)).abs() < 2e-3);
    }

    #[test]
    fn spheres_that_only_touch_do_not_hold_the_cone_between_them() {
        assert!(spheres_hold([1.0, 0.5], [1.5, 0.5], 0.1));
        assert!(!spheres_hold([1.0, 0.1], [1.2, 0.1], 0.05));
        assert!(spheres_hold([1.0, 0.5], [1.1, 0.1], 0.05));
    }

    #[test]
    fn the_cone_ends_where_the_light_is() {
        let cone = ShadowCone::new(DVec3::ZERO, DVec3::Y, 2.0, 0.1, 1e-3);
        assert_eq!((cone.far, cone.spread), (2.0, 0.05));
        let ray = cone.ray_to([0.6, 0.8]);
        assert!((ray.direction.angle_between(DVec3::Y).tan() - 0.05).abs() < 1e-12);
        assert_eq!(ShadowCone::new(DVec3::ZERO, DVec3::Y, f64::INFINITY, 0.0, 1e-3).spread, LEAST_SPREAD);
    }
}
