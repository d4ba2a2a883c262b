//! The models and baked groups of a scene as distance bricks. A job makes the missing ones, one at a time on all cores;
//! those of a changed file are made again while the old ones are shown.

use std::cell::{Cell, RefCell};
use std::collections::HashMap;
use std::hash::{Hash, Hasher};
use std::path::PathBuf;
use std::sync::{Arc, Weak};

use super::brick_cache::BrickCache;
use super::group_content::GroupContent;
use super::notice::{Notice, NoticeLevel};
use isolith_bricks::{BrickError, Bricks, ContentKey};
use isolith_jobs::{Job, JobEnd, Jobs, Task};
use isolith_mesh::{MeshLibrary, ModelPose, TriangleMesh, bricks_key, usual_resolution, voxel_for, voxelized};

/// What bricks are made of.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum BrickSubject {
    /// A model in a pose.
    Model(ModelPose),
    /// The content of a group.
    Group(Arc<GroupContent>),
}

impl BrickSubject {
    /// The name for the user.
    fn name(&self) -> &str {
        match self {
            Self::Model(pose) => &pose.path,
            Self::Group(content) => &content.name,
        }
    }

    /// Whether bricks of the other may be shown while those of this one are made.
    fn is_like(&self, other: &Self) -> bool {
        matches!((self, other), (Self::Model(own), Self::Model(other)) if own.path == other.path)
    }
}

/// What bricks are made of, and the size of their voxels.
#[derive(Clone, Debug, PartialEq)]
pub struct BrickKey {
    /// The model or group.
    pub subject: BrickSubject,
    /// Voxels along the longest side; 0 for the usual number of a model.
    pub resolution: f64,
    /// The size of a voxel in meters, which goes before the resolution; 0 for none.
    pub voxel: f64,
}

// Its numbers are finite.
impl Eq for BrickKey {}

impl Hash for BrickKey {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.subject.hash(state);
        // Equal numbers have equal bits, but for the two zeros.
        [self.resolution, self.voxel].map(|v| (v + 0.0).to_bits()).hash(state);
    }
}

/// Bricks, or the reason for the user why there are none.
pub type BrickResult = Result<Arc<Bricks>, String>;

/// The bricks that a scene needs.
#[derive(Debug, Default)]
pub struct BrickLibrary {
    folder: Option<PathBuf>,
    known: HashMap<BrickKey, KnownBricks>,
    making: Option<Making>,
    revision: u64,
    notices: Vec<Notice>,
    /// Whether a cache that cannot be written was reported.
    is_cache_told: bool,
    /// The meshes whose remarks were reported, by path: the bricks of coarser voxels repeat them.
    told: HashMap<String, Weak<TriangleMesh>>,
}

#[derive(Debug)]
struct KnownBricks {
    /// What they were made of.
    mesh: Weak<TriangleMesh>,
    result: BrickResult,
    is_canceled: bool,
}

#[derive(Debug)]
struct Making {
    key: BrickKey,
    mesh: Weak<TriangleMesh>,
    job: Job<BrickReply>,
}

/// What a maker returns.
#[derive(Debug)]
struct BrickReply {
    result: Result<Arc<Bricks>, BrickError>,
    remarks: Vec<String>,
    /// Why they are in no file.
    unkept: Option<String>,
}

const MAKING_CANCELED: &str = "making its bricks was canceled";

impl BrickLibrary {
    /// A library for scenes in `folder`, beside which its files lie; without one it keeps bricks in memory only.
    pub fn new(folder: Option<PathBuf>) -> Self {
        Self { folder, ..Self::default() }
    }

    /// Changes the folder; forgets everything if it differs from the old one.
    pub fn set_folder(&mut self, folder: Option<PathBuf>) {
        if self.folder != folder {
            *self = Self { revision: self.revision + 1, ..Self::new(folder) };
        }
    }

    /// The bricks of a model or group; `None` while they are being made.
    pub fn get(&self, key: &BrickKey) -> Option<BrickResult> {
        self.known.get(key).map(|known| known.result.clone())
    }

    /// The same; or while they are being made those of the same file in another pose or of another size.
    pub fn nearest(&self, key: &BrickKey) -> Option<BrickResult> {
        let other =
            || self.known.iter().find(|(other, known)| other.subject.is_like(&key.subject) && known.result.is_ok());
        self.get(key).or_else(|| other().map(|(_, known)| known.result.clone()))
    }

    /// Whether bricks are being made.
    pub fn is_under_way(&self) -> bool {
        self.making.is_some()
    }

    /// The messages since the last call.
    pub fn take_notices(&mut self) -> Vec<Notice> {
        std::mem::take(&mut self.notices)
    }

    /// Repeats canceled work.
    pub fn make_again(&mut self) {
        self.known.retain(|_, known| !known.is_canceled);
    }

    /// Starts making what is missing of these, forgets all others, and takes over what was made. The meshes are those
    /// that were read so far; a model is made once it was read, and again once it was read again. Called once a frame.
    /// Returns whether anything is new.
    pub fn follow(&mut self, jobs: &Jobs, keys: &[BrickKey], meshes: &MeshLibrary) -> bool {
        let before = self.revision;
        self.take_made();
        if self.making.as_ref().is_some_and(|making| !keys.contains(&making.key)) {
            self.making = None;
        }
        self.forget_all_but(keys);
        self.take_refusals(keys, meshes);
        if self.making.is_none()
            && let Some((key, source)) = keys.iter().find_map(|key| Some((key, self.missing(key, meshes)?)))
        {
            let task = Task::new(format!("Making bricks of {}", key.subject.name()));
            let (own, cache, mesh) = (key.clone(), BrickCache::new(self.folder.as_deref()), source.mesh());
            let job = jobs.start(task, move |task| make(&source, &own, &cache, task));
            self.making = Some(Making { key: key.clone(), mesh, job });
        }
        self.revision != before
    }

    /// Makes all of these at once, and reads their models before; false if the task was canceled.
    pub fn make_all(&mut self, keys: &[BrickKey], meshes: &mut MeshLibrary, task: &Task) -> bool {
        task.set_stage("bricks");
        let cache = BrickCache::new(self.folder.as_deref());
        for key in keys {
            if let BrickSubject::Model(pose) = &key.subject {
                // The library keeps the errors of those that cannot be read.
                let _ = meshes.get(pose);
            }
            if let Some(source) = self.missing(key, meshes) {
                let reply = make(&source, key, &cache, task);
                self.take(key.clone(), source.mesh(), reply);
            }
            if task.is_canceled() {
                return false;
            }
        }
        self.forget_all_but(keys);
        self.take_refusals(keys, meshes);
        true
    }

    /// What bricks are to be made of, if they are not made of it.
    fn missing(&self, key: &BrickKey, meshes: &MeshLibrary) -> Option<BrickSource> {
        let known = self.known.get(key);
        match &key.subject {
            BrickSubject::Model(pose) => {
                let mesh = meshes.known(pose)?.as_ref().ok()?;
                let is_made = known.is_some_and(|known| known.mesh.as_ptr() == Arc::as_ptr(mesh));
                (!is_made).then(|| BrickSource::Mesh(mesh.clone()))
            }
            BrickSubject::Group(content) => known.is_none().then(|| BrickSource::Group(content.clone())),
        }
    }

    /// Records the errors of models that cannot be read.
    fn take_refusals(&mut self, keys: &[BrickKey], meshes: &MeshLibrary) {
        for key in keys {
            let BrickSubject::Model(pose) = &key.subject else { continue };
            let Some(Err(error)) = meshes.known(pose) else { continue };
            let result = Err(error.to_string());
            if self.get(key).as_ref() != Some(&result) {
                self.known.insert(key.clone(), KnownBricks { mesh: Weak::new(), result, is_canceled: false });
                self.revision += 1;
            }
        }
    }

    /// Forgets what nobody asks for, but for what stands in for bricks that are not made yet.
    fn forget_all_but(&mut self, keys: &[BrickKey]) {
        let count = self.known.len();
        let waits =
            |own: &BrickKey| keys.iter().any(|key| key.subject.is_like(&own.subject) && !self.known.contains_key(key));
        let standing: Vec<BrickKey> = self.known.keys().filter(|key| waits(key)).cloned().collect();
        self.known.retain(|key, _| keys.contains(key) || standing.contains(key));
        self.revision += u64::from(self.known.len() != count);
    }

    fn take_made(&mut self) {
        let Some(end) = self.making.as_ref().and_then(|making| making.job.poll()) else { return };
        let Some(Making { key, mesh, .. }) = self.making.take() else { return };
        let reply = match end {
            JobEnd::Done(reply) => reply,
            JobEnd::Canceled => BrickReply { result: Err(BrickError::Canceled), remarks: Vec::new(), unkept: None },
            JobEnd::Failed(reason) => return self.keep_old_or(key, mesh, reason, false),
        };
        self.take(key, mesh, reply);
    }

    fn take(&mut self, key: BrickKey, mesh: Weak<TriangleMesh>, reply: BrickReply) {
        let path = key.subject.name().to_owned();
        let mut told: Vec<String> = Vec::new();
        if !reply.remarks.is_empty() {
            let before = self.told.insert(path.clone(), mesh.clone());
            if before.is_none_or(|before| !before.ptr_eq(&mesh)) {
                told.extend(reply.remarks.iter().map(|remark| format!("{path} {remark}")));
            }
        }
        if let Some(reason) = reply.unkept.filter(|_| !std::mem::replace(&mut self.is_cache_told, true)) {
            told.push(format!("Bricks of models are kept in memory only: {reason}"));
        }
        self.notices.extend(told.into_iter().map(|text| Notice::new(NoticeLevel::Warning, text)));
        match reply.result {
            Ok(bricks) => {
                self.known.insert(key, KnownBricks { mesh, result: Ok(bricks), is_canceled: false });
                self.revision += 1;
            }
            Err(BrickError::Canceled) => self.keep_old_or(key, mesh, MAKING_CANCELED.into(), true),
            Err(error) => self.keep_old_or(key, mesh, error.to_string(), false),
        }
    }

    /// Keeps bricks of an earlier version of the model, or none for this reason.
    fn keep_old_or(&mut self, key: BrickKey, mesh: Weak<TriangleMesh>, reason: String, is_canceled: bool) {
        let old = self.known.get(&key).and_then(|known| known.result.clone().ok());
        if old.is_some() {
            let text = format!("{} is shown as it was before: {reason}", key.subject.name());
            self.notices.push(Notice::new(NoticeLevel::Warning, text));
        }
        let result = old.ok_or_else(|| format!("{}: {reason}", key.subject.name()));
        self.known.insert(key, KnownBricks { mesh, result, is_canceled });
        self.revision += 1;
    }
}

/// What bricks are made of, read.
enum BrickSource {
    Mesh(Arc<TriangleMesh>),
    Group(Arc<GroupContent>),
}

impl BrickSource {
    fn mesh(&self) -> Weak<TriangleMesh> {
        if let Self::Mesh(mesh) = self { Arc::downgrade(mesh) } else { Weak::new() }
    }
}

/// Reads bricks from the cache, or makes them.
fn make(source: &BrickSource, key: &BrickKey, cache: &BrickCache, task: &Task) -> BrickReply {
    match source {
        BrickSource::Mesh(mesh) => of_mesh(mesh, key, cache, task),
        BrickSource::Group(content) => of_group(content, key, cache, task),
    }
}

fn of_group(content: &GroupContent, key: &BrickKey, cache: &BrickCache, task: &Task) -> BrickReply {
    let (is_known, remarks) = (Cell::new(false), RefCell::new(Vec::new()));
    let known = |content: ContentKey| match cache.load(content) {
        Ok(bricks) => {
            is_known.set(bricks.is_some());
            bricks
        }
        Err(reason) => {
            remarks.borrow_mut().push(format!("is made into bricks again: their file {reason}"));
            None
        }
    };
    let made = content.bricks([key.resolution, key.voxel], &known, task);
    let unkept = match &made {
        Ok((content, bricks)) if !is_known.get() => cache.store(*content, bricks).err(),
        _ => None,
    };
    BrickReply { result: made.map(|(_, bricks)| bricks), remarks: remarks.into_inner(), unkept }
}

fn of_mesh(mesh: &TriangleMesh, key: &BrickKey, cache: &BrickCache, task: &Task) -> BrickReply {
    let resolution = if key.resolution > 0.0 { key.resolution } else { usual_resolution(mesh) };
    let voxel = if key.voxel > 0.0 { key.voxel } else { voxel_for(&mesh.bounds, resolution) };
    let content = bricks_key(mesh, voxel);
    let mut remarks = Vec::new();
    let unkept = mesh.unkept_looks();
    if !unkept.is_empty() {
        remarks.push(format!("is shown as a field without what else its materials have: {}", unkept.join(", ")));
    }
    match cache.load(content) {
        Ok(Some(bricks)) => return BrickReply { result: Ok(Arc::new(bricks)), remarks, unkept: None },
        Ok(None) => {}
        Err(reason) => remarks.push(format!("is made into bricks again: their file {reason}")),
    }
    let mut progress = |share| {
        task.set_progress(share);
        !task.is_canceled()
    };
    match voxelized(mesh, voxel, &mut progress) {
        // Of a model of which there is too much, coarser voxels are better than nothing.
        Err(BrickError::TooLarge { .. }) => {
            let coarser = BrickKey { subject: key.subject.clone(), resolution: 0.0, voxel: 2.0 * voxel };
            let mut reply = of_mesh(mesh, &coarser, cache, task);
            if reply.result.as_ref().is_ok_and(|bricks| bricks.voxel() == 2.0 * voxel) {
                let [asked, given] = [1e3 * voxel, 2e3 * voxel].map(|v| format!("{v:.2} mm"));
                reply
                    .remarks
                    .push(format!("is made of voxels of {given}: in voxels of {asked} it takes too much memory"));
            }
            reply
        }
        Ok(made) => {
            remarks.extend(made.remarks);
            let unkept = cache.store(content, &made.bricks).err();
            BrickReply { result: Ok(made.bricks), remarks, unkept }
        }
        Err(error) => BrickReply { result: Err(error), remarks, unkept: None },
    }
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::Path;
    use std::time::{Duration, Instant};

    use super::*;
    use crate::CACHE_FOLDER;

    const MODEL: &str = "models/suzanne.glb";

    fn key(resolution: f64) -> BrickKey {
        BrickKey { subject: BrickSubject::Model(MODEL.into()), resolution, voxel: 0.0 }
    }

    /// A folder with a model, and both libraries.
    fn scene() -> (tempfile::TempDir, MeshLibrary, BrickLibrary) {
        let folder = tempfile::tempdir().unwrap();
        let (name, scene) = isolith_gallery::all().into_iter().find(|(name, _)| *name == "mesh-and-fields").unwrap();
        isolith_gallery::install(name, &scene, folder.path()).unwrap();
        let meshes = MeshLibrary::new(Some(folder.path().to_path_buf()));
        let bricks = BrickLibrary::new(Some(folder.path().to_path_buf()));
        (folder, meshes, bricks)
    }

    fn wait(bricks: &mut BrickLibrary, jobs: &Jobs, keys: &[BrickKey], meshes: &MeshLibrary) {
        let started = Instant::now();
        while {
            bricks.follow(jobs, keys, meshes);
            bricks.is_under_way()
        } {
            assert!(started.elapsed() < Duration::from_secs(30), "they are never ready");
            std::thread::sleep(Duration::from_millis(2));
        }
    }

    fn cache_file(folder: &Path) -> PathBuf {
        let mut files = fs::read_dir(folder.join(CACHE_FOLDER)).unwrap();
        files.next().unwrap().unwrap().path()
    }

    #[test]
    fn bricks_follow_their_model_and_come_from_the_cache_the_next_time() {
        let (folder, mut meshes, mut bricks) = scene();
        let (jobs, keys) = (Jobs::default(), [key(32.0)]);
        assert!(!bricks.follow(&jobs, &keys, &meshes) && !bricks.is_under_way(), "the model is not read yet");
        meshes.get(MODEL).unwrap();
        bricks.follow(&jobs, &keys, &meshes);
        assert!(bricks.get(&keys[0]).is_none() && bricks.is_under_way());
        assert!(jobs.foremost().unwrap().name().contains(MODEL));
        wait(&mut bricks, &jobs, &keys, &meshes);
        let first = bricks.get(&keys[0]).unwrap().unwrap();
        assert!(first.looks.is_some() && first.check().is_ok());
        // The model's eyes are open shells, which is all there is to say.
        let about_cache = |notice: &Notice| !notice.text.contains("thickness");
        assert!(!bricks.take_notices().iter().any(about_cache));
        // The same from its file; then from a file that is damaged, which is said.
        let path = cache_file(folder.path());
        for is_damaged in [false, true] {
            if is_damaged {
                let mut bytes = fs::read(&path).unwrap();
                bytes[5_000] ^= 4;
                fs::write(&path, bytes).unwrap();
            }
            let mut next = BrickLibrary::new(Some(folder.path().to_path_buf()));
            assert!(next.make_all(&keys, &mut meshes, &Task::new("Making")));
            assert!(next.get(&keys[0]).unwrap().unwrap() == first);
            let notices: Vec<_> = next.take_notices().into_iter().filter(about_cache).collect();
            assert_eq!(notices.len(), usize::from(is_damaged));
            assert!(notices.iter().all(|notice| notice.text.contains("damaged")), "{notices:?}");
        }
        // Another file under the same name: the old ones are shown until the new ones are there.
        let mut other = fs::read(folder.path().join(MODEL)).unwrap();
        let length = |at: usize| u32::from_le_bytes(other[at..at + 4].try_into().unwrap()) as usize;
        let first_vertices = 20 + length(12) + 8;
        other[first_vertices..first_vertices + 1_200].fill(0);
        fs::write(folder.path().join(MODEL), other).unwrap();
        meshes.replace(meshes.sources().remove(0).read());
        bricks.follow(&jobs, &keys, &meshes);
        assert!(Arc::ptr_eq(&bricks.get(&keys[0]).unwrap().unwrap(), &first) && bricks.is_under_way());
        wait(&mut bricks, &jobs, &keys, &meshes);
        assert!(bricks.get(&keys[0]).unwrap().unwrap() != first);
        // What nobody asks for is forgotten.
        assert!(bricks.follow(&jobs, &[], &meshes) && bricks.get(&keys[0]).is_none());
    }

    #[test]
    fn canceled_bricks_are_made_again_on_request_and_refusals_have_reasons() {
        let (folder, mut meshes, mut bricks) = scene();
        let (jobs, keys) = (Jobs::default(), [key(400.0)]);
        meshes.get(MODEL).unwrap();
        bricks.follow(&jobs, &keys, &meshes);
        assert!(jobs.cancel_foremost());
        wait(&mut bricks, &jobs, &keys, &meshes);
        assert!(bricks.get(&keys[0]).unwrap().unwrap_err().contains("canceled"));
        assert!(!bricks.follow(&jobs, &keys, &meshes), "it is not made again by itself");
        bricks.make_again();
        bricks.follow(&jobs, &keys, &meshes);
        assert!(bricks.is_under_way());
        // Too fine, and no such file.
        let fine = [
            BrickKey { voxel: 1e-5, ..key(0.0) },
            BrickKey { subject: BrickSubject::Model("none.glb".into()), ..key(64.0) },
        ];
        assert!(bricks.make_all(&fine, &mut meshes, &Task::new("Making")));
        let reason = |key: &BrickKey| bricks.get(key).unwrap().unwrap_err();
        assert!(reason(&fine[0]).contains("1024") && reason(&fine[0]).contains(MODEL), "{}", reason(&fine[0]));
        assert!(reason(&fine[1]).contains("none.glb"));
        // A folder that cannot be written: the bricks are there, and it is said once.
        fs::write(folder.path().join(CACHE_FOLDER), "no folder").unwrap();
        let mut bricks = BrickLibrary::new(Some(folder.path().to_path_buf()));
        assert!(bricks.make_all(&[key(16.0), key(24.0)], &mut meshes, &Task::new("Making")));
        assert!([16.0, 24.0].iter().all(|n| bricks.get(&key(*n)).unwrap().is_ok()));
        let unkept = |notice: &Notice| notice.text.contains("in memory only");
        assert_eq!(bricks.take_notices().into_iter().filter(unkept).count(), 1);
        let canceled = Task::new("Making");
        canceled.cancel();
        assert!(!bricks.make_all(&[key(32.0)], &mut meshes, &canceled));
    }
}
