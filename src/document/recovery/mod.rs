//! Work that was not saved, got back after a crash, a kill or a power loss.
//!
//! While a document has changes, a worker writes snapshots of it into a folder of its own below the state folder. The
//! folder goes when the document is saved or given up, and at no other time. A lock in it, which dies with the process,
//! tells other windows that its owner lives.
//!
//! | file | holds |
//! |---|---|
//! | `place` | the folder of one document: what lies in it, its lock, who may take it |
//! | `worker` | the thread that writes, and what it shares with the window |
//! | `thumbnail` | small pictures, to know a document by |

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

/// While a value is dragged, snapshots are taken this far apart: each makes the next edit copy the table of nodes.
const BETWEEN_SNAPSHOTS: Duration = Duration::from_millis(500);

/// A document that was lost.
#[derive(Debug)]
pub struct Recovered {
    /// It counts as changed.
    pub document: Document,
    /// What is wrong with its latest snapshot, where an older one had to be taken.
    pub problem: Option<FileError>,
}

/// A document none of whose snapshots can be read.
#[derive(Debug)]
pub struct Unreadable {
    /// It stays where it is.
    pub lost: Lost,
    /// What is wrong with the latest.
    pub error: FileError,
}

/// Keeps what a window changes, and finds what others lost.
pub struct Recovery {
    root: PathBuf,
    shared: Arc<Shared>,
    worker: Option<JoinHandle<()>>,
    /// The number of the document followed; another one after each saving, opening or giving up.
    document: u64,
    /// Its revision at the last snapshot; none when nothing of it has been kept.
    kept: Option<u64>,
    last: Instant,
}

impl Recovery {
    /// Keeps things below this folder, which is made when it is needed.
    pub fn start(root: &Path) -> io::Result<Self> {
        let shared = Arc::new(Shared::new(root));
        let at_work = Arc::clone(&shared);
        let worker = std::thread::Builder::new().name(AUTOSAVE_THREAD.into()).spawn(move || at_work.work())?;
        let document = 0;
        Ok(Self { root: root.to_path_buf(), shared, worker: Some(worker), document, kept: None, last: Instant::now() })
    }

    /// What processes that have died left behind, the latest first. As long as a [`Lost`] is kept, no other window is
    /// offered it.
    pub fn lost(&self) -> Vec<Lost> {
        place::claim_all(&self.root)
    }

    /// Takes a snapshot of the document where it has changed: a copy of a pointer. Once a frame. Returns when it wants to
    /// be called again although nothing happens.
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
        self.shared.offer(Snapshot { document: self.document, revision, scene: document.snapshot(), about });
        None
    }

    /// Whether something of this document is kept.
    pub fn is_keeping(&self) -> bool {
        self.kept.is_some()
    }

    /// Gives a picture of the document, from any thread.
    pub fn picture_taker(&self) -> impl Fn(Thumbnail) + Send + Sync + 'static {
        let (shared, document) = (Arc::clone(&self.shared), self.document);
        move |picture| shared.take_picture(document, picture)
    }

    /// The document is saved, or the artist has given it up: what was kept of it goes.
    pub fn forget(&mut self) {
        self.shared.order(Order::Forget(self.document));
        self.document += 1;
        self.kept = None;
    }

    /// Opens a lost document. What was kept of it stays until it is saved or given up.
    pub fn recover(&mut self, lost: Lost) -> Result<Recovered, Box<Unreadable>> {
        let read = lost.read();
        self.recover_read(lost, read)
    }

    /// The same after [`Lost::read`], which can take long: on another thread.
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

    /// Removes what was kept of a lost document.
    pub fn discard(&self, lost: Lost) {
        self.shared.order(Order::Discard(lost));
    }

    /// What has happened on other threads since the last call.
    pub fn take_notes(&self) -> Vec<Note> {
        self.shared.take_notes()
    }

    /// For the hook that every panic runs through.
    pub fn rescuer(&self) -> Rescuer {
        Rescuer::new(Arc::clone(&self.shared))
    }
}

impl Drop for Recovery {
    /// Has the last snapshot written, and forgets nothing.
    fn drop(&mut self) {
        self.shared.stop();
        if let Some(worker) = self.worker.take() {
            // A panic there has been told.
            let _ = worker.join();
        }
    }
}
