//! Adds new nodes: into the selected group or after the selected node, on what is under the pointer.

use std::collections::HashSet;

use glam::DVec3;

use super::material_edits::{self, NEW, next_color, users};
use super::state::EditorState;
use super::{instancing, placement, selection};
use isolith_document::Edit;
use isolith_scene::{Material, MaterialId, Node, NodeId, NodeKind, Object, Scene, ShapeKind};

/// Adds an object of the given kind and selects it.
pub fn shape(state: &mut EditorState, kind: ShapeKind) {
    let at = state.view.add_at.take();
    let placing = placement::placing(state, at);
    let shape = placement::sized(state, placement::remembered(state, kind), placing.point);
    let position = placement::position(state, &shape.bounds(), &placing);
    state.session.document.begin_gesture();
    let material = material(state);
    let object = Object { shape, material };
    node_in_world(state, Node::new(kind.label(), NodeKind::Object(object)).at(position));
    state.session.document.end_gesture();
}

/// Adds a node where the pointer is, or at the view's target, and selects it.
pub fn node(state: &mut EditorState, node: Node) -> Option<NodeId> {
    node_above(state, node, 0.0)
}

/// Adds a node the given number of meters above that place and selects it.
pub fn node_above(state: &mut EditorState, node: Node, up: f64) -> Option<NodeId> {
    let at = state.view.add_at.take();
    let point = placement::placing(state, at).point;
    node_in_world(state, node.at(point + DVec3::Y * up))
}

/// Adds a node with a transform in world space, and selects it.
pub fn node_in_world(state: &mut EditorState, mut node: Node) -> Option<NodeId> {
    let scene = state.session.document.scene();
    let (parent, position) = place(scene, state.session.document.selection(), &node);
    if let Some(parent) = parent {
        let local = scene.world_from_local(parent).inverse().transform_point3(node.transform.translation);
        node.transform.translation = if local.is_finite() { local } else { DVec3::ZERO };
    }
    node.name = free_name(scene, &node.name);
    let added = state.session.apply(Edit::Insert { parent, position, node }).first().copied()?;
    state.session.document.select(vec![added]);
    Some(added)
}

/// The end of the active group, or the place after the active node, or the end of the scene. An instancer takes only
/// what has a field.
fn place(scene: &Scene, selection: &[NodeId], new: &Node) -> (Option<NodeId>, usize) {
    match selection.last().and_then(|id| scene.node(*id)) {
        None => (None, scene.children(None).count()),
        Some(n) if n.has_children() && (new.can_be_type() || instancing::instancer(n).is_none()) => {
            (Some(n.id), scene.children(Some(n.id)).count())
        }
        Some(n) => (n.parent, selection::place(scene, n.id) + 1),
    }
}

/// The name itself, or the name with the first free number.
pub fn free_name(scene: &Scene, base: &str) -> String {
    let taken: HashSet<&str> = scene.nodes().iter().map(|n| n.name.as_str()).collect();
    let mut names = std::iter::once(base.to_owned()).chain((2..).map(|n| format!("{base} {n}")));
    names.find(|name| !taken.contains(name.as_str())).unwrap_or_default()
}

/// A material of its own for a new shape, so that its color can be changed without a thought of others. The first shape
/// of a scene takes the material that the scene begins with.
fn material(state: &mut EditorState) -> MaterialId {
    let scene = state.session.document.scene();
    if let [only] = scene.materials()
        && users(scene, only.id).is_empty()
    {
        return only.id;
    }
    let material = Material::new(MaterialId(0), NEW, next_color(scene));
    let first = scene.materials().first().map(|first| first.id);
    // If there are too many, the message says so, and the shape takes one of them.
    material_edits::insert(&mut state.session, material).or(first).unwrap_or(MaterialId(1))
}
