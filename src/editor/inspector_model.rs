//! The file of a model that is a field: choosing it, and how far its bricks are.

use egui::{ProgressBar, RichText, Ui};

use super::multi_edit::MultiEdit;
use super::theme;
use isolith_jobs::Task;
use isolith_scene::{Node, NodeKind, Object, Shape};

fn path(node: &Node) -> Option<&str> {
    match &node.kind {
        NodeKind::Object(Object { shape: Shape::MeshField { file, .. }, .. }) => Some(&file.path),
        _ => None,
    }
}

/// What stands below the parameters of a model; nothing for other shapes. `tasks` are those that run.
pub fn show(ui: &mut Ui, edit: &mut MultiEdit<'_>, tasks: &[Task]) {
    let Some(file) = path(edit.active()).map(str::to_owned) else { return };
    let choose = ui.button("Choose a file…").on_hover_text("Another glTF file for all nodes that use this one");
    if choose.clicked() {
        edit.session().wanted_mesh = Some(file.clone());
    }
    if file.is_empty() {
        ui.label(RichText::new("No file yet: a ring on a disc stands in for it.").color(theme::WEAK));
        return;
    }
    // The job is named by the file, see `BrickLibrary`.
    let Some(task) = tasks.iter().find(|task| task.name().ends_with(&file)) else { return };
    ui.horizontal(|ui| {
        let bar = ProgressBar::new(task.progress().unwrap_or(0.0)).desired_width(110.0).desired_height(6.0);
        ui.add(bar.fill(*theme::ACCENT));
        ui.label(RichText::new("Making bricks…").color(theme::WEAK));
        if task.can_cancel() && ui.small_button("Cancel").clicked() {
            task.cancel();
        }
    });
}
