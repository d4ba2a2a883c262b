//! Jobs that open and save documents.

use std::path::PathBuf;

use super::dialogs::Next;
use isolith_document::Saved;
use isolith_jobs::Job;
use isolith_scene::file::FileError;
use isolith_session::Opened;

/// A document being opened.
pub struct Opening {
    /// The job that reads it.
    pub job: Job<Result<Opened, String>>,
    /// Display name.
    pub name: String,
    /// The file to read; `None` for an example.
    pub path: Option<PathBuf>,
    /// The artist has already agreed to give up the current document.
    pub is_agreed: bool,
}

/// The document being saved.
pub struct Saving {
    /// The job that writes it.
    pub job: Job<SaveAnswer>,
    /// The file to write.
    pub path: PathBuf,
    /// The step after saving.
    pub then: Option<Next>,
}

/// The result of a saving job.
pub enum SaveAnswer {
    /// The file is written, or the reason why not.
    Saved(Result<Saved, FileError>),
    /// Another program has changed the file: nothing is written without the artist's consent.
    ChangedByOthers,
}
