//! Files that nodes are to keep are read on threads of their own: decoding an image may take a second.

use std::path::Path;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::Duration;

use egui::Context;

use super::Editor;
use super::edit_session::{WantedFile, subject};
use super::messages::Message;
use crate::document::Edit;
use crate::guard::guarded;
use crate::scene::{Attached, ParamValue, file};

/// A file on its way.
pub struct FileJob {
    wanted: WantedFile,
    /// For people.
    name: String,
    answer: Receiver<Result<Attached, String>>,
}

/// How soon a file that has been read is looked for again while a value is being changed.
const LATER: Duration = Duration::from_millis(100);

impl Editor {
    /// The names of the files that are being read.
    pub fn files_being_read(&self) -> impl Iterator<Item = &str> {
        self.file_jobs.iter().map(|job| &*job.name)
    }

    /// Reads a file for those that want it.
    pub(super) fn read_file(&mut self, wanted: WantedFile, path: &Path, ctx: &Context) {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let (sender, answer) = channel();
        let (ctx, path, instead_of) = (ctx.clone(), path.to_path_buf(), wanted.instead_of.clone());
        let spawned = std::thread::Builder::new().name("file to keep".into()).spawn(move || {
            // The receiver is gone when the document is another one: then nobody waits for the file.
            let _ = sender.send(guarded(|| read(&path, &instead_of)).flatten());
            ctx.request_repaint();
        });
        match spawned {
            Ok(_) => self.file_jobs.push(FileJob { wanted, name, answer }),
            Err(error) => self.refuse(&wanted, &format!("{name:?} cannot be read: {error}")),
        }
    }

    /// Gives files that have been read to their nodes. Once a frame.
    pub(super) fn poll_file_jobs(&mut self, ctx: &Context) {
        if self.file_jobs.is_empty() {
            return;
        }
        if self.session.is_changing() {
            // An undo step would be cut in two.
            ctx.request_repaint_after(LATER);
            return;
        }
        for job in std::mem::take(&mut self.file_jobs) {
            match job.answer.try_recv() {
                Err(TryRecvError::Empty) => self.file_jobs.push(job),
                Err(TryRecvError::Disconnected) => {
                    self.refuse(&job.wanted, &format!("{:?} cannot be read", job.name));
                }
                Ok(Err(reason)) => self.refuse(&job.wanted, &reason),
                Ok(Ok(file)) => self.attach(&job.wanted, &file),
            }
        }
    }

    fn refuse(&mut self, wanted: &WantedFile, reason: &str) {
        let subject = wanted.paths.last().and_then(|path| subject(self.session.document.scene(), path));
        let subject = subject.map_or(String::new(), |subject| format!("{subject}: "));
        self.report(Message::error(format!("{subject}{reason}")));
    }

    /// Gives the file to the nodes that it is wanted for, as one undo step.
    fn attach(&mut self, wanted: &WantedFile, file: &Attached) {
        self.session.together(|session| {
            for path in &wanted.paths {
                // The node may be gone since, or another shape.
                let now = path.get(session.document.scene());
                if matches!(now, Ok(ParamValue::File(now)) if now.without() == file.without()) {
                    session.apply(Edit::SetParam { path: path.clone(), value: ParamValue::File(file.clone()) });
                }
            }
        });
    }
}

fn read(path: &Path, instead_of: &Attached) -> Result<Attached, String> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let bytes = file::attachment(path).map_err(|error| error.to_string())?;
    instead_of.with(&name, bytes)
}
