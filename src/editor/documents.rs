//! Opening, saving, quitting: jobs beside the frames, and the question before a loss of work. The current document
//! stays open and editable until the next one is complete.

use std::path::Path;

use egui::{Context, ViewportCommand};

use super::dialogs::{Next, Purpose, Question};
use super::document_jobs::{Opening, SaveAnswer, Saving};
use super::intent::Intent;
use super::messages::Message;
use super::root::Editor;
use isolith_document::{Document, OverwriteRisk};
use isolith_jobs::{JobEnd, Task};
use isolith_scene::{Light, LightKind, Node, NodeKind, Scene, Shadowing};
use isolith_session::{folder_of, read_file};

impl Editor {
    /// Carries out the intent, with a question before a loss of work. A file that cannot be read is refused before the
    /// question.
    pub fn intend(&mut self, intent: Intent, ctx: &Context) {
        self.state.session.finish();
        // Whatever was chosen, also by a key: it is not in the way of what opens.
        self.welcome.is_open = false;
        match intent {
            Intent::New => self.unless_lost(Next::New, ctx),
            Intent::Choose => self.perform(Next::Choose, ctx),
            Intent::Quit if self.is_rendering() => self.dialogs.question = Some(Question::Rendering(Next::Quit)),
            Intent::Quit => self.unless_lost(Next::Quit, ctx),
            Intent::Open(path) => self.open_file(&path, false),
            Intent::Template(index) => {
                let Some((name, open)) = self.template(index) else { return };
                let job = self.state.derived.open(&name, open);
                self.opening = Some(Opening { job, name, path: None, is_agreed: false });
            }
            Intent::Example(index) => {
                let Some(example) = self.state.examples.get(index) else { return };
                let job = self.state.derived.open(&example.name, example.open.clone());
                self.opening = Some(Opening { job, name: example.name.clone(), path: None, is_agreed: false });
            }
        }
    }

    /// Opens the document in this file; replaces a pending opening.
    pub(super) fn open_file(&mut self, path: &Path, is_agreed: bool) {
        let name = name_of(path);
        let job = self.state.derived.open(&name, read_file(path));
        self.opening = Some(Opening { job, name, path: Some(path.to_path_buf()), is_agreed });
    }

    /// Performs the step, with a question before a loss of work. A running save finishes first.
    pub(super) fn unless_lost(&mut self, next: Next, ctx: &Context) {
        if let Some(saving) = &mut self.saving {
            saving.then = Some(next);
        } else if self.state.session.document.is_changed() {
            self.dialogs.question = Some(Question::Unsaved(next));
        } else {
            self.perform(next, ctx);
        }
    }

    pub(super) fn perform(&mut self, next: Next, ctx: &Context) {
        match next {
            Next::New => self.replace_document(new_document()),
            Next::Choose => self.choose(Purpose::Open, ctx),
            Next::Show(opened, path) => {
                self.show_opened(*opened);
                if let Some(path) = path {
                    self.state.files.note_recent(self.state.derived.jobs(), &path);
                }
            }
            Next::Save(path, may_replace, then) => self.start_saving(&path, may_replace, then.map(|next| *next)),
            Next::Quit => {
                self.state.files.finish();
                self.dialogs.closing = true;
                ctx.send_viewport_cmd(ViewportCommand::Close);
            }
        }
    }

    /// Saves, asking for a path if the document has none; then continues with `then`.
    pub fn save(&mut self, then: Option<Next>, ctx: &Context) {
        self.state.session.finish();
        match self.state.session.document.path().map(Path::to_path_buf) {
            None => self.choose_save_path(then, ctx),
            Some(path) => self.start_saving(&path, false, then),
        }
    }

    /// Saves in a job, then continues with `then`. `may_replace` allows overwriting the changes of another program.
    pub(super) fn start_saving(&mut self, path: &Path, may_replace: bool, then: Option<Next>) {
        if let Some(saving) = &mut self.saving {
            saving.then = Some(Next::Save(path.to_path_buf(), may_replace, then.map(Box::new)));
            return;
        }
        let order = self.state.session.document.save_order(path);
        let task = Task::without_cancel(format!("Saving {}", name_of(path)));
        let job = self.state.derived.jobs().start(task, move |_| {
            if !may_replace && order.would_replace() == OverwriteRisk::ChangedByOthers {
                return SaveAnswer::ChangedByOthers;
            }
            SaveAnswer::Saved(order.write())
        });
        self.saving = Some(Saving { job, path: path.to_path_buf(), then });
    }

    /// Takes over opened and saved documents. Call once a frame, before the panels.
    pub(super) fn poll_documents(&mut self, ctx: &Context) {
        self.poll_saving(ctx);
        self.poll_opening(ctx);
    }

    fn poll_saving(&mut self, ctx: &Context) {
        let Some(end) = self.saving.as_ref().and_then(|saving| saving.job.poll()) else { return };
        let Some(Saving { path, then, .. }) = self.saving.take() else { return };
        match end {
            JobEnd::Done(SaveAnswer::Saved(Ok(saved))) => {
                self.state.session.document.take_saved(saved);
                self.forget_kept();
                self.state.derived.set_folder(folder_of(&path));
                self.state.files.note_recent(self.state.derived.jobs(), &path);
                self.report(Message::success(format!("Saved {}", path.display())));
                match then {
                    Some(next @ Next::Save(..)) => self.perform(next, ctx),
                    // Ask about edits made during the save.
                    Some(next) => self.unless_lost(next, ctx),
                    None => {}
                }
            }
            JobEnd::Done(SaveAnswer::ChangedByOthers) => self.ask_about_conflict(path, then),
            JobEnd::Done(SaveAnswer::Saved(Err(error))) => self.report(Message::error(error.to_string())),
            JobEnd::Failed(reason) => {
                self.report(Message::error(format!("{} is not saved: {reason}", path.display())));
            }
            // Saving cannot be canceled.
            JobEnd::Canceled => {}
        }
    }

    fn poll_opening(&mut self, ctx: &Context) {
        // A drag or an open question belongs to the current document: wait for its end.
        let is_held = self.saving.is_some() || self.has_dialog() || ctx.input(|i| i.pointer.any_down());
        if is_held {
            return;
        }
        let Some(end) = self.opening.as_ref().and_then(|opening| opening.job.poll()) else { return };
        let Some(Opening { name, path, is_agreed, .. }) = self.opening.take() else { return };
        match end {
            JobEnd::Done(Ok(opened)) => {
                self.state.session.finish();
                let reread = path.as_ref().filter(|_| is_agreed).map(|path| format!("Read {} again", path.display()));
                let next = Next::Show(Box::new(opened), path);
                match reread {
                    Some(text) => {
                        self.perform(next, ctx);
                        self.report(Message::success(text));
                    }
                    None => self.unless_lost(next, ctx),
                }
            }
            JobEnd::Done(Err(reason)) => self.report(Message::error(reason)),
            JobEnd::Failed(reason) => self.report(Message::error(format!("{name} cannot be opened: {reason}"))),
            JobEnd::Canceled => self.report(Message::info(format!("Opening {name} was canceled."))),
        }
    }

    /// Keeps the window open and asks if closing would lose work.
    pub(super) fn guard_closing(&mut self, ctx: &Context) {
        let requested = ctx.input(|i| i.viewport().close_requested());
        let would_lose = self.state.session.document.is_changed() || self.saving.is_some() || self.is_rendering();
        if requested && !self.dialogs.closing && would_lose {
            ctx.send_viewport_cmd(ViewportCommand::CancelClose);
            if !self.has_dialog() {
                self.intend(Intent::Quit, ctx);
            }
        }
    }
}

/// The last component of a path, for display.
fn name_of(path: &Path) -> String {
    path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned())
}

/// The document of "New": only a sun, with shadows and occlusion.
pub fn new_document() -> Document {
    let mut scene = Scene::new();
    scene.environment.shadowing = Shadowing::default();
    let direction = glam::DQuat::from_euler(glam::EulerRot::YXZ, 0.6, -0.9, 0.0);
    // Keep bright clay below white on its lit side.
    let light = Light::new(LightKind::Sun { strength: 3.7, angle: 0.53 });
    let sun = Node::new("Sun", NodeKind::Light(light)).rotated(direction).at(glam::DVec3::new(2.0, 4.0, 3.0));
    scene.insert(None, 0, sun).expect("an empty scene takes a light");
    Document::new(scene)
}
