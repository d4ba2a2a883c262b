//! Where dragged rows of the outliner go.

use egui_ltreeview::{DirPosition, DragAndDrop};

use super::edit_session::EditSession;
use super::{instancing, selection};
use isolith_document::Edit;
use isolith_scene::{NodeId, Scene};

/// A row of the tree; `None` is the invisible root, the scene itself.
pub type RowId = Option<NodeId>;

/// Moves nodes, unless one of them is locked.
pub fn move_rows(session: &mut EditSession, ids: Vec<NodeId>, parent: RowId, position: usize) {
    if !ids.is_empty() && !selection::refuse_locked(session, &ids, "moved") {
        session.apply(Edit::Move { ids, parent, position });
    }
}

/// The destination of a drag: nodes, parent and position; `None` if it is not allowed.
pub fn destination(scene: &Scene, drag: &DragAndDrop<RowId>) -> Option<(Vec<NodeId>, RowId, usize)> {
    let parent = drag.target;
    let ids: Vec<NodeId> = drag.source.iter().copied().flatten().collect();
    let into_itself = |p| ids.iter().any(|id| scene.is_within(p, *id));
    let is_type = |id: &NodeId| scene.node(*id).is_some_and(|node| node.can_be_type());
    let takes_types = parent.and_then(|p| scene.node(p)).is_some_and(|node| instancing::instancer(node).is_some());
    if ids.is_empty() || parent.is_some_and(into_itself) || (takes_types && !ids.iter().all(is_type)) {
        return None;
    }
    // Positions do not count the moved nodes.
    let rest: Vec<NodeId> = scene.children(parent).map(|n| n.id).filter(|id| !ids.contains(id)).collect();
    let index = |row: &RowId| row.and_then(|id| rest.iter().position(|r| *r == id));
    let position = match &drag.position {
        DirPosition::First => 0,
        DirPosition::Last => rest.len(),
        DirPosition::Before(row) => index(row)?,
        DirPosition::After(row) => index(row)? + 1,
    };
    Some((ids, parent, position))
}
