//! The bounds of nodes in the world, for framing and for the selection's outline.

use glam::{DAffine3, DVec3};

use super::instancing::extent;
use isolith_field::model_pose;
use isolith_geometry::Aabb;
use isolith_mesh::MeshLibrary;
use isolith_scene::{Node, NodeId, NodeKind, Scene};
use isolith_session::pose_of;

/// Half the size assumed for nodes without bounds: lights, cameras, endless planes.
const TOKEN: f64 = 0.5;

/// The world bounds of the nodes and their descendants; `None` if there are none.
pub fn of_nodes(scene: &Scene, meshes: &MeshLibrary, ids: &[NodeId]) -> Option<Aabb> {
    let mut bounds = Aabb::EMPTY;
    for &id in ids {
        let Some(index) = scene.index_of(id) else { continue };
        visit(scene, index, scene.world_from_local(id), |node, world_from_node| {
            bounds = bounds.union(&of_node(meshes, node, &world_from_node));
            true
        });
    }
    (!bounds.is_empty()).then_some(bounds)
}

/// The bounds of all visible surfaces. Cameras and planes count only if there is nothing else, lights never: in a scene
/// with only a sun, the first new node belongs at the origin.
pub fn of_scene(scene: &Scene, meshes: &MeshLibrary) -> Option<Aabb> {
    let (mut solid, mut rest) = (Aabb::EMPTY, Aabb::EMPTY);
    for top in scene.children(None) {
        let Some(index) = scene.index_of(top.id) else { continue };
        visit(scene, index, top.transform.to_affine(), |node, world_from_node| {
            if node.visible && !matches!(node.kind, NodeKind::Light(_)) {
                let target = if has_size(node) { &mut solid } else { &mut rest };
                *target = target.union(&of_node(meshes, node, &world_from_node));
            }
            node.visible
        });
    }
    let all = if solid.is_empty() { rest } else { solid };
    (!all.is_empty()).then_some(all)
}

/// Calls `each` with the node at `index`, its descendants and their transforms, given the first transform.
/// Skips the descendants of a node for which it returns false.
fn visit(scene: &Scene, index: usize, first: DAffine3, mut each: impl FnMut(&Node, DAffine3) -> bool) {
    let (nodes, depths) = (scene.nodes(), scene.depths());
    let mut chain: Vec<DAffine3> = Vec::new();
    let end = scene.subtree(index).end;
    let mut at = index;
    while at < end {
        let level = (depths[at] - depths[index]) as usize;
        chain.truncate(level);
        let parent = chain.last().copied();
        let matrix = parent.map_or(first, |parent| parent * nodes[at].transform.to_affine());
        chain.push(matrix);
        at = if each(&nodes[at], matrix) { at + 1 } else { scene.subtree(at).end };
    }
}

fn has_size(node: &Node) -> bool {
    match &node.kind {
        NodeKind::Object(object) => node.adds() && object.shape.bounds().is_finite(),
        NodeKind::Mesh(_) => true,
        NodeKind::Instancer(instancer) => !extent(&instancer.lattice).is_empty(),
        _ => false,
    }
}

/// Whether anything of a node or below it is solid and ends somewhere.
pub fn is_solid(scene: &Scene, id: NodeId) -> bool {
    let Some(index) = scene.index_of(id) else { return false };
    scene.nodes()[scene.subtree(index)].iter().any(|node| has_size(node))
}

fn of_node(meshes: &MeshLibrary, node: &Node, world_from_node: &DAffine3) -> Aabb {
    local(meshes, node).map_or(Aabb::EMPTY, |bounds| bounds.transformed(world_from_node))
}

/// The bounds of a node's own surface in its local space, or of the places of an instancer's copies; `None` for a
/// group.
pub fn local(meshes: &MeshLibrary, node: &Node) -> Option<Aabb> {
    let token = Aabb::from_center_half(DVec3::ZERO, DVec3::splat(TOKEN));
    match &node.kind {
        NodeKind::Group(_) => None,
        NodeKind::Instancer(instancer) => Some(extent(&instancer.lattice)).filter(|extent| !extent.is_empty()),
        NodeKind::Object(object) => match object.shape.model_request() {
            Some(request) => meshes.known(pose_of(&request)).and_then(|mesh| Some(mesh.as_ref().ok()?.bounds)),
            None => Some(object.shape.bounds()).filter(Aabb::is_finite).or(Some(token)),
        },
        NodeKind::Mesh(mesh) => {
            Some(meshes.nearest(&model_pose(mesh, 0.0)).and_then(|m| m.as_ref().ok()).map_or(token, |m| m.bounds))
        }
        NodeKind::Light(_) | NodeKind::Camera(_) => Some(token),
    }
}

/// The bounds of a node and its descendants in the node's own space, with the transform to the world: an oriented box
/// that turns with the node.
pub fn oriented(scene: &Scene, meshes: &MeshLibrary, id: NodeId) -> Option<(DAffine3, Aabb)> {
    let index = scene.index_of(id)?;
    let mut bounds = Aabb::EMPTY;
    visit(scene, index, DAffine3::IDENTITY, |node, root_from_node| {
        bounds = bounds.union(&of_node(meshes, node, &root_from_node));
        true
    });
    let world_from_local = scene.world_from_local(id);
    (!bounds.is_empty()).then_some((world_from_local, bounds))
}

#[cfg(test)]
mod tests {
    use super::*;
    use isolith_scene::{Group, Instancer, Light, Object, ShapeKind};

    fn object(scene: &Scene, kind: ShapeKind) -> Node {
        let material = scene.materials()[0].id;
        Node::new(kind.label(), NodeKind::Object(Object { shape: kind.default_shape(), material }))
    }

    #[test]
    fn the_scene_is_as_large_as_its_solid_things() {
        let mut scene = Scene::new();
        let meshes = MeshLibrary::new(None);
        assert_eq!(of_scene(&scene, &meshes), None);
        scene.insert(None, 0, Node::new("Sun", NodeKind::Light(Light::sun())).at(DVec3::ONE)).unwrap();
        assert_eq!(of_scene(&scene, &meshes), None);
        let plane = object(&scene, ShapeKind::Plane);
        scene.insert(None, 0, plane).unwrap();
        assert_eq!(of_scene(&scene, &meshes).unwrap().half(), DVec3::splat(TOKEN));
        let group = Node::new("Group", NodeKind::Group(Group::UNION)).at(DVec3::X * 4.0);
        let group = scene.insert(None, 1, group).unwrap();
        let ball = object(&scene, ShapeKind::Sphere).at(DVec3::Y);
        let ball = scene.insert(Some(group), 0, ball).unwrap();
        let around = Aabb::from_center_half(DVec3::new(4.0, 1.0, 0.0), DVec3::splat(0.5));
        assert_eq!(of_scene(&scene, &meshes), Some(around));
        assert_eq!(of_nodes(&scene, &meshes, &[ball]), Some(around));
        assert_eq!(of_nodes(&scene, &meshes, &[group]), Some(around));
        assert_eq!(oriented(&scene, &meshes, group).unwrap().1.center(), DVec3::Y);
        let grid = Box::new(Instancer::grid([5, 1, 0], [2.0, 1.0, 1.0]));
        let grid = scene.insert(None, 0, Node::new("Grid", NodeKind::Instancer(grid))).unwrap();
        let half = of_nodes(&scene, &meshes, &[grid]).unwrap().half();
        assert_eq!(half, DVec3::new(4.0, 0.0, 8.0), "the places of copies, as far as they are shown");
    }
}
