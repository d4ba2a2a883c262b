//! The models that a scene names. A job reads them on the first request; they are read again when their files change or
//! the artist requests it. A notice lists the contents of their files that are not drawn.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::{Arc, Weak};

use super::notice::{Notice, NoticeLevel};
use super::prepare::read_models;
use isolith_field::{FlatMesh, FlatScene};
use isolith_jobs::{Job, JobEnd, Jobs, Task};
use isolith_mesh::{MeshLibrary, ModelFileTable, ModelPose, ReloadOutcome, TriangleMesh, Watcher};
use isolith_scene::NodeId;

/// Loads the models and watches their files.
#[derive(Debug, Default)]
pub(super) struct Models {
    library: MeshLibrary,
    /// The job that reads the missing models.
    reading: Option<Reading>,
    /// Started with the first model to watch.
    watcher: Option<Watcher>,
    /// The revision of the library at the last update of the watcher.
    revision: Option<u64>,
    /// The meshes already reported, by path and clip.
    told: HashMap<(String, Option<String>), Weak<TriangleMesh>>,
    /// A node whose model cannot be read, and why.
    problem: Option<(NodeId, String)>,
    notices: Vec<Notice>,
}

#[derive(Debug)]
struct Reading {
    job: Job<MeshLibrary>,
    poses: Vec<ModelPose>,
}

/// Most items in one message about a model.
const THINGS_TOLD: usize = 4;

impl Models {
    pub fn library(&self) -> &MeshLibrary {
        &self.library
    }

    pub fn library_mut(&mut self) -> &mut MeshLibrary {
        &mut self.library
    }

    pub fn problem(&self) -> Option<&(NodeId, String)> {
        self.problem.as_ref()
    }

    /// Whether models are being read for the first time.
    pub fn is_under_way(&self) -> bool {
        self.reading.is_some()
    }

    pub fn take_notices(&mut self) -> Vec<Notice> {
        std::mem::take(&mut self.notices)
    }

    /// Changes the folder; forgets everything if it differs from the old one.
    pub fn set_folder(&mut self, folder: Option<PathBuf>) {
        if self.library.folder() != folder.as_deref() {
            self.reading = None;
            self.library.set_folder(folder);
        }
    }

    /// Changes the files that the scene packs; forgets everything if they differ from the old ones.
    pub fn set_packed(&mut self, packed: &Arc<ModelFileTable>) {
        let before = self.library.revision();
        self.library.set_packed(packed);
        if self.library.revision() != before {
            self.reading = None;
        }
    }

    /// Takes over models that were read elsewhere.
    pub fn take_new(&mut self, library: MeshLibrary) {
        self.library.take_new(library);
    }

    /// Reads all models again, in the background.
    pub fn reload(&self) {
        if let Some(watcher) = &self.watcher {
            watcher.read_all();
        }
    }

    /// Starts reading the models that the arrays name and those that are fields, and takes over the results. Called once a frame. Returns whether
    /// anything is new.
    pub fn follow(&mut self, jobs: &Jobs, flat: &FlatScene, fields: &[ModelPose], is_new: bool) -> bool {
        self.take_reread();
        self.take_read();
        if self.reading.is_none() {
            self.read_missing(jobs, flat, fields);
        }
        let revision = self.library.revision();
        let is_changed = self.revision != Some(revision);
        if is_changed {
            self.revision = Some(revision);
            self.tell_what_is_not_drawn(flat);
            self.watch(jobs);
        }
        if is_changed || is_new {
            self.problem = self.find_problem(flat);
        }
        is_changed
    }

    fn take_reread(&mut self) {
        let news: Vec<_> = self.watcher.iter().flat_map(|watcher| watcher.news().collect::<Vec<_>>()).collect();
        for fresh in news {
            let path = fresh.source().path().to_owned();
            let (level, text) = match self.library.replace(fresh) {
                ReloadOutcome::Fresh(_) => (NoticeLevel::Info, format!("{path} was read again")),
                ReloadOutcome::Kept(error) => (NoticeLevel::Error, format!("{error}. It is shown as it was before")),
                ReloadOutcome::Broken(error) => (NoticeLevel::Error, error.to_string()),
                ReloadOutcome::Unwanted => continue,
            };
            self.notices.push(Notice::new(level, text));
        }
    }

    fn take_read(&mut self) {
        let Some(end) = self.reading.as_ref().and_then(|reading| reading.job.poll()) else { return };
        let Some(Reading { poses, .. }) = self.reading.take() else { return };
        let reason = match end {
            JobEnd::Done(library) => return self.library.take_new(library),
            JobEnd::Failed(reason) => reason,
            JobEnd::Canceled => "reading it was canceled; File, Reload models reads it".into(),
        };
        for pose in poses.iter().filter(|pose| self.library.known(*pose).is_none()).cloned().collect::<Vec<_>>() {
            self.library.refuse(&pose, &reason);
        }
    }

    fn read_missing(&mut self, jobs: &Jobs, flat: &FlatScene, fields: &[ModelPose]) {
        let all = || flat.meshes.iter().map(|mesh| &mesh.model).chain(fields);
        let poses: Vec<ModelPose> = all().filter(|pose| self.library.known(*pose).is_none()).cloned().collect();
        let name = match &*poses {
            [] => return self.library.keep_poses(all()),
            [one] => format!("Reading {}", one.path),
            many => format!("Reading {} models", many.len()),
        };
        let (mut library, wanted) = (self.library.clone(), poses.clone());
        let job = jobs.start(Task::new(name), move |task| {
            read_models(&wanted, &mut library, task, 0.0);
            library
        });
        self.reading = Some(Reading { job, poses });
    }

    /// The nodes whose models cannot be read, and why.
    pub fn problems<'a>(&'a self, flat: &'a FlatScene) -> impl Iterator<Item = (NodeId, String)> + 'a {
        let error = |mesh: &FlatMesh| self.library.known(&mesh.model)?.as_ref().err().map(|e| (mesh.id, e.to_string()));
        flat.meshes.iter().filter_map(error)
    }

    fn find_problem(&self, flat: &FlatScene) -> Option<(NodeId, String)> {
        self.problems(flat).next()
    }

    fn tell_what_is_not_drawn(&mut self, flat: &FlatScene) {
        for FlatMesh { model, .. } in &flat.meshes {
            let (Some(Ok(mesh)), path) = (self.library.known(model), &model.path) else { continue };
            let clip = model.clip.as_ref().map(|clip| clip.name.clone());
            let is_posed = clip.is_some();
            let told = self.told.insert((path.clone(), clip), Arc::downgrade(mesh));
            // Each time of a clip is another mesh of the same file.
            let is_told = told.is_some_and(|told| is_posed || told.as_ptr() == Arc::as_ptr(mesh));
            if is_told || mesh.warnings.is_empty() {
                continue;
            }
            let things = mesh.warnings.iter().take(THINGS_TOLD).map(String::as_str).collect::<Vec<_>>().join("; ");
            let more = mesh.warnings.len().saturating_sub(THINGS_TOLD);
            let more = if more > 0 { format!("; and {more} more") } else { String::new() };
            self.notices.push(Notice::new(NoticeLevel::Warning, format!("{path}: {things}{more}")));
        }
    }

    fn watch(&mut self, jobs: &Jobs) {
        let sources = self.library.sources();
        if self.watcher.is_none() && !sources.is_empty() {
            let jobs = jobs.clone();
            match Watcher::start(move || jobs.wake()) {
                Ok(watcher) => self.watcher = Some(watcher),
                Err(error) => {
                    let text = format!("Models are not looked after: {error}");
                    self.notices.push(Notice::new(NoticeLevel::Warning, text));
                }
            }
        }
        if let Some(watcher) = &self.watcher {
            watcher.watch(sources);
        }
    }
}
