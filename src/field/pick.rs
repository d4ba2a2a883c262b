//! Picking: the node that a ray hits.

use super::FlatScene;
use super::mesh_rays::{Meshes, trace_meshes};
use super::scene_eval::{RayLimits, SceneEvaluator};
use isolith_geometry::Ray;
use isolith_scene::NodeId;

/// The node of the first hit of an eye's ray between `near` and `far`, an object or a mesh. In a blend, the object with the largest
/// weight there.
pub fn pick(flat: &FlatScene, meshes: &Meshes, ray: &Ray, near: f64, far: f64) -> Option<NodeId> {
    let mesh = trace_meshes(flat, meshes, ray, near, far);
    let limit = mesh.map_or(far, |(_, hit)| hit.t);
    // A ray that cannot be followed to its end counts as a miss of all fields.
    match SceneEvaluator::new(flat).of_eye().ray(ray, RayLimits { near, far: limit }).ok().flatten() {
        Some(hit) => Some(flat.ids[hit.leaf as usize]),
        None => mesh.map(|(index, _)| flat.meshes[index].id),
    }
}
