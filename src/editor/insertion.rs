//! Adds new nodes: into the selected group or after the selected node, on what is under the pointer.

use std::collections::HashSet;

use glam::DVec3;

use super::material_edits::{self, NEW, next_color, users};
use super::state::EditorState;
use super::{instancing, placement, selection};
use isolith_document::{Edit, recomposed};
use isolith_geometry::Transform;
use isolith_scene::{Material, MaterialId, Node, NodeId, NodeKind, Object, Scene, Shape, ShapeKind};

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

/// Adds an object with a transform in world space, as part of the gesture in progress, and selects it.
pub fn drawn(state: &mut EditorState, shape: Shape, transform: Transform) -> Option<NodeId> {
    let name = shape.kind().label();
    let object = Object { shape, material: material(state) };
    node_in_world(state, Node { transform, ..Node::new(name, NodeKind::Object(object)) })
}

/// Gives an object another shape and another transform in world space, as part of the widget's gesture.
pub fn redraw(state: &mut EditorState, widget: egui::Id, id: NodeId, shape: Shape, transform: Transform) {
    let scene = state.session.document.scene();
    let Some(parent) = scene.node(id).map(|node| node.parent) else { return };
    let transform = in_parent(scene, parent, transform);
    state.session.change(widget, &[id], |node| {
        node.transform = transform;
        if let NodeKind::Object(object) = &mut node.kind {
            object.shape = shape.clone();
        }
    });
}

/// A transform in world space as one below a parent. What a group would shear only keeps its place.
fn in_parent(scene: &Scene, parent: Option<NodeId>, world: Transform) -> Transform {
    let Some(parent) = parent else { return world };
    let parent_from_world = scene.world_from_local(parent).inverse();
    if let Some(local) = recomposed(&parent_from_world, &world) {
        return local;
    }
    let place = parent_from_world.transform_point3(world.translation);
    Transform { translation: if place.is_finite() { place } else { DVec3::ZERO }, ..world }
}

/// Adds a node with a transform in world space, and selects it.
pub fn node_in_world(state: &mut EditorState, mut node: Node) -> Option<NodeId> {
    let scene = state.session.document.scene();
    let (parent, position) = place(scene, state.session.document.selection(), &node);
    node.transform = in_parent(scene, parent, node.transform);
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
