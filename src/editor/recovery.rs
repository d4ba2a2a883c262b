//! Work that is not saved is kept beside the frames, and offered again after it was lost.

use std::time::Duration;

use egui::Context;

use super::messages::Message;
use super::root::Editor;
use super::safekeeping::{RecoveryChoice, Safekeeping, take_picture};
use isolith_document::recovery::{Lost, Note, ReadSnapshot, Recovered, Recovery, Rescued, Unreadable};
use isolith_jobs::{Job, JobEnd, Task};

/// How long after a change a picture is kept, in seconds: by then the change is drawn.
const PICTURE_AFTER: f64 = 0.5;
/// Least time between two pictures, in seconds.
const BETWEEN_PICTURES: f64 = 10.0;

impl Editor {
    /// From now on unsaved work is kept there; what lies there is offered.
    pub fn set_recovery(&mut self, recovery: Recovery) {
        self.safekeeping = Some(Safekeeping::new(recovery));
        self.state.can_recover = true;
    }

    /// The window is closed by the artist's wish: what has been given up is not kept. Otherwise it is.
    pub fn end_recovery(&mut self) {
        let is_settled = self.wants_close() || !self.state.session.document.is_changed();
        if let Some(mut safekeeping) = self.safekeeping.take().filter(|_| is_settled) {
            safekeeping.recovery.forget();
        }
    }

    /// The document is saved or given up: nothing of it need be kept.
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

    /// Whether the list of lost work is shown.
    pub(super) fn is_offering(&self) -> bool {
        self.safekeeping.as_ref().is_some_and(|safekeeping| safekeeping.is_open)
    }

    /// Shows the list of lost work, with what has been lost since.
    pub(super) fn offer_lost_work(&mut self) {
        let Some(safekeeping) = &mut self.safekeeping else { return };
        let news = safekeeping.recovery.lost();
        safekeeping.lost.extend(news);
        safekeeping.is_open = !safekeeping.lost.is_empty();
        if !safekeeping.is_open {
            self.report(Message::info("There is nothing to recover."));
        }
    }

    /// Keeps what has changed, and passes on what other threads have to say. Once a frame, at its end.
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
            // Counted from the first change: an artist who never rests gets a picture, too.
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

    /// Drops what threads had to say: it was expected.
    pub fn drop_notes(&mut self) {
        if let Some(safekeeping) = &mut self.safekeeping {
            safekeeping.recovery.take_notes();
        }
    }

    /// Shows what can be got back.
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

    /// Has a lost document read. What is open is not changed, and stays until then.
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

    /// Shows a lost document that has been read. Once a frame.
    pub(super) fn poll_recovery(&mut self) {
        let Some(safekeeping) = &mut self.safekeeping else { return };
        let Some(end) = safekeeping.reading.as_ref().and_then(Job::poll) else { return };
        safekeeping.reading = None;
        match end {
            JobEnd::Done((lost, read)) => self.show_recovered(lost, read),
            // Whoever looks for lost work finds it again: nobody holds it any more.
            JobEnd::Failed(reason) => self.report(Message::error(format!("It cannot be recovered: {reason}"))),
            JobEnd::Canceled => {}
        }
    }

    fn show_recovered(&mut self, lost: Lost, read: ReadSnapshot) {
        // What is open may have been changed meanwhile, or undone so that something of it is kept all the same.
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
                // Taken out, so that nothing of the recovered document is forgotten.
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
