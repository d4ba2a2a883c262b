//! The thread that writes snapshots, and the state that it shares with the window.

use std::collections::VecDeque;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, TryLockError};
use std::time::{Duration, Instant};

use super::place::{About, Lost, Place};
use super::thumbnail::Thumbnail;
use isolith_scene::Scene;

/// The name of the thread.
pub const AUTOSAVE_THREAD: &str = "autosave";
/// Shortest and longest pause after a snapshot; within these, the pause is as long as the write took. With
/// [`super::BETWEEN_SNAPSHOTS`] and two writes this stays below five seconds if a write takes up to one second. 10 000
/// nodes take 0.05 s in a debug build.
const PAUSE: [Duration; 2] = [Duration::from_millis(1_000), Duration::from_millis(2_500)];
/// Pause after a failure.
const BEFORE_NEXT_TRY: Duration = Duration::from_secs(5);
/// How long a panic waits for a snapshot that is being written.
const RESCUE_WAITS: Duration = Duration::from_secs(2);
/// Most notes that can wait for the window.
const MAX_NOTES: usize = 32;

/// The state of a document at one moment.
#[derive(Clone, Debug)]
pub(super) struct Snapshot {
    pub document: u64,
    pub revision: u64,
    pub scene: Arc<Scene>,
    pub about: About,
}

/// An order to the worker.
pub(super) enum Order {
    /// The document of this number was saved or discarded: remove its folder.
    Forget(u64),
    /// The document of this number continues this lost one: take over its folder.
    Adopt(u64, Lost),
    /// The artist discarded this lost document: remove its folder.
    Discard(Lost),
}

/// A warning for the artist.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Note {
    /// Snapshots fail at present, for this reason.
    Failed(String),
    /// A thread has panicked: its message, and the fate of the unsaved work.
    Panicked(String, Rescued),
}

/// The fate of unsaved work after a panic.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Rescued {
    /// There were no unsaved changes.
    Nothing,
    /// The work is in a snapshot.
    Kept,
    /// The work could not be written, for this reason.
    Failed(String),
}

/// The state shared by window, worker and panic hook.
pub(super) struct Shared {
    root: PathBuf,
    desk: Mutex<Desk>,
    wake: Condvar,
    disk: Mutex<Disk>,
}

/// Requests waiting for the worker. Locked for moments only.
#[derive(Default)]
struct Desk {
    latest: Option<Snapshot>,
    picture: Option<(u64, Thumbnail)>,
    orders: VecDeque<Order>,
    notes: Vec<Note>,
    stopped: bool,
}

/// The state of the files. Locked during a write.
#[derive(Default)]
struct Disk {
    /// The document's number and its folder.
    place: Option<(u64, Place)>,
    /// Number and revision of the last snapshot.
    written: Option<(u64, u64)>,
}

impl Shared {
    pub fn new(root: &Path) -> Self {
        let (desk, disk) = (Mutex::default(), Mutex::default());
        Self { root: root.to_path_buf(), desk, wake: Condvar::new(), disk }
    }

    /// A panic that poisoned the lock left the fields consistent: each is set in one step.
    fn desk(&self) -> MutexGuard<'_, Desk> {
        self.desk.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn disk(&self) -> MutexGuard<'_, Disk> {
        self.disk.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub fn offer(&self, snapshot: Snapshot) {
        self.desk().latest = Some(snapshot);
        self.wake.notify_all();
    }

    pub fn take_picture(&self, document: u64, picture: Thumbnail) {
        self.desk().picture = Some((document, picture));
        self.wake.notify_all();
    }

    pub fn order(&self, order: Order) {
        let mut desk = self.desk();
        if let Order::Forget(document) = order {
            desk.latest = desk.latest.take().filter(|snapshot| snapshot.document != document);
            desk.picture = None;
        }
        desk.orders.push_back(order);
        self.wake.notify_all();
    }

    pub fn take_notes(&self) -> Vec<Note> {
        std::mem::take(&mut self.desk().notes)
    }

    pub fn stop(&self) {
        self.desk().stopped = true;
        self.wake.notify_all();
    }

    fn note(&self, note: Note) {
        let notes = &mut self.desk().notes;
        if notes.len() < MAX_NOTES && !notes.contains(&note) {
            notes.push(note);
        }
    }

    /// Writes snapshots and executes orders until it is stopped; finishes waiting requests first.
    pub fn work(&self) {
        let (mut next, mut failure) = (Instant::now(), None);
        while let Some(task) = self.wait(next) {
            let started = Instant::now();
            let done = catch_unwind(AssertUnwindSafe(|| self.perform(task)));
            // The hook has reported a panic already.
            let result = done.unwrap_or_else(|_| Err(io::Error::other("writing failed unexpectedly")));
            let pause = match result {
                Ok(()) => {
                    failure = None;
                    started.elapsed().clamp(PAUSE[0], PAUSE[1])
                }
                Err(error) => {
                    let text = error.to_string();
                    if failure.as_ref() != Some(&text) {
                        self.note(Note::Failed(text.clone()));
                        failure = Some(text);
                    }
                    BEFORE_NEXT_TRY
                }
            };
            next = Instant::now() + pause;
        }
    }

    /// Waits for the next task; `None` at the end. Orders come first and without a pause.
    fn wait(&self, next: Instant) -> Option<Task> {
        let mut written = self.disk().written;
        let mut tried_at_the_end = false;
        let mut desk = self.desk();
        loop {
            if let Some(order) = desk.orders.pop_front() {
                return Some(Task::Order(order));
            }
            let fresh = desk.latest.as_ref().is_some_and(|s| written != Some((s.document, s.revision)));
            let work = (fresh || desk.picture.is_some()).then(|| (desk.latest.clone(), desk.picture.clone()));
            let now = Instant::now();
            match work {
                Some((snapshot, picture)) if now >= next || (desk.stopped && !tried_at_the_end) => {
                    desk.picture = None;
                    if !desk.stopped {
                        return Some(Task::Write(snapshot, picture));
                    }
                    // The final snapshot; after a failure there is no further attempt.
                    tried_at_the_end = true;
                    drop(desk);
                    if let Err(error) = self.perform(Task::Write(snapshot, picture)) {
                        self.note(Note::Failed(error.to_string()));
                    }
                    written = self.disk().written;
                    desk = self.desk();
                }
                _ if desk.stopped => return None,
                Some(_) => {
                    let waited = self.wake.wait_timeout(desk, next - now);
                    desk = waited.unwrap_or_else(PoisonError::into_inner).0;
                }
                None => desk = self.wake.wait(desk).unwrap_or_else(PoisonError::into_inner),
            }
        }
    }

    fn perform(&self, task: Task) -> io::Result<()> {
        let mut disk = self.disk();
        match task {
            Task::Write(snapshot, picture) => {
                if let Some(snapshot) = snapshot {
                    disk.keep(&self.root, &snapshot)?;
                }
                match (&disk.place, picture) {
                    (Some((document, place)), Some((of, picture))) if *document == of => place.write_picture(&picture),
                    _ => Ok(()),
                }
            }
            Task::Order(Order::Forget(document)) => match disk.place.take() {
                Some((kept, place)) if kept == document => place.remove(),
                other => {
                    disk.place = other;
                    Ok(())
                }
            },
            Task::Order(Order::Adopt(document, lost)) => {
                disk.place = Some((document, lost.into_place()));
                Ok(())
            }
            Task::Order(Order::Discard(lost)) => lost.into_place().remove(),
        }
    }
}

enum Task {
    Order(Order),
    Write(Option<Snapshot>, Option<(u64, Thumbnail)>),
}

impl Disk {
    /// Writes a snapshot unless it is written already.
    fn keep(&mut self, root: &Path, snapshot: &Snapshot) -> io::Result<()> {
        let this = (snapshot.document, snapshot.revision);
        if self.written == Some(this) {
            return Ok(());
        }
        for is_last_try in [false, true] {
            let place = match self.place.take() {
                Some((document, place)) if document == snapshot.document => place,
                _ => Place::new(root, &snapshot.about)?,
            };
            match place.write_snapshot(&snapshot.scene) {
                // Another process has removed the folder: create a new one.
                Err(error) if error.kind() == io::ErrorKind::NotFound && !is_last_try => {}
                result => {
                    self.place = Some((snapshot.document, place));
                    return result.map(|()| self.written = Some(this));
                }
            }
        }
        Ok(())
    }
}

/// Writes the unsaved work when a thread panics.
pub struct Rescuer(Arc<Shared>);

impl Rescuer {
    pub(super) fn new(shared: Arc<Shared>) -> Self {
        Self(shared)
    }

    /// Installs a panic hook: on every panic of any thread, caught or not, it writes the unsaved work. It passes a line
    /// about it to `tell`, after the previous hook has reported the panic.
    pub fn rescue_at_panics(self, tell: impl Fn(&str) + Send + Sync + 'static) {
        let before = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |info| {
            before(info);
            let place = info.location().map_or(String::new(), |at| format!(" ({}:{})", at.file(), at.line()));
            let what = info.payload_as_str().unwrap_or("no reason given");
            match self.rescue(&format!("{what}{place}")) {
                Rescued::Nothing => {}
                Rescued::Kept => tell("What was not saved has been kept; Isolith offers it when it is started again."),
                Rescued::Failed(reason) => tell(&format!("The last changes could not be kept: {reason}")),
            }
        }));
    }

    /// Writes the last snapshot now, and leaves a note with the panic's message. It runs in the panic hook, on the
    /// panicking thread, and takes locks with a time limit only, because that thread may hold them.
    pub fn rescue(&self, what: &str) -> Rescued {
        let rescued = self.keep();
        if let Some(mut desk) = patiently(&self.0.desk)
            && desk.notes.len() < MAX_NOTES
        {
            desk.notes.push(Note::Panicked(what.to_owned(), rescued.clone()));
        }
        rescued
    }

    fn keep(&self) -> Rescued {
        let latest = patiently(&self.0.desk).map(|desk| desk.latest.clone());
        let Some(latest) = latest else { return Rescued::Failed("its memory is in use".into()) };
        let Some(snapshot) = latest else { return Rescued::Nothing };
        // The worker would wait for itself; it tries again later.
        if std::thread::current().name() == Some(AUTOSAVE_THREAD) {
            return Rescued::Nothing;
        }
        let Some(mut disk) = patiently(&self.0.disk) else {
            return Rescued::Failed("it is just being written".into());
        };
        match disk.keep(&self.0.root, &snapshot) {
            Ok(()) => Rescued::Kept,
            Err(error) => Rescued::Failed(error.to_string()),
        }
    }
}

/// The lock, unless it stays taken for [`RESCUE_WAITS`].
fn patiently<T>(mutex: &Mutex<T>) -> Option<MutexGuard<'_, T>> {
    let until = Instant::now() + RESCUE_WAITS;
    loop {
        match mutex.try_lock() {
            Ok(guard) => return Some(guard),
            Err(TryLockError::Poisoned(poisoned)) => return Some(poisoned.into_inner()),
            Err(TryLockError::WouldBlock) if Instant::now() < until => std::thread::sleep(Duration::from_millis(5)),
            Err(TryLockError::WouldBlock) => return None,
        }
    }
}
