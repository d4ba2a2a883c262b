//! Nodes as a scene of their own, for the clipboard, and such a scene within another.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use super::links::NewLinks;
use super::packed_copies;
use super::placement::kept_in_place;
use super::structure::{FreeNames, move_to, tops};
use isolith_scene::{
    Environment, Material, MaterialId, Node, NodeId, NodeKind, ParamOwner, ParamPath, Scene, SceneError, Track,
};

/// The nodes with what is below them, their materials, their keys and the packed files of their models as a scene. They keep their place in the world if
/// a translation, rotation and scale can express it. References to other nodes are dropped.
///
/// # Errors
/// A node does not exist.
pub fn extracted(scene: &Scene, ids: &[NodeId]) -> Result<Scene, SceneError> {
    let tops = tops(scene, ids)?;
    let taken: HashSet<NodeId> = tops.iter().flat_map(|range| &scene.nodes()[range.clone()]).map(|n| n.id).collect();
    let mut nodes = Vec::with_capacity(taken.len());
    for range in tops {
        for (place, node) in scene.nodes()[range].iter().enumerate() {
            let mut node = Node::clone(node);
            if place == 0 {
                node.transform = kept_in_place(scene, node.id, None);
                node.parent = None;
            }
            node.apart.retain(|id| taken.contains(id));
            if let NodeKind::Instancer(instancer) = &mut node.kind {
                instancer.target = instancer.target.filter(|id| taken.contains(id));
            }
            nodes.push(node);
        }
    }
    let packed = packed_copies::needed(&mut nodes, &scene.packed);
    let used: HashSet<MaterialId> = nodes.iter().flat_map(Node::materials).collect();
    let materials: Vec<Material> =
        scene.materials().iter().filter(|m| used.contains(&m.id)).map(|m| Material::clone(m)).collect();
    let mut part = Scene::from_tables(nodes, materials, Environment::default(), scene.next_id())?;
    let belongs = |track: &&Arc<Track>| match track.path.owner {
        ParamOwner::Node(id, _) => taken.contains(&id),
        ParamOwner::Material(id) => used.contains(&id),
        ParamOwner::Environment | ParamOwner::Display => false,
    };
    part.set_tracks(scene.animation.tracks().iter().filter(belongs).map(|track| Track::clone(track)))?;
    part.animation.timeline = scene.animation.timeline;
    part.packed = packed;
    Ok(part)
}

/// Adds the nodes of another scene as children of `parent`, from `position` on, with new ids. They keep their place in
/// the world as with a move. Materials of the same name and values are shared. Returns the ids of the top nodes.
pub(super) fn merge(
    scene: &mut Arc<Scene>,
    from: &Scene,
    parent: Option<NodeId>,
    position: usize,
) -> Result<Vec<NodeId>, SceneError> {
    let mut next = Scene::clone(scene);
    let [material_of, new_materials] = merge_materials(&mut next, from)?;
    let folder = packed_copies::taken_over(&mut next, from)?;
    let mut names = FreeNames::new(scene);
    let mut links = NewLinks::new(scene);
    let first = next.next_id();
    let new_id: HashMap<NodeId, NodeId> =
        from.nodes().iter().zip(first..).map(|(node, id)| (node.id, NodeId(id))).collect();
    let mut added = Vec::new();
    let mut at = 0;
    while at < from.nodes().len() {
        let range = from.subtree(at);
        let mut subtree: Vec<Node> = from.nodes()[range.clone()].iter().map(|node| Node::clone(node)).collect();
        for node in &mut subtree {
            node.id = new_id[&node.id];
            node.parent = node.parent.and_then(|id| new_id.get(&id).copied());
            node.rename_references(|id| new_id.get(&id).copied());
            node.linked = node.linked.map(|link| links.of(link));
            packed_copies::moved_below(node, &folder, from);
            node.rename_materials(|id| material_of.get(&id).copied());
        }
        subtree[0].name = names.free(parent, &subtree[0].name);
        added.push(subtree[0].id);
        next.insert_subtree(None, usize::MAX, subtree)?;
        at = range.end;
    }
    let moved = |track: &Arc<Track>| {
        let owner = match track.path.owner {
            ParamOwner::Node(id, part) => ParamOwner::Node(*new_id.get(&id)?, part),
            ParamOwner::Material(id) => ParamOwner::Material(*new_materials.get(&id)?),
            ParamOwner::Environment | ParamOwner::Display => return None,
        };
        Some(Track { path: ParamPath { owner, ..track.path.clone() }, keys: track.keys.clone() })
    };
    next.set_tracks(from.animation.tracks().iter().filter_map(moved))?;
    let mut next = Arc::new(next);
    move_to(&mut next, &added, parent, position)?;
    *scene = next;
    Ok(added)
}

/// The new id of each material.
type NewIds = HashMap<MaterialId, MaterialId>;

/// Adds the materials that nodes of `from` use, unless the scene has them. Returns the new ids of all of them, and of
/// those added.
fn merge_materials(scene: &mut Scene, from: &Scene) -> Result<[NewIds; 2], SceneError> {
    let used: HashSet<MaterialId> = from.nodes().iter().flat_map(|node| node.materials()).collect();
    let (mut all, mut new) = (NewIds::new(), NewIds::new());
    for material in from.materials().iter().filter(|material| used.contains(&material.id)) {
        let same = |other: &&Arc<Material>| Material { id: material.id, ..Material::clone(other) } == **material;
        let id = match scene.materials().iter().find(same) {
            Some(own) => own.id,
            None => {
                let id = scene.next_material_id();
                scene.insert_material(Material { id, ..Material::clone(material) })?;
                new.insert(material.id, id);
                id
            }
        };
        all.insert(material.id, id);
    }
    Ok([all, new])
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use isolith_scene::{Group, Instancer, Object, ShapeKind};

    /// A group at X = 2 with a ball at X = 1 in it, of a material of its own.
    fn scene() -> (Scene, [NodeId; 2]) {
        let mut scene = Scene::new();
        let id = scene.next_material_id();
        scene.insert_material(Material::new(id, "Red", [1.0, 0.0, 0.0])).unwrap();
        let group = Node::new("Pair", NodeKind::Group(Group::UNION)).at(DVec3::X * 2.0);
        let group = scene.insert(None, 0, group).unwrap();
        let object = Object { shape: ShapeKind::Sphere.default_shape(), material: id };
        let ball = scene.insert(Some(group), 0, Node::new("Ball", NodeKind::Object(object)).at(DVec3::X)).unwrap();
        (scene, [group, ball])
    }

    #[test]
    fn a_part_keeps_its_place_and_brings_its_material() {
        let (scene, [group, ball]) = scene();
        let part = extracted(&scene, &[ball]).unwrap();
        assert_eq!(part.nodes()[0].transform.translation, DVec3::X * 3.0);
        assert_eq!(part.materials().len(), 1);
        assert_eq!(extracted(&scene, &[ball, group]).unwrap().nodes().len(), 2, "what is within another goes along");
        let mut other = Arc::new(Scene::new());
        let added = merge(&mut other, &part, None, 0).unwrap();
        assert_eq!(other.node(added[0]).unwrap().name, "Ball");
        assert_eq!(other.materials().len(), 2, "its own clay, and the red");
        let again = merge(&mut other, &part, None, 0).unwrap();
        assert_eq!((other.materials().len(), &*other.node(again[0]).unwrap().name), (2, "Ball 2"));
        // Into a group that stands elsewhere.
        let mut back = Arc::new(scene);
        let added = merge(&mut back, &part, Some(group), 0).unwrap();
        assert_eq!(back.node(added[0]).unwrap().transform.translation, DVec3::X);
        assert_eq!(back.world_from_local(added[0]).translation, DVec3::X * 3.0);
    }

    #[test]
    fn references_follow_their_nodes_or_are_dropped() {
        let (mut scene, [group, ball]) = scene();
        let mut instancer = Instancer::grid([2, 1, 1], [1.0; 3]);
        instancer.target = Some(group);
        let grid = scene.insert(None, 1, Node::new("Grid", NodeKind::Instancer(Box::new(instancer)))).unwrap();
        let target = |scene: &Scene, id: NodeId| match &scene.node(id).unwrap().kind {
            NodeKind::Instancer(instancer) => instancer.target,
            _ => panic!("an instancer"),
        };
        assert_eq!(target(&extracted(&scene, &[grid, ball]).unwrap(), grid), None);
        let both = extracted(&scene, &[grid, group]).unwrap();
        let mut scene = Arc::new(scene);
        let added = merge(&mut scene, &both, None, 9).unwrap();
        assert_eq!(target(&scene, added[1]), Some(added[0]));
    }
}
