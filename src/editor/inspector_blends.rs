//! How nodes join: the role of an operand among its siblings, and the card of a group.

use egui::{RichText, Ui};

use super::inspector_kinds::field;
use super::multi_edit::MultiEdit;
use super::{theme, widgets};
use crate::scene::limits::{BLEND_RADIUS, Limits, STEPS, THICKNESS, UNIT};
use crate::scene::{BlendKernel, BlendOverride, Group, Node, NodeKind, Operator, RadiusUnit};

/// Whether the node is joined or cut away, and how it blends; objects and groups.
pub fn role(ui: &mut Ui, edit: &mut MultiEdit<'_>) {
    let describe = |cuts| if cuts { "Cut away from what stands before it" } else { "Joined by its group's operator" };
    edit.choice(
        ui,
        ("Operation", "What the node does to those before it in its group"),
        &[false, true],
        (|cuts| if cuts { "Subtract" } else { "Add" }, describe),
        |n| Some(n.negative),
        |n, cuts| n.negative = cuts,
    );
    if edit.common(|n| n.parent.is_none()) == Some(true) {
        return;
    }
    let describe = |kind: usize| {
        ["With the radius of its group", "Without a blend", "With a radius of its own, in its group's unit"][kind]
    };
    let kind = |n: &Node| match n.blend_override {
        BlendOverride::Inherit => 0,
        BlendOverride::Hard => 1,
        BlendOverride::Radius(_) => 2,
    };
    edit.choice(
        ui,
        ("Blend", "How this node blends with its siblings"),
        &[0, 1, 2],
        (|kind: usize| ["Inherit", "None", "Custom"][kind], describe),
        |n| Some(kind(n)),
        |n, kind| n.blend_override = [BlendOverride::Inherit, BlendOverride::Hard, BlendOverride::Radius(0.1)][kind],
    );
    let radius = field("Custom radius", "The radius of this node's blend", BLEND_RADIUS, Some(0.1));
    let get = |n: &Node| if let BlendOverride::Radius(radius) = n.blend_override { Some(radius) } else { None };
    edit.number(ui, &radius, get, |n, v| n.blend_override = BlendOverride::Radius(v));
    apart(ui, edit);
}

/// One check box for each sibling: those that are ticked do not blend with the active node.
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

fn with(n: &mut Node, change: impl FnOnce(&mut Group)) {
    if let NodeKind::Group(g) = &mut n.kind {
        change(g);
    }
}

/// Operator, blend, and what else the operator needs: only what applies is shown.
pub fn group(ui: &mut Ui, edit: &mut MultiEdit<'_>) {
    widgets::card(ui, "Group", |ui| {
        edit.choice(
            ui,
            ("Boolean operation", "How each child joins those before it"),
            &Operator::ALL,
            (Operator::label, Operator::help),
            |n| get(n).map(|g| g.operator),
            |n, v| with(n, |g| g.operator = v),
        );
        let Some(active) = get(edit.active()) else { return };
        let operator = active.operator;
        if operator.has_radius() {
            radius(ui, edit, &active);
        }
        if operator.has_kernel() {
            kernel(ui, edit, &active);
        }
        measures(ui, edit, operator);
    });
}

fn radius(ui: &mut Ui, edit: &mut MultiEdit<'_>, group: &Group) {
    let (label, help) = match group.operator {
        Operator::Paint => ("Soft edge", "How far the colors run into each other on both sides of the edge"),
        _ => ("Blend radius", "How round the blends are; 0 is a sharp edge"),
    };
    let is_share = group.blend.unit == RadiusUnit::Size;
    let limits = if is_share { Limits { unit: "", ..BLEND_RADIUS } } else { BLEND_RADIUS };
    let radius = field(label, help, limits, Some(0.0));
    edit.number(ui, &radius, |n| get(n).map(|g| g.blend.radius), |n, v| with(n, |g| g.blend.radius = v));
    let describe = |unit| match unit {
        RadiusUnit::Meters => "The same length whatever the size",
        RadiusUnit::Size => "Times the largest half extent of the smaller operand: scales along",
    };
    edit.choice(
        ui,
        ("Blend units", "What the radius is measured in"),
        &RadiusUnit::ALL,
        (RadiusUnit::label, describe),
        |n| get(n).map(|g| g.blend.unit),
        |n, v| with(n, |g| g.blend.unit = v),
    );
}

fn kernel(ui: &mut Ui, edit: &mut MultiEdit<'_>, group: &Group) {
    edit.choice(
        ui,
        ("Blend profile", "The curve of the blend; all thicken equally"),
        &BlendKernel::ALL,
        (BlendKernel::label, BlendKernel::help),
        |n| get(n).map(|g| g.blend.kernel),
        |n, v| with(n, |g| g.blend.kernel = v),
    );
    if group.blend.kernel.has_steps() && group.operator.has_steps() {
        let steps = field("Steps", "How many steps or columns", STEPS, Some(4.0));
        let count = |n: &Node| get(n).map(|g| f64::from(g.blend.steps));
        edit.number(ui, &steps, count, |n, v| {
            with(n, |g| g.blend.steps = v.round().clamp(STEPS.hard[0], STEPS.hard[1]) as u32)
        });
    }
}

fn measures(ui: &mut Ui, edit: &mut MultiEdit<'_>, operator: Operator) {
    if operator.has_width() {
        let help = if operator == Operator::Pipe { "Diameter of the tube" } else { "From side to side" };
        let width = field("Width", help, THICKNESS, Some(0.1));
        edit.number(ui, &width, |n| get(n).map(|g| g.width), |n, v| with(n, |g| g.width = v));
    }
    if operator.has_depth() {
        let tongue = operator == Operator::Tongue;
        let (label, help) = if tongue { ("Height", "How high it rises") } else { ("Depth", "How deep it is cut") };
        let depth = field(label, help, THICKNESS, Some(0.05));
        edit.number(ui, &depth, |n| get(n).map(|g| g.depth), |n, v| with(n, |g| g.depth = v));
    }
    if operator == Operator::Morph {
        let share = field("Share", "0 is the first child, 1 the next", UNIT, Some(0.5));
        edit.number(ui, &share, |n| get(n).map(|g| g.share), |n, v| with(n, |g| g.share = v));
    }
}
