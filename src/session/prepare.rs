//! A scene made ready to be drawn: its arrays, and the models that it names.

use std::path::PathBuf;
use std::sync::Arc;

use isolith_field::{FlatScene, FlattenError, Flattener};
use isolith_jobs::Task;
use isolith_mesh::MeshLibrary;
use isolith_scene::Scene;

/// Progress of a task when the arrays are there. Reading the scene comes before that.
const FLATTENED: f32 = 0.75;

/// See the module.
#[derive(Debug)]
pub struct PreparedScene {
    /// The arrays.
    pub flat: Arc<FlatScene>,
    /// The models, read or refused.
    pub library: MeshLibrary,
    /// What made the arrays, and makes them again after a small change.
    pub(super) flattener: Flattener,
}

impl PreparedScene {
    /// The scene at `time` seconds, with its models from this folder; nothing where the task was canceled.
    ///
    /// # Errors
    /// The scene is beyond a limit.
    pub fn of(scene: &Scene, time: f64, folder: Option<PathBuf>, task: &Task) -> Result<Option<Self>, FlattenError> {
        task.set_stage("preparing");
        let mut flattener = Flattener::default();
        let Some(flat) = flattener.flatten_until(scene, time, task.flag())? else { return Ok(None) };
        task.set_progress(FLATTENED);
        let mut library = MeshLibrary::new(folder);
        let paths: Vec<_> = flat.meshes.iter().map(|mesh| mesh.path.clone()).collect();
        let is_whole = read_models(&paths, &mut library, task, FLATTENED);
        Ok(is_whole.then_some(Self { flat, library, flattener }))
    }
}

/// Reads what the library lacks of these; false where the task was canceled. `start` is how much of the task was done before.
pub(super) fn read_models(paths: &[String], library: &mut MeshLibrary, task: &Task, start: f32) -> bool {
    task.set_stage("models");
    for (index, path) in paths.iter().enumerate() {
        if task.is_canceled() {
            return false;
        }
        task.set_progress(start + (1.0 - start) * index as f32 / paths.len() as f32);
        // One that cannot be read is kept in the library as such.
        let _ = library.get(path);
    }
    !task.is_canceled()
}
