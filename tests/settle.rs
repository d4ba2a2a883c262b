//! Waits for the editor's jobs.

use std::time::{Duration, Instant};

use egui_kittest::Harness;
use isolith::editor::Editor;

/// Longer than any job of a test.
const PATIENCE: Duration = Duration::from_secs(60);

pub trait Settle {
    /// Shows frames until nothing moves and no job runs.
    fn settle(&mut self);
}

impl Settle for Harness<'_, Editor> {
    fn settle(&mut self) {
        self.run_ok();
        let started = Instant::now();
        while self.state().is_busy() {
            assert!(started.elapsed() < PATIENCE, "a job does not end");
            std::thread::sleep(Duration::from_millis(1));
            self.step();
        }
        self.run_ok();
        self.run();
    }
}
