//! Jobs: work that takes longer than a frame runs on a thread of its own, with a name, progress and a cancel flag. A
//! panic in a job is an error of that job. The owner of a job polls it; a status bar lists the running ones.

use std::fmt;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, TryRecvError, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use isolith_guard::guarded;

/// A flag that stops long work; all clones share it.
#[derive(Clone, Debug, Default)]
pub struct Cancel(Arc<AtomicBool>);

impl Cancel {
    /// Requests the work to stop.
    pub fn cancel(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether a stop was requested.
    pub fn is_canceled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// The error of work that stopped on request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Canceled;

impl fmt::Display for Canceled {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("was canceled")
    }
}

/// The visibility of a task in the user interface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Visibility {
    /// Listed, and can be canceled.
    Listed,
    /// The same, but not by Escape: a stray key must not end an hour of work.
    Lasting,
    /// Listed, and runs to its end: stopping halfway would help nobody.
    WithoutCancel,
    /// Not listed: it is short, and nobody waits for it.
    Hidden,
}

/// A piece of work that reports its state. All clones share it.
#[derive(Clone, Debug)]
pub struct Task(Arc<Shared>);

#[derive(Debug)]
struct Shared {
    name: String,
    visibility: Visibility,
    cancel: Cancel,
    /// Whether the work has ended, for any reason.
    is_over: AtomicBool,
    /// Bits of an `f32`; NaN while unknown.
    progress: AtomicU32,
    stage: Mutex<&'static str>,
}

impl Task {
    /// A task that can be canceled. The name describes the activity: "Opening pawn.json".
    pub fn new(name: impl Into<String>) -> Self {
        Self::with(name, Visibility::Listed, Cancel::default())
    }

    /// A task that can be canceled, but is not by [`Jobs::cancel_foremost`].
    pub fn lasting(name: impl Into<String>) -> Self {
        Self::with(name, Visibility::Lasting, Cancel::default())
    }

    /// A task that cannot be canceled.
    pub fn without_cancel(name: impl Into<String>) -> Self {
        Self::with(name, Visibility::WithoutCancel, Cancel::default())
    }

    /// A task that is not listed.
    pub fn hidden(name: impl Into<String>) -> Self {
        Self::with(name, Visibility::Hidden, Cancel::default())
    }

    /// A task that an existing flag cancels.
    pub fn canceled_by(name: impl Into<String>, cancel: &Cancel) -> Self {
        Self::with(name, Visibility::Listed, cancel.clone())
    }

    fn with(name: impl Into<String>, visibility: Visibility, cancel: Cancel) -> Self {
        let progress = AtomicU32::new(f32::NAN.to_bits());
        let stage = Mutex::default();
        Self(Arc::new(Shared {
            name: name.into(),
            visibility,
            cancel,
            is_over: AtomicBool::new(false),
            progress,
            stage,
        }))
    }

    /// The name of the activity.
    pub fn name(&self) -> &str {
        &self.0.name
    }

    /// The current step, in a word or two; empty if there is only one step.
    pub fn stage(&self) -> &'static str {
        *lock(&self.0.stage)
    }

    /// Sets the current step.
    pub fn set_stage(&self, stage: &'static str) {
        *lock(&self.0.stage) = stage;
    }

    /// The progress from 0 to 1; `None` while unknown.
    pub fn progress(&self) -> Option<f32> {
        let share = f32::from_bits(self.0.progress.load(Ordering::Relaxed));
        share.is_finite().then_some(share)
    }

    /// Sets the progress, 0 to 1.
    pub fn set_progress(&self, share: f32) {
        self.0.progress.store(share.clamp(0.0, 1.0).to_bits(), Ordering::Relaxed);
    }

    /// Whether the task can be canceled.
    pub fn can_cancel(&self) -> bool {
        matches!(self.0.visibility, Visibility::Listed | Visibility::Lasting)
    }

    /// Cancels the task, if that is possible.
    pub fn cancel(&self) {
        if self.can_cancel() {
            self.0.cancel.cancel();
        }
    }

    /// The cancel flag, for work that takes one.
    pub fn flag(&self) -> &Cancel {
        &self.0.cancel
    }

    /// Whether the task was canceled.
    pub fn is_canceled(&self) -> bool {
        self.0.cancel.is_canceled()
    }

    /// Ends canceled work by `?`.
    ///
    /// # Errors
    /// The task was canceled.
    pub fn check(&self) -> Result<(), Canceled> {
        if self.is_canceled() { Err(Canceled) } else { Ok(()) }
    }

    fn is(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

type Wake = Box<dyn Fn() + Send>;

/// The running jobs. All clones share them.
#[derive(Clone, Default)]
pub struct Jobs {
    running: Arc<Mutex<Vec<Task>>>,
    wake: Arc<Mutex<Option<Wake>>>,
}

impl Jobs {
    /// Sets a function to be called whenever a job ends, from the thread of that job.
    pub fn set_wake(&self, wake: impl Fn() + Send + 'static) {
        *lock(&self.wake) = Some(Box::new(wake));
    }

    /// Makes the poller look at once.
    pub fn wake(&self) {
        if let Some(wake) = &*lock(&self.wake) {
            wake();
        }
    }

    /// Starts the work on a thread of its own. If no thread can be started, the job has failed, and polling it says so.
    pub fn start<T: Send + 'static>(&self, task: Task, work: impl FnOnce(&Task) -> T + Send + 'static) -> Job<T> {
        let (sender, answer) = channel();
        let job = Job { task: task.clone(), answer };
        lock(&self.running).push(task.clone());
        let (jobs, at_work) = (self.clone(), task.clone());
        let failed = sender.clone();
        let spawned = std::thread::Builder::new().name("job".into()).spawn(move || {
            let done = guarded(|| work(&at_work));
            at_work.0.is_over.store(true, Ordering::Relaxed);
            // The receiver is gone if nobody waits for the job anymore.
            let _ = sender.send(done);
            jobs.remove(&at_work);
            jobs.wake();
        });
        if let Err(error) = spawned {
            let _ = failed.send(Err(format!("no thread can be started: {error}")));
            self.remove(&task);
        }
        job
    }

    /// The listed tasks, in the order of their start. Canceled tasks are not listed, though their threads may still be
    /// running.
    pub fn listed(&self) -> Vec<Task> {
        let is_shown = |task: &&Task| task.0.visibility != Visibility::Hidden && !task.is_canceled();
        lock(&self.running).iter().filter(is_shown).cloned().collect()
    }

    /// Whether no thread is running, listed or not.
    pub fn is_idle(&self) -> bool {
        lock(&self.running).is_empty()
    }

    /// The task to show if there is room for one only: the oldest that can be canceled, or else the oldest.
    pub fn foremost(&self) -> Option<Task> {
        let tasks = self.listed();
        tasks.iter().find(|task| task.can_cancel()).or(tasks.first()).cloned()
    }

    /// The task that Escape cancels: the oldest that is neither lasting nor without cancel.
    pub fn escapable(&self) -> Option<Task> {
        self.listed().into_iter().find(|task| task.0.visibility == Visibility::Listed)
    }

    /// Cancels the task that Escape cancels; false if there is none.
    pub fn cancel_foremost(&self) -> bool {
        let task = self.escapable();
        task.iter().for_each(Task::cancel);
        task.is_some()
    }

    fn remove(&self, task: &Task) {
        lock(&self.running).retain(|other| !other.is(task));
    }
}

impl fmt::Debug for Jobs {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Jobs").field(&*lock(&self.running)).finish()
    }
}

/// The end of a job.
#[derive(Debug, PartialEq, Eq)]
pub enum JobEnd<T> {
    /// The work returned this.
    Done(T),
    /// The work panicked, or could not be started; the text is a reason for the user.
    Failed(String),
    /// The job was canceled.
    Canceled,
}

/// A running job. Dropping it before its end cancels it.
#[derive(Debug)]
pub struct Job<T> {
    task: Task,
    answer: Receiver<Result<T, String>>,
}

impl<T> Job<T> {
    /// The task of the job.
    pub fn task(&self) -> &Task {
        &self.task
    }

    /// The end of the job, once: drop the job afterward. `None` while it runs. A canceled job counts as ended at once.
    pub fn poll(&self) -> Option<JobEnd<T>> {
        if self.task.is_canceled() {
            return Some(JobEnd::Canceled);
        }
        match self.answer.try_recv() {
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => Some(JobEnd::Failed("it ended without an answer".into())),
            Ok(Ok(done)) => Some(JobEnd::Done(done)),
            Ok(Err(reason)) => Some(JobEnd::Failed(reason)),
        }
    }

    /// Waits for the end. For callers without a user interface.
    pub fn wait(self) -> JobEnd<T> {
        self.wait_telling(Duration::from_secs(1), |_| {})
    }

    /// Waits for the end, and calls `tell` at this interval until then. The thread has finished its work afterward,
    /// even after a cancel.
    pub fn wait_telling(self, every: Duration, mut tell: impl FnMut(&Task)) -> JobEnd<T> {
        loop {
            let answer = self.answer.recv_timeout(every);
            match answer {
                Err(RecvTimeoutError::Timeout) => tell(&self.task),
                _ if self.task.is_canceled() => return JobEnd::Canceled,
                Ok(Ok(done)) => return JobEnd::Done(done),
                Ok(Err(reason)) => return JobEnd::Failed(reason),
                Err(RecvTimeoutError::Disconnected) => return JobEnd::Failed("it ended without an answer".into()),
            }
        }
    }
}

impl<T> Drop for Job<T> {
    fn drop(&mut self) {
        // Others may share the flag and go on after this job, so a finished job must not set it.
        if !self.task.0.is_over.load(Ordering::Relaxed) {
            self.task.cancel();
        }
    }
}

/// A panic leaves the list intact, so poisoning is ignored.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::sync_channel;
    use std::time::Instant;

    use super::*;

    fn until(what: &str, is_true: impl Fn() -> bool) {
        let started = Instant::now();
        while !is_true() {
            assert!(started.elapsed() < Duration::from_secs(20), "{what}");
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    #[test]
    fn a_job_tells_how_far_it_is_and_wakes_when_it_is_done() {
        let (jobs, (go, gate), (woken, wakes)) = (Jobs::default(), sync_channel::<()>(0), channel());
        jobs.set_wake(move || {
            let _ = woken.send(());
        });
        let job = jobs.start(Task::new("Counting"), move |task| {
            task.set_stage("sheep");
            task.set_progress(0.25);
            gate.recv().map(|()| 7)
        });
        until("it never begins", || job.task().progress().is_some());
        let seen: Vec<_> = jobs.listed().iter().map(|t| (t.name().to_owned(), t.stage(), t.progress())).collect();
        assert_eq!(seen, [("Counting".to_owned(), "sheep", Some(0.25))]);
        assert!(job.poll().is_none() && wakes.try_recv().is_err());
        go.send(()).expect("it waits");
        wakes.recv_timeout(Duration::from_secs(20)).expect("a wake");
        assert!(jobs.is_idle() && jobs.listed().is_empty());
        assert_eq!(job.poll(), Some(JobEnd::Done(Ok(7))));
    }

    #[test]
    fn a_panic_is_the_jobs_error_and_others_go_on() {
        let jobs = Jobs::default();
        let broken = jobs.start(Task::new("Breaking"), |_| panic!("no {}", "way"));
        let sound = jobs.start(Task::new("Adding"), |_| 1 + 1);
        assert_eq!(broken.wait(), JobEnd::<()>::Failed("an internal error: no way".into()));
        assert_eq!(sound.wait(), JobEnd::Done(2));
        until("its thread ends", || jobs.is_idle());
    }

    #[test]
    fn a_canceled_job_has_ended_at_once_and_its_thread_soon() {
        let jobs = Jobs::default();
        let endless = |task: &Task| {
            while task.check().is_ok() {
                std::thread::yield_now();
            }
        };
        let job = jobs.start(Task::new("Waiting"), endless);
        assert!(jobs.cancel_foremost());
        assert_eq!(job.poll(), Some(JobEnd::Canceled));
        assert!(jobs.listed().is_empty() && !jobs.cancel_foremost());
        until("its thread ends", || jobs.is_idle());
        // Dropping the job cancels it.
        drop(jobs.start(Task::new("Waiting"), endless));
        until("a dropped one ends", || jobs.is_idle());
        // A finished job cancels nothing anymore: others may share its flag.
        let flag = Cancel::default();
        assert_eq!(jobs.start(Task::canceled_by("Adding", &flag), |_| 2).wait(), JobEnd::Done(2));
        assert!(!flag.is_canceled());
        drop(jobs.start(Task::canceled_by("Waiting", &flag), endless));
        assert!(flag.is_canceled());
    }

    #[test]
    fn who_waits_is_told_how_far_it_is() {
        let (jobs, (go, gate)) = (Jobs::default(), sync_channel::<()>(1));
        let job = jobs.start(Task::new("Drawing"), move |task| {
            task.set_progress(0.5);
            gate.recv().is_ok()
        });
        let mut told = Vec::new();
        let end = job.wait_telling(Duration::from_millis(1), |task| {
            told.push(task.progress());
            if told.last() == Some(&Some(0.5)) {
                let _ = go.try_send(());
            }
        });
        assert_eq!(end, JobEnd::Done(true));
        assert!(told.contains(&Some(0.5)), "{told:?}");
    }

    #[test]
    fn lasting_work_ends_by_its_own_cancel_only() {
        let (jobs, (go, gate)) = (Jobs::default(), sync_channel::<()>(0));
        let rendering = jobs.start(Task::lasting("Rendering"), move |_| gate.recv().is_ok());
        assert!(!jobs.cancel_foremost() && jobs.foremost().is_some_and(|task| task.can_cancel()));
        rendering.task().cancel();
        assert!(jobs.listed().is_empty());
        drop(go);
    }

    #[test]
    fn what_cannot_be_canceled_is_listed_and_what_is_hidden_is_not() {
        let (jobs, (go, gate)) = (Jobs::default(), sync_channel::<()>(0));
        let saving = jobs.start(Task::without_cancel("Saving"), move |_| gate.recv().is_ok());
        let (start, started) = sync_channel::<()>(0);
        let hidden = jobs.start(Task::hidden("Noting"), move |_| started.recv().is_ok());
        assert_eq!(jobs.listed().iter().map(Task::name).collect::<Vec<_>>(), ["Saving"]);
        assert!(!jobs.cancel_foremost() && !saving.task().is_canceled());
        assert!(!jobs.is_idle());
        go.send(()).expect("it waits");
        start.send(()).expect("it waits");
        assert_eq!((saving.wait(), hidden.wait()), (JobEnd::Done(true), JobEnd::Done(true)));
    }
}
