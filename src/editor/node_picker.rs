//! A button that shows a node, and the list of nodes that it opens: found by typing, chosen by a click.

use egui::{Id, Popup, PopupCloseBehavior, RichText, ScrollArea, TextEdit, Ui, vec2};

use super::{icons, theme, widgets};
use isolith_scene::{Node, NodeId, Scene};

/// Width of the list, in points.
const WIDTH: f32 = 240.0;

/// The button with the name that it shows. Returns its id, and the choice: a node that `accept` accepts, or none.
pub fn show(
    ui: &mut Ui,
    label: &str,
    shown: &str,
    scene: &Scene,
    accept: impl Fn(&Node) -> bool,
) -> (Id, Option<Option<NodeId>>) {
    let size = vec2(ui.available_width(), theme::ROW_HEIGHT);
    let opener = ui.add_sized(size, egui::Button::new(format!("{shown}…")).truncate().min_size(size));
    ui.ctx().accesskit_node_builder(opener.id, |node| node.set_label(format!("{label}: {shown}")));
    let is_new = opener.clicked();
    let search = opener.id.with("search");
    let popup = Popup::menu(&opener).close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    let chosen = popup.show(|ui| {
        ui.set_width(WIDTH);
        let mut text = ui.data(|d| d.get_temp::<String>(search)).filter(|_| !is_new).unwrap_or_default();
        let field = TextEdit::singleline(&mut text).hint_text("Search nodes…").desired_width(f32::INFINITY);
        let field = ui.add(field.margin(egui::Margin::symmetric(8, 4)));
        ui.ctx().accesskit_node_builder(field.id, |node| node.set_label("Search nodes"));
        if is_new {
            field.request_focus();
        }
        let wanted = text.trim().to_lowercase();
        ui.data_mut(|d| d.insert_temp(search, text));
        let none = ui.selectable_label(false, "None").clicked();
        let is_found = |node: &&&Node| accept(node) && node.name.to_lowercase().contains(&wanted);
        let found: Vec<&Node> = scene.nodes().iter().map(|node| &**node).filter(|node| is_found(&node)).collect();
        let chosen = entries(ui, &found).map(Some).or(none.then_some(None));
        if chosen.is_some() {
            ui.close();
        }
        chosen
    });
    (opener.id, chosen.and_then(|shown| shown.inner))
}

fn entries(ui: &mut Ui, found: &[&Node]) -> Option<NodeId> {
    if found.is_empty() {
        ui.label(RichText::new("No node here fits.").color(theme::WEAK));
    }
    let room = widgets::list_room(ui.ctx());
    let mut chosen = None;
    let area = ScrollArea::vertical().max_height(room).auto_shrink([false, true]);
    area.show_rows(ui, theme::ROW_HEIGHT, found.len(), |ui, rows| {
        for node in &found[rows] {
            ui.horizontal(|ui| {
                let (rect, _) = ui.allocate_exact_size(vec2(18.0, theme::ROW_HEIGHT), egui::Sense::hover());
                icons::paint_node(ui.painter(), icons::centered(rect, 14.0), node);
                let entry = ui.selectable_label(false, widgets::elided(&node.name, 28));
                ui.ctx()
                    .accesskit_node_builder(entry.id, |entry| entry.set_label(format!("{} {}", node.name, node.id)));
                if entry.on_hover_text(format!("{} {}", node.name, node.id)).clicked() {
                    chosen = Some(node.id);
                }
            });
        }
    });
    chosen
}
