//! Somebody else has changed the document's file: asked before it is written over, told when it is noticed.

use std::path::{Path, PathBuf};

use egui::{Button, Context, Id, Key, Modal, RichText, vec2};

use super::dialogs::Next;
use super::messages::Message;
use super::{Editor, theme};
use crate::document::{Document, OverwriteRisk};
use crate::scene::file::Stamp;

/// A question that waits, and what has been told.
#[derive(Default)]
pub(super) struct Conflict {
    question: Option<ConflictQuestion>,
    had_focus: bool,
    /// What the file was when the artist was told that it is another one.
    told: Option<Stamp>,
}

/// Whether to write over the file, and how to go on then.
struct ConflictQuestion {
    path: PathBuf,
    then: Option<Next>,
}

enum ConflictAnswer {
    Overwrite,
    SaveAs,
    Reload,
    Cancel,
}

impl Conflict {
    /// Whether the window waits for an answer.
    pub fn is_open(&self) -> bool {
        self.question.is_some()
    }
}

impl Editor {
    /// Saves to the path, unless somebody else has changed the document's file: then it asks first.
    pub(super) fn save_unless_changed(&mut self, path: &Path, then: Option<Next>, ctx: &Context) {
        match self.session.document.would_replace(path) {
            OverwriteRisk::ChangedByOthers => {
                self.conflict.question = Some(ConflictQuestion { path: path.to_path_buf(), then });
            }
            OverwriteRisk::Nothing | OverwriteRisk::OtherFile => self.save_to(path, then, ctx),
        }
    }

    /// Reads the document's file again. Changes are given up, so they are asked about first.
    pub(super) fn reload(&mut self) {
        let Some(path) = self.session.document.path().map(Path::to_path_buf) else { return };
        match Document::open(&path) {
            Ok(document) => {
                self.replace_document(document);
                self.report(Message::success(format!("Read {} again", path.display())));
            }
            Err(error) => self.report(Message::error(error.to_string())),
        }
    }

    /// Looks whether the file has changed when the artist comes back to the window. Once a frame.
    pub(super) fn watch_file(&mut self, ctx: &Context) {
        let has_focus = ctx.input(|i| i.focused);
        let had_focus = std::mem::replace(&mut self.conflict.had_focus, has_focus);
        let came_back = has_focus && !had_focus;
        let stamp = self.session.document.stamp();
        if came_back && self.conflict.told != stamp && self.session.document.seems_outdated() {
            self.conflict.told = stamp;
            let name = self.session.document.title();
            let name = name.trim_end_matches(" *");
            let text = format!("Another program has changed {name}. File, Reload reads it again; saving asks first.");
            self.report(Message::warning(text));
        }
    }

    /// Shows the question.
    pub(super) fn show_conflict(&mut self, ctx: &Context) {
        let Some(question) = &self.conflict.question else { return };
        let Some(answer) = ask(ctx, &question.path) else { return };
        let Some(ConflictQuestion { path, then }) = self.conflict.question.take() else { return };
        match answer {
            ConflictAnswer::Overwrite => self.save_to(&path, then, ctx),
            ConflictAnswer::SaveAs => self.choose_save_path(then, ctx),
            ConflictAnswer::Reload => self.reload(),
            ConflictAnswer::Cancel => {}
        }
    }
}

fn ask(ctx: &Context, path: &Path) -> Option<ConflictAnswer> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let mut answer = None;
    let frame = egui::Frame::window(&ctx.global_style()).inner_margin(18.0);
    let response = Modal::new(Id::unique("changed by others")).frame(frame).show(ctx, |ui| {
        ui.set_width(520.0);
        let heading = RichText::new(format!("“{name}” was changed by another program")).heading();
        ui.add(egui::Label::new(heading.color(egui::Color32::WHITE)).wrap());
        ui.add_space(2.0);
        let text = "It is not the file any more that was opened or saved here. To write over it loses what the other \
                    program has written, though a backup stays beside it; to reload it loses your changes.";
        ui.add(egui::Label::new(RichText::new(text).color(theme::WEAK)).wrap());
        ui.add_space(14.0);
        ui.horizontal(|ui| {
            let size = vec2(96.0, 28.0);
            if ui.add(Button::new("Reload").min_size(size)).clicked() {
                answer = Some(ConflictAnswer::Reload);
            }
            if ui.add(Button::new("Overwrite").min_size(size)).clicked() {
                answer = Some(ConflictAnswer::Overwrite);
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                let text = RichText::new("Save as…").color(egui::Color32::BLACK);
                if ui.add(Button::new(text).fill(theme::ACCENT).min_size(size)).clicked() {
                    answer = Some(ConflictAnswer::SaveAs);
                }
                if ui.add(Button::new("Cancel").min_size(size)).clicked() {
                    answer = Some(ConflictAnswer::Cancel);
                }
            });
        });
    });
    if ctx.input_mut(|i| i.consume_key(egui::Modifiers::NONE, Key::Enter)) {
        answer = answer.or(Some(ConflictAnswer::SaveAs));
    }
    if response.should_close() {
        answer = answer.or(Some(ConflictAnswer::Cancel));
    }
    answer
}
