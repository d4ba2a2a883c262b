//! How nodes join: the role of an operand among its siblings, and the card of a group.

use egui::{RichText, Ui};

use super::inspector_kinds::field;
use super::sheet::Sheet;
use super::{fields, theme};
use crate::scene::limits::{BLEND_RADIUS, Limits, STEPS, THICKNESS, UNIT};
use crate::scene::{BlendKernel, Group, Joining, Node, NodeKind, Operator, RadiusUnit};

/// Whether the node is joined or cut away, and how it blends; objects and groups.
pub fn role(ui: &mut Ui, sheet: &mut Sheet<'_>) {
    let describe = |cuts| if cuts { "Cut away from what stands before it" } else { "Joined by its group's operator" };
    sheet.choice(
        ui,
        ("Operation", "What the node does to those before it in its group"),
        &[false, true],
        (|cuts| if cuts { "Subtract" } else { "Add" }, describe),
        |n| Some(n.negative),
        |n, cuts| n.negative = cuts,
    );
    if sheet.common(|n| n.parent.is_none()) == Some(true) {
        return;
    }
    let describe = |kind: usize| {
        ["With the radius of its group", "Without a blend", "With a radius of its own, in its group's unit"][kind]
    };
    let kind = |n: &Node| match n.joining {
        Joining::Inherit => 0,
        Joining::Hard => 1,
        Joining::Radius(_) => 2,
    };
    sheet.choice(
        ui,
        ("Blends", "How this node blends with its siblings"),
        &[0, 1, 2],
        (|kind: usize| ["As its group", "Hard", "Own radius"][kind], describe),
        |n| Some(kind(n)),
        |n, kind| n.joining = [Joining::Inherit, Joining::Hard, Joining::Radius(0.1)][kind],
    );
    let radius = field("Own radius", "The blend radius of this node's joint", BLEND_RADIUS, Some(0.1));
    let get = |n: &Node| if let Joining::Radius(radius) = n.joining { Some(radius) } else { None };
    sheet.number(ui, &radius, get, |n, v| n.joining = Joining::Radius(v));
    apart(ui, sheet);
}

/// One check box for each sibling: those that are ticked do not blend with the active node.
fn apart(ui: &mut Ui, sheet: &mut Sheet<'_>) {
    let active = sheet.active().clone();
    let siblings: Vec<_> = {
        let scene = sheet.bench().document.scene();
        scene.children(active.parent).filter(|n| n.id != active.id && n.has_field()).cloned().collect()
    };
    if siblings.is_empty() || sheet.common(|n| n.id).is_none() {
        return;
    }
    let is_theirs = |n: &Node| n.apart.contains(&active.id);
    let count = siblings.iter().filter(|n| active.apart.contains(&n.id) || is_theirs(n)).count();
    let title = if count == 0 { "Does not blend with…".to_owned() } else { format!("Does not blend with {count}") };
    egui::CollapsingHeader::new(RichText::new(title).color(theme::WEAK)).id_salt("apart").show(ui, |ui| {
        for sibling in &siblings {
            let id = sibling.id;
            let name = format!("{} {id}", sibling.name);
            if is_theirs(sibling) {
                ui.label(RichText::new(format!("{name} (set there)")).color(theme::WEAK));
                continue;
            }
            let help = "A joint without a blend between these two";
            let is_apart = |n: &Node| n.apart.contains(&id);
            let set = |n: &mut Node, on| {
                n.apart.retain(|other| *other != id);
                if on {
                    n.apart.push(id);
                }
            };
            ui.push_id(id, |ui| sheet.toggle(ui, ("", name.as_str(), help), is_apart, set));
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
pub fn group(ui: &mut Ui, sheet: &mut Sheet<'_>) {
    fields::card(ui, "Group", |ui| {
        sheet.choice(
            ui,
            ("Operator", "How each child joins those before it"),
            &Operator::ALL,
            (Operator::label, Operator::help),
            |n| get(n).map(|g| g.operator),
            |n, v| with(n, |g| g.operator = v),
        );
        let Some(active) = get(sheet.active()) else { return };
        let operator = active.operator;
        if operator.has_radius() {
            radius(ui, sheet, &active);
        }
        if operator.has_kernel() {
            kernel(ui, sheet, &active);
        }
        measures(ui, sheet, operator);
    });
}

fn radius(ui: &mut Ui, sheet: &mut Sheet<'_>, group: &Group) {
    let (label, help) = match group.operator {
        Operator::Paint => ("Soft edge", "How far the colours run into each other on both sides of the edge"),
        _ => ("Blend radius", "How round the joints are; 0 is a sharp edge"),
    };
    let is_share = group.blend.unit == RadiusUnit::Size;
    let limits = if is_share { Limits { unit: "", ..BLEND_RADIUS } } else { BLEND_RADIUS };
    let radius = field(label, help, limits, Some(0.0));
    sheet.number(ui, &radius, |n| get(n).map(|g| g.blend.radius), |n, v| with(n, |g| g.blend.radius = v));
    let describe = |unit| match unit {
        RadiusUnit::Metres => "The same length whatever the size",
        RadiusUnit::Size => "Times the largest half extent of the smaller operand: scales along",
    };
    sheet.choice(
        ui,
        ("Radius in", "What the radius is measured in"),
        &RadiusUnit::ALL,
        (RadiusUnit::label, describe),
        |n| get(n).map(|g| g.blend.unit),
        |n, v| with(n, |g| g.blend.unit = v),
    );
}

fn kernel(ui: &mut Ui, sheet: &mut Sheet<'_>, group: &Group) {
    sheet.choice(
        ui,
        ("Blend curve", "The curve of the joint; all thicken equally"),
        &BlendKernel::ALL,
        (BlendKernel::label, BlendKernel::help),
        |n| get(n).map(|g| g.blend.kernel),
        |n, v| with(n, |g| g.blend.kernel = v),
    );
    if group.blend.kernel.has_steps() && group.operator.has_steps() {
        let steps = field("Steps", "How many steps or columns", STEPS, Some(4.0));
        let count = |n: &Node| get(n).map(|g| f64::from(g.blend.steps));
        sheet.number(ui, &steps, count, |n, v| {
            with(n, |g| g.blend.steps = v.round().clamp(STEPS.hard[0], STEPS.hard[1]) as u32)
        });
    }
}

fn measures(ui: &mut Ui, sheet: &mut Sheet<'_>, operator: Operator) {
    if operator.has_width() {
        let help = if operator == Operator::Pipe { "Diameter of the tube" } else { "From side to side" };
        let width = field("Width", help, THICKNESS, Some(0.1));
        sheet.number(ui, &width, |n| get(n).map(|g| g.width), |n, v| with(n, |g| g.width = v));
    }
    if operator.has_depth() {
        let tongue = operator == Operator::Tongue;
        let (label, help) = if tongue { ("Height", "How high it rises") } else { ("Depth", "How deep it is cut") };
        let depth = field(label, help, THICKNESS, Some(0.05));
        sheet.number(ui, &depth, |n| get(n).map(|g| g.depth), |n, v| with(n, |g| g.depth = v));
    }
    if operator == Operator::Morph {
        let share = field("Share", "0 is the first child, 1 the next", UNIT, Some(0.5));
        sheet.number(ui, &share, |n| get(n).map(|g| g.share), |n, v| with(n, |g| g.share = v));
    }
}
