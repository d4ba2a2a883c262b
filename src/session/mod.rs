//! A session: data derived from a document while it is edited. These are its arrays, its models, and the jobs that make
//! them. It names no user interface, so that editor, command line, playback and export share it.
//!
//! | file | holds |
//! |---|---|
//! | `prepare` | a scene prepared for drawing, in one call: for opening, and for a single picture |
//! | `open` | a document read and prepared by one job |
//! | `arrays` | the arrays of a changing document |
//! | `models` | the models that it names, read in the background and again when their files change |
//! | `bricks` | models as distance bricks, made in the background |
//! | `brick_cache` | their files |
//! | `group_content` | what groups hold that are drawn from bricks |
//! | `model_fields` | the shapes that are made of them |
//! | `packing` | the files of models within a scene, and beside it again |
//! | `notice` | messages of a session |
//! | `render_order`, `frames` | orders to render pictures into files, by a dialog or from the command line |
//! | `scene_cost` | what a picture takes, as measured |
//! | `studio` | what a renderer does for a user interface beside the frames |

mod arrays;
mod brick_cache;
mod bricks;
mod frames;
mod group_content;
mod model_fields;
mod models;
mod notice;
mod open;
mod packing;
mod prepare;
mod render_order;
mod scene_cost;
mod studio;

use std::borrow::Cow;
use std::path::PathBuf;
use std::sync::Arc;

use arrays::Arrays;
pub use brick_cache::CACHE_FOLDER;
pub use frames::{FrameRange, numbered, parse_fps};
pub use model_fields::{ModelFields, pose_of};
use models::Models;
pub use notice::{Notice, NoticeLevel};
pub use open::{Opened, ReadDocument, folder_of, read_file};
pub use packing::{bring, has_unpacked, pack, unpack};
pub use prepare::{PreparedScene, library_of};
pub use render_order::{
    DEFAULT_SAMPLES, DEFAULT_SIZE, MAX_SAMPLES, MAX_SIDE, Moments, RenderOrder, RenderSettings, check_size, ending,
};
pub use scene_cost::{MeasuredView, NodeCost, PassCost, SceneCost};
pub use studio::{RenderRefusal, RenderReport, SharedStudio, StillPreview, Studio};

use isolith_document::Document;
use isolith_field::FlatScene;
use isolith_jobs::{Job, Jobs, Task};
use isolith_mesh::{MeshLibrary, ModelPose};
use isolith_scene::{NodeId, Scene};

/// The session of one document; see the module.
#[derive(Debug, Default)]
pub struct SceneSession {
    jobs: Jobs,
    arrays: Arrays,
    models: Models,
    fields: ModelFields,
}

impl SceneSession {
    /// The jobs for all work that takes longer than a frame.
    pub fn jobs(&self) -> &Jobs {
        &self.jobs
    }

    /// Forgets everything, for a document that is not prepared yet; its models lie in this folder.
    pub fn reset(&mut self, folder: Option<PathBuf>) {
        self.arrays = Arrays::default();
        self.fields.set_folder(folder.clone());
        self.models.set_folder(folder);
    }

    /// Takes over a document that a job has opened, and returns it.
    pub fn adopt(&mut self, opened: Opened) -> Document {
        let Opened { document, prepared } = opened;
        self.reset(document.path().and_then(folder_of));
        self.models.set_packed(document.resting().packed.table());
        match prepared {
            Ok(PreparedScene { flattener, flat, library, .. }) => {
                self.models.take_new(library);
                self.arrays = Arrays::prepared(flattener, flat, &document, &self.fields);
            }
            Err(problem) => self.arrays = Arrays::refused(problem, &document, &self.fields),
        }
        document
    }

    /// Sets the folder of the models.
    pub fn set_folder(&mut self, folder: Option<PathBuf>) {
        self.fields.set_folder(folder.clone());
        self.models.set_folder(folder);
    }

    /// Follows the document, and takes over the results of jobs. Called once a frame. Returns whether anything is new.
    pub fn follow(&mut self, document: &Document) -> bool {
        self.models.set_packed(document.resting().packed.table());
        let requests = document.resting().model_requests();
        self.fields.follow(&self.jobs, document.resting(), self.models.library());
        let has_arrays = self.arrays.follow(&self.jobs, document, &self.fields);
        let poses: Vec<ModelPose> = requests.iter().map(pose_of).collect();
        let has_models = self.models.follow(&self.jobs, self.arrays.scene(), &poses, has_arrays);
        has_arrays || has_models
    }

    /// Whether arrays or models of the document are being prepared.
    pub fn is_preparing(&self) -> bool {
        self.arrays.is_under_way() || self.models.is_under_way() || self.fields.is_under_way()
    }

    /// Repeats canceled work.
    pub fn prepare_again(&mut self) {
        self.arrays.prepare_again();
        self.fields.make_again();
    }

    /// Whether preparing was canceled, so that the arrays are older than the document.
    pub fn is_canceled(&self) -> bool {
        self.arrays.is_canceled()
    }

    /// The arrays of the document; the last good ones if the document exceeds a limit or is being prepared.
    pub fn flat(&self) -> &Arc<FlatScene> {
        self.arrays.scene()
    }

    /// Why the arrays do not show the current document.
    pub fn problem(&self) -> Option<&str> {
        self.arrays.problem()
    }

    /// A node whose model cannot be read, and why.
    pub fn model_problem(&self) -> Option<&(NodeId, String)> {
        self.models.problem()
    }

    /// The nodes whose models cannot be read, and why.
    pub fn model_problems(&self) -> impl Iterator<Item = (NodeId, String)> + '_ {
        self.models.problems(self.flat())
    }

    /// Sets how many MiB the bricks of all models together may take.
    pub fn set_brick_budget(&mut self, mebibytes: u32) {
        self.fields.set_budget((mebibytes as usize) << 16);
    }

    /// How many that are.
    pub fn brick_budget(&self) -> usize {
        self.fields.budget() >> 16
    }

    /// A node whose model cannot be a field as it should be, and why.
    pub fn field_problem(&self, document: &Document) -> Option<(NodeId, String)> {
        self.fields.problems(document.resting()).next().or_else(|| self.fields.reductions(document.resting()).next())
    }

    /// A scene with the bricks of its models, where they are made.
    pub fn filled<'a>(&self, scene: &'a Scene) -> Cow<'a, Scene> {
        self.fields.filled(scene)
    }

    /// The library of models.
    pub fn library(&self) -> &MeshLibrary {
        self.models.library()
    }

    /// The library, to request further models.
    pub fn library_mut(&mut self) -> &mut MeshLibrary {
        self.models.library_mut()
    }

    /// Reads all models again, in the background.
    pub fn reload_models(&self) {
        self.models.reload();
    }

    /// The messages since the last call.
    pub fn take_notices(&mut self) -> Vec<Notice> {
        let mut notices = self.models.take_notices();
        notices.extend(self.fields.take_notices());
        notices
    }

    /// Starts a job that reads and prepares a document while the current one stays.
    pub fn open(&self, name: &str, read: ReadDocument) -> Job<Result<Opened, String>> {
        self.jobs.start(Task::new(format!("Opening {name}")), move |task| Opened::by(&read, task))
    }
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use super::*;
    use isolith_document::Edit;
    use isolith_field::flatten;
    use isolith_jobs::JobEnd;
    use isolith_scene::{Modifier, Node, NodeKind, Object, Scene, ShapeKind};

    /// A ball in many rings: flattening it takes longer than a frame.
    fn rings(count: u32) -> Node {
        let around = |count| Modifier::Polar { count, radius: 9.0, mirrored: false };
        let material = Scene::new().materials()[0].id;
        let ball = Object { shape: ShapeKind::Sphere.default_shape(), material };
        Node::new("Rings", NodeKind::Object(ball)).modified(around(512)).modified(around(count))
    }

    fn document(count: u32) -> Document {
        let mut scene = Scene::new();
        scene.insert(None, 0, rings(count)).unwrap();
        Document::new(scene)
    }

    fn wait(session: &mut SceneSession, document: &Document) {
        let started = Instant::now();
        while session.is_preparing() {
            assert!(started.elapsed() < Duration::from_secs(20), "it is never ready");
            std::thread::sleep(Duration::from_millis(1));
            session.follow(document);
        }
    }

    #[test]
    fn a_session_follows_a_document_beside_whoever_holds_it() {
        let mut session = SceneSession::default();
        let mut document = document(100);
        assert!(session.follow(&document) && session.is_preparing());
        assert!(session.flat().nodes.is_empty(), "nobody has waited");
        wait(&mut session, &document);
        assert_eq!(**session.flat(), flatten(document.scene(), 0.0).unwrap());
        assert!(!session.follow(&document), "nothing is new");
        // A canceled job leaves the old arrays, and a new request makes the new ones.
        let node = document.scene().nodes()[0].id;
        document.apply(Edit::Replace(Node { id: node, ..rings(99) })).unwrap();
        let before = Arc::clone(session.flat());
        session.follow(&document);
        assert!(session.jobs().cancel_foremost());
        assert!(session.follow(&document) && !session.is_preparing());
        assert!(session.is_canceled() && session.problem().is_some_and(|problem| problem.contains("canceled")));
        assert!(Arc::ptr_eq(session.flat(), &before));
        session.prepare_again();
        session.follow(&document);
        wait(&mut session, &document);
        assert_eq!((session.problem(), session.is_canceled()), (None, false));
        assert_eq!(**session.flat(), flatten(document.scene(), 0.0).unwrap());
    }

    #[test]
    fn a_document_that_was_opened_by_a_job_is_ready_at_once() {
        let mut session = SceneSession::default();
        let job = session.open("rings", Arc::new(|_| Ok(document(100))));
        let JobEnd::Done(Ok(opened)) = job.wait() else { panic!("it opens") };
        let document = session.adopt(opened);
        assert_eq!(**session.flat(), flatten(document.scene(), 0.0).unwrap());
        session.follow(&document);
        assert!(!session.is_preparing(), "nothing is left to make");
        // A scene beyond a limit opens nonetheless, and reports the limit.
        let too_many = session.open("rings", Arc::new(|_| Ok(self::document(1_000))));
        let JobEnd::Done(Ok(opened)) = too_many.wait() else { panic!("it opens") };
        let document = session.adopt(opened);
        session.follow(&document);
        assert!(session.problem().is_some() && session.flat().nodes.is_empty());
        // A reader that refuses reports its reason.
        let refused = session.open("rings", Arc::new(|_| Err("no rings".into()))).wait();
        assert!(matches!(refused, JobEnd::Done(Err(reason)) if reason == "no rings"));
    }
}
