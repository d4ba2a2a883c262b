//! What lies under the pointer.

use super::Editor;
use crate::geometry::Ray;
use crate::scene::NodeId;

/// The node that the ray meets first.
pub fn pick(editor: &mut Editor, ray: &Ray) -> Option<NodeId> {
    let scene = editor.bench.document.snapshot();
    let mut nearest: Option<(f64, NodeId)> = None;
    for id in &editor.flat.scene.ids {
        let Some((world, bounds)) = super::bounds::oriented(&scene, &mut editor.meshes, *id) else { continue };
        let local = world.inverse();
        let direction = local.transform_vector3(ray.direction);
        let ray = Ray { origin: local.transform_point3(ray.origin), direction };
        if let Some((t, _)) = bounds.ray_interval(&ray) {
            if nearest.is_none_or(|(best, _)| t < best) {
                nearest = Some((t, *id));
            }
        }
    }
    nearest.map(|(_, id)| id)
}
