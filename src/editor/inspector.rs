//! The panel on the right: all parameters of the selection, or of the world if nothing is selected.

use std::collections::HashMap;
use std::sync::Arc;

use egui::{RichText, ScrollArea, TextEdit, Ui, vec2};
use egui_material_icons::icons::{ICON_LINK, ICON_LOCK, ICON_LOCK_OPEN, ICON_VISIBILITY, ICON_VISIBILITY_OFF};

use super::edit_session::EditSession;
use super::material_library::MaterialLibrary;
use super::messages::Severity;
use super::multi_edit::MultiEdit;
use super::panel::{Panel, PanelPlace};
use super::state::EditorState;
use super::theme::MIXED;
use super::{
    icons, inspector_blends, inspector_instancer, inspector_kinds, inspector_lists, inspector_material,
    inspector_scene, inspector_transform, inspector_types, node_warnings, selection, theme, widgets,
};
use isolith_jobs::Task;
use isolith_scene::limits::MAX_NAME;
use isolith_scene::{Node, NodeId, NodeKind};

/// State of the inspector that persists between frames.
#[derive(Default)]
pub struct Inspector {
    transform: inspector_transform::EulerMemory,
    /// The tasks that run in this frame.
    tasks: Vec<Task>,
    /// What is wrong with nodes in this frame.
    warned: HashMap<NodeId, String>,
}

impl Panel for Inspector {
    fn id(&self) -> &'static str {
        "inspector"
    }

    fn title(&self) -> &'static str {
        "Inspector"
    }

    fn place(&self) -> PanelPlace {
        PanelPlace::Right(316.0, 240.0)
    }

    fn ui(&mut self, state: &mut EditorState, ui: &mut Ui) {
        self.tasks = state.derived.jobs().listed();
        self.warned = node_warnings::all(state);
        widgets::fixed(ui, |ui| self.show(ui, &mut state.session, &mut state.materials));
    }
}

impl Inspector {
    fn show(&mut self, ui: &mut Ui, session: &mut EditSession, library: &mut MaterialLibrary) {
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = 8.0;
            let selected = session.selected();
            match selected.last() {
                None => match library.current {
                    Some(material) => inspector_material::show_alone(ui, session, library, material),
                    None => inspector_scene::show(ui, session),
                },
                // Text typed for one node must not reach another.
                Some(active) => {
                    let all = selected.clone();
                    ui.push_id(active.id, |ui| self.show_selection(ui, session, library, active.clone(), all));
                }
            }
            ui.add_space(12.0);
        });
    }

    /// The transforms of the unlocked nodes; disabled if all are locked.
    fn transform(&mut self, ui: &mut Ui, session: &mut EditSession, all: &[Arc<Node>]) {
        let scene = session.document.snapshot();
        let (locked, free): (Vec<_>, Vec<_>) =
            all.iter().cloned().partition(|node| selection::holder_of_lock(&scene, node.id).is_some());
        let is_free = !free.is_empty();
        let Some(mut edit) = MultiEdit::new(session, if is_free { free } else { locked.clone() }) else { return };
        ui.add_enabled_ui(is_free, |ui| self.transform.show(ui, &mut edit));
        if !locked.is_empty() {
            let which = match (locked.len(), all.len()) {
                (1, 1) => "It is".to_owned(),
                (1, _) => "One is".to_owned(),
                (count, _) => format!("{count} are"),
            };
            let text = RichText::new(format!("{which} locked and not moved")).small().color(theme::WARNING);
            ui.label(text);
        }
    }

    fn show_selection(
        &mut self,
        ui: &mut Ui,
        session: &mut EditSession,
        library: &mut MaterialLibrary,
        active: Arc<Node>,
        all: Vec<Arc<Node>>,
    ) {
        header(ui, session, &active, &all);
        if let Some(warning) = self.warned.get(&active.id) {
            ui.horizontal_wrapped(|ui| {
                ui.label(Severity::Warning.icon().size(14.0));
                ui.label(RichText::new(warning).color(theme::WARNING));
            });
        }
        if all.iter().all(|n| n.has_field())
            && let Some(mut edit) = MultiEdit::new(session, all.clone())
        {
            // In line with the rows of the cards below.
            let inset = egui::Frame::new().inner_margin(egui::Margin::symmetric(10, 0));
            inset.show(ui, |ui| inspector_blends::role(ui, &mut edit));
        }
        self.transform(ui, session, &all);
        if let Some(mut edit) = MultiEdit::new(session, all.clone()) {
            inspector_types::of_children(ui, &mut edit);
        }
        let moving = all.iter().all(|n| n.can_move()).then(|| all.clone());
        let has_march = |n: &Arc<Node>| n.parent.is_none() || !n.march.is_usual();
        let marched = moving.clone().filter(|all| all.iter().all(has_march));
        let with_fields = all.iter().all(|n| n.has_field()).then(|| all.clone());
        let alike: Vec<_> = all.into_iter().filter(|n| same_kind(&n.kind, &active.kind)).collect();
        let Some(mut edit) = MultiEdit::new(session, alike) else { return };
        match &active.kind {
            NodeKind::Group(_) => inspector_blends::group(ui, &mut edit),
            NodeKind::Object(_) => {
                inspector_kinds::shape(ui, &mut edit, &self.tasks);
                inspector_material::show(ui, &mut edit, library);
            }
            NodeKind::Mesh(mesh) => {
                inspector_kinds::mesh(ui, &mut edit, mesh);
                inspector_material::show(ui, &mut edit, library);
            }
            NodeKind::Instancer(_) => inspector_instancer::show(ui, &mut edit, library),
            NodeKind::Light(_) => inspector_kinds::light(ui, &mut edit),
            NodeKind::Camera(_) => inspector_kinds::camera(ui, &mut edit),
        }
        if let Some(mut edit) = moving.and_then(|nodes| MultiEdit::new(session, nodes)) {
            inspector_lists::dynamics(ui, &mut edit);
        }
        if let Some(mut edit) = with_fields.and_then(|nodes| MultiEdit::new(session, nodes)) {
            inspector_lists::modifiers(ui, &mut edit);
        }
        if let Some(mut edit) = marched.and_then(|nodes| MultiEdit::new(session, nodes)) {
            inspector_kinds::march(ui, &mut edit);
        }
    }
}

fn same_kind(a: &NodeKind, b: &NodeKind) -> bool {
    std::mem::discriminant(a) == std::mem::discriminant(b)
}

/// The name of a node's kind.
pub fn kind_label(node: &Node) -> &'static str {
    match &node.kind {
        NodeKind::Group(_) => "Group",
        NodeKind::Object(object) => object.shape.kind().label(),
        NodeKind::Instancer(_) => "Instancer",
        NodeKind::Mesh(_) => "Mesh",
        NodeKind::Light(_) => "Light",
        NodeKind::Camera(_) => "Camera",
    }
}

/// Icon, name, visibility and lock; for several nodes their number.
fn header(ui: &mut Ui, session: &mut EditSession, active: &Node, all: &[Arc<Node>]) {
    ui.horizontal(|ui| {
        let (rect, _) = ui.allocate_exact_size(vec2(22.0, theme::ROW_HEIGHT), egui::Sense::hover());
        icons::paint_node(ui.painter(), icons::centered(rect, 17.0), active);
        let ids: Vec<_> = all.iter().map(|n| n.id).collect();
        let is_mixed = all.iter().any(|n| n.name != active.name);
        let mut name = if is_mixed { String::new() } else { active.name.clone() };
        let field = TextEdit::singleline(&mut name)
            .hint_text(if is_mixed { MIXED } else { "" })
            .char_limit(MAX_NAME)
            .desired_width(ui.available_width() - 58.0)
            .margin(egui::Margin::symmetric(6, 4));
        let help = if ids.len() > 1 { "The name of all of them" } else { "The name" };
        let response = ui.add(field).on_hover_text(help);
        ui.ctx().accesskit_node_builder(response.id, |node| node.set_label("Name"));
        if response.changed() {
            session.change(response.id, &ids, |n| n.name.clone_from(&name));
        }
        let (icon, text) = if active.visible { (ICON_VISIBILITY, "Hide") } else { (ICON_VISIBILITY_OFF, "Show") };
        let color = if active.visible { theme::WEAK } else { theme::WARNING };
        let differs = |of: fn(&Node) -> bool| all.iter().any(|n| of(n) != of(active));
        let eye = widgets::switch_button(ui, (icon, text), color, differs(|n| n.visible));
        if eye.clicked() {
            session.change(eye.id, &ids, |n| n.visible = !active.visible);
        }
        let (icon, text) = if active.locked { (ICON_LOCK, "Unlock") } else { (ICON_LOCK_OPEN, "Lock") };
        let color = if active.locked { theme::WARNING } else { theme::WEAK };
        let lock = widgets::switch_button(ui, (icon, text), color, differs(|n| n.locked));
        if lock.clicked() {
            session.change(lock.id, &ids, |n| n.locked = !active.locked);
        }
    });
    let what = match all.len() {
        1 => format!("{} {}", kind_label(active), active.id),
        n => format!("{n} nodes selected; fields change all of them, “–” marks values that differ"),
    };
    ui.label(RichText::new(what).small().color(theme::WEAK));
    links(ui, session, active);
}

/// With how many others the active object shares shape and material, and a button to end that.
fn links(ui: &mut Ui, session: &mut EditSession, active: &Node) {
    let Some(link) = active.linked else { return };
    let others = session.document.scene().linked(link).count() - 1;
    if others == 0 {
        return;
    }
    ui.horizontal(|ui| {
        let text = format!("{} Shape and material linked with {others} more", ICON_LINK.codepoint);
        ui.label(RichText::new(text).small().color(theme::WARNING));
        let help = "Takes the selection out of its set of linked objects";
        if ui.small_button("Unlink").on_hover_text(help).clicked() {
            selection::unlink(session);
        }
    });
}
