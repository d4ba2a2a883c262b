//! Watches the document's file for changes by other programs: warns about them, and asks before overwriting them.

use std::path::PathBuf;

use egui::Context;

use super::conflict::{OverwriteAnswer, OverwriteQuestion, ask};
use super::dialogs::Next;
use super::messages::Message;
use super::root::Editor;
use isolith_jobs::{JobEnd, Task};

impl Editor {
    /// Asks whether to overwrite a file that another program has changed.
    pub(super) fn ask_about_conflict(&mut self, path: PathBuf, then: Option<Next>) {
        self.conflict.question = Some(OverwriteQuestion { path, then });
    }

    /// Checks for changes of the file whenever the window regains the focus. Call once a frame.
    pub(super) fn watch_file(&mut self, ctx: &Context) {
        let has_focus = ctx.input(|i| i.focused);
        let had_focus = std::mem::replace(&mut self.conflict.had_focus, has_focus);
        let stamp = self.state.session.document.stamp();
        if let (true, Some(path), Some(stamp)) = (has_focus && !had_focus, self.state.session.document.path(), stamp)
            && self.conflict.told != Some(stamp)
        {
            let path = path.to_path_buf();
            let job = self.state.derived.jobs().start(Task::hidden("File"), move |_| stamp.seems_outdated(&path));
            self.conflict.looking = Some((job, stamp));
        }
        let Some((job, looked_at)) = &self.conflict.looking else { return };
        let Some(end) = job.poll() else { return };
        let is_this = stamp == Some(*looked_at);
        self.conflict.looking = None;
        if end == JobEnd::Done(true) && is_this {
            self.conflict.told = stamp;
            let name = self.state.session.document.title();
            let name = name.trim_end_matches(" *");
            let text = format!("Another program has changed {name}. File, Reload reads it again; saving asks first.");
            self.report(Message::warning(text));
        }
    }

    /// Shows the question.
    pub(super) fn show_conflict(&mut self, ctx: &Context) {
        let Some(question) = &self.conflict.question else { return };
        let Some(answer) = ask(ctx, &question.path) else { return };
        let Some(OverwriteQuestion { path, then }) = self.conflict.question.take() else { return };
        match answer {
            OverwriteAnswer::Overwrite => self.start_saving(&path, true, then),
            OverwriteAnswer::SaveAs => self.choose_save_path(then, ctx),
            // The artist has just agreed to give up the changes.
            OverwriteAnswer::Reload => self.open_file(&path, true),
            OverwriteAnswer::Cancel => {}
        }
    }
}
