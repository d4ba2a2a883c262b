//! Tests of the tables.

use super::*;
use crate::{Group, Object, Shape};

fn node(id: u64, parent: Option<u64>, is_group: bool) -> Node {
    let object = Object { shape: Shape::Sphere { radius: 1.0 }, material: MaterialId(1) };
    let kind = if is_group { NodeKind::Group(Group::UNION) } else { NodeKind::Object(object) };
    Node { id: NodeId(id), parent: parent.map(NodeId), ..Node::new("n", kind) }
}

fn table(nodes: &[(u64, Option<u64>, bool)]) -> Result<Scene, SceneError> {
    let nodes = nodes.iter().map(|(id, parent, is_group)| node(*id, *parent, *is_group)).collect();
    Scene::from_tables(nodes, vec![Material::new(MaterialId(1), "Clay", [0.5; 3])], Environment::default(), 1)
}

#[test]
fn tables_that_break_a_rule_are_refused() {
    let id = NodeId;
    let (g, o) = (true, false);
    assert_eq!(table(&[(1, Some(2), g)]), Err(SceneError::NoNode(id(2))));
    assert_eq!(table(&[(1, Some(1), g)]), Err(SceneError::NoNode(id(1))));
    assert_eq!(table(&[(1, None, o), (2, Some(1), o)]), Err(SceneError::NotAGroup(id(1))));
    assert_eq!(table(&[(1, None, g), (1, None, g)]), Err(SceneError::DuplicateNode(id(1))));
    assert_eq!(table(&[(1, None, g), (2, None, g), (3, Some(1), o)]), Err(SceneError::OutOfOrder(id(3))));
    assert!(matches!(table(&[(MAX_ID + 1, None, g)]), Err(SceneError::Limit { .. })));
    let scene = table(&[(7, None, g), (2, Some(7), g), (3, Some(2), o), (5, Some(7), o)]).unwrap();
    scene.assert_invariants();
    assert_eq!((scene.depths(), scene.next_id()), (&[0, 1, 2, 1][..], 8));
}

#[test]
fn subtrees_are_held_to_the_same_rules() {
    let mut scene = table(&[(1, None, true), (2, Some(1), false)]).unwrap();
    let before = scene.clone();
    let mut refuse = |parent: u64, nodes: Vec<Node>, error: SceneError| {
        assert_eq!(scene.insert_subtree(Some(NodeId(parent)), 0, nodes), Err(error));
        assert_eq!(scene, before);
    };
    refuse(2, vec![node(8, None, true)], SceneError::NotAGroup(NodeId(2)));
    refuse(1, vec![node(8, None, false), node(9, Some(8), false)], SceneError::NotAGroup(NodeId(8)));
    refuse(1, vec![node(8, None, true), node(9, Some(4), false)], SceneError::NoNode(NodeId(4)));
    refuse(1, vec![node(8, None, true), node(2, Some(8), false)], SceneError::DuplicateNode(NodeId(2)));
    scene.insert_subtree(Some(NodeId(1)), 0, vec![node(8, None, true), node(9, Some(8), false)]).unwrap();
    scene.assert_invariants();
    assert_eq!(scene.nodes().iter().map(|n| n.id.0).collect::<Vec<_>>(), [1, 8, 9, 2]);
}

#[test]
fn copies_of_a_scene_share_what_an_edit_leaves_alone() {
    let scene = table(&[(1, None, true), (2, Some(1), false)]).unwrap();
    let mut edited = scene.clone();
    edited.replace(node(2, None, false).subtracted()).unwrap();
    assert!(Arc::ptr_eq(&scene.nodes[0], &edited.nodes[0]) && !Arc::ptr_eq(&scene.nodes[1], &edited.nodes[1]));
    assert!(Arc::ptr_eq(&scene.index, &edited.index) && Arc::ptr_eq(&scene.depths, &edited.depths));
    assert_ne!(scene, edited);
}
