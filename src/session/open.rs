//! A document read and prepared by one job: the current one stays until the next is complete.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::prepare::PreparedScene;
use isolith_document::Document;
use isolith_jobs::{Canceled, Task};

/// Reads a document. The error is a reason for the user.
pub type ReadDocument = Arc<dyn Fn(&Task) -> Result<Document, String> + Send + Sync>;

/// Reads the document in this file.
pub fn read_file(path: &Path) -> ReadDocument {
    let path = path.to_path_buf();
    Arc::new(move |task| Document::open_by(&path, task).map_err(|error| error.to_string()))
}

/// The folder of a scene's file; the current one for a bare name.
pub fn folder_of(file: &Path) -> Option<PathBuf> {
    file.parent().map(|folder| if folder.as_os_str().is_empty() { PathBuf::from(".") } else { folder.to_path_buf() })
}

/// A document that is ready to be shown.
#[derive(Debug)]
pub struct Opened {
    /// The document.
    pub document: Document,
    /// The prepared scene, or the reason why there is none: a scene beyond a limit can still be edited.
    pub(super) prepared: Result<PreparedScene, String>,
}

impl Opened {
    /// Reads and prepares the document.
    ///
    /// # Errors
    /// The document cannot be read, or the task was canceled.
    pub fn by(read: &ReadDocument, task: &Task) -> Result<Self, String> {
        task.set_stage("reading");
        Self::of(read(task)?, task)
    }

    /// Prepares the document.
    ///
    /// # Errors
    /// The task was canceled.
    pub fn of(document: Document, task: &Task) -> Result<Self, String> {
        let folder = document.path().and_then(folder_of);
        let prepared = PreparedScene::without_fields(document.resting(), document.time(), folder, task)
            .map_err(|error| error.to_string());
        let prepared = prepared.transpose().ok_or_else(|| Canceled.to_string())?;
        Ok(Self { document, prepared })
    }
}
