//! The scene evaluator: distances and rays to all components at once, in f64. `eval` evaluates one component; the
//! hierarchy over the bounds selects the components that matter. Counterpart of `shaders/scene/`.
//!
//! The value of a component at a point is its field, or the distance to its bounds if that is more: both are lower
//! bounds of the distance to its surface. The value of the scene is the least of all, so a component whose bounds are
//! farther away than a known value cannot change it.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use glam::DVec3;

use super::copies::world_field;
use super::hierarchy::{Hierarchy, HierarchyNode};
pub use super::ray_limits::RayLimits;
use super::reference::trace::{Hit, TraceError, leaf_at, trace_component};
use super::veil::Veils;
use super::{Component, FlatScene};
use isolith_geometry::{Aabb, Ray};

/// Offset of a ray that leaves a surface, in footprints of a pixel there: more than the tolerance of a picture's
/// depth. `shaders/scene/march.wgsl` has the same number.
pub const SURFACE_BIAS: f64 = 0.25;

/// Slack of the half space, relative to the coordinates: the arrays are rounded to f32, it is not.
const HALF_SPACE_SLACK: f64 = 1e-6;

/// The value of the scene at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneDistance {
    /// Never more than the distance to the nearest surface; negative inside.
    pub value: f64,
    /// Its component: index into [`FlatScene::components`]; `None` for a scene without components.
    pub component: Option<u32>,
}

/// A component that a cone may meet, with entry and exit of the cone through its bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneVisit {
    /// Where it enters.
    pub entry: f64,
    /// Where it leaves.
    pub exit: f64,
    /// Index into [`FlatScene::components`].
    pub component: u32,
}

/// Counters of work.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SceneCounts {
    /// Evaluations of the field of one component.
    pub evaluations: u64,
    /// Comparisons of a box with a point or a ray.
    pub boxes: u64,
}

/// Evaluates a scene at points and along rays.
#[derive(Clone, Debug)]
pub struct SceneEvaluator<'a> {
    flat: &'a FlatScene,
    hierarchy: &'a Hierarchy,
    /// What rays of an eye pass, if rays are those.
    of_eye: Option<Veils<'a>>,
    /// See [`FlatScene::translucency`].
    translucency: Vec<f64>,
    /// Work since its creation.
    pub counts: SceneCounts,
}

impl<'a> SceneEvaluator<'a> {
    /// Uses the scene's own hierarchy, which is built here if it does not exist yet.
    pub fn new(flat: &'a FlatScene) -> Self {
        Self::with_hierarchy(flat, flat.hierarchy())
    }

    /// Uses another hierarchy over the scene's components.
    pub fn with_hierarchy(flat: &'a FlatScene, hierarchy: &'a Hierarchy) -> Self {
        Self { flat, hierarchy, of_eye: None, translucency: flat.translucency(), counts: SceneCounts::default() }
    }

    /// The same for rays that start at this eye: they do not meet components nearer or farther than these are drawn, nor
    /// surfaces without any opacity.
    pub fn of_eye(self, eye: DVec3) -> Self {
        Self { of_eye: Some(Veils::new(self.flat, eye, 0.0)), ..self }
    }

    /// Share of the light that passes a component.
    pub fn translucency(&self, component: u32) -> f64 {
        self.translucency.get(component as usize).copied().unwrap_or(0.0)
    }

    /// The value of the scene at a point of the world. Any lower bound of the distance that is at least `within` may
    /// stand for a value of at least `within`: the evaluator then skips the fields of farther components.
    pub fn distance(&mut self, point: DVec3, within: f64) -> SceneDistance {
        let mut nearest = SceneDistance { value: f64::INFINITY, component: None };
        let nodes = &self.hierarchy.nodes;
        let mut open: Vec<(f64, usize)> =
            nodes.first().map(|root| (root.bounds.distance(point), 0)).into_iter().collect();
        self.counts.boxes += open.len() as u64;
        while let Some((bound, index)) = open.pop() {
            if bound > 0.0 && bound >= nearest.value {
                continue;
            }
            let node = &nodes[index];
            if node.is_leaf() {
                self.consider(node.link, point, bound, within, &mut nearest);
                continue;
            }
            let [left, right] =
                [index + 1, node.link as usize].map(|child| (nodes[child].bounds.distance(point), child));
            self.counts.boxes += 2;
            open.extend(if left.0 <= right.0 { [right, left] } else { [left, right] });
        }
        for index in self.hierarchy.unbounded.iter() {
            self.consider(*index, point, 0.0, within, &mut nearest);
        }
        nearest
    }

    /// Lowers `nearest` to the value of a component whose bounds are at the distance `bound`.
    fn consider(&mut self, index: u32, point: DVec3, bound: f64, within: f64, nearest: &mut SceneDistance) {
        let component = &self.flat.components[index as usize];
        let local = point - component.origin;
        let bound = if component.instanced.is_some() { bound } else { bound.max(half_space_bound(component, local)) };
        let is_outside = bound > 0.0;
        if is_outside && bound >= nearest.value {
            return;
        }
        let value = if is_outside && bound >= within {
            bound
        } else {
            self.counts.evaluations += 1;
            let value = world_field(self.flat, component, point);
            if is_outside { value.max(bound) } else { value }
        };
        if value < nearest.value {
            *nearest = SceneDistance { value, component: Some(index) };
        }
    }

    /// The first surface on the ray within the limits.
    ///
    /// # Errors
    /// A ray could not be followed to its end.
    pub fn ray(&mut self, ray: &Ray, limits: RayLimits) -> Result<Option<Hit>, TraceError> {
        let mut nearest: Option<(f64, u32)> = None;
        let mut open = BinaryHeap::new();
        self.open(0, ray, limits, &mut open);
        while let Some(Open { entry, exit, index }) = open.pop() {
            let limit = nearest.map_or(exit, |(t, _)| exit.min(t));
            if entry > limit {
                break;
            }
            let HierarchyNode { link, .. } = self.hierarchy.nodes[index];
            if self.hierarchy.nodes[index].is_leaf() {
                self.follow(link, ray, RayLimits { near: entry, far: limit }, &mut nearest)?;
            } else {
                let limits = RayLimits { far: nearest.map_or(limits.far, |(t, _)| t), ..limits };
                self.open(index + 1, ray, limits, &mut open);
                self.open(link as usize, ray, limits, &mut open);
            }
        }
        for index in self.hierarchy.unbounded.iter() {
            let far = nearest.map_or(limits.far, |(t, _)| t);
            self.follow(*index, ray, RayLimits { far, ..limits }, &mut nearest)?;
        }
        let hit = |(t, component)| Hit { t, component, leaf: leaf_at(self.flat, component, ray, t) };
        Ok(nearest.map(hit))
    }

    /// The share of light that passes all that is in the way of a ray.
    ///
    /// # Errors
    /// A march could not be followed to its end.
    pub fn passed(&mut self, ray: &Ray, limits: RayLimits) -> Result<f64, TraceError> {
        if self.translucency.is_empty() {
            return Ok(if self.ray(ray, limits)?.is_none() { 1.0 } else { 0.0 });
        }
        let mut share = 1.0;
        for SceneVisit { entry, exit, component } in self.visits(ray, limits, 0.0) {
            let mut met = None;
            self.follow(component, ray, RayLimits { near: entry, far: exit }, &mut met)?;
            share *= met.map_or(1.0, |_| self.translucency(component));
            if share == 0.0 {
                break;
            }
        }
        Ok(share)
    }

    /// The scene.
    pub fn flat(&self) -> &'a FlatScene {
        self.flat
    }

    /// The components whose bounds meet the cone of radius `spread` at distance 1 around the ray, in the order in which
    /// the cone enters them.
    pub fn visits(&mut self, ray: &Ray, limits: RayLimits, spread: f64) -> Vec<SceneVisit> {
        let mut found = Vec::new();
        let mut open: Vec<usize> = if self.hierarchy.nodes.is_empty() { Vec::new() } else { vec![0] };
        while let Some(index) = open.pop() {
            let node = &self.hierarchy.nodes[index];
            self.counts.boxes += 1;
            // Nothing of the box is farther along the ray than this.
            let middle = node.bounds.center() - ray.origin;
            let reach = middle.dot(ray.direction) + node.bounds.half().dot(ray.direction.abs());
            let bounds = widened(&node.bounds, ray).expanded(spread * reach.clamp(0.0, limits.far));
            let Some((entry, exit)) = bounds.ray_interval(ray) else { continue };
            let (entry, exit) = (entry.max(limits.near), exit.min(limits.far));
            if entry > exit {
                continue;
            }
            if node.is_leaf() {
                found.push(SceneVisit { entry, exit, component: node.link });
            } else {
                open.extend([index + 1, node.link as usize]);
            }
        }
        found.sort_unstable_by(|a, b| a.entry.total_cmp(&b.entry).then(a.component.cmp(&b.component)));
        let unbounded = |component: &u32| SceneVisit { entry: limits.near, exit: limits.far, component: *component };
        found.extend(self.hierarchy.unbounded.iter().map(unbounded));
        found
    }

    /// Adds a node to the open ones if the ray meets it.
    fn open(&mut self, index: usize, ray: &Ray, limits: RayLimits, open: &mut BinaryHeap<Open>) {
        let Some(node) = self.hierarchy.nodes.get(index) else { return };
        self.counts.boxes += 1;
        let Some((entry, exit)) = widened(&node.bounds, ray).ray_interval(ray) else { return };
        let (entry, exit) = (entry.max(limits.near), exit.min(limits.far));
        if entry <= exit {
            open.push(Open { entry, exit, index });
        }
    }

    fn follow(
        &mut self,
        index: u32,
        ray: &Ray,
        limits: RayLimits,
        nearest: &mut Option<(f64, u32)>,
    ) -> Result<(), TraceError> {
        let march = &self.flat.components[index as usize].march;
        let (near, far) = match self.of_eye.is_some() {
            true => (limits.near.max(march.near), limits.far.min(march.end())),
            false => (limits.near, limits.far),
        };
        if near > far {
            return Ok(());
        }
        let hit =
            trace_component(self.flat, index, ray, [near, far], self.of_eye.as_ref(), &mut self.counts.evaluations)?;
        if let Some(t) = hit {
            *nearest = Some((t, index));
        }
        Ok(())
    }
}

/// The ray that leaves a surface at `point` along `direction`: it starts [`SURFACE_BIAS`] footprints off the surface,
/// on the side of its direction. `normal` has unit length.
pub fn surface_ray(point: DVec3, normal: DVec3, direction: DVec3, footprint: f64) -> Ray {
    let side = if normal.dot(direction) < 0.0 { -normal } else { normal };
    Ray { origin: point + side * (SURFACE_BIAS * footprint), direction }
}

/// Distance of a point, relative to the component's origin, from the half space that contains the component; 0 if
/// none is known.
fn half_space_bound(component: &Component, p: DVec3) -> f64 {
    let Some([x, y, z, d]) = component.half_space else { return 0.0 };
    (DVec3::new(x, y, z).dot(p) + d - HALF_SPACE_SLACK * (p.length() + d.abs())).max(0.0)
}

/// The box grown by some rounding steps of f64, so that no surface in one of its sides is lost.
fn widened(bounds: &Aabb, ray: &Ray) -> Aabb {
    let reach = bounds.min.abs().max(bounds.max.abs()).max_element() + ray.origin.abs().max_element();
    bounds.expanded(reach * 1e-14)
}

/// A node that the ray meets, ordered nearest first.
#[derive(Clone, Copy, Debug)]
struct Open {
    entry: f64,
    exit: f64,
    index: usize,
}

impl Ord for Open {
    fn cmp(&self, other: &Self) -> Ordering {
        other.entry.total_cmp(&self.entry).then(other.index.cmp(&self.index))
    }
}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Open {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Open {}
