//! What is shown when nothing is selected: the world and a word to beginners.

use egui::{RichText, Ui};

use super::edit_session::EditSession;
use super::{theme, widgets};
use crate::document::Edit;
use crate::scene::Environment;

type ParamAccess = fn(&mut Environment) -> &mut [f64; 3];

/// The cards.
pub fn show(ui: &mut Ui, session: &mut EditSession) {
    ui.label(RichText::new("Scene").heading().color(egui::Color32::WHITE));
    let rows: [(&str, &str, ParamAccess); 3] = [
        ("Sky", "Background above", |e| &mut e.sky),
        ("Horizon", "Background at and below the horizon", |e| &mut e.horizon),
        ("Ambient", "Light from everywhere", |e| &mut e.ambient),
    ];
    widgets::card(ui, "World", |ui| {
        for (label, help, part) in rows {
            let mut environment = session.document.scene().environment;
            let value = *part(&mut environment);
            let (widget, changed) = widgets::row(ui, label, help, |ui| widgets::color(ui, label, value, false));
            if let Some(value) = changed {
                *part(&mut environment) = value;
                session.apply_by(widget, Edit::SetEnvironment(environment));
            }
        }
    });
    widgets::card(ui, "First steps", |ui| {
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
    ("Add", "shapes with the buttons above the viewport"),
    ("Click", "something in the viewport or the outliner to select it"),
    ("Drag", "a number sideways to change it, click it to type"),
    ("Select several", "with Shift, then join them with Ctrl G"),
    ("Subtract", "cuts an object out of what stands before it"),
    ("F3", "finds every command by its name"),
];
