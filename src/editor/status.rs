//! The bar at the bottom: mouse actions, progress, counts.

use egui::{Align, Button, Layout, ProgressBar, RichText, Ui};

use super::commands::entries::hovered_help;
use super::messages::Severity;
use super::panel::{Panel, PanelPlace};
use super::state::EditorState;
use super::view_state::{Picture, PointerActivity};
use super::{instancing, theme};
use isolith_jobs::Task;
use isolith_scene::NodeId;

/// The panel of the status bar.
pub struct StatusBar;

impl Panel for StatusBar {
    fn id(&self) -> &'static str {
        "status"
    }

    fn title(&self) -> &'static str {
        "Status"
    }

    fn place(&self) -> PanelPlace {
        PanelPlace::Bottom
    }

    fn ui(&mut self, state: &mut EditorState, ui: &mut Ui) {
        ui.style_mut().override_text_style = Some(egui::TextStyle::Small);
        ui.horizontal(|ui| {
            ui.set_height(20.0);
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                counts(state, ui);
                if !state.picture.status.is_empty() {
                    ui.label(RichText::new("·").color(theme::RESTING));
                    ui.label(RichText::new(&state.picture.status).color(theme::WEAK));
                }
                samples(state, ui);
                drawing(state, ui);
                ui.with_layout(Layout::left_to_right(Align::Center), |ui| left(state, ui));
            });
        });
    }
}

/// Number of samples in the picture.
fn samples(state: &EditorState, ui: &mut Ui) {
    if let Some([count, wanted]) = state.picture.samples.filter(|[_, wanted]| *wanted > 1) {
        ui.label(RichText::new("·").color(theme::RESTING));
        ui.label(RichText::new(format!("{count} / {wanted} samples")).color(theme::WEAK));
    }
}

/// Progress of the picture, and a button that stops drawing.
fn drawing(state: &mut EditorState, ui: &mut Ui) {
    let Picture { progress, is_waiting, is_sampling, .. } = state.picture;
    if progress.is_none() && !is_waiting && !is_sampling {
        return;
    }
    let help = "Stops drawing: the picture stays as it is until something changes";
    let button = ui.add(Button::new("Stop").small()).on_hover_text(help);
    ui.ctx().accesskit_node_builder(button.id, |node| node.set_label("Stop drawing"));
    state.view.stops_drawing |= button.clicked();
    if let Some(progress) = progress {
        ui.add(ProgressBar::new(progress).desired_width(110.0).desired_height(6.0).fill(theme::ACCENT));
    }
}

fn counts(state: &EditorState, ui: &mut Ui) {
    let nodes = state.session.document.scene().nodes().len();
    let selected = state.session.document.selection().len();
    let chosen = if selected > 1 { format!("{selected} of ") } else { String::new() };
    let text = format!("{chosen}{nodes} {}", if nodes == 1 { "node" } else { "nodes" });
    ui.label(RichText::new(text).color(theme::WEAK));
    let active = state.session.selected().pop();
    let listed = active.as_ref().and_then(|node| instancing::listed_text(state.flat(), node.id));
    let counted = || active.as_deref().and_then(instancing::instancer).and_then(instancing::count_text);
    if let Some(text) = listed.or_else(counted) {
        ui.label(RichText::new("·").color(theme::RESTING));
        ui.label(RichText::new(text).color(theme::WEAK));
    }
}

/// The running job, a problem of the scene, or a hint on the mouse.
fn left(state: &mut EditorState, ui: &mut Ui) {
    if let Some(task) = state.derived.jobs().foremost() {
        job(ui, &task, state.derived.jobs().listed().len());
        return;
    }
    if let Some(problem) = state.derived.problem() {
        let text = format!("Not shown: {problem}");
        ui.label(Severity::Error.icon().size(14.0));
        let is_canceled = state.derived.is_canceled();
        if is_canceled && ui.small_button("Prepare again").clicked() {
            state.derived.prepare_again();
        }
        ui.add(egui::Label::new(RichText::new(text).color(theme::ERROR)).truncate());
        return;
    }
    if let Some((node, text)) = warning(state) {
        ui.label(Severity::Warning.icon().size(14.0));
        let button = Button::new(RichText::new(text).color(theme::WARNING)).frame(false).truncate();
        if ui.add(button).on_hover_text("Selects the node").clicked() {
            state.session.document.select(vec![node]);
        }
        return;
    }
    let help = ui.ctx().data_mut(|d| d.remove_temp::<String>(hovered_help()));
    let hint = help.unwrap_or_else(|| hint_of(state));
    ui.add(egui::Label::new(RichText::new(hint).color(theme::WEAK)).truncate());
}

/// The current mouse actions, in one line.
fn hint_of(state: &EditorState) -> String {
    match state.view.pointer {
        PointerActivity::Orbiting => "Orbiting · Shift with the middle button pans".into(),
        PointerActivity::Panning => "Panning".into(),
        PointerActivity::Zooming => "Zooming · up is nearer".into(),
        PointerActivity::Moving => "Ctrl: snap · F: onto a surface · Shift: precise · Esc: cancel".into(),
        PointerActivity::Transforming => {
            "X, Y, Z: axis, again: local · Shift X: plane · Type a number · Ctrl: snap · F: onto a surface · Shift: precise · \
             Click or Enter: done · Esc: cancel"
                .into()
        }
        PointerActivity::OverHandle(true) => {
            "Drag: move the point · Ctrl click: delete it · Drag or click +: add a point".into()
        }
        PointerActivity::OverHandle(false) => "Drag: change the value".into(),
        PointerActivity::Lassoing => "Draw a line around what you want to select · Shift: add · Esc: cancel".into(),
        PointerActivity::Boxing => "Drag a box around what you want to select · Shift: add · Esc: cancel".into(),
        PointerActivity::Shaping => "Ctrl: snap · Shift: precise · Alt: both sides · Esc: cancel".into(),
        _ if state.session.is_changing() => "Drag sideways to change · Shift: precise · Click: type a number".into(),
        PointerActivity::Hovering => {
            "Click: select, again: below · Double click: into the group · Shift A: add · G R S: move, rotate, scale · \
             Drag: orbit · Shift drag: pan · Ctrl drag: box"
                .into()
        }
        PointerActivity::Away => {
            "Hover a field for help · Drag rows in the outliner to reorder · F3: find a command".into()
        }
    }
}

/// A running task: name, progress, and a cancel button.
fn job(ui: &mut Ui, task: &Task, count: usize) {
    if task.can_cancel() {
        let button = ui.add(Button::new("Cancel").small()).on_hover_text("Stops it (Escape)");
        ui.ctx().accesskit_node_builder(button.id, |node| node.set_label(format!("Cancel: {}", task.name())));
        if button.clicked() {
            task.cancel();
        }
    }
    if let Some(progress) = task.progress() {
        ui.add(ProgressBar::new(progress).desired_width(110.0).desired_height(6.0).fill(theme::ACCENT));
    }
    let label = |text: String| egui::Label::new(RichText::new(text).color(theme::WEAK));
    ui.add(label(format!("{}…", task.name())).truncate());
    let more = if count > 1 { format!("{} more", count - 1) } else { String::new() };
    let rest = [task.stage(), &more].into_iter().filter(|text| !text.is_empty()).collect::<Vec<_>>().join(", ");
    if !rest.is_empty() {
        ui.add(label(rest).truncate());
    }
}

/// The most important warning for the artist, with its node.
fn warning(state: &EditorState) -> Option<(NodeId, String)> {
    if let Some(problem) = state.derived.model_problem() {
        return Some(problem.clone());
    }
    let warnings = &state.flat().warnings;
    let first = warnings.first()?;
    let more = if warnings.len() > 1 { format!(" (+{})", warnings.len() - 1) } else { String::new() };
    Some((first.node, format!("{}: {}{more}", first.name, first.reason)))
}
