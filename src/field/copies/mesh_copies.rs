//! Copies of triangle meshes: those that a camera shows, and those along a ray. Their type stands among
//! [`FlatScene::meshes`], in the space of a copy.

use std::ops::ControlFlow;

use glam::{DAffine3, DVec3};

use super::dynamics::copy_envelope;
use super::eval::world_from_copy;
use super::in_view::{CopiesInView, ViewLimits, copies_in_view};
use super::instancer::{FlatInstancer, Placement};
use super::variation::{Copy, copy_of_place};
use super::walk::{CopyCone, copies_along};
use crate::arrays::{FlatMesh, FlatScene};
use crate::ray_limits::RayLimits;
use isolith_geometry::{Aabb, Camera, Ray};

/// Limits of the copies of a mesh that are drawn: the nearest ones are.
pub const MESH_COPY_LIMITS: ViewLimits = ViewLimits { copies: 1 << 14, cells: 1 << 20 };

/// A copy of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshCopy {
    /// Which one.
    pub copy: Copy,
    /// World from the space of the mesh.
    pub world_from_mesh: DAffine3,
}

/// The copies of a mesh that a camera shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshCopies {
    /// The copies, the nearest first.
    pub all: Vec<MeshCopy>,
    /// The depth beyond which others are left out; none if all are there.
    pub cut: Option<f64>,
}

/// The instancer of a mesh, with room for its triangles.
struct MeshInstancer<'a> {
    instancer: FlatInstancer,
    kind: u32,
    placed: &'a FlatMesh,
    /// How far triangles reach from the place of a copy.
    reach: f64,
}

impl<'a> MeshInstancer<'a> {
    /// That of a mesh whose triangles have these bounds; `None` for a mesh that stands alone.
    fn new(flat: &FlatScene, placed: &'a FlatMesh, bounds: &Aabb) -> Option<Self> {
        let of = placed.instanced?;
        let mut instancer = flat.instancers[of.instancer as usize].clone();
        let bounds = bounds.transformed(&placed.world_from_local);
        let (center, radius) = (bounds.center(), bounds.half().length());
        instancer.spheres[of.kind as usize] = (center, radius);
        let scale = DVec3::from_array(instancer.variation.scale_max).max_element();
        let reach = (center.length() + radius) * scale * copy_envelope(&instancer.dynamics).scale;
        instancer.reach += DVec3::splat(reach);
        instancer.reach_at_rest += reach;
        Some(Self { instancer, kind: of.kind, placed, reach })
    }

    fn copy(&self, copy: Copy) -> MeshCopy {
        MeshCopy { copy, world_from_mesh: world_from_copy(&self.instancer, &copy) * self.placed.world_from_local }
    }
}

/// Bounds of all copies of a mesh in the world; those of the mesh itself if it stands alone.
pub fn mesh_copies_bounds(flat: &FlatScene, placed: &FlatMesh, bounds: &Aabb) -> Aabb {
    let Some(of) = MeshInstancer::new(flat, placed, bounds) else {
        return bounds.transformed(&placed.world_from_local);
    };
    let places = of.instancer.bounds();
    match &of.instancer.placement {
        Placement::List(_) if !places.is_empty() => {
            places.expanded(of.reach).transformed(&of.instancer.world_from_local)
        }
        _ => of.instancer.world_bounds(),
    }
}

/// The copies of a mesh that a camera shows, as far as [`MESH_COPY_LIMITS`] allow.
pub fn mesh_copies_in_view(
    flat: &FlatScene,
    placed: &FlatMesh,
    bounds: &Aabb,
    camera: &Camera,
    aspect: f64,
) -> MeshCopies {
    let Some(of) = MeshInstancer::new(flat, placed, bounds) else { return MeshCopies::default() };
    let CopiesInView { all, cut } = copies_in_view(&of.instancer, of.reach, camera, aspect, MESH_COPY_LIMITS);
    let own = all.into_iter().filter(|copy| copy.kind == of.kind);
    MeshCopies { all: own.map(|copy| of.copy(copy)).collect(), cut }
}

/// Visits the copies of a mesh that a ray of the world may meet. `visit` returns the new end of the ray.
pub fn mesh_copies_along(
    flat: &FlatScene,
    placed: &FlatMesh,
    bounds: &Aabb,
    ray: &Ray,
    limits: RayLimits,
    visit: &mut dyn FnMut(&MeshCopy) -> f64,
) {
    let Some(of) = MeshInstancer::new(flat, placed, bounds) else { return };
    let local_from_world = of.instancer.world_from_local.inverse();
    let axis = Ray {
        origin: local_from_world.transform_point3(ray.origin),
        direction: local_from_world.transform_vector3(ray.direction),
    };
    let mut cone = CopyCone { axis, limits, spread: 0.0 };
    let Placement::List(list) = &of.instancer.placement else {
        copies_along(&of.instancer, cone, &mut |met, limits| {
            if met.copy.kind == of.kind {
                limits.far = limits.far.min(visit(&of.copy(met.copy)));
            }
            ControlFlow::Continue(())
        });
        return;
    };
    let mut open: Vec<usize> = if list.tree.nodes.is_empty() { Vec::new() } else { vec![0] };
    while let Some(index) = open.pop() {
        let node = &list.tree.nodes[index];
        let RayLimits { near, far } = cone.interval(&node.bounds.expanded(of.reach));
        if near > far {
            continue;
        }
        if !node.is_leaf() {
            open.extend([node.link as usize, index + 1]);
        } else if let Some(copy) = copy_of_place(&of.instancer, node.link as usize).filter(|copy| copy.kind == of.kind)
        {
            cone.limits.far = cone.limits.far.min(visit(&of.copy(copy)));
        }
    }
}
