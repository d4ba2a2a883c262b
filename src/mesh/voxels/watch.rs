//! Progress and cancellation of work on all cores.

use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use isolith_bricks::BrickError;

/// How often the thread that waits tells the progress.
const EVERY: Duration = Duration::from_millis(40);

/// What the threads at work share with the one that waits for them.
#[derive(Debug, Default)]
pub(super) struct Watch {
    is_canceled: AtomicBool,
    /// Of a million.
    done: AtomicU32,
    /// The share that the work under way has of all, in a million.
    part: AtomicU32,
}

impl Watch {
    /// What comes next has this share of the whole work.
    pub fn begin(&self, part: f64) {
        self.part.store((part * 1e6) as u32, Ordering::Relaxed);
    }

    /// Adds a share of what is under way.
    pub fn advance(&self, share: f64) {
        let part = f64::from(self.part.load(Ordering::Relaxed));
        self.done.fetch_add((share * part) as u32, Ordering::Relaxed);
    }

    /// Ends canceled work.
    pub fn check(&self) -> Result<(), BrickError> {
        if self.is_canceled.load(Ordering::Relaxed) { Err(BrickError::Canceled) } else { Ok(()) }
    }

    fn progress(&self) -> f32 {
        self.done.load(Ordering::Relaxed) as f32 * 1e-6
    }
}

/// Does work on another thread while this one tells its progress; work ends soon after `progress` returns false.
pub(super) fn watched<T: Send>(
    progress: &mut dyn FnMut(f32) -> bool,
    work: impl FnOnce(&Watch) -> Result<T, BrickError> + Send,
) -> Result<T, BrickError> {
    let watch = Watch::default();
    let (sender, answer) = channel();
    std::thread::scope(|scope| {
        let watch = &watch;
        let worker = scope.spawn(move || {
            let done = work(watch);
            // The receiver waits until the end.
            let _ = sender.send(());
            done
        });
        while matches!(answer.recv_timeout(EVERY), Err(RecvTimeoutError::Timeout)) {
            if !progress(watch.progress().min(1.0)) {
                watch.is_canceled.store(true, Ordering::Relaxed);
            }
        }
        worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    })
}
