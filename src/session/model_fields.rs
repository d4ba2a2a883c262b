//! The shapes of a scene that are made of models, and its baked groups, with bricks in voxels of several sizes.

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::Arc;

use super::bricks::{BrickKey, BrickLibrary, BrickSubject};
use super::group_content::{GroupContent, GroupContents};
use super::notice::Notice;
use isolith_bricks::{BrickLevels, Bricks, MAX_BRICK_TEXELS};
use isolith_jobs::{Jobs, Task};
use isolith_mesh::{ClipTime, MeshLibrary, ModelPose};
use isolith_scene::{ModelRequest, NodeId, NodeKind, Scene};

/// The models and baked groups of a scene as fields.
#[derive(Debug)]
pub struct ModelFields {
    library: BrickLibrary,
    groups: GroupContents,
    /// The bricks of each model and group, by those of the finest voxels.
    levels: HashMap<BrickKey, ModelLevels>,
    revision: u64,
    /// Most texels of all bricks together.
    budget: usize,
    is_budget_new: bool,
    /// By how much voxels are larger than asked for, to stay within the budget.
    enlarged: HashMap<BrickKey, u32>,
}

impl Default for ModelFields {
    fn default() -> Self {
        Self {
            library: BrickLibrary::default(),
            groups: GroupContents::default(),
            levels: HashMap::new(),
            revision: 0,
            budget: MAX_BRICK_TEXELS,
            is_budget_new: false,
            enlarged: HashMap::new(),
        }
    }
}

/// The bricks of a model with all that its file says, and without its looks.
#[derive(Clone, Debug)]
struct ModelLevels {
    full: Arc<BrickLevels>,
    plain: Arc<BrickLevels>,
}

impl ModelLevels {
    fn new(finest: &Arc<Bricks>) -> Self {
        let full = Arc::new(BrickLevels::new(finest));
        let plain = if full.has_looks() { Arc::new(full.without_looks()) } else { full.clone() };
        Self { full, plain }
    }
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

    /// Sets how many texels of 16 bytes all bricks together may take; at most [`MAX_BRICK_TEXELS`].
    pub fn set_budget(&mut self, texels: usize) {
        let budget = texels.min(MAX_BRICK_TEXELS);
        self.is_budget_new |= self.budget != budget;
        self.budget = budget;
    }

    /// Most texels of all bricks together.
    pub fn budget(&self) -> usize {
        self.budget
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
        let is_new = self.library.follow(jobs, &self.keys(&wanted), meshes) || std::mem::take(&mut self.is_budget_new);
        is_new && self.assemble(&wanted, scene)
    }

    /// Makes all that is missing at once; false if the task was canceled.
    pub fn make_all(&mut self, scene: &Scene, meshes: &mut MeshLibrary, task: &Task) -> bool {
        self.groups.follow(scene);
        let wanted = self.wanted(scene);
        // What is too large for the budget is known when it is made.
        loop {
            let keys = self.keys(&wanted);
            if !self.library.make_all(&keys, meshes, task) {
                return false;
            }
            self.assemble(&wanted, scene);
            if self.keys(&wanted) == keys {
                return true;
            }
        }
    }

    /// The scene with the bricks of its models and groups, where they are made.
    pub fn filled<'a>(&self, scene: &'a Scene) -> Cow<'a, Scene> {
        if self.levels.is_empty() {
            return Cow::Borrowed(scene);
        }
        let filled = scene.with_bricks(&|request| {
            let ModelLevels { full, plain } = self.levels.get(&key_of(request))?;
            Some(if request.file_materials { full.clone() } else { plain.clone() })
        });
        if self.groups.is_empty() {
            return Cow::Owned(filled);
        }
        let made = self.groups.of(scene).filter_map(|(index, resolution, content)| {
            let key = key_of_group(content.as_ref().ok()?, resolution);
            Some((index, self.levels.get(&key)?.full.clone()))
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

    /// The nodes whose voxels are larger than asked for, and why.
    pub fn reductions<'a>(&'a self, scene: &'a Scene) -> impl Iterator<Item = (NodeId, String)> + 'a {
        let of_groups = self.groups.of(scene).filter_map(|(index, resolution, content)| {
            Some((scene.nodes()[index].id, key_of_group(content.as_ref().ok()?, resolution)))
        });
        let of_models = scene.nodes().iter().filter_map(|node| {
            let NodeKind::Object(object) = &node.kind else { return None };
            Some((node.id, key_of(&object.shape.model_request()?)))
        });
        of_groups.chain(of_models).filter_map(|(id, key)| {
            let (factor, levels) = (self.enlarged.get(&key)?, self.levels.get(&key)?);
            let millimeters = 1e3 * levels.full.finest().voxel();
            let most = self.budget >> 16;
            Some((
                id,
                format!(
                    "is shown in voxels of {millimeters:.2} mm, {factor} times as large as asked for: the bricks of all \
                     models may take {most} MiB"
                ),
            ))
        })
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

    /// What is to be made: what the scene asks for, and what has larger voxels instead.
    fn keys(&self, wanted: &[BrickKey]) -> Vec<BrickKey> {
        let larger = wanted.iter().filter_map(|key| self.larger(key, *self.enlarged.get(key)?));
        wanted.iter().cloned().chain(larger).collect()
    }

    /// The same in voxels that are `factor` times as large. The coarser levels of a model have sheets as thin as its finest,
    /// which would have holes in their voxels.
    fn larger(&self, key: &BrickKey, factor: u32) -> Option<BrickKey> {
        let finest = self.library.nearest(key)?.ok()?;
        let voxel = f64::from(factor) * finest.voxel();
        Some(BrickKey { subject: key.subject.clone(), resolution: 0.0, voxel })
    }

    /// Puts together what was made. Returns whether anything is new.
    #[allow(clippy::mutable_key_type, reason = "the hash of a group is that of its content, made once")]
    fn assemble(&mut self, wanted: &[BrickKey], scene: &Scene) -> bool {
        let mut chains: Vec<Chain> = Vec::new();
        for key in wanted {
            if chains.iter().any(|chain| chain.key == *key) {
                continue;
            }
            let Some(Ok(finest)) = self.library.nearest(key) else { continue };
            let is_group = matches!(key.subject, BrickSubject::Group(_));
            let levels = finest.levels().collect();
            chains.push(Chain { key: key.clone(), levels, skipped: 0, shown: [false, is_group] });
        }
        for request in scene.model_requests() {
            let key = key_of(&request);
            if let Some(chain) = chains.iter_mut().find(|chain| chain.key == key) {
                chain.shown[usize::from(request.file_materials)] = true;
            }
        }
        fit(&mut chains, self.budget);
        let mut all = HashMap::new();
        self.enlarged.clear();
        for Chain { key, levels, skipped, .. } in chains {
            let made = (skipped > 0).then(|| self.library.get(&self.larger(&key, 1 << skipped)?)?.ok()).flatten();
            let finest = made.as_ref().unwrap_or(&levels[skipped]);
            let old = self.levels.get(&key).filter(|old| Arc::ptr_eq(&old.full.all()[0], finest));
            let new = old.cloned().unwrap_or_else(|| ModelLevels::new(finest));
            if skipped > 0 {
                self.enlarged.insert(key.clone(), 1 << skipped);
            }
            all.insert(key, new);
        }
        let is_new = all.len() != self.levels.len()
            || all.iter().any(|(key, new)| self.levels.get(key).is_none_or(|old| !Arc::ptr_eq(&old.full, &new.full)));
        self.levels = all;
        self.revision += u64::from(is_new);
        is_new
    }
}

/// The bricks of a request.
struct Chain {
    key: BrickKey,
    /// The finest first.
    levels: Vec<Arc<Bricks>>,
    /// How many of the finest are left out.
    skipped: usize,
    /// Whether they are shown without looks, and with looks.
    shown: [bool; 2],
}

impl Chain {
    fn texels(&self) -> usize {
        let looks = |bricks: &Bricks| bricks.looks.as_ref().map_or(0, |looks| looks.texels.len());
        let [plain, full] = self.shown.map(usize::from);
        let of = |bricks: &Arc<Bricks>| (plain + full) * bricks.texels.len() + full * looks(bricks);
        self.levels[self.skipped..].iter().map(of).sum()
    }
}

/// Leaves out the finest levels of the largest models until all take no more than `budget` texels, or nothing is left
/// to be left out.
fn fit(chains: &mut [Chain], budget: usize) {
    while chains.iter().map(Chain::texels).sum::<usize>() > budget {
        let can_shrink = |chain: &&mut Chain| chain.skipped + 1 < chain.levels.len();
        let Some(largest) = chains.iter_mut().filter(can_shrink).max_by_key(|chain| chain.texels()) else { return };
        largest.skipped += 1;
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

#[cfg(test)]
mod tests {
    use super::*;
    use isolith_bricks::placeholder;

    fn chain(resolution: f64, file_materials: bool) -> Chain {
        let key = BrickKey { subject: BrickSubject::Model("model.glb".into()), resolution, voxel: 0.0 };
        let shown = [!file_materials, file_materials];
        Chain { key, levels: placeholder().all().to_vec(), skipped: 0, shown }
    }

    #[test]
    fn the_largest_models_lose_their_finest_voxels_until_all_fit() {
        let whole = chain(1.0, true).texels();
        assert!(chain(1.0, true).levels.len() > 1);
        let fitted = |budget: usize| {
            let mut chains = [chain(1.0, true), chain(2.0, false)];
            fit(&mut chains, budget);
            (chains.iter().map(Chain::texels).sum::<usize>(), chains.map(|chain| chain.skipped))
        };
        assert_eq!(fitted(2 * whole), (2 * whole, [0, 0]));
        let (texels, mut skipped) = fitted(2 * whole - 1);
        skipped.sort_unstable();
        assert!(texels < 2 * whole && skipped == [0, 1], "{texels}: {skipped:?}");
        // The coarsest stays, whatever it takes.
        let (texels, skipped) = fitted(0);
        assert!(texels > 0 && skipped.iter().all(|n| *n + 1 == placeholder().all().len()), "{texels}: {skipped:?}");
    }
}
