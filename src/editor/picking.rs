//! What lies under the pointer.

use super::Editor;
use crate::flat::pick;
use crate::geometry::Ray;
use crate::scene::NodeId;

/// The node that the ray meets first: the very surface that is drawn, not a box around it.
pub fn pick_node(editor: &mut Editor, ray: &Ray) -> Option<NodeId> {
    let flat = &editor.flat.scene;
    let meshes: Vec<_> = flat.meshes.iter().map(|mesh| editor.meshes.get(&mesh.path).ok()).collect();
    let camera = editor.navigation.camera();
    pick::pick(flat, &meshes, ray, camera.near, camera.far)
}
