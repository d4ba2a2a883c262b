//! Jobs that read and write files: files to store in nodes, because decoding an image may take a second, and the list
//! of recent files, because a disk may sleep.

use std::path::{Path, PathBuf};
use std::time::Duration;

use super::edit_session::{EditSession, WantedFile, subject};
use super::messages::Message;
use isolith_document::{Edit, RecentFiles};
use isolith_jobs::{Job, JobEnd, Jobs, Task};
use isolith_scene::{Attached, ParamValue, file};

/// The file jobs of the editor and the list of recent files.
#[derive(Default)]
pub struct FileJobs {
    /// Attachments being read.
    attachments: Vec<Attachment>,
    recent: RecentFiles,
    /// Writes the list and returns it with the entries that other windows have added.
    noting: Option<Job<RecentFiles>>,
    /// Files for the next write of the list.
    to_note: Vec<PathBuf>,
}

/// An attachment being read.
struct Attachment {
    wanted: WantedFile,
    /// Display name.
    name: String,
    job: Job<Result<Attached, String>>,
}

/// Delay until the next look for read files during a gesture.
const LATER: Duration = Duration::from_millis(100);

impl FileJobs {
    /// Sets the list of recent files, which persists between runs.
    pub fn set_recent(&mut self, recent: RecentFiles) {
        self.recent = recent;
    }

    /// Recently opened and saved files.
    pub fn recent(&self) -> &RecentFiles {
        &self.recent
    }

    /// The names of the files being read.
    pub fn files_being_read(&self) -> impl Iterator<Item = &str> {
        self.attachments.iter().map(|attachment| &*attachment.name)
    }

    /// Whether any job is running.
    pub fn is_busy(&self) -> bool {
        !self.attachments.is_empty() || self.noting.is_some()
    }

    /// Reads a file for the nodes that request it.
    pub fn read(&mut self, jobs: &Jobs, wanted: WantedFile, path: &Path) {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let (path, instead_of) = (path.to_path_buf(), wanted.instead_of.clone());
        let job = jobs.start(Task::new(format!("Reading {name}")), move |_| read(&path, &instead_of));
        self.attachments.push(Attachment { wanted, name, job });
    }

    /// Drops pending attachments: another document is open.
    pub fn forget_attachments(&mut self) {
        self.attachments.clear();
    }

    /// Puts a file first in the list of recent ones.
    pub fn note_recent(&mut self, jobs: &Jobs, path: &Path) {
        self.to_note.push(path.to_path_buf());
        self.write_recent(jobs);
    }

    fn write_recent(&mut self, jobs: &Jobs) {
        if self.noting.is_some() || self.to_note.is_empty() {
            return;
        }
        let (mut recent, paths) = (self.recent.clone(), std::mem::take(&mut self.to_note));
        self.noting = Some(jobs.start(Task::hidden("Recent files"), move |_| {
            paths.iter().for_each(|path| recent.add(path));
            recent
        }));
    }

    /// Waits until the list is written, at the end of the program.
    pub fn finish(&mut self) {
        if let Some(JobEnd::Done(recent)) = self.noting.take().map(Job::wait) {
            self.recent = recent;
        }
        for path in std::mem::take(&mut self.to_note) {
            self.recent.add(&path);
        }
    }

    /// Stores read files in their nodes. Call once a frame. Returns the delay until the next call if no event comes
    /// earlier.
    pub fn poll(&mut self, jobs: &Jobs, session: &mut EditSession) -> Option<Duration> {
        if let Some(end) = self.noting.as_ref().and_then(Job::poll) {
            self.noting = None;
            if let JobEnd::Done(recent) = end {
                self.recent = recent;
            }
            self.write_recent(jobs);
        }
        if self.attachments.is_empty() {
            return None;
        }
        if session.is_changing() {
            // Attaching now would split the undo step of the gesture.
            return Some(LATER);
        }
        for attachment in std::mem::take(&mut self.attachments) {
            let Attachment { wanted, name, job } = &attachment;
            match job.poll() {
                None => self.attachments.push(attachment),
                Some(JobEnd::Done(Ok(file))) => attach(session, wanted, &file),
                Some(JobEnd::Done(Err(reason))) => refuse(session, wanted, &reason),
                Some(JobEnd::Failed(reason)) => refuse(session, wanted, &format!("{name:?} cannot be read: {reason}")),
                Some(JobEnd::Canceled) => session.messages.push(Message::info(format!("Reading {name} was canceled."))),
            }
        }
        None
    }
}

fn refuse(session: &mut EditSession, wanted: &WantedFile, reason: &str) {
    let subject = wanted.paths.last().and_then(|path| subject(session.document.scene(), path));
    let subject = subject.map_or(String::new(), |subject| format!("{subject}: "));
    session.messages.push(Message::error(format!("{subject}{reason}")));
}

/// Stores the file in the nodes that request it, as one undo step.
fn attach(session: &mut EditSession, wanted: &WantedFile, file: &Attached) {
    session.together(|session| {
        for path in &wanted.paths {
            // Meanwhile the node may be gone or have another shape.
            let now = path.get(session.document.scene());
            if matches!(now, Ok(ParamValue::File(now)) if now.without() == file.without()) {
                session.apply(Edit::SetParam { path: path.clone(), value: ParamValue::File(file.clone()) });
            }
        }
    });
}

fn read(path: &Path, instead_of: &Attached) -> Result<Attached, String> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let bytes = file::attachment(path).map_err(|error| error.to_string())?;
    instead_of.with(&name, bytes)
}
