//! Models from outside of the scene's folder: copied below it by a job, then used.

use std::path::Path;

use super::edit_session::EditSession;
use super::messages::Message;
use isolith_jobs::{Job, JobEnd, Jobs, Task};
use isolith_session::{bring, folder_of};

/// What a model is wanted for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ModelUse {
    /// A new mesh of this name.
    Add(String),
    /// In place of the model with this path.
    Relink(String),
}

/// The copy under way.
#[derive(Default)]
pub struct Bringing {
    running: Option<(ModelUse, Job<Result<String, String>>)>,
}

impl Bringing {
    /// Whether it is at work.
    pub fn is_busy(&self) -> bool {
        self.running.is_some()
    }

    /// Forgets the job: another document is open.
    pub fn forget(&mut self) {
        self.running = None;
    }

    /// Starts to copy a model below the folder of the scene.
    pub fn start(&mut self, jobs: &Jobs, session: &EditSession, model: &Path, wanted: ModelUse) {
        let Some(folder) = session.document.path().and_then(folder_of) else { return };
        let (model, name) = (model.to_path_buf(), model.file_name().unwrap_or_default().to_string_lossy().into_owned());
        let job = jobs.start(Task::new(format!("Copying {name}")), move |task| bring(&model, &folder, task));
        self.running = Some((wanted, job));
    }

    /// What is to be done with a model, and its path from the scene's folder, once it is there. Call once a frame.
    pub fn poll(&mut self, session: &mut EditSession) -> Option<(ModelUse, String)> {
        if session.is_changing() {
            return None;
        }
        let end = self.running.as_ref()?.1.poll()?;
        let (wanted, _) = self.running.take()?;
        let message = match end {
            JobEnd::Done(Ok(path)) => {
                session.messages.push(Message::info(format!("Copied into the scene's folder: {path}")));
                return Some((wanted, path));
            }
            JobEnd::Done(Err(reason)) | JobEnd::Failed(reason) => {
                Message::error(format!("The model is not copied into the scene's folder: {reason}"))
            }
            JobEnd::Canceled => Message::info("It was canceled."),
        };
        session.messages.push(message);
        None
    }
}
