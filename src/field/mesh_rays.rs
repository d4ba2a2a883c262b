//! Intersections of rays with the meshes of a scene.

use std::sync::Arc;

use super::coverage::{PixelSample, coverage_layer, coverage_threshold};
use super::{FlatScene, MESH_BIT};
use glam::DVec3;
use isolith_geometry::Ray;
use isolith_mesh::{MeshHit, TriangleMesh};

/// The meshes of a scene, parallel to [`FlatScene::meshes`]; `None` where a file could not be read.
pub type Meshes = [Option<Arc<TriangleMesh>>];

/// The first triangle on the ray between `near` and `far`: the index of its mesh, and the hit with `t` along the ray
/// in meters and everything else in the mesh's own space. Blended surfaces count where they have any opacity.
pub fn trace_meshes(flat: &FlatScene, meshes: &Meshes, ray: &Ray, near: f64, far: f64) -> Option<(usize, MeshHit)> {
    trace_covering(flat, meshes, ray, [near, far], |_, opacity| opacity > 0.0)
}

/// The same for the ray of a sample of a pixel: blended surfaces count where they cover it.
pub fn trace_meshes_of_pixel(
    flat: &FlatScene,
    meshes: &Meshes,
    ray: &Ray,
    range: [f64; 2],
    at: PixelSample,
) -> Option<(usize, MeshHit)> {
    trace_covering(flat, meshes, ray, range, |layer, opacity| opacity > coverage_threshold(at, layer))
}

/// The first triangle that stops light between `near` and `far`, as [`TriangleMesh::hit_solid`] has it. Counterpart of
/// the function of this name in `shaders/scene/mesh_rays.wgsl`.
pub fn mesh_rays_hit(flat: &FlatScene, meshes: &Meshes, ray: &Ray, near: f64, far: f64) -> Option<(usize, MeshHit)> {
    nearest(flat, meshes, ray, [near, far], |_, mesh, local, limit| mesh.hit_solid(local, limit))
}

/// Whether a triangle stops light between `near` and `far`.
pub fn mesh_rays_blocked(flat: &FlatScene, meshes: &Meshes, ray: &Ray, near: f64, far: f64) -> bool {
    mesh_rays_hit(flat, meshes, ray, near, far).is_some()
}

/// Distance from `p` to the nearest triangle that stops light, in meters; `within` if there is none so near. Counterpart
/// of `mesh_near_distance` in `shaders/scene/mesh_near.wgsl`.
pub fn mesh_rays_distance(flat: &FlatScene, meshes: &Meshes, p: DVec3, within: f64) -> f64 {
    let of_mesh = |best: f64, (placed, mesh): (&crate::FlatMesh, &Option<Arc<TriangleMesh>>)| {
        let local_from_world = placed.world_from_local.inverse();
        match mesh {
            Some(mesh) if local_from_world.is_finite() => {
                mesh.distance_to_solid(local_from_world.transform_point3(p), &placed.world_from_local.matrix3, best)
            }
            _ => best,
        }
    };
    flat.meshes.iter().zip(meshes).fold(within, of_mesh)
}

fn trace_covering(
    flat: &FlatScene,
    meshes: &Meshes,
    ray: &Ray,
    range: [f64; 2],
    covers: impl Fn(u32, f64) -> bool,
) -> Option<(usize, MeshHit)> {
    nearest(flat, meshes, ray, range, |index, mesh, local, limit| {
        let code = MESH_BIT | index as u32;
        mesh.hit_covering(local, limit, |vertex, opacity| covers(coverage_layer(code, vertex), opacity))
    })
}

/// The nearest of the hits in all meshes; `hit` gives that of a mesh for a ray in its own space.
fn nearest(
    flat: &FlatScene,
    meshes: &Meshes,
    ray: &Ray,
    [near, far]: [f64; 2],
    hit: impl Fn(usize, &TriangleMesh, &Ray, f64) -> Option<MeshHit>,
) -> Option<(usize, MeshHit)> {
    let mut nearest: Option<(usize, MeshHit)> = None;
    for (index, (placed, mesh)) in flat.meshes.iter().zip(meshes).enumerate() {
        let Some(mesh) = mesh else { continue };
        let local_from_world = placed.world_from_local.inverse();
        let local = Ray {
            origin: local_from_world.transform_point3(ray.at(near)),
            direction: local_from_world.transform_vector3(ray.direction),
        };
        let limit = nearest.map_or(far, |(_, hit)| hit.t) - near;
        if let Some(mut hit) = hit(index, mesh, &local, limit) {
            hit.t += near;
            nearest = Some((index, hit));
        }
    }
    nearest
}
