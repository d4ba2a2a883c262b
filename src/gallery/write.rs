//! Writes the example scenes as files, with the models that they show.

use std::path::{Path, PathBuf};

use isolith_scene::file::{self, FileError};
use isolith_scene::{Node, NodeKind, Scene};

/// Every model of the examples: its path beside the scene, and its bytes.
const MODELS: &[(&str, &[u8])] = &[("models/suzanne.glb", include_bytes!("models/suzanne.glb"))];

/// Writes every scene as `NAME.json` into `folder`, which must exist, and the models below it. Returns the scene files.
///
/// # Errors
/// The first file that cannot be written.
pub fn write_all(folder: &Path) -> Result<Vec<PathBuf>, FileError> {
    super::all().into_iter().map(|(name, scene)| install(name, &scene, folder)).collect()
}

/// Writes one of the scenes as `NAME.json` into `folder`, with the models that it shows. Returns the scene's file.
///
/// # Errors
/// A file that cannot be written.
pub fn install(name: &str, scene: &Scene, folder: &Path) -> Result<PathBuf, FileError> {
    for (model, bytes) in MODELS.iter().filter(|(model, _)| shows(scene, model)) {
        let path = folder.join(model);
        // An identical file stays untouched: it may be watched.
        if std::fs::read(&path).is_ok_and(|present| present == *bytes) {
            continue;
        }
        let parent = path.parent().unwrap_or(folder);
        std::fs::create_dir_all(parent).map_err(|error| FileError::new(parent, error.to_string()))?;
        file::replace(&path, bytes, 0).map_err(|error| FileError::new(&path, error.to_string()))?;
    }
    let path = folder.join(format!("{name}.json"));
    file::save(scene, &path).map(|()| path)
}

/// Whether a mesh of the scene has this path, or the field of one.
fn shows(scene: &Scene, model: &str) -> bool {
    let is_mesh = |node: &Node| matches!(&node.kind, NodeKind::Mesh(mesh) if mesh.path == model);
    scene.nodes().iter().any(|node| is_mesh(node)) || scene.model_requests().iter().any(|request| request.path == model)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_model_that_an_example_shows_is_written_with_it() {
        let folder = tempfile::tempdir().expect("a folder");
        for (name, scene) in crate::all() {
            let file = install(name, &scene, folder.path()).unwrap_or_else(|error| panic!("{error}"));
            let read = file::parse(&std::fs::read(&file).expect("it was written"), &file);
            assert!(read.is_ok_and(|read| read == scene), "{name}");
            for node in scene.nodes() {
                if let NodeKind::Mesh(mesh) = &node.kind {
                    assert!(folder.path().join(&mesh.path).is_file(), "{name}: {}", mesh.path);
                }
            }
        }
    }
}
