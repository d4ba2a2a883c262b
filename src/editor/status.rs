//! The bar at the bottom: what the mouse does, what is going on, how much there is.

use egui::{Align, Button, Layout, ProgressBar, RichText, Ui};

use super::{Editor, Picture, theme};
use crate::scene::NodeId;

/// Shows the bar.
pub fn show(editor: &mut Editor, ui: &mut Ui, picture: &Picture) {
    ui.style_mut().override_text_style = Some(egui::TextStyle::Small);
    ui.horizontal(|ui| {
        ui.set_height(20.0);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            counts(editor, ui);
            if !picture.status.is_empty() {
                ui.label(RichText::new("·").color(theme::RESTING));
                ui.label(RichText::new(&picture.status).color(theme::WEAK));
            }
            if let Some(progress) = picture.progress {
                ui.add(ProgressBar::new(progress).desired_width(110.0).desired_height(6.0).fill(theme::ACCENT));
            }
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| left(editor, ui));
        });
    });
}

fn counts(editor: &Editor, ui: &mut Ui) {
    let nodes = editor.session.document.scene().nodes().len();
    let selected = editor.session.document.selection().len();
    let chosen = if selected > 1 { format!("{selected} of ") } else { String::new() };
    let text = format!("{chosen}{nodes} {}", if nodes == 1 { "node" } else { "nodes" });
    ui.label(RichText::new(text).color(theme::WEAK));
}

/// What is being read, a problem of the scene, or what the mouse does.
fn left(editor: &mut Editor, ui: &mut Ui) {
    if let Some(name) = editor.files_being_read().next() {
        ui.add(egui::Label::new(RichText::new(format!("Reading {name}…")).color(theme::WEAK)).truncate());
        return;
    }
    if editor.is_flattening(ui.ctx()) {
        ui.label(RichText::new("Preparing the scene…").color(theme::WEAK));
        return;
    }
    if let Some(problem) = &editor.flat.problem {
        let text = format!("Not shown: {problem}");
        ui.label(super::messages::Severity::Error.icon().size(14.0));
        ui.add(egui::Label::new(RichText::new(text).color(theme::ERROR)).truncate());
        return;
    }
    if let Some((node, text)) = warning(editor) {
        ui.label(super::messages::Severity::Warning.icon().size(14.0));
        let button = Button::new(RichText::new(text).color(theme::WARNING)).frame(false).truncate();
        if ui.add(button).on_hover_text("Selects the node").clicked() {
            editor.session.document.select(vec![node]);
        }
        return;
    }
    let help = ui.ctx().data_mut(|d| d.remove_temp::<String>(super::commands::hovered_help()));
    let hint = help.unwrap_or_else(|| editor.viewport.hint(&editor.session));
    ui.add(egui::Label::new(RichText::new(hint).color(theme::WEAK)).truncate());
}

/// The first thing that the artist should look at, with its node.
fn warning(editor: &Editor) -> Option<(NodeId, String)> {
    if let Some(problem) = &editor.flat.mesh_problem {
        return Some(problem.clone());
    }
    let warnings = &editor.flat().warnings;
    let first = warnings.first()?;
    let more = if warnings.len() > 1 { format!(" (+{})", warnings.len() - 1) } else { String::new() };
    Some((first.node, format!("{}: {}{more}", first.name, first.reason)))
}
