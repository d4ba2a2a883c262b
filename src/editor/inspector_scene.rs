//! What is shown when nothing is selected: the surroundings and a word to beginners.

use egui::{RichText, Ui};

use super::workbench::Workbench;
use super::{fields, theme};
use crate::document::Edit;
use crate::scene::Environment;

type Part = fn(&mut Environment) -> &mut [f64; 3];

/// The cards.
pub fn show(ui: &mut Ui, bench: &mut Workbench) {
    ui.label(RichText::new("Scene").heading().color(egui::Color32::WHITE));
    let rows: [(&str, &str, Part); 3] = [
        ("Sky", "Background above", |e| &mut e.sky),
        ("Horizon", "Background at and below the horizon", |e| &mut e.horizon),
        ("Ambient", "Light from everywhere", |e| &mut e.ambient),
    ];
    fields::card(ui, "Surroundings", |ui| {
        for (label, help, part) in rows {
            let mut environment = bench.document.scene().environment;
            let value = *part(&mut environment);
            let (widget, changed) = fields::row(ui, label, help, |ui| fields::color(ui, label, value, false));
            if let Some(value) = changed {
                *part(&mut environment) = value;
                bench.apply_by(widget, Edit::SetEnvironment(environment));
            }
        }
    });
    fields::card(ui, "First steps", |ui| {
        for (keys, what) in HINTS {
            ui.horizontal_wrapped(|ui| {
                ui.spacing_mut().item_spacing.x = 5.0;
                ui.label(RichText::new(keys).color(theme::TEXT));
                ui.label(RichText::new(what).color(theme::WEAK));
            });
        }
    });
}

const HINTS: [(&str, &str); 6] = [
    ("Add", "shapes with the buttons above the picture"),
    ("Click", "something in the picture or the tree to select it"),
    ("Drag", "a number sideways to change it, click it to type"),
    ("Select several", "with Shift, then join them with Ctrl G"),
    ("Negative", "objects are cut out of what stands before them"),
    ("F3", "finds every command by its name"),
];
