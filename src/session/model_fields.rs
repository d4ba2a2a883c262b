//! The shapes of a scene that are made of models, and its baked groups, with bricks in voxels of several sizes.

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::Arc;

use super::bricks::{BrickKey, BrickLibrary, BrickSubject};
use super::group_content::{GroupContent, GroupContents};
use super::notice::Notice;
use isolith_bricks::BrickLevels;
use isolith_jobs::{Jobs, Task};
use isolith_mesh::{ClipTime, MeshLibrary, ModelPose};
use isolith_scene::{ModelRequest, NodeId, NodeKind, Scene};

/// The models and baked groups of a scene as fields.
#[derive(Debug, Default)]
pub struct ModelFields {
    library: BrickLibrary,
    groups: GroupContents,
    /// The bricks of each model and group, by those of the finest voxels.
    levels: HashMap<BrickKey, Arc<BrickLevels>>,
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
    pub fn follow(&mut self, jobs: &Jobs, scene: &Scene, meshes: &MeshLibrary) -> bool {
        self.groups.follow(scene);
        let wanted = self.wanted(scene);
        let is_new = self.library.follow(jobs, &self.keys(&wanted), meshes);
        is_new && self.assemble(&wanted)
    }

    /// Makes all that is missing at once; false if the task was canceled.
    pub fn make_all(&mut self, scene: &Scene, meshes: &mut MeshLibrary, task: &Task) -> bool {
        self.groups.follow(scene);
        let wanted = self.wanted(scene);
        let mut keys = self.keys(&wanted);
        loop {
            if !self.library.make_all(&keys, meshes, task) {
                return false;
            }
            let more = self.keys(&wanted);
            if more == keys {
                self.assemble(&wanted);
                return true;
            }
            keys = more;
        }
    }

    /// The scene with the bricks of its models and groups, where they are made.
    pub fn filled<'a>(&self, scene: &'a Scene) -> Cow<'a, Scene> {
        if self.levels.is_empty() {
            return Cow::Borrowed(scene);
        }
        let filled = scene.with_bricks(&|request| self.levels.get(&key_of(request)).cloned());
        if self.groups.is_empty() {
            return Cow::Owned(filled);
        }
        let made = self.groups.of(scene).filter_map(|(index, resolution, content)| {
            let key = key_of_group(content.as_ref().ok()?, resolution);
            Some((index, self.levels.get(&key)?.clone()))
        });
        Cow::Owned(filled.with_baked(&made.collect()))
    }

    /// The nodes whose bricks cannot be made, why, and what is shown instead.
    pub fn problems<'a>(&'a self, scene: &'a Scene) -> impl Iterator<Item = (NodeId, String)> + 'a {
        let groups = self.groups.of(scene).filter_map(|(index, resolution, content)| {
            let reason = match content {
                Ok(content) => self.library.get(&key_of_group(content, resolution))?.err()?,
                Err(reason) => reason.clone(),
            };
            Some((scene.nodes()[index].id, format!("is not baked: {reason}")))
        });
        groups.chain(scene.nodes().iter().filter_map(|node| {
            let NodeKind::Object(object) = &node.kind else { return None };
            let key = key_of(&object.shape.model_request()?);
            let reason = self.library.get(&key)?.err()?;
            Some((node.id, format!("is shown as a placeholder: {reason}")))
        }))
    }

    /// The finest bricks that a scene asks for.
    fn wanted(&self, scene: &Scene) -> Vec<BrickKey> {
        let mut keys: Vec<BrickKey> = scene.model_requests().iter().map(key_of).collect();
        for (_, resolution, content) in self.groups.of(scene) {
            let key = content.as_ref().ok().map(|content| key_of_group(content, resolution));
            keys.extend(key.filter(|key| !keys.contains(key)));
        }
        keys
    }

    /// What is to be made: the finest voxels of each, and behind them the next larger ones of those that are made.
    fn keys(&self, wanted: &[BrickKey]) -> Vec<BrickKey> {
        let mut keys = wanted.to_vec();
        for key in wanted {
            keys.extend(self.chain(key).1);
        }
        keys
    }

    /// The bricks that are made so far, the finest first, and the keys of all but those.
    fn chain(&self, finest: &BrickKey) -> (Vec<Arc<isolith_bricks::Bricks>>, Vec<BrickKey>) {
        let (mut levels, mut keys) = (Vec::new(), Vec::new());
        let mut next = self.library.nearest(finest).and_then(Result::ok);
        while let Some(bricks) = next.take() {
            levels.push(bricks);
            let Some(voxel) = BrickLevels::coarser(&levels[levels.len() - 1], levels.len()) else { break };
            let key = BrickKey { subject: finest.subject.clone(), resolution: 0.0, voxel };
            next = self.library.get(&key).and_then(Result::ok);
            keys.push(key);
        }
        (levels, keys)
    }

    /// Puts together what was made. Returns whether anything is new.
    fn assemble(&mut self, wanted: &[BrickKey]) -> bool {
        let mut all = HashMap::new();
        for key in wanted {
            let (levels, keys) = self.chain(key);
            // Shown once it is complete: far from the surface it would be a bound of little use.
            let is_complete = levels.len() > keys.len() || keys.is_empty();
            let old = self.levels.get(key);
            let same = |old: &&Arc<BrickLevels>| {
                old.all().len() == levels.len() && old.all().iter().zip(&levels).all(|(a, b)| Arc::ptr_eq(a, b))
            };
            let new = match old.filter(same).or(old.filter(|_| !is_complete)) {
                Some(old) => Some(Arc::clone(old)),
                None if is_complete => BrickLevels::new(levels).map(Arc::new),
                None => None,
            };
            all.extend(new.map(|new| (key.clone(), new)));
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

fn key_of_group(content: &Arc<GroupContent>, resolution: f64) -> BrickKey {
    BrickKey { subject: BrickSubject::Group(content.clone()), resolution, voxel: 0.0 }
}

fn key_of(request: &ModelRequest) -> BrickKey {
    BrickKey {
        subject: BrickSubject::Model(pose_of(request)),
        resolution: request.resolution,
        voxel: request.voxel_size,
    }
}
