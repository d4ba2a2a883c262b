//! Recovery of unsaved work after a crash, a kill or a power loss.
//!
//! While a document has changes, a worker writes snapshots of it into the document's folder below the state folder. The
//! folder is removed when the document is saved or discarded, and at no other time. A lock in the folder, which dies
//! with the process, tells other windows that its owner is alive.
//!
//! | file | holds |
//! |---|---|
//! | `place` | the folder of one document: its contents, its lock, its owner |
//! | `worker` | the thread that writes, and the state shared with the window |
//! | `thumbnail` | small pictures to recognize a document by |

mod place;
mod thumbnail;
mod worker;

use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

pub use place::{Lost, ReadSnapshot};
pub use thumbnail::Thumbnail;
pub use worker::{AUTOSAVE_THREAD, Note, Rescued, Rescuer};

use super::Document;
use isolith_scene::file::FileError;
use place::About;
use worker::{Order, Shared, Snapshot};

/// Interval of snapshots while a value is dragged: each snapshot makes the next edit copy the table of nodes.
const BETWEEN_SNAPSHOTS: Duration = Duration::from_millis(500);

/// A recovered document.
#[derive(Debug)]
pub struct Recovered {
    /// The document; it counts as changed.
    pub document: Document,
    /// The error in its latest snapshot, if an older one had to be used.
    pub problem: Option<FileError>,
}

/// A lost document without any readable snapshot.
#[derive(Debug)]
pub struct Unreadable {
    /// The lost document; its folder stays.
    pub lost: Lost,
    /// The error in the latest snapshot.
    pub error: FileError,
}

/// Keeps snapshots of the document in a window, and finds lost documents of others.
pub struct Recovery {
    root: PathBuf,
    shared: Arc<Shared>,
    worker: Option<JoinHandle<()>>,
    /// The number of the current document; it changes with each save, open or discard.
    document: u64,
    /// The document's revision at the last snapshot; `None` without a snapshot.
    kept: Option<u64>,
    last: Instant,
}

impl Recovery {
    /// Starts keeping snapshots below this folder, which is created on first use.
    pub fn start(root: &Path) -> io::Result<Self> {
        let shared = Arc::new(Shared::new(root));
        let at_work = Arc::clone(&shared);
        let worker = std::thread::Builder::new().name(AUTOSAVE_THREAD.into()).spawn(move || at_work.work())?;
        let document = 0;
        Ok(Self { root: root.to_path_buf(), shared, worker: Some(worker), document, kept: None, last: Instant::now() })
    }

    /// The lost documents of dead processes, latest first. While a [`Lost`] is alive, no other window is offered it.
    pub fn lost(&self) -> Vec<Lost> {
        place::claim_all(&self.root)
    }

    /// Takes a snapshot of the document if it has changed: a copy of a pointer. Called once a frame. Returns the time
    /// after which it wants a call even without events.
    pub fn follow(&mut self, document: &Document, is_changing: bool) -> Option<Duration> {
        let revision = document.revision();
        let is_known = match self.kept {
            Some(kept) => kept == revision,
            None => !document.is_changed(),
        };
        if is_known {
            return None;
        }
        let since = self.last.elapsed();
        if is_changing && since < BETWEEN_SNAPSHOTS {
            return Some(BETWEEN_SNAPSHOTS - since);
        }
        (self.kept, self.last) = (Some(revision), Instant::now());
        let about = About::of(document);
        self.shared.offer(Snapshot { document: self.document, revision, scene: Arc::clone(document.resting()), about });
        None
    }

    /// Whether a snapshot of this document exists.
    pub fn is_keeping(&self) -> bool {
        self.kept.is_some()
    }

    /// A function that stores a picture of the document, callable from any thread.
    pub fn picture_taker(&self) -> impl Fn(Thumbnail) + Send + Sync + 'static {
        let (shared, document) = (Arc::clone(&self.shared), self.document);
        move |picture| shared.take_picture(document, picture)
    }

    /// Removes the snapshots of the document after it was saved or discarded.
    pub fn forget(&mut self) {
        self.shared.order(Order::Forget(self.document));
        self.document += 1;
        self.kept = None;
    }

    /// Opens a lost document. Its snapshots stay until it is saved or discarded.
    pub fn recover(&mut self, lost: Lost) -> Result<Recovered, Box<Unreadable>> {
        let read = lost.read();
        self.recover_read(lost, read)
    }

    /// Like [`Self::recover`], after [`Lost::read`], which can take long and may run on another thread.
    pub fn recover_read(&mut self, lost: Lost, read: ReadSnapshot) -> Result<Recovered, Box<Unreadable>> {
        let (scene, problem) = match read {
            Ok(read) => read,
            Err(error) => return Err(Box::new(Unreadable { lost, error })),
        };
        let document = Document::recovered(scene, lost.path(), lost.stamp());
        self.shared.order(Order::Adopt(self.document, lost));
        self.kept = Some(document.revision());
        Ok(Recovered { document, problem })
    }

    /// Removes the snapshots of a lost document.
    pub fn discard(&self, lost: Lost) {
        self.shared.order(Order::Discard(lost));
    }

    /// The notes from other threads since the last call.
    pub fn take_notes(&self) -> Vec<Note> {
        self.shared.take_notes()
    }

    /// The rescuer for the panic hook.
    pub fn rescuer(&self) -> Rescuer {
        Rescuer::new(Arc::clone(&self.shared))
    }
}

impl Drop for Recovery {
    /// Lets the worker write the last snapshot, and removes nothing.
    fn drop(&mut self) {
        self.shared.stop();
        if let Some(worker) = self.worker.take() {
            // The hook has reported a panic of the worker already.
            let _ = worker.join();
        }
    }
}
