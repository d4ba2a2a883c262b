//! Picks the node under the pointer.

use super::state::EditorState;
use isolith_field::pick;
use isolith_geometry::Ray;
use isolith_scene::NodeId;

/// The node at the first hit of the ray: it traces the exact surface, not its bounds.
pub fn pick_node(state: &EditorState, ray: &Ray) -> Option<NodeId> {
    let flat = state.flat();
    let meshes = flat.known_meshes(state.derived.library());
    let camera = state.view.navigation.camera();
    pick::pick(flat, &meshes, ray, camera.near, camera.far)
}
