//! Everything that takes longer than a frame runs here: on a thread of its own, with a name, progress and a cancel flag. A
//! panic in a job is an error of that job. Whoever starts a job polls it; a status bar lists those that run.

use std::fmt;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, TryRecvError, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use isolith_guard::guarded;

/// Tells work that takes long to stop; all clones are one.
#[derive(Clone, Debug, Default)]
pub struct Cancel(Arc<AtomicBool>);

impl Cancel {
    /// Says stop.
    pub fn cancel(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether somebody said stop.
    pub fn is_canceled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// The work was told to stop, and did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Canceled;

impl fmt::Display for Canceled {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("was canceled")
    }
}

/// How a task appears to people.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Visibility {
    /// It is listed, and can be canceled.
    Listed,
    /// It is listed, and runs to its end: stopping in the middle would help nobody.
    WithoutCancel,
    /// It is not listed: it is short, and nobody waits for it.
    Hidden,
}

/// A piece of work, as it reports about itself and as others see it. All clones are one.
#[derive(Clone, Debug)]
pub struct Task(Arc<Shared>);

#[derive(Debug)]
struct Shared {
    name: String,
    visibility: Visibility,
    cancel: Cancel,
    /// The work has come to its end, one way or another.
    is_over: AtomicBool,
    /// Bits of an `f32`; NaN while it is unknown.
    progress: AtomicU32,
    stage: Mutex<&'static str>,
}

impl Task {
    /// A task of this name that can be canceled. The name says what is going on: "Opening pawn.json".
    pub fn new(name: impl Into<String>) -> Self {
        Self::with(name, Visibility::Listed, Cancel::default())
    }

    /// A task that cannot be canceled.
    pub fn without_cancel(name: impl Into<String>) -> Self {
        Self::with(name, Visibility::WithoutCancel, Cancel::default())
    }

    /// A task that is not listed.
    pub fn hidden(name: impl Into<String>) -> Self {
        Self::with(name, Visibility::Hidden, Cancel::default())
    }

    /// A task that somebody else's flag cancels.
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

    /// What is going on.
    pub fn name(&self) -> &str {
        &self.0.name
    }

    /// The step that the task is at, in a word or two; empty where it has only one.
    pub fn stage(&self) -> &'static str {
        *lock(&self.0.stage)
    }

    /// Says which step begins.
    pub fn set_stage(&self, stage: &'static str) {
        *lock(&self.0.stage) = stage;
    }

    /// How much is done, 0 to 1; `None` while nobody knows.
    pub fn progress(&self) -> Option<f32> {
        let share = f32::from_bits(self.0.progress.load(Ordering::Relaxed));
        share.is_finite().then_some(share)
    }

    /// Says how much is done, 0 to 1.
    pub fn set_progress(&self, share: f32) {
        self.0.progress.store(share.clamp(0.0, 1.0).to_bits(), Ordering::Relaxed);
    }

    /// Whether it can be canceled.
    pub fn can_cancel(&self) -> bool {
        self.0.visibility == Visibility::Listed
    }

    /// Tells it to stop, where that is possible.
    pub fn cancel(&self) {
        if self.can_cancel() {
            self.0.cancel.cancel();
        }
    }

    /// The flag that stops it, for work that takes one.
    pub fn flag(&self) -> &Cancel {
        &self.0.cancel
    }

    /// Whether it is to stop.
    pub fn is_canceled(&self) -> bool {
        self.0.cancel.is_canceled()
    }

    /// Ends work by `?` where it is to stop.
    ///
    /// # Errors
    /// It was told to stop.
    pub fn check(&self) -> Result<(), Canceled> {
        if self.is_canceled() { Err(Canceled) } else { Ok(()) }
    }

    fn is(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

type Wake = Box<dyn Fn() + Send>;

/// The jobs that run, seen from outside. All clones are one.
#[derive(Clone, Default)]
pub struct Jobs {
    running: Arc<Mutex<Vec<Task>>>,
    wake: Arc<Mutex<Option<Wake>>>,
}

impl Jobs {
    /// Calls this from now on whenever a job ends, from the thread of that job.
    pub fn set_wake(&self, wake: impl Fn() + Send + 'static) {
        *lock(&self.wake) = Some(Box::new(wake));
    }

    /// Has whoever polls look at once.
    pub fn wake(&self) {
        if let Some(wake) = &*lock(&self.wake) {
            wake();
        }
    }

    /// Does the work on a thread of its own. Where none can be started the job has failed, and says so when it is polled.
    pub fn start<T: Send + 'static>(&self, task: Task, work: impl FnOnce(&Task) -> T + Send + 'static) -> Job<T> {
        let (sender, answer) = channel();
        let job = Job { task: task.clone(), answer };
        lock(&self.running).push(task.clone());
        let (jobs, at_work) = (self.clone(), task.clone());
        let failed = sender.clone();
        let spawned = std::thread::Builder::new().name("job".into()).spawn(move || {
            let done = guarded(|| work(&at_work));
            at_work.0.is_over.store(true, Ordering::Relaxed);
            // The receiver is gone where nobody waits for the job any more.
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

    /// The tasks for people to see, in the order in which they were started. One that was told to stop is not listed, though
    /// its thread may need some time yet.
    pub fn listed(&self) -> Vec<Task> {
        let is_shown = |task: &&Task| task.0.visibility != Visibility::Hidden && !task.is_canceled();
        lock(&self.running).iter().filter(is_shown).cloned().collect()
    }

    /// Whether any thread is at work, listed or not.
    pub fn is_idle(&self) -> bool {
        lock(&self.running).is_empty()
    }

    /// The task that there is room to show: the oldest that can be canceled, or else the oldest.
    pub fn foremost(&self) -> Option<Task> {
        let tasks = self.listed();
        tasks.iter().find(|task| task.can_cancel()).or(tasks.first()).cloned()
    }

    /// Tells the foremost task to stop; false where there is none that can.
    pub fn cancel_foremost(&self) -> bool {
        let task = self.foremost().filter(Task::can_cancel);
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

/// How a job ended.
#[derive(Debug, PartialEq, Eq)]
pub enum JobEnd<T> {
    /// With this.
    Done(T),
    /// It panicked, or could not be started; the text is for people.
    Failed(String),
    /// Somebody told it to stop.
    Canceled,
}

/// A job under way. Dropping it before its end cancels it.
#[derive(Debug)]
pub struct Job<T> {
    task: Task,
    answer: Receiver<Result<T, String>>,
}

impl<T> Job<T> {
    /// What others see of it.
    pub fn task(&self) -> &Task {
        &self.task
    }

    /// How it ended, once: afterward it is to be dropped. `None` while it runs. One that was canceled has ended at once.
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

    /// Waits for its end: for where no interface waits.
    pub fn wait(self) -> JobEnd<T> {
        self.wait_telling(Duration::from_secs(1), |_| {})
    }

    /// Waits for its end, and calls `tell` every so often until then. Its thread has ended its work afterward, also where it
    /// was canceled.
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
        // The flag may be somebody else's, who goes on after a job that is over.
        if !self.task.0.is_over.load(Ordering::Relaxed) {
            self.task.cancel();
        }
    }
}

/// A list that a panic interrupted is as good as before.
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
        // Nobody waits for it any more.
        drop(jobs.start(Task::new("Waiting"), endless));
        until("a dropped one ends", || jobs.is_idle());
        // One that is over cancels nothing any more: its flag may be that of others.
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
