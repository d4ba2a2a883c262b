//! Blends: the role of an operand among its siblings, and the card of a group.

use egui::{RichText, Ui};

use super::multi_edit::MultiEdit;
use super::numbers::NumberField;
use super::{inspector_params, theme, widgets};
use isolith_scene::{Group, Node, NodeKind, Operator, Part, RadiusUnit};

/// Whether the node is added, subtracted or intersected, and how it blends; for objects and groups.
pub fn role(ui: &mut Ui, edit: &mut MultiEdit<'_>) {
    inspector_params::row(ui, edit, Part::Node, "operation");
    if edit.common(|n| n.parent.is_none()) == Some(true) {
        return;
    }
    inspector_params::row(ui, edit, Part::Node, "joining");
    inspector_params::row(ui, edit, Part::Node, "joining.radius");
    apart(ui, edit);
}

/// One check box for each sibling; checked siblings do not blend with the active node.
fn apart(ui: &mut Ui, edit: &mut MultiEdit<'_>) {
    let active = edit.active().clone();
    let siblings: Vec<_> = {
        let scene = edit.session().document.scene();
        scene.children(active.parent).filter(|n| n.id != active.id && n.has_field()).cloned().collect()
    };
    if siblings.is_empty() || edit.common(|n| n.id).is_none() {
        return;
    }
    let is_theirs = |n: &Node| n.apart.contains(&active.id);
    let count = siblings.iter().filter(|n| active.apart.contains(&n.id) || is_theirs(n)).count();
    let title = if count == 0 { "Blend exclusions".to_owned() } else { format!("Blend exclusions ({count})") };
    egui::CollapsingHeader::new(RichText::new(title).color(theme::WEAK)).id_salt("apart").show(ui, |ui| {
        for sibling in &siblings {
            let id = sibling.id;
            let name = format!("{} {id}", sibling.name);
            if is_theirs(sibling) {
                ui.label(RichText::new(format!("{name} (set there)")).color(theme::WEAK));
                continue;
            }
            let help = "No blend between these two";
            let is_apart = |n: &Node| n.apart.contains(&id);
            let set = |n: &mut Node, on| {
                n.apart.retain(|other| *other != id);
                if on {
                    n.apart.push(id);
                }
            };
            ui.push_id(id, |ui| edit.toggle(ui, ("", name.as_str(), help), is_apart, set));
        }
    });
}

fn get(n: &Node) -> Option<Group> {
    if let NodeKind::Group(g) = n.kind { Some(g) } else { None }
}

/// Operator, blend and the other parameters of the operator; shows only those that apply.
pub fn group(ui: &mut Ui, edit: &mut MultiEdit<'_>) {
    widgets::card(ui, "Group", |ui| {
        row(ui, edit, "operator", |_| {});
        let Some(active) = get(edit.active()) else { return };
        let operator = active.operator;
        if operator.has_radius() {
            radius(ui, edit, &active);
        }
        if operator.has_kernel() {
            row(ui, edit, "blend.kernel", |_| {});
            if active.blend.kernel.has_steps() && operator.has_steps() {
                row(ui, edit, "blend.steps", |_| {});
            }
        }
        measures(ui, edit, operator);
        row(ui, edit, "bake", |_| {});
    });
}

fn row(ui: &mut Ui, edit: &mut MultiEdit<'_>, name: &'static str, adapt: impl FnOnce(&mut NumberField<'_>)) {
    inspector_params::row_with(ui, edit, Part::Operator, name, adapt);
}

fn radius(ui: &mut Ui, edit: &mut MultiEdit<'_>, group: &Group) {
    row(ui, edit, "blend.radius", |field| {
        if group.operator == Operator::Paint {
            field.label = "Soft edge";
            field.help = "How far the colors run into each other on both sides of the edge";
        }
        if group.blend.unit == RadiusUnit::Size {
            field.limits.unit = "";
        }
    });
    row(ui, edit, "blend.unit", |_| {});
}

fn measures(ui: &mut Ui, edit: &mut MultiEdit<'_>, operator: Operator) {
    if operator.has_width() {
        let help = if operator == Operator::Pipe { "Diameter of the tube" } else { "From side to side" };
        row(ui, edit, "width", |field| field.help = help);
    }
    if operator.has_depth() {
        let tongue = operator == Operator::Tongue;
        let (label, help) = if tongue { ("Height", "How high it rises") } else { ("Depth", "How deep it is cut") };
        row(ui, edit, "depth", |field| (field.label, field.help) = (label, help));
    }
    if operator == Operator::Morph {
        row(ui, edit, "share", |field| field.help = "0 is the first child, 1 the next");
    }
}
