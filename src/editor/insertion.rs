//! Adds new nodes: into the selected group or after the selected node, at the view's target.

use std::collections::HashSet;

use glam::DVec3;

use super::material_edits::{self, NEW, next_color, users};
use super::state::EditorState;
use super::{instancing, selection};
use isolith_document::Edit;
use isolith_scene::{Material, MaterialId, Node, NodeId, NodeKind, Object, Scene, ShapeKind};

/// Adds an object of the given kind and selects it.
pub fn shape(state: &mut EditorState, kind: ShapeKind) {
    state.session.document.begin_gesture();
    let material = material(state);
    let object = Object { shape: kind.default_shape(), material };
    node(state, Node::new(kind.label(), NodeKind::Object(object)));
    state.session.document.end_gesture();
}

/// Adds a node at the view's target and selects it.
pub fn node(state: &mut EditorState, node: Node) -> Option<NodeId> {
    node_above(state, node, 0.0)
}

/// Adds a node the given number of meters above the view's target and selects it.
pub fn node_above(state: &mut EditorState, node: Node, up: f64) -> Option<NodeId> {
    let target = if state.session.document.scene().nodes().is_empty() { DVec3::ZERO } else { tidy_target(state) };
    node_in_world(state, node.at(target + DVec3::Y * up))
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
        Some(n) if n.has_children() && (new.has_field() || instancing::instancer(n).is_none()) => {
            (Some(n.id), scene.children(Some(n.id)).count())
        }
        Some(n) => (n.parent, selection::place(scene, n.id) + 1),
    }
}

/// The view's target, rounded to about a hundredth of the view's width.
fn tidy_target(state: &EditorState) -> DVec3 {
    let step = 10.0_f64.powf((state.view.navigation.distance * 0.02).log10().floor());
    // Dividing by the step's reciprocal gives 0.3, where multiplying by 0.1 gives 0.30000000000000004.
    let per_meter = (1.0 / step).round().max(1.0);
    (state.view.navigation.target * per_meter).round() / per_meter
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
