//! The bar at the bottom: mouse actions, progress, counts.

use egui::{Align, Button, Context, Id, Layout, ProgressBar, RichText, Ui};

use super::commands::command::Command;
use super::commands::entries::hovered_help;
use super::keymap::{KeyBindings, shown};
use super::messages::Severity;
use super::panel::{Panel, PanelPlace};
use super::state::EditorState;
use super::transforms::kinds::{Tool, TransformKind};
use super::view_state::{Picture, PointerActivity};
use super::{drawing, instancing, node_warnings, theme};
use isolith_geometry::Camera;
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
        ui.add(ProgressBar::new(progress).desired_width(110.0).desired_height(6.0).fill(*theme::ACCENT));
        if let Some(left) = time_left(ui, "picture", progress) {
            ui.label(RichText::new(left).color(theme::WEAK));
        }
    }
}

/// How long a piece of work still takes, judged by its progress since it was first seen here; `None` while that says
/// little.
fn time_left(ui: &Ui, name: &str, progress: f32) -> Option<String> {
    const ENOUGH: (f64, f64) = (2.0, 0.02);
    let id = Id::unique("time left").with(name);
    let now = ui.input(|i| i.time);
    let (since, from) = ui.data_mut(|d| {
        let (since, from, _) = d
            .get_temp::<(f64, f32, f32)>(id)
            .filter(|(_, _, last)| *last <= progress)
            .unwrap_or((now, progress, progress));
        d.insert_temp(id, (since, from, progress));
        (since, from)
    });
    let (elapsed, done) = (now - since, f64::from(progress - from));
    (elapsed >= ENOUGH.0 && done >= ENOUGH.1).then(|| left_text(elapsed * f64::from(1.0 - progress) / done))
}

fn left_text(seconds: f64) -> String {
    match seconds {
        s if s < 60.0 => format!("about {} s left", s.ceil().max(1.0)),
        s => format!("about {} min left", (s / 60.0).ceil()),
    }
}

fn counts(state: &EditorState, ui: &mut Ui) {
    let nodes = state.session.document.scene().nodes().len();
    let selected = state.session.document.selection().len();
    let chosen = if selected > 1 { format!("{selected} of ") } else { String::new() };
    let text = format!("{chosen}{nodes} {}", if nodes == 1 { "node" } else { "nodes" });
    ui.label(RichText::new(text).color(theme::WEAK));
    if let Some(text) = bricks_text(state) {
        ui.label(RichText::new("·").color(theme::RESTING));
        ui.label(RichText::new(text).color(theme::WEAK));
    }
    let active = state.session.selected().pop();
    let listed = active.as_ref().and_then(|node| instancing::listed_text(state.flat(), node.id));
    let counted = || active.as_deref().and_then(instancing::instancer).and_then(instancing::count_text);
    if let Some(text) = listed.or_else(counted) {
        ui.label(RichText::new("·").color(theme::RESTING));
        ui.label(RichText::new(text).color(theme::WEAK));
    }
    if let Some(text) = active.and_then(|node| in_view(state, ui, node.id)) {
        ui.label(RichText::new("·").color(theme::RESTING));
        ui.label(RichText::new(text).color(theme::WEAK));
    }
}

/// What the number of copies in view was counted for, and what it says.
type CountedView = (usize, NodeId, Camera, f64, Option<String>);

/// How many copies of an instancer are in view; counted again where the scene or the view has changed.
fn in_view(state: &EditorState, ui: &Ui, id: NodeId) -> Option<String> {
    let (camera, aspect) = (state.view.navigation.camera(), state.view.aspect());
    let scene = std::sync::Arc::as_ptr(state.flat()) as usize;
    let key = Id::unique("copies in view");
    let known = ui.data(|d| d.get_temp::<CountedView>(key));
    if let Some((of, node, from, wide, text)) = known
        && (of, node, from, wide) == (scene, id, camera, aspect)
    {
        return text;
    }
    let text = instancing::in_view_text(state.flat(), id, &camera, aspect);
    ui.data_mut(|d| d.insert_temp::<CountedView>(key, (scene, id, camera, aspect, text.clone())));
    text
}

/// What the bricks of models take, and may take; `None` without any.
fn bricks_text(state: &EditorState) -> Option<String> {
    let texels = state.flat().bricks.texels();
    let most = state.derived.brick_budget();
    (texels > 0).then(|| format!("bricks {:.1} of {most} MiB", texels as f64 / 65_536.0))
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
    if let Some((node, text)) = node_warnings::first(state) {
        // What has just happened goes before what has been so for long.
        let now = ui.input(|i| i.time);
        if let Some(message) = state.session.messages.recent(now) {
            ui.label(message.severity.icon().size(14.0));
            ui.add(egui::Label::new(RichText::new(&message.text).color(message.severity.color())).truncate());
            return;
        }
        ui.label(Severity::Warning.icon().size(14.0));
        let button = Button::new(RichText::new(text).color(theme::WARNING)).frame(false).truncate();
        if ui.add(button).on_hover_text("Selects the node").clicked() {
            state.session.document.select(vec![node]);
        }
        return;
    }
    let help = ui.ctx().data_mut(|d| d.remove_temp::<String>(hovered_help()));
    let hint = help.unwrap_or_else(|| hint_of(state, ui.ctx()));
    ui.add(egui::Label::new(RichText::new(hint).color(theme::WEAK)).truncate());
}

/// The current mouse actions, in one line.
fn hint_of(state: &EditorState, ctx: &Context) -> String {
    match state.view.pointer {
        PointerActivity::Orbiting => "Orbiting · Shift with the middle button pans".into(),
        PointerActivity::Panning => "Panning".into(),
        PointerActivity::Zooming => "Zooming · up is nearer".into(),
        PointerActivity::Flying => {
            "W A S D: move · Q E: down, up · Drag: look around · Wheel: speed · Shift: fast".into()
        }
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
        PointerActivity::Drawing => format!(
            "Drag: draw, here {} · Wheel or arrows while drawing: {} · Ctrl: snap · Toolbar, Shift A: another shape · Alt drag: orbit",
            state.view.drawn.label().to_lowercase(),
            drawing::detail_name(state.view.drawn).unwrap_or("nothing more"),
        ),
        PointerActivity::Lassoing => "Draw a line around what you want to select · Shift: add · Esc: cancel".into(),
        PointerActivity::Boxing => "Drag a box around what you want to select · Shift: add · Esc: cancel".into(),
        PointerActivity::Shaping => "Ctrl: snap · Shift: precise · Alt: both sides · Esc: cancel".into(),
        _ if state.session.is_changing() => "Drag sideways to change · Shift: precise · Click: type a number".into(),
        PointerActivity::Hovering if state.view.copy_path.is_some() => {
            state.view.copy_path.clone().unwrap_or_default()
        }
        PointerActivity::Hovering => format!(
            "Click: select, again: below · Double click: into the group · {}Drag: orbit · Shift drag: pan · \
             Ctrl drag: box · Right button with W A S D: fly",
            keys_text(ctx)
        ),
        PointerActivity::Away => {
            "Hover a field for help · Drag rows in the outliner to reorder · F3: find a command".into()
        }
    }
}

/// The keys that add and transform, as they are now.
fn keys_text(ctx: &Context) -> String {
    let bindings = KeyBindings::of(ctx);
    let key = |command: Command| command.info().keys_in(&bindings).first().map(|key| shown(ctx, key));
    let all = |commands: [Command; 3]| commands.map(key).into_iter().collect::<Option<Vec<_>>>();
    let kinds = [TransformKind::Move, TransformKind::Rotate, TransformKind::Scale];
    let at_once = all(kinds.map(Command::Transform));
    let tools = all(kinds.map(|kind| Command::UseTool(Tool::Transform(kind))));
    let transforms = at_once.or(tools).map(|keys| format!("{}: move, rotate, scale · ", keys.join(" ")));
    let add = key(Command::AddAtPointer).map(|key| format!("{key}: add · "));
    add.unwrap_or_default() + &transforms.unwrap_or_default()
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
        ui.add(ProgressBar::new(progress).desired_width(110.0).desired_height(6.0).fill(*theme::ACCENT));
    }
    let left = task.progress().and_then(|progress| time_left(ui, task.name(), progress));
    let label = |text: String| egui::Label::new(RichText::new(text).color(theme::WEAK));
    ui.add(label(format!("{}…", task.name())).truncate());
    let more = if count > 1 { format!("{} more", count - 1) } else { String::new() };
    let left = left.unwrap_or_default();
    let rest = [task.stage(), &left, &more].into_iter().filter(|text| !text.is_empty()).collect::<Vec<_>>().join(", ");
    if !rest.is_empty() {
        ui.add(label(rest).truncate());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_left_is_said_when_enough_is_known() {
        let ctx = Context::default();
        let mut said = Vec::new();
        for (second, progress) in [(0.0, 0.1), (1.0, 0.2), (3.0, 0.4), (6.0, 0.4), (7.0, 0.05)] {
            let input = egui::RawInput { time: Some(second), ..Default::default() };
            let mut output = ctx.run_ui(input, |ui| said.push(time_left(ui, "work", progress)));
            output.textures_delta.clear();
        }
        let said: Vec<_> = said.iter().map(Option::as_deref).collect();
        assert_eq!(said, [None, None, Some("about 6 s left"), Some("about 12 s left"), None]);
        assert_eq!(left_text(200.0), "about 4 min left");
    }
}
