//! The types of an instancer: a weight for each, with its share of the copies.

use egui::{Align, Layout, RichText, Ui};
use egui_material_icons::icons::ICON_ARROW_FORWARD;

use super::edit_session::EditSession;
use super::instancing;
use super::multi_edit::MultiEdit;
use super::numbers::{self, FieldResponse, NumberField};
use super::{inspector_params, theme, widgets};
use isolith_scene::limits::WEIGHT;
use isolith_scene::{Node, NodeId, ParamPath, ParamValue, Part};

/// Width of what stands behind the number, in points.
const SHARE_WIDTH: f32 = 74.0;

const HELP: &str = "How often copies are of this type, in relation to the other types";

/// The card of an instancer.
pub fn show(ui: &mut Ui, edit: &mut MultiEdit<'_>) {
    widgets::card(ui, "Types", |ui| {
        if edit.ids().len() > 1 {
            ui.label(RichText::new("Choose one instancer to edit its types").color(theme::WEAK));
            return;
        }
        let id = edit.active().id;
        let scene = edit.session().document.snapshot();
        let shares = instancing::shares(&scene, id);
        if shares.is_empty() {
            let hint = "No types yet. Drag objects or groups onto the instancer in the outliner, or add a shape while \
                        it is selected.";
            ui.label(RichText::new(hint).color(theme::WEAK));
        }
        for (child, share) in shares {
            let Some(node) = scene.node(child) else { continue };
            ui.push_id(child, |ui| row(ui, edit.session(), node, share));
        }
    });
}

fn row(ui: &mut Ui, session: &mut EditSession, node: &Node, share: f64) {
    let field = NumberField { label: &node.name, help: HELP, limits: WEIGHT, default: Some(1.0) };
    let answer = widgets::row(ui, &node.name, HELP, |ui| {
        let width = (ui.available_width() - SHARE_WIDTH).max(40.0);
        let answer = numbers::number(ui, &field, &format!("Weight of {}", node.name), node.weight, false, width);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let name = format!("Select {}", node.name);
            if widgets::icon_button(ui, ICON_ARROW_FORWARD, &name, theme::WEAK).clicked() {
                session.finish();
                session.document.select(vec![node.id]);
            }
            let color = if share > 0.0 { theme::TEXT } else { theme::FAINT };
            ui.label(RichText::new(instancing::percent(share)).color(color));
        });
        answer
    });
    if let FieldResponse { widget, value: Some(value) } = answer {
        let path = ParamPath::of_node(node.id, Part::Node, "weight");
        session.set_params(widget, vec![(path, ParamValue::Scalar(value))]);
    }
}

/// The card of nodes that are types themselves.
pub fn of_children(ui: &mut Ui, edit: &mut MultiEdit<'_>) {
    let scene = edit.session().document.snapshot();
    let parent = |node: &Node| node.parent.and_then(|id| scene.node(id)).filter(|n| instancing::instancer(n).is_some());
    let parents: Option<Vec<NodeId>> =
        edit.ids().into_iter().map(|id| scene.node(id).and_then(|node| parent(node)).map(|node| node.id)).collect();
    let Some(parents) = parents else { return };
    widgets::card(ui, "Type", |ui| {
        inspector_params::row(ui, edit, Part::Node, "weight");
        let active = edit.active().id;
        let share = parents.last().and_then(|parent| {
            instancing::shares(&scene, *parent).into_iter().find(|(id, _)| *id == active).map(|(_, share)| share)
        });
        if let (Some(share), 1) = (share, edit.ids().len()) {
            let text = format!("{} of the copies are of this type", instancing::percent(share));
            ui.label(RichText::new(text).color(theme::WEAK));
        }
    });
}
