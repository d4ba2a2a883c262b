//! Ray tracing by the CPU evaluator, with certainty instead of a step limit.
//!
//! A ray advances by the field, which is a safe step, until the field's sign changes; secants and bisection then
//! close in on the surface. Close to the surface the ray steps to the zero that the field's slope along the ray
//! predicts, plus the rounding: so it enters a sheet however thin, and a ray that only comes near continues and never
//! counts as a hit.
//!
//! Surfaces that do not cover what the ray is for, see [`Veils`], are passed: within the solid the ray follows the field with
//! its sign turned, until it leaves the solid.
//!
//! Conventions shared with the renderer: a hit is the first point where the field is negative, so a shape without
//! volume is invisible; a ray that starts inside a solid hits at `near`. The arrays are rounded to f32. Where a cut
//! ends flush with a face, or two faces coincide, that rounding may leave a skin: between parallel faces of two
//! shapes, anything thinner than the rounding is not a hit.

use std::cell::Cell;
use std::ops::ControlFlow;

use glam::DVec3;
use thiserror::Error;

use crate::copies::{CopyRay, copy_ray, nearest_copy, visit_copies, world_gradient};
use crate::coverage::PixelSample;
use crate::eval::{SurfacePoint, field, gradient, surface};
use crate::ray_limits::RayLimits;
use crate::veil::{VeilPoint, Veils};
use crate::{Component, FlatScene};
use isolith_geometry::{Aabb, Ray};
use isolith_scene::NodeId;

/// The hit of a ray on the first component.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance along the ray.
    pub t: f64,
    /// Index into [`FlatScene::components`].
    pub component: u32,
    /// Index into [`FlatScene::nodes`].
    pub leaf: u32,
}

/// The result of following a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct March {
    /// The hit, if any.
    pub hit: Option<Hit>,
    /// The angle in radians by which the ray could turn before it might hit something else: the minimum of field over
    /// distance at every surface that it passed, and of depth over distance in the solid that it enters. The first is
    /// a lower bound within a factor of two; the second is not measured beyond [`CLEAR`].
    pub margin: f64,
}

/// The ray reached the limit of evaluations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("a ray was not at its end after {MAX_EVALUATIONS} evaluations of what node {node} is part of")]
pub struct TraceError {
    /// The first node of the component.
    pub node: NodeId,
}

/// The limit on evaluations of one component for one ray, so that every ray ends.
pub const MAX_EVALUATIONS: u32 = 10_000_000;
/// Margins beyond this angle are not measured further; it is a hundredth of a pixel or more.
pub const CLEAR: f64 = 1e-4;

/// Below this fraction of the distance from the eye the field counts as touching.
const TOUCHING: f64 = 1e-7;
/// The longest step where the field touches, as a fraction of the distance from the eye. The ray may miss a shorter
/// chord if the field's slope does not predict it.
const LONGEST_CREEP: f64 = 1e-5;
/// The rounding of an evaluation relative to its inputs: some units in the last place of f64.
const ROUNDING: f64 = 16.0 * f64::EPSILON;
/// The depth of a skin that rounding to f32 may leave between two faces that should coincide, relative to the
/// distance from the component's origin. Placing a face rounds three coefficients, a shift and a size, each by half a
/// unit, and a skin is twice as thick as it is deep.
const SKIN: f64 = 2.0 * f32::EPSILON as f64;
/// A ray that approaches a face by less than this, per distance, follows it.
const FOLLOWING: f64 = 1e-3;
/// The tolerance for opposite normals of such faces: 1 + cos of the angle, a thousandth of a radian.
const PARALLEL: f64 = 5e-7;

/// The first surface on the ray between `near` and `far`. For one ray at a time; [`Tracer`] is faster for many.
pub fn trace(flat: &FlatScene, ray: &Ray, near: f64, far: f64) -> Result<Option<Hit>, TraceError> {
    Tracer::new(flat).march(ray, near, far).map(|march| march.hit)
}

/// The first surface of one component on the ray between `near` and `far`; with `veils` the first that covers. Adds the number of evaluations to
/// `evaluations`.
pub fn trace_component(
    flat: &FlatScene,
    index: u32,
    ray: &Ray,
    [near, far]: [f64; 2],
    veils: Option<&Veils<'_>>,
    evaluations: &mut u64,
) -> Result<Option<f64>, TraceError> {
    let found = follow(flat, index, ray, [near, far], veils);
    *evaluations += found.evaluations;
    found.hit
}

/// The way of a ray through one component.
struct Followed {
    hit: Result<Option<f64>, TraceError>,
    evaluations: u64,
    margin: f64,
    /// See [`Line::side`], at the hit.
    side: f64,
}

/// Follows the ray through a component, or through each copy that it may meet.
fn follow(flat: &FlatScene, index: u32, ray: &Ray, [near, far]: [f64; 2], veils: Option<&Veils<'_>>) -> Followed {
    let component = &flat.components[index as usize];
    let veils = veils.filter(|veils| veils.may_pass(index));
    if component.instanced.is_none() {
        let mut line = Line::new(flat, index, ray);
        let passes = |t: f64, surface: &SurfacePoint, passed: u32| {
            let (materials, gradient) = (surface.materials, surface.gradient);
            let point = VeilPoint { component: index, copy: None, t, materials, gradient, passed };
            veils.is_some_and(|veils| !veils.covers(ray, &point))
        };
        let hit = line.covering_hit([near, far], veils.is_some().then_some(&passes));
        return Followed { hit, evaluations: line.fields.get(), margin: line.margin, side: line.side };
    }
    let mut found = Followed { hit: Ok(None), evaluations: 0, margin: f64::INFINITY, side: 1.0 };
    visit_copies(flat, component, ray, RayLimits { near, far }, CLEAR, &mut |copy, limits| {
        let CopyRay { ray: inner, stretch, .. } = copy_ray(flat, component, copy, ray);
        let mut line = Line::new(flat, index, &inner);
        let passes = |t: f64, surface: &SurfacePoint, passed: u32| {
            let gradient = world_gradient(flat, component, ray.at(t / stretch)).1;
            let (copy, materials) = (Some(copy), surface.materials);
            let point = VeilPoint { component: index, copy, t: t / stretch, materials, gradient, passed };
            veils.is_some_and(|veils| !veils.covers(ray, &point))
        };
        let range = [limits.near * stretch, limits.far * stretch];
        let hit = line.covering_hit(range, veils.is_some().then_some(&passes));
        found.evaluations += line.fields.get();
        found.margin = found.margin.min(line.margin);
        match hit {
            Err(error) => {
                found.hit = Err(error);
                return ControlFlow::Break(());
            }
            Ok(Some(t)) => (found.hit, found.side) = (Ok(Some(t / stretch)), line.side),
            Ok(None) => {}
        }
        ControlFlow::Continue(found.hit.ok().flatten().unwrap_or(far))
    });
    found
}

/// A line through the component at `t`, and `t` along it: for copies in the space of the copy there.
fn line_at<'a>(flat: &'a FlatScene, index: u32, ray: &Ray, t: f64) -> (Line<'a>, f64) {
    let component = &flat.components[index as usize];
    match nearest_copy(flat, component, ray.at(t)).copy {
        Some(copy) => {
            let CopyRay { ray, stretch, .. } = copy_ray(flat, component, &copy, ray);
            (Line::new(flat, index, &ray), t * stretch)
        }
        None => (Line::new(flat, index, ray), t),
    }
}

/// The leaf of a component that the ray meets at `t`: index into [`FlatScene::nodes`].
pub fn leaf_at(flat: &FlatScene, component: u32, ray: &Ray, t: f64) -> u32 {
    let (line, t) = line_at(flat, component, ray, t);
    surface(flat, line.component, line.at(t)).leaf
}

/// Traces many rays through one scene.
#[derive(Clone)]
pub struct Tracer<'a> {
    flat: &'a FlatScene,
    /// What rays pass.
    veils: Option<Veils<'a>>,
    /// Bounds of the components, slightly expanded: the arrays are rounded to f32, the bounds are not.
    bounds: Vec<Aabb>,
    /// Entry, exit and index of the components on the current ray.
    order: Vec<(f64, f64, u32)>,
    /// The number of evaluations of components so far.
    pub evaluations: u64,
}

impl<'a> Tracer<'a> {
    /// Prepares a scene.
    pub fn new(flat: &'a FlatScene) -> Self {
        Self {
            flat,
            veils: None,
            bounds: flat.components.iter().map(|c| c.world_bounds().translated(-c.origin)).collect(),
            order: Vec::new(),
            evaluations: 0,
        }
    }

    /// Makes rays pass surfaces. All of them have to begin at the eye of `veils`.
    pub fn through(self, veils: Veils<'a>) -> Self {
        Self { veils: Some(veils), ..self }
    }

    /// Whether rays pass surfaces of the scene.
    pub fn passes_surfaces(&self) -> bool {
        self.veils.as_ref().is_some_and(Veils::is_on)
    }

    /// Sets the sample of the pixel that rays are for from now on.
    pub fn set_sample(&mut self, at: PixelSample) {
        if let Some(veils) = &mut self.veils {
            veils.at = Some(at);
        }
    }

    /// Follows the ray of an eye from `near` to the first surface, or to `far`. Components have limits of their own,
    /// see [`isolith_scene::MarchSettings`].
    pub fn march(&mut self, ray: &Ray, near: f64, far: f64) -> Result<March, TraceError> {
        self.order.clear();
        for (index, component) in self.flat.components.iter().enumerate() {
            let local = Ray { origin: ray.origin - component.origin, ..*ray };
            if let Some((entry, exit)) = self.bounds[index].ray_interval(&local) {
                let march = &component.march;
                let (entry, exit) = (entry.max(near).max(march.near), exit.min(far).min(march.end()));
                if entry <= exit {
                    self.order.push((entry, exit, index as u32));
                }
            }
        }
        self.order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let mut nearest: Option<(f64, u32, f64)> = None;
        let mut margin = f64::INFINITY;
        for &(entry, exit, index) in &self.order {
            let limit = nearest.map_or(exit, |(t, ..)| exit.min(t));
            if entry > limit {
                break;
            }
            let found = follow(self.flat, index, ray, [entry, limit], self.veils.as_ref());
            self.evaluations += found.evaluations;
            if let Some(t) = found.hit? {
                nearest = Some((t, index, found.side));
            }
            margin = margin.min(found.margin);
        }
        let Some((t, component, side)) = nearest else { return Ok(March { hit: None, margin }) };
        let (mut line, along) = line_at(self.flat, component, ray, t);
        line.side = side;
        let leaf = surface(self.flat, line.component, line.at(along)).leaf;
        let margin = margin.min(line.depth(along));
        self.evaluations += line.fields.get();
        Ok(March { hit: Some(Hit { t, component, leaf }), margin })
    }
}

/// See [`Line::covering_hit`].
type Passes<'a> = dyn Fn(f64, &SurfacePoint, u32) -> bool + 'a;

/// A ray through one component.
struct Line<'a> {
    flat: &'a FlatScene,
    component: &'a Component,
    origin: DVec3,
    direction: DVec3,
    /// −1 within a solid that the ray may leave: its field counts as that of the space around.
    side: f64,
    evaluations: u32,
    /// The number of evaluations by `field` and `slope`.
    fields: Cell<u64>,
    margin: f64,
}

impl<'a> Line<'a> {
    fn new(flat: &'a FlatScene, index: u32, ray: &Ray) -> Self {
        let component = &flat.components[index as usize];
        let origin = ray.origin - component.origin;
        Self {
            flat,
            component,
            origin,
            direction: ray.direction,
            side: 1.0,
            evaluations: 0,
            fields: Cell::new(0),
            margin: f64::INFINITY,
        }
    }

    fn at(&self, t: f64) -> DVec3 {
        self.origin + self.direction * t
    }

    fn field(&self, t: f64) -> f64 {
        self.fields.set(self.fields.get() + 1);
        self.side * field(self.flat, self.component, self.at(t))
    }

    /// The field's slope along the ray.
    fn slope(&self, t: f64) -> f64 {
        self.fields.set(self.fields.get() + 1);
        self.side * gradient(self.flat, self.component, self.at(t)).1.dot(self.direction)
    }

    /// The rounding of the field's value at `t`.
    fn rounding(&self, t: f64) -> f64 {
        ROUNDING * (self.origin.length() + t)
    }

    /// The first hit that is not passed; `passes` gets its place, its surface, and how many have been passed before.
    fn covering_hit(
        &mut self,
        [entry, exit]: [f64; 2],
        passes: Option<&Passes<'_>>,
    ) -> Result<Option<f64>, TraceError> {
        let (mut from, mut passed) = (entry, 0);
        loop {
            let Some(hit) = self.first_hit(from, exit)? else { return Ok(None) };
            let Some(passes) = passes else { return Ok(Some(hit)) };
            if !passes(hit, &surface(self.flat, self.component, self.at(hit)), passed) {
                return Ok(Some(hit));
            }
            // At the hit, the sign has just changed.
            (from, passed, self.side) = (hit, passed + 1, -self.side);
        }
    }

    fn first_hit(&mut self, entry: f64, exit: f64) -> Result<Option<f64>, TraceError> {
        let (mut t, mut f) = (entry, self.field(entry));
        if f < 0.0 {
            return Ok(Some(t));
        }
        let mut min_step = 0.0;
        // The decrease of the field in the last step, per distance.
        let mut fell = 1.0;
        while t < exit {
            self.evaluations += 1;
            if self.evaluations > MAX_EVALUATIONS {
                return Err(TraceError { node: self.flat.ids[self.component.first as usize] });
            }
            let next = (t + self.step(t, f, fell, &mut min_step)).min(exit);
            let g = self.field(next);
            if g < 0.0 {
                let hit = self.close_in([t, f], [next, g]);
                let Some(behind) = self.skin_end(hit) else { return Ok(Some(hit)) };
                (t, f, min_step, fell) = (behind, self.field(behind).max(0.0), 0.0, 1.0);
                continue;
            }
            // Where the field, seen from the eye, begins to grow again, the ray has passed a surface.
            if g * t > f * next {
                self.pass(f, t);
            }
            fell = (f - g) / (next - t);
            (t, f) = (next, g);
        }
        self.pass(f, t);
        Ok(None)
    }

    /// The next step from `t`, where the field is `f`: the field itself, or, where the field touches, a step to the
    /// predicted zero plus the rounding. The least step doubles as long as the field touches, so that a ray along a
    /// surface advances.
    fn step(&self, t: f64, f: f64, fell: f64, min_step: &mut f64) -> f64 {
        let rounding = self.rounding(t);
        let touches = f < (TOUCHING * t).max(rounding);
        // Along a face, the field equals the rounding of the face all the way.
        let follows = fell < FOLLOWING && f < SKIN * self.at(t).length();
        if !touches && !follows {
            *min_step = 0.0;
            return f;
        }
        let longest = (LONGEST_CREEP * t).max(rounding);
        *min_step = (2.0 * *min_step).clamp(rounding, longest);
        let descent = if touches { -self.slope(t) } else { 0.0 };
        let straight = if descent > 0.0 { f / descent + rounding } else { 0.0 };
        f.max(straight.min(longest)).max(*min_step)
    }

    /// The end of the solid that the ray enters at `t`, if it is a skin that rounding left, see [`SKIN`].
    fn skin_end(&self, t: f64) -> Option<f64> {
        let thin = SKIN * self.at(t).length();
        let is_deep = |f: f64| f < -thin;
        if is_deep(self.field(t + 4.0 * thin)) {
            return None;
        }
        let (mut end, mut least) = (t, self.rounding(t));
        let farthest = t + (LONGEST_CREEP * t).max(8.0 * thin);
        loop {
            let f = self.field(end);
            if end > t && f >= 0.0 {
                break;
            }
            if is_deep(f) || end > farthest {
                return None;
            }
            end += least.max(-f);
            least *= 2.0;
        }
        let [front, back] = [t, end].map(|t| surface(self.flat, self.component, self.at(t)));
        let normals = [front.gradient, back.gradient].map(|gradient| gradient.normalize_or_zero());
        (front.leaf != back.leaf && normals[0].dot(normals[1]) < PARALLEL - 1.0).then_some(end)
    }

    fn pass(&mut self, f: f64, t: f64) {
        self.margin = self.margin.min(f / t.max(f64::MIN_POSITIVE));
    }

    /// The sign change between a point outside and one inside, each with its field: secants, or the middle if a
    /// secant has not halved the interval.
    fn close_in(&self, mut outside: [f64; 2], mut inside: [f64; 2]) -> f64 {
        let precision = 0.25 * self.rounding(inside[0]);
        let mut use_secant = true;
        loop {
            let width = inside[0] - outside[0];
            if width <= precision {
                return inside[0];
            }
            // Evaluate slightly to either side of the secant's root, so that both ends move.
            let share = if use_secant { (outside[1] / (outside[1] - inside[1])).clamp(1e-3, 0.999) } else { 0.5 };
            for t in [share * (1.0 - 1e-6), share * (1.0 + 1e-6)].map(|share| outside[0] + width * share) {
                let f = self.field(t);
                if f < 0.0 {
                    inside = [t, f];
                    break;
                }
                outside = [t, f];
            }
            use_secant = inside[0] - outside[0] < 0.5 * width;
        }
    }

    /// The depth of the solid behind `t` over the distance; at most about [`CLEAR`]. Probes at growing distances: one
    /// of them is close to the middle of the chord, however short that is.
    fn depth(&self, t: f64) -> f64 {
        let mut deepest = 0.0;
        let first = (1e-10 * t).max(self.rounding(t));
        let mut ahead = first;
        while ahead < t && deepest < CLEAR {
            let depth = -self.field(t + ahead) / (t + ahead);
            // The first probes are closer to the surface than the rounding.
            if depth < 0.0 && ahead > 100.0 * first {
                break;
            }
            deepest = f64::max(deepest, depth);
            ahead *= 1.3;
        }
        deepest
    }
}
