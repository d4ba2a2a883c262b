//! Picks what is under the pointer: the node in front, what lies below it, a point of the surface.

use std::collections::HashSet;

use glam::DVec3;

use super::state::EditorState;
use isolith_field::mesh_rays::trace_meshes;
use isolith_field::scene_eval::{RayLimits, SceneEvaluator};
use isolith_field::{FlatScene, flatten, pick};
use isolith_geometry::Ray;
use isolith_scene::{Node, NodeId, Scene};

/// Most nodes in the list of what lies below the pointer.
pub const MOST_BELOW: usize = 24;

/// A point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PickedPoint {
    /// In the world.
    pub point: DVec3,
    /// A unit vector.
    pub normal: DVec3,
}

/// The node at the first hit of the ray: it traces the exact surface, not its bounds.
pub fn pick_node(state: &EditorState, ray: &Ray) -> Option<NodeId> {
    pick_in(state, state.flat(), ray)
}

/// The same with the copy of an instancer that it is part of.
pub fn pick_copy(state: &EditorState, ray: &Ray) -> Option<pick::Picked> {
    let flat = state.flat();
    let camera = state.view.navigation.camera();
    pick::pick_copy(flat, &flat.known_meshes(state.derived.library()), ray, camera.near, camera.far)
}

fn pick_in(state: &EditorState, flat: &FlatScene, ray: &Ray) -> Option<NodeId> {
    let meshes = flat.known_meshes(state.derived.library());
    let camera = state.view.navigation.camera();
    pick::pick(flat, &meshes, ray, camera.near, camera.far)
}

/// The nodes that the ray meets, nearest first: each is looked for without those before it.
pub fn pick_all(state: &EditorState, ray: &Ray) -> Vec<NodeId> {
    let mut found = Vec::new();
    let mut scene = state.derived.filled(state.session.document.scene()).into_owned();
    let mut hit = pick_node(state, ray);
    while let Some(id) = hit.filter(|_| found.len() < MOST_BELOW) {
        found.push(id);
        if !hide(&mut scene, id) {
            break;
        }
        let Ok(flat) = flatten(&scene, 0.0) else { break };
        hit = pick_in(state, &flat, ray).filter(|id| !found.contains(id));
    }
    found
}

fn hide(scene: &mut Scene, id: NodeId) -> bool {
    let Some(node) = scene.node(id).filter(|node| node.visible) else { return false };
    let hidden = Node { visible: false, ..Node::clone(node) };
    scene.replace(hidden).is_ok()
}

/// The point of the surface that the ray meets first.
pub fn pick_surface(state: &EditorState, ray: &Ray) -> Option<PickedPoint> {
    pick_surface_in(state, state.flat(), ray)
}

/// The same without some nodes, between two distances.
pub fn pick_surface_without(
    state: &EditorState,
    ray: &Ray,
    without: &[NodeId],
    range: [f64; 2],
) -> Option<PickedPoint> {
    let flat = flat_without(state, without)?;
    surface(state, &flat, ray, RayLimits { near: range[0], far: range[1] })
}

/// The scene without some nodes, to look for several points in it.
pub fn flat_without(state: &EditorState, without: &[NodeId]) -> Option<FlatScene> {
    let mut scene = state.derived.filled(state.session.document.scene()).into_owned();
    let unique: HashSet<NodeId> = without.iter().copied().collect();
    for id in unique {
        hide(&mut scene, id);
    }
    flatten(&scene, 0.0).ok()
}

/// The point of a scene's surface that the ray meets first.
pub fn pick_surface_in(state: &EditorState, flat: &FlatScene, ray: &Ray) -> Option<PickedPoint> {
    let camera = state.view.navigation.camera();
    surface(state, flat, ray, RayLimits { near: camera.near, far: camera.far })
}

fn surface(state: &EditorState, flat: &FlatScene, ray: &Ray, limits: RayLimits) -> Option<PickedPoint> {
    let meshes = flat.known_meshes(state.derived.library());
    let mesh = trace_meshes(flat, &meshes, ray, limits.near, limits.far);
    let limits = RayLimits { far: mesh.as_ref().map_or(limits.far, |found| found.hit.t), ..limits };
    let mut evaluator = SceneEvaluator::new(flat).of_eye(ray.origin);
    let Some(hit) = evaluator.ray(ray, limits).ok().flatten() else {
        let found = mesh?;
        let normal = found.normal().unwrap_or(-ray.direction);
        let normal = if normal.dot(ray.direction) > 0.0 { -normal } else { normal };
        return Some(PickedPoint { point: ray.at(found.hit.t), normal });
    };
    let point = ray.at(hit.t);
    // Central differences: wide enough for the digits of the field, narrow against what can be seen.
    let step = 1e-5 * (hit.t + point.length());
    let mut value = |axis: usize, by: f64| evaluator.distance(point + DVec3::AXES[axis] * by, 10.0 * step).value;
    let slope = DVec3::from([0, 1, 2].map(|axis| value(axis, step) - value(axis, -step)));
    Some(PickedPoint { point, normal: slope.try_normalize().unwrap_or(-ray.direction) })
}
