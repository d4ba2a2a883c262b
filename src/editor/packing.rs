//! Packs the models of a scene into it, and writes them beside it again; both in a job.

use std::path::PathBuf;
use std::sync::Arc;

use super::edit_session::EditSession;
use super::messages::Message;
use isolith_document::Edit;
use isolith_jobs::{Job, JobEnd, Jobs, Task};
use isolith_scene::PackedFiles;
use isolith_session::{folder_of, pack, unpack};

/// The job that packs or unpacks the open scene.
#[derive(Default)]
pub struct Packing {
    running: Option<(PackingKind, Job<Result<PackedFiles, String>>)>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum PackingKind {
    Pack,
    Unpack,
}

impl Packing {
    /// Whether it is at work.
    pub fn is_busy(&self) -> bool {
        self.running.is_some()
    }

    /// Forgets the job: another document is open.
    pub fn forget(&mut self) {
        self.running = None;
    }

    /// Reads the models of the scene, to store them in it.
    pub fn pack(&mut self, jobs: &Jobs, session: &EditSession) {
        let (scene, folder) = (Arc::clone(session.document.resting()), folder(session));
        let job = jobs.start(Task::new("Packing files"), move |task| pack(&scene, folder.as_deref(), task));
        self.running = Some((PackingKind::Pack, job));
    }

    /// Writes the packed files beside the scene.
    pub fn unpack(&mut self, jobs: &Jobs, session: &EditSession) {
        let Some(folder) = folder(session) else { return };
        let scene = Arc::clone(session.document.resting());
        let job = jobs.start(Task::new("Unpacking files"), move |task| {
            unpack(&scene, &folder, task).map(|_| PackedFiles::default())
        });
        self.running = Some((PackingKind::Unpack, job));
    }

    /// Takes over the result, as one step of undo, once no gesture is under way. Call once a frame.
    pub fn poll(&mut self, session: &mut EditSession) {
        if session.is_changing() {
            return;
        }
        let Some((kind, end)) = self.running.as_ref().and_then(|(kind, job)| Some((*kind, job.poll()?))) else {
            return;
        };
        self.running = None;
        let verb = if kind == PackingKind::Pack { "packed" } else { "unpacked" };
        let failed = |reason: String| Message::error(format!("The files are not {verb}: {reason}"));
        let message = match end {
            JobEnd::Done(Ok(files)) => take(session, kind, files),
            JobEnd::Done(Err(reason)) | JobEnd::Failed(reason) => failed(reason),
            JobEnd::Canceled => Message::info("It was canceled."),
        };
        session.messages.push(message);
    }
}

fn take(session: &mut EditSession, kind: PackingKind, files: PackedFiles) -> Message {
    let before = session.document.resting().packed.table().len();
    let text = match kind {
        PackingKind::Pack => {
            let (count, size) = (files.table().len(), files.size() as f64 / f64::from(1 << 20));
            format!("{count} files of models are packed, {size:.1} MiB. The scene opens anywhere once it is saved.")
        }
        PackingKind::Unpack => {
            format!("{before} files of models are beside the scene again. Save it to take them out.")
        }
    };
    session.apply(Edit::SetPacked(files));
    Message::info(text)
}

fn folder(session: &EditSession) -> Option<PathBuf> {
    session.document.path().and_then(folder_of)
}
