//! The steps of writing a file. Each may fail.

use std::fmt;
use std::io;

/// The steps, in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WriteStep {
    /// Follow links and read the metadata of the existing file.
    Resolve,
    /// Create the temporary file beside it.
    Create,
    /// Write the bytes.
    Write,
    /// Give the temporary the owner and mode of the old file.
    Mode,
    /// Sync the bytes to the disk.
    Sync,
    /// Keep the old contents under another name.
    Backup,
    /// Rename the temporary over the old file.
    Rename,
    /// Sync the folder to the disk.
    SyncFolder,
}

impl WriteStep {
    /// The step, as messages name it.
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

/// Why a file was not written. Unless the last step failed, the file is unchanged.
#[derive(Debug)]
pub struct WriteError {
    /// The step that failed.
    pub step: WriteStep,
    /// The error of the system.
    pub error: io::Error,
}

impl fmt::Display for WriteError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.step.label(), plain(&self.error))
    }
}

impl std::error::Error for WriteError {}

/// Wraps every system call of a write, so that tests can let any of them fail.
pub(super) struct Calls<'a> {
    pub before: &'a mut dyn FnMut(WriteStep) -> io::Result<()>,
}

impl Calls<'_> {
    pub fn call<T>(&mut self, step: WriteStep, work: impl FnOnce() -> io::Result<T>) -> Result<T, WriteError> {
        (self.before)(step).and_then(|()| work()).map_err(|error| WriteError { step, error })
    }
}

/// The message without the system's error number.
pub(super) fn plain(error: &io::Error) -> String {
    let text = error.to_string();
    match text.find(" (os error") {
        Some(end) => text[..end].to_owned(),
        None => text,
    }
}
