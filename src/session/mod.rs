//! What is derived from a document and kept while it is edited: its arrays, its models, and the jobs that make them. Names no
//! user interface, so that editor, command line, playback and export go the same way.
//!
//! | file | holds |
//! |---|---|
//! | `prepare` | a scene made ready to be drawn, in one go: for opening, and for who draws once |
//! | `open` | a document read and made ready as one job |
//! | `arrays` | the arrays of a document that changes |
//! | `models` | the models that it names, read beside the frames and again when their files change |
//! | `notice` | what a session has to say |

mod arrays;
mod models;
mod notice;
mod open;
mod prepare;

use std::path::PathBuf;
use std::sync::Arc;

use arrays::Arrays;
use models::Models;
pub use notice::{Notice, NoticeLevel};
pub use open::{Opened, ReadDocument, folder_of, read_file};
pub use prepare::PreparedScene;

use isolith_document::Document;
use isolith_field::FlatScene;
use isolith_jobs::{Job, Jobs, Task};
use isolith_mesh::MeshLibrary;
use isolith_scene::NodeId;

/// See the module.
#[derive(Debug, Default)]
pub struct SceneSession {
    jobs: Jobs,
    arrays: Arrays,
    models: Models,
}

impl SceneSession {
    /// Where everything runs that takes longer than a frame.
    pub fn jobs(&self) -> &Jobs {
        &self.jobs
    }

    /// Forgets everything for a document that is not prepared yet, whose models lie in this folder.
    pub fn reset(&mut self, folder: Option<PathBuf>) {
        self.arrays = Arrays::default();
        self.models.set_folder(folder);
    }

    /// Takes over a document that was opened by a job, and returns it.
    pub fn adopt(&mut self, opened: Opened) -> Document {
        let Opened { document, prepared } = opened;
        self.reset(document.path().and_then(folder_of));
        match prepared {
            Ok(PreparedScene { flattener, flat, library }) => {
                self.models.take_new(library);
                self.arrays = Arrays::prepared(flattener, flat, document.revision());
            }
            Err(problem) => self.arrays = Arrays::refused(problem, document.revision()),
        }
        document
    }

    /// Models lie in this folder from now on.
    pub fn set_folder(&mut self, folder: Option<PathBuf>) {
        self.models.set_folder(folder);
    }

    /// Follows the document, and takes over what jobs have made. Once a frame; whether something is new.
    pub fn follow(&mut self, document: &Document) -> bool {
        let has_arrays = self.arrays.follow(&self.jobs, document);
        let has_models = self.models.follow(&self.jobs, self.arrays.scene(), has_arrays);
        has_arrays || has_models
    }

    /// Whether arrays or models of the document are still on their way.
    pub fn is_preparing(&self) -> bool {
        self.arrays.is_under_way() || self.models.is_under_way()
    }

    /// Tries again what was canceled.
    pub fn prepare_again(&mut self) {
        self.arrays.prepare_again();
    }

    /// Whether preparing was canceled, so that what is shown is older than the document.
    pub fn is_canceled(&self) -> bool {
        self.arrays.is_canceled()
    }

    /// The document as arrays; the last good ones where it is beyond a limit or on its way.
    pub fn flat(&self) -> &Arc<FlatScene> {
        self.arrays.scene()
    }

    /// Why the document is not shown as it is.
    pub fn problem(&self) -> Option<&str> {
        self.arrays.problem()
    }

    /// A model that cannot be read, and why.
    pub fn model_problem(&self) -> Option<&(NodeId, String)> {
        self.models.problem()
    }

    /// The models that were read.
    pub fn library(&self) -> &MeshLibrary {
        self.models.library()
    }

    /// The same, to ask it for one that was not.
    pub fn library_mut(&mut self) -> &mut MeshLibrary {
        self.models.library_mut()
    }

    /// Reads all models again, in the background.
    pub fn reload_models(&self) {
        self.models.reload();
    }

    /// What there is to say since the last call.
    pub fn take_notices(&mut self) -> Vec<Notice> {
        self.models.take_notices()
    }

    /// Reads a document and makes it ready, beside what is shown.
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

    /// A ball in rings, so often that flattening it takes longer than a frame.
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
        // What is canceled leaves the arrays of before, and is made when it is asked for again.
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
        // Beyond a limit it opens all the same, and says so.
        let too_many = session.open("rings", Arc::new(|_| Ok(self::document(1_000))));
        let JobEnd::Done(Ok(opened)) = too_many.wait() else { panic!("it opens") };
        let document = session.adopt(opened);
        session.follow(&document);
        assert!(session.problem().is_some() && session.flat().nodes.is_empty());
        // A reader that refuses says why.
        let refused = session.open("rings", Arc::new(|_| Err("no rings".into()))).wait();
        assert!(matches!(refused, JobEnd::Done(Err(reason)) if reason == "no rings"));
    }
}
