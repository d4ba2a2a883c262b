//! Commands that make instancers and give them ready-made settings; each is one undo step.

use super::edit_session::EditSession;
use super::instancing::instancer;
use super::messages::Message;
use super::state::EditorState;
use super::{bounds, insertion, selection};
use isolith_document::Edit;
use isolith_mesh::MeshLibrary;
use isolith_scene::{InstancerPreset, Node, NodeId, NodeKind, Scene};

/// Name of a new instancer.
const NEW: &str = "Instancer";

/// Adds an instancer without types.
pub fn add(state: &mut EditorState) {
    let added = insertion::node(state, Node::new(NEW, NodeKind::Instancer(Box::default())));
    if added.is_some() {
        let hint = "Drag what it shall copy onto the instancer in the outliner, or add a shape while it is selected.";
        state.session.messages.push(Message::info(hint));
    }
}

/// Whether the selection can become the types of an instancer.
pub fn can_instance(session: &EditSession) -> bool {
    let selected = session.selected();
    !selected.is_empty() && selected.iter().all(|node| node.can_be_type())
}

/// Makes the selection the types of a new instancer, which stands where the first of them stands, and selects it.
pub fn from_selection(session: &mut EditSession) -> Option<NodeId> {
    let ids = selection::roots(session);
    if selection::refuse_locked(session, &ids, "made a type") {
        return None;
    }
    let scene = session.document.scene();
    let at = scene.node(*ids.first()?)?.transform.translation;
    let node = Node::new(insertion::free_name(scene, NEW), NodeKind::Instancer(Box::default())).at(at);
    let added = session.apply(Edit::Instance { ids, node }).first().copied()?;
    session.document.select(vec![added]);
    Some(added)
}

/// The selected instancers.
fn selected_instancers(session: &EditSession) -> Vec<NodeId> {
    session.selected().iter().filter(|node| instancer(node).is_some()).map(|node| node.id).collect()
}

/// Whether a preset has something to work on: instancers, or what can become types.
pub fn can_take_preset(session: &EditSession) -> bool {
    !selected_instancers(session).is_empty() || can_instance(session)
}

/// Gives the selected instancers the settings of a preset, or a new one of the selection.
pub fn apply_preset(state: &mut EditorState, preset: InstancerPreset) {
    let (session, meshes) = (&mut state.session, state.derived.library());
    session.together(|session| {
        let mut ids = selected_instancers(session);
        if ids.is_empty() {
            ids.extend(from_selection(session));
        }
        for id in ids {
            let scene = session.document.scene();
            let Some(node) = scene.node(id) else { continue };
            let mut node = Node::clone(node);
            preset.apply(&mut node, width_of_types(scene, meshes, id));
            session.apply(Edit::Replace(node));
        }
    });
}

/// The mean width of the types of an instancer in its own space; a meter where there are none.
fn width_of_types(scene: &Scene, meshes: &MeshLibrary, id: NodeId) -> f64 {
    let types = scene.children(Some(id)).filter(|node| node.can_be_type());
    let widths: Vec<f64> = types
        .filter_map(|node| {
            let (_, bounds) = bounds::oriented(scene, meshes, node.id)?;
            let half = bounds.transformed(&node.transform.to_affine()).half();
            Some(2.0 * half.x.max(half.z))
        })
        .collect();
    if widths.is_empty() { 1.0 } else { widths.iter().sum::<f64>() / widths.len() as f64 }
}
