//! The files of models within a scene, so that one file is all of it, and beside the scene again.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use isolith_jobs::{Canceled, Task};
use isolith_mesh::{ModelFileTable, model_files};
use isolith_scene::{NodeKind, PackedFiles, Scene, file};

/// Where models from elsewhere are put.
const MODELS: &str = "models";
/// Most places that are tried if other files are in the way.
const MOST_PLACES: usize = 9;

/// The paths of the models that a scene names, each once.
fn models(scene: &Scene) -> Vec<String> {
    let mut paths: Vec<String> = scene.model_requests().into_iter().map(|request| request.path).collect();
    let meshes = scene.nodes().iter().filter_map(|node| match &node.kind {
        NodeKind::Mesh(mesh) => Some(mesh.path.clone()),
        _ => None,
    });
    paths.extend(meshes);
    paths.sort_unstable();
    paths.dedup();
    paths
}

/// Whether the scene names models that it does not pack.
pub fn has_unpacked(scene: &Scene) -> bool {
    models(scene).iter().any(|path| !scene.packed.table().contains_key(path))
}

/// The files of all models of a scene in this folder; those that it packs already stay as they are.
///
/// # Errors
/// A model cannot be read or packed; the reason names its file.
pub fn pack(scene: &Scene, folder: Option<&Path>, task: &Task) -> Result<PackedFiles, String> {
    let mut files = ModelFileTable::clone(scene.packed.table());
    let paths = models(scene);
    for (index, path) in paths.iter().enumerate() {
        if task.is_canceled() {
            return Err(Canceled.to_string());
        }
        task.set_progress(index as f32 / paths.len() as f32);
        if scene.packed.table().contains_key(path) {
            continue;
        }
        let folder = folder.ok_or_else(|| format!("{path}: the scene has no folder to look in until it is saved"))?;
        files.extend(model_files(folder, path).map_err(|error| error.to_string())?);
    }
    PackedFiles::new(files)
}

/// Writes the packed files of a scene below a folder. Files that are there already stay; if one of them has other
/// content, nothing is written. Returns what was written.
///
/// # Errors
/// A file stands in the way or cannot be written; the reason names it.
pub fn unpack(scene: &Scene, folder: &Path, task: &Task) -> Result<Vec<PathBuf>, String> {
    write_below(scene.packed.table(), folder, task)
}

/// Copies a model from elsewhere, with the files that it names, below the folder of a scene. Returns its path from there.
///
/// # Errors
/// The model cannot be read or written; the reason names the file.
pub fn bring(model: &Path, folder: &Path, task: &Task) -> Result<String, String> {
    let name = model.file_name().map(|name| name.to_string_lossy().into_owned());
    let (Some(name), Some(from)) = (name, model.parent()) else { return Err("names no file".into()) };
    let files = model_files(from, &name).map_err(|error| error.to_string())?;
    let stem = model.file_stem().unwrap_or_default().to_string_lossy();
    // Other files of these names stay.
    let places = std::iter::once(MODELS.to_owned()).chain((1..MOST_PLACES).map(|n| format!("{MODELS}/{stem}-{n}")));
    let mut refusal = String::new();
    for place in places {
        let below = files.iter().map(|(name, bytes)| (format!("{place}/{name}"), bytes.clone())).collect();
        match write_below(&below, folder, task) {
            Ok(_) => return Ok(format!("{place}/{name}")),
            Err(reason) => refusal = reason,
        }
        if task.is_canceled() {
            break;
        }
    }
    Err(refusal)
}

fn write_below(files: &ModelFileTable, folder: &Path, task: &Task) -> Result<Vec<PathBuf>, String> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let failed = |path: &Path, error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
    let root = folder.canonicalize().map_err(|error| failed(folder, &error))?;
    let mut missing: Vec<(PathBuf, &Arc<[u8]>)> = Vec::new();
    for (name, bytes) in files {
        let path = root.join(name);
        let there = path.ancestors().skip(1).find(|folder| folder.exists()).unwrap_or(&root);
        let there = there.canonicalize().map_err(|error| failed(there, &error))?;
        if !there.starts_with(&root) {
            return Err(failed(&path, &"would leave the folder by a link"));
        }
        match fs::read(&path) {
            Ok(there) if there == bytes[..] => {}
            Ok(_) => return Err(failed(&path, &"is another file; nothing was written")),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => missing.push((path, bytes)),
            Err(error) => return Err(failed(&path, &error)),
        }
    }
    let mut written = Vec::new();
    for (path, bytes) in missing {
        if task.is_canceled() {
            return Err(Canceled.to_string());
        }
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent).map_err(|error| failed(parent, &error))?;
        }
        file::replace(&path, bytes, 0).map_err(|error| failed(&path, &error))?;
        written.push(path);
    }
    Ok(written)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::PreparedScene;
    use isolith_scene::{MeshNode, Node};

    /// A triangle whose buffer is another file in a folder below.
    const GLTF: &str = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
            "min": [0, 0, 0], "max": [1, 1, 0]}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"uri": "./parts/tri%61ngle.bin", "byteLength": 36}]}"#;

    fn scene_in(folder: &Path) -> Scene {
        fs::create_dir_all(folder.join("models/parts")).unwrap();
        let corners = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
        let bytes: Vec<u8> = corners.iter().flat_map(|v| v.to_le_bytes()).collect();
        fs::write(folder.join("models/parts/triangle.bin"), bytes).unwrap();
        fs::write(folder.join("models/triangle.gltf"), GLTF).unwrap();
        let mut scene = Scene::new();
        let mesh = Node::new("Triangle", NodeKind::Mesh(MeshNode::new("models/triangle.gltf")));
        scene.insert(None, 0, mesh).unwrap();
        scene
    }

    fn triangles(scene: &Scene, folder: Option<PathBuf>) -> Result<usize, String> {
        let prepared = PreparedScene::of(scene, 0.0, folder, &Task::new("test")).unwrap().unwrap();
        let mesh = prepared.library.known("models/triangle.gltf").unwrap().clone();
        mesh.map(|mesh| mesh.indices.len() / 3).map_err(|error| error.to_string())
    }

    #[test]
    fn a_packed_scene_opens_anywhere_and_unpacks_to_the_same_files() {
        let (home, away) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        let mut scene = scene_in(home.path());
        let task = Task::new("test");
        assert!(has_unpacked(&scene) && triangles(&scene, Some(away.path().into())).is_err());
        scene.packed = pack(&scene, Some(home.path()), &task).unwrap();
        let text = file::to_json(&scene).unwrap();
        let read = file::parse(text.as_bytes(), Path::new("x")).unwrap();
        assert_eq!((read.packed.table().len(), triangles(&read, None)), (2, Ok(1)));
        assert!(!has_unpacked(&read));
        let written = unpack(&read, away.path(), &task).unwrap();
        assert_eq!(written.len(), 2);
        let mut plain = read.clone();
        plain.packed = PackedFiles::default();
        assert_eq!(triangles(&plain, Some(away.path().into())), Ok(1));
        assert_eq!(unpack(&read, away.path(), &task).unwrap().len(), 0, "they are there");
        assert_eq!(pack(&plain, Some(away.path()), &task).unwrap(), read.packed);
    }

    #[test]
    fn unpacking_replaces_nothing_and_follows_no_link_out() {
        let (home, away) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        let mut scene = scene_in(home.path());
        let task = Task::new("test");
        scene.packed = pack(&scene, Some(home.path()), &task).unwrap();
        fs::create_dir(away.path().join("models")).unwrap();
        fs::write(away.path().join("models/triangle.gltf"), "mine").unwrap();
        let reason = unpack(&scene, away.path(), &task).unwrap_err();
        assert!(reason.contains("triangle.gltf") && reason.contains("another file"), "{reason}");
        assert_eq!(fs::read(away.path().join("models/triangle.gltf")).unwrap(), b"mine");
        assert!(!away.path().join("models/parts").exists(), "nothing was written");
        #[cfg(unix)]
        {
            let (trap, outside) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
            std::os::unix::fs::symlink(outside.path(), trap.path().join("models")).unwrap();
            let reason = unpack(&scene, trap.path(), &task).unwrap_err();
            assert!(reason.contains("link"), "{reason}");
            assert_eq!(fs::read_dir(outside.path()).unwrap().count(), 0);
        }
    }

    #[test]
    fn a_model_from_elsewhere_is_copied_with_its_files_and_replaces_none() {
        let (home, away) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        scene_in(home.path());
        let (model, task) = (home.path().join("models/triangle.gltf"), Task::new("test"));
        let there = bring(&model, away.path(), &task).unwrap();
        assert_eq!(there, "models/triangle.gltf");
        assert!(away.path().join("models/parts/triangle.bin").is_file());
        assert_eq!(bring(&model, away.path(), &task).unwrap(), there, "the same file once more");
        fs::write(away.path().join(&there), "mine").unwrap();
        let beside = bring(&model, away.path(), &task).unwrap();
        assert_eq!(beside, "models/triangle-1/triangle.gltf");
        assert_eq!(fs::read(away.path().join(&there)).unwrap(), b"mine");
        assert_eq!(model_files(away.path(), &beside).unwrap().len(), 2);
        let gone = bring(&home.path().join("models/none.glb"), away.path(), &task).unwrap_err();
        assert!(gone.contains("none.glb"), "{gone}");
    }

    #[test]
    fn a_model_that_is_gone_is_named() {
        let (home, away) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        let scene = scene_in(home.path());
        let task = Task::new("test");
        let reason = pack(&scene, Some(away.path()), &task).unwrap_err();
        assert!(reason.contains("models/triangle.gltf"), "{reason}");
        assert!(pack(&scene, None, &task).unwrap_err().contains("until it is saved"));
        fs::remove_file(home.path().join("models/parts/triangle.bin")).unwrap();
        let reason = pack(&scene, Some(home.path()), &task).unwrap_err();
        assert!(reason.contains("buffers[0]"), "{reason}");
    }
}
