//! Cards of an instancer: where its copies stand, which of them exist, how they differ, and their seed.

use egui::{RichText, Ui};
use egui_material_icons::icons::{ICON_CASINO, ICON_LOCK, ICON_LOCK_OPEN};

use super::instancing::{self, TargetNeed};
use super::material_library::MaterialLibrary;
use super::multi_edit::MultiEdit;
use super::{inspector_palette, inspector_params, inspector_types, node_picker, seeds, slot_list, theme, widgets};
use isolith_scene::{Instancer, Lattice, MaskSlot, Node, NodeId, Part, Snap};

/// All cards.
pub fn show(ui: &mut Ui, edit: &mut MultiEdit<'_>, library: &mut MaterialLibrary) {
    inspector_types::show(ui, edit);
    distribution(ui, edit);
    widgets::card(ui, "Existence", |ui| {
        inspector_params::row(ui, edit, Part::Instancer, "probability");
        slot_list::show::<MaskSlot>(ui, edit);
    });
    randomize(ui, edit);
    widgets::card(ui, "Materials", |ui| {
        inspector_palette::show(ui, edit, library);
        rows_below(ui, edit, "material.");
    });
    seed(ui, edit);
}

/// A row for each parameter of the instancer whose name begins with `prefix`.
fn rows_below(ui: &mut Ui, edit: &mut MultiEdit<'_>, prefix: &str) {
    let mut names = Vec::new();
    if let Some(params) = Part::Instancer.params(edit.active()) {
        params.visit("", &mut |before, param, _| names.push(format!("{before}{}", param.name)));
    }
    for name in names.into_iter().filter(|name| name.starts_with(prefix)) {
        inspector_params::row(ui, edit, Part::Instancer, name);
    }
}

fn active(edit: &MultiEdit<'_>) -> Instancer {
    instancing::instancer(edit.active()).cloned().unwrap_or_default()
}

/// The lattice with its parameters, the target where one is needed, and how copies stand on it.
fn distribution(ui: &mut Ui, edit: &mut MultiEdit<'_>) {
    widgets::card(ui, "Distribution", |ui| {
        let scene = edit.session().document.snapshot();
        if let Some(problem) = instancing::problem(&scene, edit.active()) {
            ui.label(RichText::new(format!("{} {problem}", edit.active().name)).color(theme::WARNING));
        }
        rows_below(ui, edit, "lattice.");
        let now = active(edit);
        let can_snap = !matches!(now.lattice, Lattice::Curve { .. });
        if can_snap {
            inspector_params::row(ui, edit, Part::Instancer, "snap");
        }
        if let Some(need) = instancing::need_of_target(&now) {
            target(ui, edit, need);
        }
        if matches!(now.lattice, Lattice::Scatter { .. }) || (can_snap && now.snap != Snap::Off) {
            inspector_params::row(ui, edit, Part::Instancer, "align");
        }
        let common = edit.common(|node| instancing::instancer(node).and_then(instancing::count_text));
        if let Some(text) = common.flatten() {
            ui.label(RichText::new(text).color(theme::WEAK));
        }
    });
}

/// The node that copies stand on or follow.
fn target(ui: &mut Ui, edit: &mut MultiEdit<'_>, need: TargetNeed) {
    let scene = edit.session().document.snapshot();
    let ids = edit.ids();
    let of = |node: &Node| instancing::instancer(node).and_then(|instancer| instancer.target);
    let shown = match edit.common(of) {
        None => widgets::MIXED.to_owned(),
        Some(None) => "None".to_owned(),
        Some(Some(id)) => scene.node(id).map_or_else(|| format!("Missing {id}"), |node| node.name.clone()),
    };
    let help = match need {
        TargetNeed::Surface => "The object or group whose surface the copies stand on",
        TargetNeed::Curve => "The tube whose curve the copies follow",
    };
    let accept = |node: &Node| need.accepts(&scene, node, &ids);
    let (widget, chosen) =
        widgets::row(ui, "Target", help, |ui| node_picker::show(ui, "Target", &shown, &scene, accept));
    if let Some(chosen) = chosen {
        set_target(edit, widget, chosen);
    }
}

fn set_target(edit: &mut MultiEdit<'_>, widget: egui::Id, target: Option<NodeId>) {
    edit.change(widget, |node| {
        if let Some(instancer) = instancing::instancer_mut(node) {
            instancer.target = target;
        }
    });
}

/// How far the transforms of copies differ: each range as its least and greatest value.
fn randomize(ui: &mut Ui, edit: &mut MultiEdit<'_>) {
    const RANGES: [[&str; 2]; 3] = [
        ["variation.offset_min", "variation.offset_max"],
        ["variation.rotation_min", "variation.rotation_max"],
        ["variation.scale_min", "variation.scale_max"],
    ];
    widgets::card(ui, "Randomize transform", |ui| {
        inspector_params::row(ui, edit, Part::Instancer, "variation.looseness");
        for [least, most] in RANGES {
            inspector_params::end_row(ui, edit, Part::Instancer, [least, most], f64::max);
            inspector_params::end_row(ui, edit, Part::Instancer, [most, least], f64::min);
        }
        inspector_params::row(ui, edit, Part::Instancer, "variation.uniform");
    });
}

/// The seed, a button for another one, and its lock.
fn seed(ui: &mut Ui, edit: &mut MultiEdit<'_>) {
    widgets::card(ui, "Seed", |ui| {
        inspector_params::row(ui, edit, Part::Instancer, "seed");
        ui.horizontal(|ui| {
            let is_locked = active(edit).seed_locked;
            let ids = edit.ids();
            let usable = seeds::unlocked(edit.session().document.scene(), &ids).next().is_some();
            let text = format!("{} Re-roll", ICON_CASINO.codepoint);
            let roll = ui.add_enabled(usable, egui::Button::new(text)).on_hover_text("Another seed, other copies");
            ui.ctx().accesskit_node_builder(roll.id, |node| node.set_label("Re-roll"));
            if roll.clicked() {
                edit.session().finish();
                seeds::reroll(edit.session(), &ids);
            }
            let (icon, name) =
                if is_locked { (ICON_LOCK, "Unlock the seed") } else { (ICON_LOCK_OPEN, "Lock the seed") };
            let color = if is_locked { theme::WARNING } else { theme::WEAK };
            let differs = |node: &Node| instancing::instancer(node).map(|instancer| instancer.seed_locked);
            let lock = widgets::switch_button(ui, (icon, name), color, edit.common(differs).is_none());
            if lock.clicked() {
                edit.change(lock.id, |node| {
                    if let Some(instancer) = instancing::instancer_mut(node) {
                        instancer.seed_locked = !is_locked;
                    }
                });
            }
        });
    });
}
