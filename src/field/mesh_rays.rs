//! Intersections of rays with the meshes of a scene.

use std::sync::Arc;

use super::copies::{Copy, mesh_copies_along};
use super::coverage::{PixelSample, coverage_layer, coverage_threshold};
use super::ray_limits::RayLimits;
use super::{FlatScene, MESH_BIT};
use glam::{DAffine3, DVec3};
use isolith_geometry::Ray;
use isolith_mesh::{MeshHit, TriangleMesh};

/// The meshes of a scene, parallel to [`FlatScene::meshes`]; `None` where a file could not be read.
pub type Meshes = [Option<Arc<TriangleMesh>>];

/// A triangle that a ray meets.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshRayHit {
    /// The index of its mesh.
    pub index: usize,
    /// The hit, with `t` along the ray in meters and everything else in the mesh's own space.
    pub hit: MeshHit,
    /// World from that space.
    pub world_from_local: DAffine3,
    /// The copy of an instancer that it is part of.
    pub copy: Option<Copy>,
}

impl MeshRayHit {
    /// The interpolated normal in the world, of unit length; `None` where the mesh is pressed flat.
    pub fn normal(&self) -> Option<DVec3> {
        (self.world_from_local.matrix3.inverse().transpose() * self.hit.normal).try_normalize()
    }
}

/// The first triangle on the ray between `near` and `far`. Blended surfaces count where they have any opacity.
pub fn trace_meshes(flat: &FlatScene, meshes: &Meshes, ray: &Ray, near: f64, far: f64) -> Option<MeshRayHit> {
    trace_covering(flat, meshes, ray, [near, far], |_, opacity| opacity > 0.0)
}

/// The same for the ray of a sample of a pixel: blended surfaces count where they cover it.
pub fn trace_meshes_of_pixel(
    flat: &FlatScene,
    meshes: &Meshes,
    ray: &Ray,
    range: [f64; 2],
    at: PixelSample,
) -> Option<MeshRayHit> {
    trace_covering(flat, meshes, ray, range, |layer, opacity| opacity > coverage_threshold(at, layer))
}

/// The first triangle that stops light between `near` and `far`, as [`TriangleMesh::hit_solid`] has it: copies stop none.
/// Counterpart of the function of this name in `shaders/scene/mesh_rays.wgsl`.
pub fn mesh_rays_hit(flat: &FlatScene, meshes: &Meshes, ray: &Ray, near: f64, far: f64) -> Option<(usize, MeshHit)> {
    let hit = |_, mesh: &TriangleMesh, local: &Ray, limit| mesh.hit_solid(local, limit);
    nearest(flat, meshes, ray, [near, far], false, hit).map(|found| (found.index, found.hit))
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
            Some(mesh) if local_from_world.is_finite() && placed.instanced.is_none() => {
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
) -> Option<MeshRayHit> {
    nearest(flat, meshes, ray, range, true, |index, mesh, local, limit| {
        let code = MESH_BIT | index as u32;
        mesh.hit_covering(local, limit, |vertex, opacity| covers(coverage_layer(code, vertex), opacity))
    })
}

/// The nearest of the hits in all meshes, and in their copies if `with_copies`; `hit` gives that of a mesh for a ray in
/// its own space.
fn nearest(
    flat: &FlatScene,
    meshes: &Meshes,
    ray: &Ray,
    [near, far]: [f64; 2],
    with_copies: bool,
    hit: impl Fn(usize, &TriangleMesh, &Ray, f64) -> Option<MeshHit>,
) -> Option<MeshRayHit> {
    let mut nearest: Option<MeshRayHit> = None;
    let mut look = |index: usize, mesh: &TriangleMesh, world_from_local: DAffine3, copy: Option<Copy>| {
        let local_from_world = world_from_local.inverse();
        let local = Ray {
            origin: local_from_world.transform_point3(ray.at(near)),
            direction: local_from_world.transform_vector3(ray.direction),
        };
        let limit = nearest.as_ref().map_or(far, |found| found.hit.t) - near;
        if let Some(mut hit) = hit(index, mesh, &local, limit) {
            hit.t += near;
            nearest = Some(MeshRayHit { index, hit, world_from_local, copy });
        }
        nearest.as_ref().map_or(far, |found| found.hit.t)
    };
    for (index, (placed, mesh)) in flat.meshes.iter().zip(meshes).enumerate() {
        let Some(mesh) = mesh else { continue };
        if placed.instanced.is_none() {
            look(index, mesh, placed.world_from_local, None);
        } else if with_copies {
            let limits = RayLimits { near, far };
            mesh_copies_along(flat, placed, &mesh.bounds, ray, limits, &mut |copy| {
                look(index, mesh, copy.world_from_mesh, Some(copy.copy))
            });
        }
    }
    nearest
}
