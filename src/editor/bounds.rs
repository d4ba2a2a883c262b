//! How much room nodes take in the world: for framing, for the selection's outline.

use glam::{DAffine3, DVec3};

use crate::geometry::Aabb;
use crate::mesh::MeshLibrary;
use crate::scene::{Node, NodeId, NodeKind, Scene};

/// Half the room given to what has none of its own: lights, cameras, endless planes.
const TOKEN: f64 = 0.5;

/// The box around the nodes and all below them, in the world; `None` where there is nothing.
pub fn of_nodes(scene: &Scene, meshes: &mut MeshLibrary, ids: &[NodeId]) -> Option<Aabb> {
    let mut bounds = Aabb::EMPTY;
    for &id in ids {
        let Some(index) = scene.index_of(id) else { continue };
        for node in &scene.nodes()[scene.subtree(index)] {
            bounds = bounds.union(&of_node(scene, meshes, node));
        }
    }
    (!bounds.is_empty()).then_some(bounds)
}

/// The box around everything visible that has a surface; lights, cameras and planes count only
/// where there is nothing else.
pub fn of_scene(scene: &Scene, meshes: &mut MeshLibrary) -> Option<Aabb> {
    let (mut solid, mut rest) = (Aabb::EMPTY, Aabb::EMPTY);
    let mut index = 0;
    while let Some(node) = scene.nodes().get(index) {
        if !node.visible {
            index = scene.subtree(index).end;
            continue;
        }
        let bounds = of_node(scene, meshes, node);
        let target = if has_size(node) { &mut solid } else { &mut rest };
        *target = target.union(&bounds);
        index += 1;
    }
    let all = if solid.is_empty() { rest } else { solid };
    (!all.is_empty()).then_some(all)
}

fn has_size(node: &Node) -> bool {
    match &node.kind {
        NodeKind::Object(object) => !node.negative && object.shape.bounds().is_finite(),
        NodeKind::Mesh(_) => true,
        _ => false,
    }
}

fn of_node(scene: &Scene, meshes: &mut MeshLibrary, node: &Node) -> Aabb {
    match local(meshes, node) {
        Some(bounds) => bounds.transformed(&scene.world_from_local(node.id)),
        None => Aabb::EMPTY,
    }
}

/// The box around a node's own surface in its local space; `None` for a group.
pub fn local(meshes: &mut MeshLibrary, node: &Node) -> Option<Aabb> {
    let token = Aabb::from_center_half(DVec3::ZERO, DVec3::splat(TOKEN));
    match &node.kind {
        NodeKind::Group(_) => None,
        NodeKind::Object(object) => Some(object.shape.bounds()).filter(Aabb::is_finite).or(Some(token)),
        NodeKind::Mesh(mesh) => Some(meshes.get(&mesh.path).map_or(token, |m| m.bounds)),
        NodeKind::Light(_) | NodeKind::Camera(_) => Some(token),
    }
}

/// The box around a node and all below it in the node's own space, with the way to the world: an
/// oriented box that turns with the node.
pub fn oriented(scene: &Scene, meshes: &mut MeshLibrary, id: NodeId) -> Option<(DAffine3, Aabb)> {
    let index = scene.index_of(id)?;
    let world_from_local = scene.world_from_local(id);
    let local_from_world = world_from_local.inverse();
    let mut bounds = Aabb::EMPTY;
    for node in &scene.nodes()[scene.subtree(index)] {
        if let Some(own) = local(meshes, node) {
            bounds = bounds.union(&own.transformed(&(local_from_world * scene.world_from_local(node.id))));
        }
    }
    (!bounds.is_empty()).then_some((world_from_local, bounds))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Group, Object, ShapeKind};

    fn object(scene: &Scene, kind: ShapeKind) -> Node {
        let material = scene.materials()[0].id;
        Node::new(kind.label(), NodeKind::Object(Object { shape: kind.default_shape(), material }))
    }

    #[test]
    fn the_scene_is_as_large_as_its_solid_things() {
        let mut scene = Scene::new();
        let mut meshes = MeshLibrary::new(None);
        assert_eq!(of_scene(&scene, &mut meshes), None);
        let plane = object(&scene, ShapeKind::Plane);
        scene.insert(None, 0, plane).unwrap();
        assert_eq!(of_scene(&scene, &mut meshes).unwrap().half(), DVec3::splat(TOKEN));
        let group = Node::new("Group", NodeKind::Group(Group::UNION)).at(DVec3::X * 4.0);
        let group = scene.insert(None, 1, group).unwrap();
        let ball = object(&scene, ShapeKind::Sphere).at(DVec3::Y);
        let ball = scene.insert(Some(group), 0, ball).unwrap();
        let around = Aabb::from_center_half(DVec3::new(4.0, 1.0, 0.0), DVec3::splat(0.5));
        assert_eq!(of_scene(&scene, &mut meshes), Some(around));
        assert_eq!(of_nodes(&scene, &mut meshes, &[ball]), Some(around));
        assert_eq!(of_nodes(&scene, &mut meshes, &[group]), Some(around));
        assert_eq!(oriented(&scene, &mut meshes, group).unwrap().1.center(), DVec3::Y);
    }
}
