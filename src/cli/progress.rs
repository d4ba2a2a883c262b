//! The progress bar, and Ctrl-C.

use std::io::IsTerminal;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{LazyLock, OnceLock};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use super::text::complain;
use crate::field::Cancel;

/// Interval of progress lines, which replace the bar if standard error is not a terminal.
const LINE_EVERY: Duration = Duration::from_secs(10);

/// The effect of Ctrl-C. A second one always ends the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interrupts {
    /// Cancels the task at its next step.
    StopTheTask,
    /// Ends the program: the task cannot be canceled, and ending in the middle loses nothing.
    EndTheProgram,
}

/// Exit code after an interrupt, by the convention of shells: 128 plus the number of the signal.
const INTERRUPTED: i32 = 130;

/// Shows the progress of a long task on standard error, and tells the task when to stop.
pub struct Progress {
    task: &'static str,
    shown: Option<ProgressBar>,
    last_line: Instant,
    quiet: bool,
}

impl Progress {
    /// Starts at zero progress.
    pub fn start(task: &'static str, quiet: bool, interrupts: Interrupts) -> Self {
        let ends = interrupts == Interrupts::EndTheProgram;
        AT_ONCE.store(ends, Ordering::Relaxed);
        if !ends {
            catch_interrupts();
        }
        let shown = (!quiet && std::io::stderr().is_terminal()).then(|| bar(task));
        Self { task, shown, last_line: Instant::now(), quiet }
    }

    /// Sets the finished fraction of the task, 0 to 1. Returns false if the task must stop.
    pub fn update(&mut self, share: f64) -> bool {
        let share = share.clamp(0.0, 1.0);
        if let Some(bar) = &self.shown {
            bar.set_position((share * 1000.0) as u64);
        } else if !self.quiet && self.last_line.elapsed() > LINE_EVERY {
            self.last_line = Instant::now();
            complain(&format!("{}: {:.0} %", self.task, share * 100.0));
        }
        !is_canceled()
    }

    /// Removes the bar.
    pub fn finish(self) {
        if let Some(bar) = self.shown {
            bar.finish_and_clear();
        }
    }
}

fn bar(task: &'static str) -> ProgressBar {
    let style = ProgressStyle::with_template("{msg} {wide_bar} {percent:>3} %  {eta} left");
    let bar = ProgressBar::new(1000).with_style(style.expect("the template is fixed"));
    bar.set_message(task);
    bar
}

/// Whether Ctrl-C was pressed.
pub fn is_canceled() -> bool {
    CANCEL.is_canceled()
}

/// Whether Ctrl-C ends the program at once.
static AT_ONCE: AtomicBool = AtomicBool::new(false);

static CANCEL: LazyLock<Cancel> = LazyLock::new(Cancel::default);

/// A cancel token that Ctrl-C triggers from now on.
pub fn cancel_by_interrupts() -> Cancel {
    catch_interrupts();
    CANCEL.clone()
}

fn catch_interrupts() {
    static ONCE: OnceLock<()> = OnceLock::new();
    ONCE.get_or_init(|| {
        // If this fails, Ctrl-C still ends the program, only less gently.
        #[expect(clippy::disallowed_methods, reason = "asked a second time, the program stops without waiting")]
        let _ = ctrlc::set_handler(|| {
            if is_canceled() || AT_ONCE.load(Ordering::Relaxed) {
                std::process::exit(INTERRUPTED);
            }
            CANCEL.cancel();
        });
    });
}
