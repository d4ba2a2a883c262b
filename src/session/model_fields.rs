//! The shapes of a scene that are made of models, with bricks in voxels of several sizes.

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::Arc;

use super::bricks::{BrickLibrary, ModelKey};
use super::notice::Notice;
use isolith_bricks::BrickLevels;
use isolith_jobs::{Jobs, Task};
use isolith_mesh::{ClipTime, MeshLibrary, ModelPose};
use isolith_scene::{ModelRequest, NodeId, NodeKind, Scene};

/// The models of a scene as fields.
#[derive(Debug, Default)]
pub struct ModelFields {
    library: BrickLibrary,
    /// The bricks of each request, by those of the finest voxels.
    levels: HashMap<ModelKey, Arc<BrickLevels>>,
    revision: u64,
}

impl ModelFields {
    /// Fields for scenes in this folder, beside which their files are kept.
    pub fn new(folder: Option<std::path::PathBuf>) -> Self {
        Self { library: BrickLibrary::new(folder), ..Self::default() }
    }

    /// Changes the folder; forgets everything if it differs from the old one.
    pub fn set_folder(&mut self, folder: Option<std::path::PathBuf>) {
        self.library.set_folder(folder);
    }

    /// A number that changes with what scenes get.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Whether bricks are being made.
    pub fn is_under_way(&self) -> bool {
        self.library.is_under_way()
    }

    /// Repeats canceled work.
    pub fn make_again(&mut self) {
        self.library.make_again();
    }

    /// The messages since the last call.
    pub fn take_notices(&mut self) -> Vec<Notice> {
        self.library.take_notices()
    }

    /// Starts making what is missing, and takes over what was made. Returns whether scenes
    /// get anything else than before.
    pub fn follow(&mut self, jobs: &Jobs, requests: &[ModelRequest], meshes: &MeshLibrary) -> bool {
        let keys = self.keys(requests);
        self.library.follow(jobs, &keys, meshes) && self.assemble(requests)
    }

    /// Makes all that is missing at once; false if the task was canceled.
    pub fn make_all(&mut self, requests: &[ModelRequest], meshes: &mut MeshLibrary, task: &Task) -> bool {
        let mut keys = self.keys(requests);
        loop {
            if !self.library.make_all(&keys, meshes, task) {
                return false;
            }
            let more = self.keys(requests);
            if more == keys {
                self.assemble(requests);
                return true;
            }
            keys = more;
        }
    }

    /// The scene with the bricks of its models, where they are made.
    pub fn filled<'a>(&self, scene: &'a Scene) -> Cow<'a, Scene> {
        if self.levels.is_empty() {
            return Cow::Borrowed(scene);
        }
        Cow::Owned(scene.with_bricks(&|request| self.levels.get(&key_of(request)).cloned()))
    }

    /// The nodes whose bricks cannot be made, and why.
    pub fn problems<'a>(&'a self, scene: &'a Scene) -> impl Iterator<Item = (NodeId, String)> + 'a {
        scene.nodes().iter().filter_map(|node| {
            let NodeKind::Object(object) = &node.kind else { return None };
            let key = key_of(&object.shape.model_request()?);
            Some((node.id, self.library.get(&key)?.err()?))
        })
    }

    /// What is wanted: the finest voxels of each request, and behind them the next larger ones of those that are made.
    fn keys(&self, requests: &[ModelRequest]) -> Vec<ModelKey> {
        let mut keys: Vec<ModelKey> = requests.iter().map(key_of).collect();
        for request in requests {
            keys.extend(self.chain(&key_of(request)).1);
        }
        keys
    }

    /// The bricks of a request that are made so far, the finest first, and the keys of all but those.
    fn chain(&self, finest: &ModelKey) -> (Vec<Arc<isolith_bricks::Bricks>>, Vec<ModelKey>) {
        let (mut levels, mut keys) = (Vec::new(), Vec::new());
        let mut next = self.library.nearest(finest).and_then(Result::ok);
        while let Some(bricks) = next.take() {
            levels.push(bricks);
            let Some(voxel) = BrickLevels::coarser(&levels[levels.len() - 1], levels.len()) else { break };
            let key = ModelKey { pose: finest.pose.clone(), resolution: 0.0, voxel };
            next = self.library.get(&key).and_then(Result::ok);
            keys.push(key);
        }
        (levels, keys)
    }

    /// Puts together what was made. Returns whether anything is new.
    fn assemble(&mut self, requests: &[ModelRequest]) -> bool {
        let mut all = HashMap::new();
        for request in requests {
            let key = key_of(request);
            let (levels, keys) = self.chain(&key);
            // Shown once it is complete: far from the surface it would be a bound of little use.
            let is_complete = levels.len() > keys.len() || keys.is_empty();
            let old = self.levels.get(&key);
            let same = |old: &&Arc<BrickLevels>| {
                old.all().len() == levels.len() && old.all().iter().zip(&levels).all(|(a, b)| Arc::ptr_eq(a, b))
            };
            let new = match old.filter(same).or(old.filter(|_| !is_complete)) {
                Some(old) => Some(Arc::clone(old)),
                None if is_complete => BrickLevels::new(levels).map(Arc::new),
                None => None,
            };
            all.extend(new.map(|new| (key, new)));
        }
        let is_new = all.len() != self.levels.len()
            || all.iter().any(|(key, new)| self.levels.get(key).is_none_or(|old| !Arc::ptr_eq(old, new)));
        self.levels = all;
        self.revision += u64::from(is_new);
        is_new
    }
}

/// The model of a request.
pub fn pose_of(request: &ModelRequest) -> ModelPose {
    let ModelRequest { path, clip, clip_time, .. } = request;
    let clip = (!clip.is_empty()).then(|| ClipTime { name: clip.clone(), time: *clip_time });
    ModelPose { path: path.clone(), clip }
}

fn key_of(request: &ModelRequest) -> ModelKey {
    ModelKey { pose: pose_of(request), resolution: request.resolution, voxel: request.voxel_size }
}
