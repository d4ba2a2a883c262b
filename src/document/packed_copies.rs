//! Packed files on the way with copied nodes: a part takes those of its models along, and a scene takes them over.

use std::sync::Arc;

use isolith_scene::{Node, NodeKind, PackedFiles, Scene, SceneError, Shape};

/// The path of a node's model, if it has one.
fn model_path(node: &mut Node) -> Option<&mut String> {
    match &mut node.kind {
        NodeKind::Mesh(mesh) => Some(&mut mesh.path),
        NodeKind::Object(object) => match &mut object.shape {
            Shape::MeshField { file, .. } => Some(&mut file.path),
            _ => None,
        },
        _ => None,
    }
}

/// The packed files that the models of these nodes may need: a .glb is complete, a .gltf names others.
pub(super) fn needed(nodes: &mut [Node], packed: &PackedFiles) -> PackedFiles {
    let paths: Vec<String> = nodes.iter_mut().filter_map(model_path).map(|path| path.clone()).collect();
    let used: Vec<&String> = paths.iter().filter(|path| packed.table().contains_key(*path)).collect();
    if used.iter().any(|path| !path.ends_with(".glb")) {
        return packed.clone();
    }
    let files = packed.table().iter().filter(|(name, _)| used.contains(name));
    // A part of packed files can be packed.
    PackedFiles::new(files.map(|(name, bytes)| (name.clone(), Arc::clone(bytes)))).unwrap_or_default()
}

/// Adds the packed files of another scene, below a folder of their own if a file of one name has another content.
/// Returns that folder, with a slash behind it, or nothing.
///
/// # Errors
/// Together they are too many or too large.
pub(super) fn taken_over(scene: &mut Scene, from: &Scene) -> Result<String, SceneError> {
    let (own, new) = (scene.packed.table(), from.packed.table());
    let fits = |folder: &str| {
        new.iter().all(|(name, bytes)| own.get(&format!("{folder}{name}")).is_none_or(|there| there == bytes))
    };
    let folders = std::iter::once(String::new()).chain((1..).map(|number| format!("pasted-{number}/")));
    let folder = folders.into_iter().find(|folder| fits(folder)).unwrap_or_default();
    let mut all = own.as_ref().clone();
    all.extend(new.iter().map(|(name, bytes)| (format!("{folder}{name}"), Arc::clone(bytes))));
    if all.len() != own.len() {
        scene.packed = PackedFiles::new(all).map_err(SceneError::Packed)?;
    }
    Ok(folder)
}

/// Names the model of a node below this folder, if its file is packed in the scene that the node comes from.
pub(super) fn moved_below(node: &mut Node, folder: &str, from: &Scene) {
    if let Some(path) = model_path(node).filter(|path| from.packed.table().contains_key(*path)) {
        *path = format!("{folder}{path}");
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use isolith_scene::{MeshNode, NodeId};

    fn packed(files: &[(&str, &str)]) -> PackedFiles {
        PackedFiles::new(files.iter().map(|(name, text)| ((*name).to_owned(), Arc::from(text.as_bytes())))).unwrap()
    }

    fn with_mesh(path: &str, files: &[(&str, &str)]) -> (Scene, NodeId) {
        let mut scene = Scene::new();
        scene.packed = packed(files);
        let mesh = MeshNode::new(path);
        let id = scene.insert(None, 0, Node::new("Model", NodeKind::Mesh(mesh))).unwrap();
        (scene, id)
    }

    fn names(scene: &Scene) -> Vec<&str> {
        scene.packed.table().keys().map(String::as_str).collect()
    }

    #[test]
    fn a_part_takes_the_files_of_its_models_only() {
        let (scene, id) = with_mesh("a.glb", &[("a.glb", "A"), ("b.glb", "B")]);
        let part = crate::extracted(&scene, &[id]).unwrap();
        assert_eq!(names(&part), ["a.glb"]);
        let (scene, id) = with_mesh("a.gltf", &[("a.gltf", "A"), ("a.bin", "B")]);
        assert_eq!(names(&crate::extracted(&scene, &[id]).unwrap()), ["a.bin", "a.gltf"]);
        let (scene, id) = with_mesh("beside.glb", &[("a.glb", "A")]);
        assert!(crate::extracted(&scene, &[id]).unwrap().packed.is_empty());
    }

    #[test]
    fn a_file_of_the_same_name_and_other_content_goes_into_a_folder_of_its_own() {
        let (part, _) = with_mesh("a.glb", &[("a.glb", "A")]);
        let path = |scene: &Scene, id: NodeId| model_path(&mut Node::clone(scene.node(id).unwrap())).unwrap().clone();
        let merged = |files: &[(&str, &str)]| {
            let (mut scene, _) = with_mesh("x.glb", files);
            scene.packed = packed(files);
            let mut scene = Arc::new(scene);
            let added = crate::copying::merge(&mut scene, &part, None, 1).unwrap();
            (path(&scene, added[0]), scene)
        };
        let (name, scene) = merged(&[]);
        assert_eq!((&*name, names(&scene)), ("a.glb", vec!["a.glb"]));
        let (name, scene) = merged(&[("a.glb", "A")]);
        assert_eq!((&*name, names(&scene)), ("a.glb", vec!["a.glb"]));
        let (name, scene) = merged(&[("a.glb", "Other")]);
        assert_eq!((&*name, names(&scene)), ("pasted-1/a.glb", vec!["a.glb", "pasted-1/a.glb"]));
        assert_eq!(&*scene.packed.table()["a.glb"], b"Other");
    }
}
