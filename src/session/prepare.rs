//! A scene prepared for drawing: its arrays, and the models that it names.

use std::path::PathBuf;
use std::sync::Arc;

use super::model_fields::ModelFields;
use isolith_field::{FlatScene, FlattenError, Flattener, Warning};
use isolith_jobs::Task;
use isolith_mesh::{MeshLibrary, ModelPose};
use isolith_scene::Scene;

/// Progress of a task after flattening. The part before belongs to reading the scene.
const FLATTENED: f32 = 0.75;

/// A prepared scene; see the module.
#[derive(Debug)]
pub struct PreparedScene {
    /// The arrays.
    pub flat: Arc<FlatScene>,
    /// The models, or the errors of those that cannot be read.
    pub library: MeshLibrary,
    /// The models that are fields.
    pub fields: ModelFields,
    /// Nodes whose models are no fields.
    refused: Vec<Warning>,
    /// The flattener of the arrays, for updates after small changes.
    pub(super) flattener: Flattener,
}

impl PreparedScene {
    /// Prepares the scene at `time` seconds, with its models from this folder; `None` if the task was canceled. Models
    /// that are fields are made.
    ///
    /// # Errors
    /// The scene is beyond a limit.
    pub fn of(scene: &Scene, time: f64, folder: Option<PathBuf>, task: &Task) -> Result<Option<Self>, FlattenError> {
        let mut library = library_of(scene, folder.clone());
        let mut fields = ModelFields::new(folder);
        if !fields.make_all(scene, &mut library, task) {
            return Ok(None);
        }
        Self::with(scene, time, (library, fields), task)
    }

    /// The same without fields of models, which take long: placeholders stand in for them.
    ///
    /// # Errors
    /// As [`Self::of`].
    pub fn without_fields(
        scene: &Scene,
        time: f64,
        folder: Option<PathBuf>,
        task: &Task,
    ) -> Result<Option<Self>, FlattenError> {
        Self::with(scene, time, (library_of(scene, folder), ModelFields::default()), task)
    }

    fn with(
        scene: &Scene,
        time: f64,
        (mut library, fields): (MeshLibrary, ModelFields),
        task: &Task,
    ) -> Result<Option<Self>, FlattenError> {
        task.set_stage("preparing");
        let mut flattener = Flattener::default();
        let Some(flat) = flattener.flatten_until(&fields.filled(scene), time, task.flag())? else { return Ok(None) };
        task.set_progress(FLATTENED);
        let poses: Vec<_> = flat.meshes.iter().map(|mesh| mesh.model.clone()).collect();
        let is_whole = read_models(&poses, &mut library, task, FLATTENED);
        let refused = fields
            .problems(scene)
            .filter_map(|(node, reason)| Some(Warning { node, name: scene.node(node)?.name.clone(), reason }));
        let refused = refused.collect();
        Ok(is_whole.then_some(Self { flat, library, fields, refused, flattener }))
    }

    /// Why models are no fields, as warnings about their nodes, and what was noticed while they were made.
    pub fn warnings_of_fields(&self) -> Vec<Warning> {
        self.refused.clone()
    }

    /// Prepares the same scene at another moment, which costs what has changed; false if the task was canceled.
    ///
    /// # Errors
    /// The scene is beyond a limit.
    pub fn advance(&mut self, scene: &Scene, time: f64, task: &Task) -> Result<bool, FlattenError> {
        let scene = self.fields.filled(scene);
        let Some(flat) = self.flattener.flatten_until(&scene, time, task.flag())? else { return Ok(false) };
        self.flat = flat;
        let poses: Vec<_> = self.flat.meshes.iter().map(|mesh| mesh.model.clone()).collect();
        self.library.keep_poses(poses.iter());
        Ok(read_models(&poses, &mut self.library, task, 0.0))
    }
}

/// The library of a scene in a folder, with the files that the scene packs.
pub fn library_of(scene: &Scene, folder: Option<PathBuf>) -> MeshLibrary {
    MeshLibrary::new(folder).with_packed(scene.packed.table().clone())
}

/// Reads the models that the library lacks; false if the task was canceled. `start` is the progress of the task so far.
pub(super) fn read_models(poses: &[ModelPose], library: &mut MeshLibrary, task: &Task, start: f32) -> bool {
    task.set_stage("models");
    for (index, pose) in poses.iter().enumerate() {
        if task.is_canceled() {
            return false;
        }
        task.set_progress(start + (1.0 - start) * index as f32 / poses.len() as f32);
        // The library records models that cannot be read.
        let _ = library.get(pose);
    }
    !task.is_canceled()
}
