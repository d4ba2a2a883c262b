//! Linked objects: all of a set have the same shape and material, and an edit of one is an edit of all.

use std::collections::HashMap;
use std::sync::Arc;

use isolith_scene::{Node, NodeKind, Scene, SceneError};

/// Replaces a node, and the shape and material of those with which it is linked.
pub(super) fn replace(scene: &mut Arc<Scene>, node: Node) -> Result<(), SceneError> {
    let scene = Arc::make_mut(scene);
    let differs = |other: &&Arc<Node>| other.id != node.id && other.kind != node.kind;
    let others: Vec<Node> = match node.linked {
        Some(link) => scene.linked(link).filter(differs).map(|other| Node::clone(other)).collect(),
        None => Vec::new(),
    };
    for other in others {
        scene.replace(Node { kind: node.kind.clone(), ..other })?;
    }
    scene.replace(node)
}

/// Makes a set of each object at these places that is in none.
pub(super) fn link(scene: &mut Arc<Scene>, places: impl Iterator<Item = usize>) -> Result<(), SceneError> {
    let mut next = scene.next_link();
    let mut nodes = scene.nodes().to_vec();
    for place in places {
        if nodes[place].linked.is_none() && matches!(nodes[place].kind, NodeKind::Object(_)) {
            Arc::make_mut(&mut nodes[place]).linked = Some(next);
            next += 1;
        }
    }
    Arc::make_mut(scene).set_nodes(nodes)
}

/// New numbers for the sets of another scene.
pub(super) struct NewLinks {
    next: u64,
    known: HashMap<u64, u64>,
}

impl NewLinks {
    pub fn new(scene: &Scene) -> Self {
        Self { next: scene.next_link(), known: HashMap::new() }
    }

    /// The number of the set that has this number in the other scene.
    pub fn of(&mut self, link: u64) -> u64 {
        let next = &mut self.next;
        *self.known.entry(link).or_insert_with(|| {
            *next += 1;
            *next - 1
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Document, Edit};
    use isolith_scene::{Group, NodeId, Object, Shape, ShapeKind, file};

    /// A group with a ball in it.
    fn document() -> (Document, [NodeId; 2]) {
        let mut scene = Scene::new();
        let material = scene.materials()[0].id;
        let group = scene.insert(None, 0, Node::new("Pair", NodeKind::Group(Group::UNION))).unwrap();
        let ball = Object { shape: ShapeKind::Sphere.default_shape(), material };
        let ball = scene.insert(Some(group), 0, Node::new("Ball", NodeKind::Object(ball))).unwrap();
        (Document::new(scene), [group, ball])
    }

    fn resize(document: &mut Document, id: NodeId, size: f64) {
        let mut node = Node::clone(document.scene().node(id).unwrap());
        let NodeKind::Object(object) = &mut node.kind else { panic!("an object") };
        object.shape = Shape::Sphere { radius: size };
        document.apply(Edit::Replace(node)).unwrap();
    }

    fn radius(document: &Document, id: NodeId) -> f64 {
        match &document.scene().node(id).unwrap().kind {
            NodeKind::Object(Object { shape: Shape::Sphere { radius }, .. }) => *radius,
            _ => panic!("a ball"),
        }
    }

    #[test]
    fn an_edit_of_one_is_an_edit_of_all_that_are_linked() {
        let (mut document, [group, ball]) = document();
        let copy = document.apply(Edit::DuplicateLinked(vec![group])).unwrap()[0];
        let inner = document.scene().children(Some(copy)).next().unwrap().id;
        resize(&mut document, inner, 0.25);
        assert_eq!((radius(&document, ball), radius(&document, inner)), (0.25, 0.25));
        let loose = document.apply(Edit::Duplicate(vec![ball])).unwrap()[0];
        resize(&mut document, ball, 0.75);
        assert_eq!([ball, inner, loose].map(|id| radius(&document, id)), [0.75, 0.75, 0.25]);
        document.undo();
        assert_eq!([ball, inner, loose].map(|id| radius(&document, id)), [0.25; 3], "one step");
        let third = document.apply(Edit::DuplicateLinked(vec![inner])).unwrap()[0];
        assert_eq!(document.scene().node(third).unwrap().linked, document.scene().node(ball).unwrap().linked);
        assert_eq!(document.scene().linked(1).count(), 3);
    }

    #[test]
    fn files_keep_links_and_refuse_those_that_differ() {
        let (mut document, [_, ball]) = document();
        document.apply(Edit::DuplicateLinked(vec![ball])).unwrap();
        let text = file::to_json(document.scene()).unwrap();
        let read = file::parse(text.as_bytes(), std::path::Path::new("x")).unwrap();
        assert_eq!(read.linked(1).count(), 2);
        let other = text.replacen("\"radius\": 0.5", "\"radius\": 0.6", 1);
        assert_ne!(text, other);
        let reason = file::parse(other.as_bytes(), std::path::Path::new("x")).unwrap_err().to_string();
        assert!(reason.contains("linked") && reason.contains("Ball 2"), "{reason}");
    }

    #[test]
    fn pasted_objects_are_linked_among_themselves_only() {
        let (mut document, [_, ball]) = document();
        let partner = document.apply(Edit::DuplicateLinked(vec![ball])).unwrap()[0];
        let part = Arc::new(crate::extracted(document.scene(), &[ball, partner]).unwrap());
        let added = document.apply(Edit::Merge { parent: None, position: 0, from: part }).unwrap();
        resize(&mut document, added[0], 0.3);
        assert_eq!([ball, partner, added[0], added[1]].map(|id| radius(&document, id)), [0.5, 0.5, 0.3, 0.3]);
    }
}
