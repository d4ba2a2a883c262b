//! Selects by relation: parents, children, what is alike; shows the selection alone; drops it on a surface.

use glam::{DMat3, DVec3};

use super::bounds;
use super::picking::pick_surface_without;
use super::selection;
use super::state::EditorState;
use super::steps::rounded;
use super::transforms::kinds::PivotPoint;
use super::transforms::starts::{SelectionMotion, Starts};
use isolith_document::Edit;
use isolith_geometry::Ray;
use isolith_scene::{MaterialId, Node, NodeId, NodeKind, Scene};

/// Selects the groups that hold the selection.
pub fn select_parents(state: &mut EditorState) {
    let scene = state.session.document.scene();
    let mut parents: Vec<NodeId> = Vec::new();
    for node in state.session.selected() {
        let parent = node.parent.filter(|parent| scene.node(*parent).is_some());
        if let Some(parent) = parent.filter(|parent| !parents.contains(parent)) {
            parents.push(parent);
        }
    }
    if !parents.is_empty() {
        state.session.document.select(parents);
    }
}

/// Selects the children of the selected groups.
pub fn select_children(state: &mut EditorState) {
    let scene = state.session.document.scene();
    let roots = selection::roots(&state.session);
    let children: Vec<NodeId> =
        roots.iter().flat_map(|id| scene.children(Some(*id))).filter(|node| !node.locked).map(|node| node.id).collect();
    if !children.is_empty() {
        state.session.document.select(children);
    }
}

/// Selects what is of the same kind as the active node: shape, operator, kind of light.
pub fn select_similar(state: &mut EditorState) {
    let Some(active) = state.session.selected().last().cloned() else { return };
    let scene = state.session.document.scene();
    let mut alike: Vec<NodeId> = scene
        .nodes()
        .iter()
        .filter(|node| node.id != active.id && is_alike(node, &active))
        .filter(|node| selection::holder_of_lock(scene, node.id).is_none())
        .map(|node| node.id)
        .collect();
    alike.push(active.id);
    state.session.document.select(alike);
}

/// Selects what has the material of the active node.
pub fn select_same_material(state: &mut EditorState) {
    let Some(active) = state.session.selected().last().cloned() else { return };
    let wanted: Vec<MaterialId> = active.materials().collect();
    let scene = state.session.document.scene();
    let mut alike: Vec<NodeId> = scene
        .nodes()
        .iter()
        .filter(|node| node.id != active.id && node.materials().any(|id| wanted.contains(&id)))
        .filter(|node| selection::holder_of_lock(scene, node.id).is_none())
        .map(|node| node.id)
        .collect();
    alike.push(active.id);
    state.session.document.select(alike);
}

/// Selects what is linked with the selection.
pub fn select_linked(state: &mut EditorState) {
    let links: Vec<u64> = selection::linked_in_selection(&state.session).iter().filter_map(|n| n.linked).collect();
    let scene = state.session.document.scene();
    let is_linked = |node: &&std::sync::Arc<Node>| node.linked.is_some_and(|link| links.contains(&link));
    let free = |node: &&std::sync::Arc<Node>| selection::holder_of_lock(scene, node.id).is_none();
    let linked: Vec<NodeId> = scene.nodes().iter().filter(is_linked).filter(free).map(|node| node.id).collect();
    if !linked.is_empty() {
        state.session.document.select(linked);
    }
}

/// Duplicates the selection and moves, turns or scales the copies as was done last.
pub fn duplicate_along(state: &mut EditorState) {
    let Some(last) = state.view.last_motion else { return };
    let ids = selection::roots(&state.session);
    if selection::refuse_locked(&mut state.session, &ids, "moved") {
        return;
    }
    state.session.document.begin_step("Duplicate along the last move");
    selection::duplicate(&mut state.session);
    if let Some(mut starts) = Starts::new(&state.session, PivotPoint::Median) {
        (starts.pivot, starts.is_individual) = (last.pivot, last.is_individual);
        starts.apply(&mut state.session, egui::Id::unique("duplicate along"), last.motion, &last.axes, 1e-9);
        state.session.finish();
    }
    state.session.document.end_gesture();
}

fn is_alike(a: &Node, b: &Node) -> bool {
    match (&a.kind, &b.kind) {
        (NodeKind::Object(a), NodeKind::Object(b)) => a.shape.kind() == b.shape.kind(),
        (NodeKind::Group(a), NodeKind::Group(b)) => a.operator == b.operator,
        (NodeKind::Light(a), NodeKind::Light(b)) => {
            std::mem::discriminant(&a.light) == std::mem::discriminant(&b.light)
        }
        (NodeKind::Mesh(a), NodeKind::Mesh(b)) => a.path == b.path,
        (NodeKind::Camera(_), NodeKind::Camera(_)) => true,
        _ => false,
    }
}

/// Hides everything but the selection, lights and cameras; or shows again what that has hidden.
pub fn isolate(state: &mut EditorState) {
    let scene = state.session.document.snapshot();
    let hidden: Vec<NodeId> = std::mem::take(&mut state.view.isolated)
        .into_iter()
        .filter(|id| scene.node(*id).is_some_and(|node| !node.visible))
        .collect();
    let (ids, visible) =
        if hidden.is_empty() { (others(&scene, &selection::roots(&state.session)), false) } else { (hidden, true) };
    if !visible && selection::roots(&state.session).is_empty() {
        return;
    }
    state.session.together(|session| {
        for node in ids.iter().filter_map(|id| scene.node(*id)) {
            session.apply(Edit::Replace(Node { visible, ..Node::clone(node) }));
        }
    });
    if !visible {
        state.view.isolated = ids;
    }
}

/// The topmost visible nodes without a chosen one. A group whose first child carries it stays as it is.
fn others(scene: &Scene, chosen: &[NodeId]) -> Vec<NodeId> {
    let mut found = Vec::new();
    let mut at = 0;
    while let Some(node) = scene.nodes().get(at) {
        let below = scene.subtree(at);
        let holds = chosen.iter().any(|id| scene.index_of(*id).is_some_and(|index| below.contains(&index)));
        let opens = matches!(&node.kind, NodeKind::Group(group) if !group.operator.needs_first());
        if holds && !chosen.contains(&node.id) && opens {
            at += 1;
            continue;
        }
        let is_drawn = !matches!(node.kind, NodeKind::Light(_) | NodeKind::Camera(_));
        if !holds && node.visible && is_drawn {
            found.push(node.id);
        }
        at = below.end;
    }
    found
}

/// Rays to find the ground below something, per side.
const SAMPLES: usize = 3;
/// Their part of its width.
const INNER: f64 = 0.5;

/// Moves the selection down until it touches what is below it, or the ground.
pub fn drop_on_surface(state: &mut EditorState) {
    let ids = selection::roots(&state.session);
    if selection::refuse_locked(&mut state.session, &ids, "moved") {
        return;
    }
    let Some(bounds) = bounds::of_nodes(state.session.document.scene(), state.derived.library(), &ids) else { return };
    let (center, half) = (bounds.center(), bounds.half());
    let reach = 1e3 * (1.0 + half.length() + center.length());
    let mut way = if bounds.min.y > 0.0 { bounds.min.y } else { f64::INFINITY };
    for sample in 0..SAMPLES * SAMPLES {
        let along = |index: usize| INNER * (2.0 * index as f64 / (SAMPLES - 1) as f64 - 1.0);
        let (x, z) = (along(sample % SAMPLES) * half.x, along(sample / SAMPLES) * half.z);
        let origin = DVec3::new(center.x + x, bounds.min.y, center.z + z);
        let ray = Ray { origin, direction: DVec3::NEG_Y };
        if let Some(hit) = pick_surface_without(state, &ray, &ids, [0.0, reach]) {
            way = way.min(bounds.min.y - hit.point.y);
        }
    }
    // What begins in a solid stays.
    if !way.is_finite() || way <= 0.0 {
        return;
    }
    let step = 1e-9 * (1.0 + bounds.min.y.abs());
    if let Some(starts) = Starts::new(&state.session, PivotPoint::Median) {
        let motion = SelectionMotion::Offset(DVec3::NEG_Y * rounded(way, step));
        starts.apply(&mut state.session, egui::Id::unique("drop on surface"), motion, &DMat3::IDENTITY, step);
        state.session.finish();
    }
}
