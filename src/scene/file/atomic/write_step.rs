//! The steps of writing a file, each of which may fail.

use std::fmt;
use std::io;

/// What writing does, in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WriteStep {
    /// Follow links and look at the file that stands there.
    Resolve,
    /// Make the temporary file beside it.
    Create,
    /// Write the bytes.
    Write,
    /// Give it owner and mode of the old file.
    Mode,
    /// Have them on the disk.
    Sync,
    /// Keep the old contents under another name.
    Backup,
    /// Put the new in the place of the old.
    Rename,
    /// Have the names on the disk.
    SyncFolder,
}

impl WriteStep {
    /// For messages.
    pub fn label(self) -> &'static str {
        match self {
            Self::Resolve => "looking at the file",
            Self::Create => "making a temporary file beside it",
            Self::Write => "writing the temporary file",
            Self::Mode => "giving the temporary file the old one's mode",
            Self::Sync => "flushing to the disk",
            Self::Backup => "keeping the old file as a backup",
            Self::Rename => "replacing the old file",
            Self::SyncFolder => "flushing the folder to the disk",
        }
    }
}

/// Why a file was not written. Unless it is the last step that failed, the file is what it was.
#[derive(Debug)]
pub struct WriteError {
    /// What failed.
    pub step: WriteStep,
    /// What the system says.
    pub error: io::Error,
}

impl fmt::Display for WriteError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.step.label(), plain(&self.error))
    }
}

impl std::error::Error for WriteError {}

/// Every call to the system that writing consists of goes through this. Tests let any of them fail.
pub(super) struct Calls<'a> {
    pub before: &'a mut dyn FnMut(WriteStep) -> io::Result<()>,
}

impl Calls<'_> {
    pub fn call<T>(&mut self, step: WriteStep, work: impl FnOnce() -> io::Result<T>) -> Result<T, WriteError> {
        (self.before)(step).and_then(|()| work()).map_err(|error| WriteError { step, error })
    }
}

/// The message without the number that the system has for it.
pub(super) fn plain(error: &io::Error) -> String {
    let text = error.to_string();
    match text.find(" (os error") {
        Some(end) => text[..end].to_owned(),
        None => text,
    }
}
