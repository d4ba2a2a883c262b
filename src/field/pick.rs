//! Picking: the node that a ray hits.

use super::FlatScene;
use super::copies::nearest_copy;
use super::mesh_rays::{Meshes, trace_meshes};
use super::scene_eval::{RayLimits, SceneEvaluator};
use isolith_geometry::Ray;
use isolith_scene::NodeId;

/// What a ray hits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Picked {
    /// An object or a mesh. In a blend, the object with the largest weight there.
    pub node: NodeId,
    /// The copy of an instancer that it is part of.
    pub copy: Option<PickedCopy>,
}

/// A copy that a ray hits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PickedCopy {
    /// The instancer.
    pub instancer: NodeId,
    /// Its cell, or the id of its place.
    pub cell: [i32; 3],
}

/// The node of the first hit of an eye's ray between `near` and `far`.
pub fn pick(flat: &FlatScene, meshes: &Meshes, ray: &Ray, near: f64, far: f64) -> Option<NodeId> {
    pick_copy(flat, meshes, ray, near, far).map(|picked| picked.node)
}

/// The same with the copy that it is part of.
pub fn pick_copy(flat: &FlatScene, meshes: &Meshes, ray: &Ray, near: f64, far: f64) -> Option<Picked> {
    let mesh = trace_meshes(flat, meshes, ray, near, far);
    let limit = mesh.as_ref().map_or(far, |found| found.hit.t);
    // A ray that cannot be followed to its end counts as a miss of all fields.
    let Some(hit) =
        SceneEvaluator::new(flat).of_eye(ray.origin).ray(ray, RayLimits { near, far: limit }).ok().flatten()
    else {
        return mesh.map(|found| {
            let placed = &flat.meshes[found.index];
            let instancer = placed.instanced.map(|of| flat.instancers[of.instancer as usize].id);
            let copy = instancer.zip(found.copy).map(|(instancer, copy)| PickedCopy { instancer, cell: copy.cell });
            Picked { node: placed.id, copy }
        });
    };
    let component = &flat.components[hit.component as usize];
    let copy = component.instanced.and_then(|of| {
        let instancer = flat.instancers[of.instancer as usize].id;
        let copy = nearest_copy(flat, component, ray.at(hit.t)).copy?;
        Some(PickedCopy { instancer, cell: copy.cell })
    });
    Some(Picked { node: flat.ids[hit.leaf as usize], copy })
}
