//! Intersections of rays with the meshes of a scene.

use std::sync::Arc;

use super::FlatScene;
use isolith_geometry::Ray;
use isolith_mesh::{MeshHit, TriangleMesh};

/// The meshes of a scene, parallel to [`FlatScene::meshes`]; `None` where a file could not be read.
pub type Meshes = [Option<Arc<TriangleMesh>>];

/// The first triangle on the ray between `near` and `far`: the index of its mesh, and the hit with `t` along the ray
/// in meters and everything else in the mesh's own space.
pub fn trace_meshes(flat: &FlatScene, meshes: &Meshes, ray: &Ray, near: f64, far: f64) -> Option<(usize, MeshHit)> {
    let mut nearest: Option<(usize, MeshHit)> = None;
    for (index, (placed, mesh)) in flat.meshes.iter().zip(meshes).enumerate() {
        let Some(mesh) = mesh else { continue };
        let local_from_world = placed.world_from_local.inverse();
        let local = Ray {
            origin: local_from_world.transform_point3(ray.at(near)),
            direction: local_from_world.transform_vector3(ray.direction),
        };
        let limit = nearest.map_or(far, |(_, hit)| hit.t) - near;
        if let Some(mut hit) = mesh.hit(&local, limit) {
            hit.t += near;
            nearest = Some((index, hit));
        }
    }
    nearest
}
