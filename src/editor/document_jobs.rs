//! Documents on their way from and to their files.

use std::path::PathBuf;

use super::dialogs::Next;
use isolith_document::Saved;
use isolith_jobs::Job;
use isolith_scene::file::FileError;
use isolith_session::Opened;

/// A document on its way.
pub struct Opening {
    /// See [`isolith_jobs`].
    pub job: Job<Result<Opened, String>>,
    /// For people.
    pub name: String,
    /// The file that it is read from; an example has none.
    pub path: Option<PathBuf>,
    /// The artist has agreed already that what is open is given up.
    pub is_agreed: bool,
}

/// The document on its way to its file.
pub struct Saving {
    /// See [`isolith_jobs`].
    pub job: Job<SaveAnswer>,
    /// Where to.
    pub path: PathBuf,
    /// What is done when it is saved.
    pub then: Option<Next>,
}

/// What came of it.
pub enum SaveAnswer {
    /// It is written, or not for this reason.
    Saved(Result<Saved, FileError>),
    /// Somebody else has changed the file: nothing is written unasked.
    ChangedByOthers,
}
