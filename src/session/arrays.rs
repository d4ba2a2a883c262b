//! The arrays of a changing document. Quick scenes are flattened at once, others by a job, which stops when a newer
//! revision needs flattening.

use std::sync::Arc;

use super::model_fields::ModelFields;
use isolith_document::Document;
use isolith_field::{FlatScene, Flattener, is_quick};
use isolith_jobs::{Job, JobEnd, Jobs, Task};
use isolith_scene::Scene;

/// The flat scene of a revision of the document.
#[derive(Debug, Default)]
pub(super) struct Arrays {
    flattener: Flattener,
    /// The last successful one.
    scene: Arc<FlatScene>,
    /// The revision, the moment and the revision of the fields of models handled last.
    handled: Option<(u64, f64, u64)>,
    problem: Option<String>,
    job: Option<Job<FlattenReply>>,
    is_canceled: bool,
}

/// The result of a job: the flattener, and the flat scene or an error; no scene if the job was canceled.
type FlattenReply = (Flattener, Result<Option<Arc<FlatScene>>, String>);

const CANCELED: &str = "preparing it was canceled";

impl Arrays {
    /// Arrays of this document as it is that were made elsewhere.
    pub fn prepared(flattener: Flattener, scene: Arc<FlatScene>, document: &Document, fields: &ModelFields) -> Self {
        Self { flattener, scene, handled: Some(state_of(document, fields)), ..Self::default() }
    }

    /// No arrays of this document as it is, for this reason.
    pub fn refused(problem: String, document: &Document, fields: &ModelFields) -> Self {
        Self { problem: Some(problem), handled: Some(state_of(document, fields)), ..Self::default() }
    }

    pub fn scene(&self) -> &Arc<FlatScene> {
        &self.scene
    }

    pub fn problem(&self) -> Option<&str> {
        self.problem.as_deref()
    }

    /// Whether a job is running.
    pub fn is_under_way(&self) -> bool {
        self.job.is_some()
    }

    /// Whether the arrays are older than the document because the job was canceled.
    pub fn is_canceled(&self) -> bool {
        self.is_canceled
    }

    /// Flattens the same revision again.
    pub fn prepare_again(&mut self) {
        self.handled = None;
    }

    /// Updates the arrays, or starts a job for it, and takes over the result of a job. Returns whether anything is new.
    pub fn follow(&mut self, jobs: &Jobs, document: &Document, fields: &ModelFields) -> bool {
        let state = state_of(document, fields);
        let is_new = self.handled != Some(state);
        // A step in time waits for the step before it, which would otherwise never be shown.
        let is_step = self.handled.is_some_and(|(revision, ..)| revision == state.0);
        let waits = is_step && self.job.is_some();
        if is_new && !waits {
            self.start(jobs, document, fields);
            self.handled = Some(state);
        }
        self.poll() || (is_new && !waits)
    }

    fn start(&mut self, jobs: &Jobs, document: &Document, fields: &ModelFields) {
        (self.job, self.is_canceled) = (None, false);
        let (scene, time) = (fields.filled(document.resting()), document.time());
        if let Some(flat) = self.flattener.update(&scene, time) {
            self.take(Ok(flat));
        } else if is_quick(&scene) {
            let result = self.flattener.flatten(&scene, time).map_err(|error| error.to_string());
            self.take(result);
        } else {
            let flattener = std::mem::take(&mut self.flattener);
            self.job = Some(flatten_by_job(jobs, Arc::new(scene.into_owned()), time, flattener));
        }
    }

    fn take(&mut self, result: Result<Arc<FlatScene>, String>) {
        match result {
            Ok(flat) => (self.scene, self.problem) = (flat, None),
            Err(problem) => self.problem = Some(problem),
        }
    }

    fn poll(&mut self) -> bool {
        let Some(end) = self.job.as_ref().and_then(Job::poll) else { return false };
        self.job = None;
        let result = match end {
            JobEnd::Done((flattener, result)) => {
                self.flattener = flattener;
                result.transpose().unwrap_or_else(|| Err(CANCELED.into()))
            }
            JobEnd::Failed(reason) => Err(reason),
            JobEnd::Canceled => {
                self.is_canceled = true;
                Err(CANCELED.into())
            }
        };
        self.take(result);
        true
    }
}

/// What the arrays of a document depend on.
fn state_of(document: &Document, fields: &ModelFields) -> (u64, f64, u64) {
    (document.revision(), document.time(), fields.revision())
}

fn flatten_by_job(jobs: &Jobs, scene: Arc<Scene>, time: f64, mut flattener: Flattener) -> Job<FlattenReply> {
    jobs.start(Task::new("Preparing the scene"), move |task| {
        let made = flattener.flatten_until(&scene, time, task.flag()).map_err(|error| error.to_string());
        (flattener, made)
    })
}
