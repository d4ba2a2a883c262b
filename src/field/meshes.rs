//! Loads the meshes that a scene names.

use std::collections::HashSet;
use std::sync::Arc;

use super::{FlatScene, Warning};
use isolith_mesh::{ClipTime, MeshLibrary, ModelPose, TriangleMesh};
use isolith_scene::MeshNode;

/// The pose of a model at `time` seconds.
pub fn model_pose(mesh: &MeshNode, time: f64) -> ModelPose {
    let at = mesh.clip_time + mesh.clip_speed * time;
    // Speed and time within their limits may still have a product that is not finite.
    let at = if at.is_finite() { at } else { mesh.clip_time };
    let clip = (!mesh.clip.is_empty()).then(|| ClipTime { name: mesh.clip.clone(), time: at });
    ModelPose { path: mesh.path.clone(), clip }
}

impl FlatScene {
    /// The loaded meshes, parallel to [`FlatScene::meshes`], for rays and the renderer, with warnings: about each
    /// mesh that cannot be loaded (the scene is drawn without it), and about undrawn contents of files, at the first
    /// node that shows the file.
    pub fn load_meshes(&self, library: &mut MeshLibrary) -> (Vec<Option<Arc<TriangleMesh>>>, Vec<Warning>) {
        let mut warnings = Vec::new();
        let mut told = HashSet::new();
        let load = |mesh: &super::FlatMesh| match library.get(&mesh.model) {
            Ok(triangles) => {
                if !triangles.warnings.is_empty() && told.insert(mesh.model.clone()) {
                    let warning = |reason: &String| Warning {
                        node: mesh.id,
                        name: mesh.model.path.clone(),
                        reason: reason.clone(),
                    };
                    warnings.extend(triangles.warnings.iter().map(warning));
                }
                Some(triangles)
            }
            Err(error) => {
                let reason = format!("the mesh is not drawn: {error}");
                warnings.push(Warning { node: mesh.id, name: mesh.model.path.clone(), reason });
                None
            }
        };
        let meshes = self.meshes.iter().map(load).collect();
        (meshes, warnings)
    }

    /// The same for a library as it is: reads no file and leaves out meshes that are not loaded yet. Another pose stands
    /// in for one that is not loaded yet.
    pub fn known_meshes(&self, library: &MeshLibrary) -> Vec<Option<Arc<TriangleMesh>>> {
        let known = |mesh: &super::FlatMesh| library.nearest(&mesh.model).and_then(|mesh| mesh.as_ref().ok()).cloned();
        self.meshes.iter().map(known).collect()
    }
}

#[cfg(test)]
mod tests {
    use crate::flatten;
    use isolith_mesh::MeshLibrary;
    use isolith_scene::{MeshNode, Node, NodeKind, Scene};

    #[test]
    fn a_mesh_that_is_missing_is_a_warning_about_its_node() {
        let mut scene = Scene::new();
        let node = NodeKind::Mesh(MeshNode::new("no-such.glb"));
        let id = scene.insert(None, 0, Node::new("statue", node)).unwrap();
        let flat = flatten(&scene, 0.0).unwrap();
        let (meshes, warnings) = flat.load_meshes(&mut MeshLibrary::new(Some(std::env::temp_dir())));
        assert_eq!((meshes.len(), meshes[0].is_none()), (1, true));
        assert_eq!((warnings.len(), warnings[0].node), (1, id));
        assert!(warnings[0].reason.contains("no-such.glb"), "{}", warnings[0].reason);
    }
}
