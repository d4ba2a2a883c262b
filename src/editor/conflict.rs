//! Conflicts with another program that changes the document's file: a warning when noticed, a question before
//! overwriting.

use std::path::{Path, PathBuf};

use egui::{Button, Context, Id, Key, Modal, RichText, vec2};

use super::dialogs::Next;
use super::theme;
use isolith_jobs::Job;
use isolith_scene::file::Stamp;

/// The pending question and the last warning.
#[derive(Default)]
pub struct Conflict {
    /// The pending question.
    pub question: Option<OverwriteQuestion>,
    /// The window had the focus in the last frame.
    pub had_focus: bool,
    /// The stamp of the changed file in the last warning.
    pub told: Option<Stamp>,
    /// The check whether the file still has this stamp.
    pub looking: Option<(Job<bool>, Stamp)>,
}

/// Whether to overwrite the file, and the step after it.
pub struct OverwriteQuestion {
    /// The file to write.
    pub path: PathBuf,
    /// The step after saving.
    pub then: Option<Next>,
}

/// The answer to an [`OverwriteQuestion`].
pub enum OverwriteAnswer {
    /// Overwrite the file.
    Overwrite,
    /// Choose another file.
    SaveAs,
    /// Reload the file and discard the changes.
    Reload,
    /// Do nothing.
    Cancel,
}

impl Conflict {
    /// Whether a check of the file is running.
    pub fn is_looking(&self) -> bool {
        self.looking.is_some()
    }

    /// Whether a question is open.
    pub fn is_open(&self) -> bool {
        self.question.is_some()
    }
}

/// Shows the question; returns the answer.
pub fn ask(ctx: &Context, path: &Path) -> Option<OverwriteAnswer> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let mut answer = None;
    let frame = egui::Frame::window(&ctx.global_style()).inner_margin(18.0);
    let response = Modal::new(Id::unique("changed by others")).frame(frame).show(ctx, |ui| {
        ui.set_width(520.0);
        let heading = RichText::new(format!("“{name}” was changed by another program")).heading();
        ui.add(egui::Label::new(heading.color(theme::STRONG)).wrap());
        ui.add_space(2.0);
        let text = "It is not the file any more that was opened or saved here. To write over it loses what the other \
                    program has written, though a backup stays beside it; to reload it loses your changes.";
        ui.add(egui::Label::new(RichText::new(text).color(theme::WEAK)).wrap());
        ui.add_space(14.0);
        ui.horizontal(|ui| {
            let size = vec2(96.0, 28.0);
            if ui.add(Button::new("Reload").min_size(size)).clicked() {
                answer = Some(OverwriteAnswer::Reload);
            }
            if ui.add(Button::new("Overwrite").min_size(size)).clicked() {
                answer = Some(OverwriteAnswer::Overwrite);
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                let text = RichText::new("Save as…").color(theme::ON_ACCENT);
                if ui.add(Button::new(text).fill(*theme::ACCENT).min_size(size)).clicked() {
                    answer = Some(OverwriteAnswer::SaveAs);
                }
                if ui.add(Button::new("Cancel").min_size(size)).clicked() {
                    answer = Some(OverwriteAnswer::Cancel);
                }
            });
        });
    });
    if ctx.input_mut(|i| i.consume_key(egui::Modifiers::NONE, Key::Enter)) {
        answer = answer.or(Some(OverwriteAnswer::SaveAs));
    }
    if response.should_close() {
        answer = answer.or(Some(OverwriteAnswer::Cancel));
    }
    answer
}
