//! Lights, meshes and cameras: what has a place in the world, but no field.

use glam::{DAffine3, DMat3, DQuat, DVec3};

use super::arrays::{FlatCamera, FlatLight, FlatMesh, FlatScene};
use super::meshes::model_pose;
use isolith_geometry::{Camera, Lens};
use isolith_scene::{CameraNode, Light, MaterialId, MeshNode, Node, NodeId, NodeKind, Scene};

/// The material that a mesh has instead of its own.
pub(super) fn mesh_material_of(node: &Node) -> Option<MaterialId> {
    if let NodeKind::Mesh(mesh) = &node.kind { mesh.material } else { None }
}

/// Adds a node without a field; `material` is the index of [`mesh_material_of`].
pub(super) fn add(flat: &mut FlatScene, node: &Node, world_from_local: &DAffine3, material: Option<u32>, time: f64) {
    match &node.kind {
        NodeKind::Light(light) => flat.lights.push(place_light(node.id, light, world_from_local)),
        NodeKind::Mesh(mesh) => flat.meshes.push(place_mesh(node.id, mesh, world_from_local, material, time)),
        NodeKind::Camera(camera) => flat.cameras.push(place_camera(node, camera, world_from_local)),
        _ => {}
    }
}

/// Puts those that a scene has already into their places at `time`. Their number and order have not changed.
pub(super) fn update(flat: &mut FlatScene, scene: &Scene, time: f64) {
    for place in &mut flat.lights {
        if let Some((node, world)) = placed(scene, place.id)
            && let NodeKind::Light(light) = &node.kind
        {
            *place = place_light(node.id, light, &world);
        }
    }
    for place in &mut flat.meshes {
        if let Some((node, world)) = placed(scene, place.id)
            && let NodeKind::Mesh(mesh) = &node.kind
        {
            let instanced = place.instanced;
            let world = if instanced.is_some() { node.transform.to_affine() } else { world };
            *place = FlatMesh { instanced, ..place_mesh(node.id, mesh, &world, place.material, time) };
        }
    }
    for place in &mut flat.cameras {
        if let Some((node, world)) = placed(scene, place.id)
            && let NodeKind::Camera(camera) = &node.kind
        {
            *place = place_camera(node, camera, &world);
        }
    }
}

/// A node with its transform, multiplied from the outermost group inward as the whole scene is: the same bits.
fn placed(scene: &Scene, id: NodeId) -> Option<(&Node, DAffine3)> {
    let node = scene.node(id)?;
    let mut path = vec![node];
    while let Some(parent) = path.last().and_then(|node| node.parent) {
        path.push(scene.node(parent)?);
    }
    let world = path.iter().rev().fold(DAffine3::IDENTITY, |world, node| world * node.transform.to_affine());
    Some((node, world))
}

fn place_light(id: NodeId, light: &Light, world_from_local: &DAffine3) -> FlatLight {
    let DAffine3 { matrix3, translation } = *world_from_local;
    FlatLight {
        id,
        position: translation,
        direction: (matrix3 * DVec3::NEG_Z).try_normalize().unwrap_or(DVec3::NEG_Z),
        axes: [matrix3.x_axis, matrix3.y_axis],
        scale: matrix3.determinant().abs().cbrt(),
        light: *light,
    }
}

/// A mesh in its place.
pub(super) fn place_mesh(
    id: NodeId,
    mesh: &MeshNode,
    world_from_local: &DAffine3,
    material: Option<u32>,
    time: f64,
) -> FlatMesh {
    FlatMesh { id, model: model_pose(mesh, time), world_from_local: *world_from_local, material, instanced: None }
}

fn place_camera(node: &Node, camera: &CameraNode, world_from_local: &DAffine3) -> FlatCamera {
    FlatCamera {
        id: node.id,
        name: node.name.clone(),
        camera: camera_at(camera, world_from_local),
        lens: Lens { aperture: camera.aperture, focus_distance: camera.focus_distance, shutter: camera.shutter },
    }
}

/// A camera ignores scale: it inherits only its position and its orientation.
fn camera_at(camera: &CameraNode, world_from_local: &DAffine3) -> Camera {
    let back = (world_from_local.matrix3 * DVec3::Z).try_normalize().unwrap_or(DVec3::Z);
    let up = world_from_local.matrix3 * DVec3::Y;
    let right = up.cross(back).try_normalize().unwrap_or(back.any_orthonormal_vector());
    let rotation = DQuat::from_mat3(&DMat3::from_cols(right, back.cross(right), back));
    Camera {
        position: world_from_local.translation,
        rotation,
        fov_y: camera.fov_y.to_radians(),
        near: camera.near,
        far: camera.far,
    }
}
