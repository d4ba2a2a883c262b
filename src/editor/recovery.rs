//! Keeps unsaved work in jobs beside the frames and offers it again after a loss.

use std::time::Duration;

use egui::Context;

use super::messages::Message;
use super::root::Editor;
use super::safekeeping::{RecoveryChoice, Safekeeping, take_picture};
use isolith_document::recovery::{Lost, Note, ReadSnapshot, Recovered, Recovery, Rescued, Unreadable};
use isolith_jobs::{Job, JobEnd, Task};

/// Delay from a change to its thumbnail, in seconds: by then the viewport shows the change.
const PICTURE_AFTER: f64 = 0.5;
/// Minimum time between two thumbnails, in seconds.
const BETWEEN_PICTURES: f64 = 10.0;

impl Editor {
    /// Starts to keep unsaved work by `recovery` and offers the lost work there.
    pub fn set_recovery(&mut self, recovery: Recovery) {
        self.safekeeping = Some(Safekeeping::new(recovery));
        self.state.can_recover = true;
    }

    /// Ends recovery when the artist closes the window: drops the copy of saved or discarded work, keeps any other.
    pub fn end_recovery(&mut self) {
        let is_settled = self.wants_close() || !self.state.session.document.is_changed();
        if let Some(mut safekeeping) = self.safekeeping.take().filter(|_| is_settled) {
            safekeeping.recovery.forget();
        }
    }

    /// Drops the copy of the document, which is saved or discarded.
    pub(super) fn forget_kept(&mut self) {
        if let Some(safekeeping) = &mut self.safekeeping {
            safekeeping.recovery.forget();
            safekeeping.seen = None;
        }
    }

    /// Whether lost work is being read.
    pub(super) fn is_recovering(&self) -> bool {
        self.safekeeping.as_ref().is_some_and(|safekeeping| safekeeping.reading.is_some())
    }

    /// Whether the list of lost work is open.
    pub(super) fn is_offering(&self) -> bool {
        self.safekeeping.as_ref().is_some_and(|safekeeping| safekeeping.is_open)
    }

    /// Shows the list of lost work, including recent losses.
    pub(super) fn offer_lost_work(&mut self) {
        let Some(safekeeping) = &mut self.safekeeping else { return };
        let news = safekeeping.recovery.lost();
        safekeeping.lost.extend(news);
        safekeeping.is_open = !safekeeping.lost.is_empty();
        if !safekeeping.is_open {
            self.report(Message::info("There is nothing to recover."));
        }
    }

    /// Keeps the latest changes and reports the notes of other threads. Call once a frame, at its end.
    pub(super) fn follow_recovery(&mut self, ctx: &Context) {
        let is_changing = self.state.session.is_changing();
        let is_covered = self.has_dialog();
        let Some(safekeeping) = &mut self.safekeeping else { return };
        if let Some(after) = safekeeping.recovery.follow(&self.state.session.document, is_changing) {
            ctx.request_repaint_after(after);
        }
        let now = ctx.input(|i| i.time);
        let revision = self.state.session.document.revision();
        if safekeeping.seen != Some(revision) {
            safekeeping.seen = Some(revision);
            // Count from the first change: continuous editing gets a thumbnail, too.
            if std::mem::replace(&mut safekeeping.is_pictured, false) {
                safekeeping.changed_at = now;
            }
        }
        let picture = &self.state.picture;
        let is_whole = picture.texture.is_some() && picture.progress.is_none() && !is_covered && !is_changing;
        if !safekeeping.is_pictured && is_whole && safekeeping.recovery.is_keeping() {
            let due = (safekeeping.changed_at + PICTURE_AFTER).max(safekeeping.pictured_at + BETWEEN_PICTURES);
            if now >= due {
                (safekeeping.is_pictured, safekeeping.pictured_at) = (true, now);
                let area = self.state.view.rect * ctx.pixels_per_point();
                take_picture(ctx, area, safekeeping.recovery.picture_taker());
            } else {
                ctx.request_repaint_after(Duration::from_secs_f64(due - now));
            }
        }
        for note in safekeeping.recovery.take_notes() {
            self.report(message(&note));
        }
    }

    /// Drops the notes of other threads: they were expected.
    pub fn drop_notes(&mut self) {
        if let Some(safekeeping) = &mut self.safekeeping {
            safekeeping.recovery.take_notes();
        }
    }

    /// Shows the list of recoverable work.
    pub(super) fn show_recovery(&mut self, ctx: &Context) {
        let may_open = !self.state.session.document.is_changed();
        let Some(safekeeping) = self.safekeeping.as_mut().filter(|safekeeping| safekeeping.is_open) else { return };
        let Some(choice) = safekeeping.show(ctx, may_open) else { return };
        match choice {
            RecoveryChoice::Later => (safekeeping.is_open, safekeeping.confirming) = (false, None),
            RecoveryChoice::Discard(index) => {
                let lost = safekeeping.lost.remove(index);
                safekeeping.recovery.discard(lost);
                (safekeeping.is_open, safekeeping.confirming) = (!safekeeping.lost.is_empty(), None);
            }
            RecoveryChoice::Recover(index) => self.recover(index),
        }
    }

    /// Starts to read a lost document. The current document stays unchanged until then.
    fn recover(&mut self, index: usize) {
        let jobs = self.state.derived.jobs().clone();
        let Some(safekeeping) = &mut self.safekeeping else { return };
        let lost = safekeeping.lost.remove(index);
        safekeeping.is_open = false;
        let task = Task::without_cancel(format!("Recovering {}", lost.name()));
        safekeeping.reading = Some(jobs.start(task, move |_| {
            let read = lost.read();
            (lost, read)
        }));
    }

    /// Shows a lost document after reading. Call once a frame.
    pub(super) fn poll_recovery(&mut self) {
        let Some(safekeeping) = &mut self.safekeeping else { return };
        let Some(end) = safekeeping.reading.as_ref().and_then(Job::poll) else { return };
        safekeeping.reading = None;
        match end {
            JobEnd::Done((lost, read)) => self.show_recovered(lost, read),
            // The lost work has no owner now, so the next search finds it again.
            JobEnd::Failed(reason) => self.report(Message::error(format!("It cannot be recovered: {reason}"))),
            JobEnd::Canceled => {}
        }
    }

    fn show_recovered(&mut self, lost: Lost, read: ReadSnapshot) {
        // Meanwhile the current document may have changes, or undone changes of which a copy exists.
        let is_changed = self.state.session.document.is_changed();
        if !is_changed {
            self.forget_kept();
        }
        let Some(safekeeping) = &mut self.safekeeping else { return };
        if is_changed {
            safekeeping.lost.insert(0, lost);
            safekeeping.is_open = true;
            return;
        }
        let name = lost.name().to_owned();
        match safekeeping.recovery.recover_read(lost, read) {
            Err(failure) => {
                let Unreadable { lost, error } = *failure;
                safekeeping.lost.insert(0, lost);
                safekeeping.is_open = true;
                self.report(Message::error(format!("“{name}” cannot be recovered: {error}")));
            }
            Ok(Recovered { document, problem }) => {
                let rest = safekeeping.lost.len();
                // Taken out, so that `replace_document` drops nothing of the recovered document.
                let safekeeping = self.safekeeping.take();
                self.replace_document(document);
                self.safekeeping = safekeeping;
                self.report(Message::success(format!("“{name}” is recovered. It is not saved yet.")));
                if let Some(problem) = problem {
                    let text = format!("The latest changes could not be read, so an older copy was taken: {problem}");
                    self.report(Message::warning(text));
                }
                if rest > 0 {
                    let text = format!("{rest} more can be recovered: File, Recover unsaved work.");
                    self.report(Message::info(text));
                }
            }
        }
    }
}

fn message(note: &Note) -> Message {
    match note {
        Note::Failed(reason) => Message::error(format!(
            "Unsaved work cannot be kept for recovery: {reason}. Save often until that is mended."
        )),
        Note::Panicked(what, rescued) => {
            let then = match rescued {
                Rescued::Nothing => "Nothing was changed that is not saved.".to_owned(),
                Rescued::Kept => "Your work has been kept. Save it and start Isolith again.".to_owned(),
                Rescued::Failed(reason) => format!("Your last changes could not be kept ({reason}). Save now."),
            };
            Message::error(format!("A part of Isolith has failed: {what}. {then}"))
        }
    }
}
