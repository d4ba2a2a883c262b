//! The inspector without a selection: the world and a hint for beginners.

use egui::{RichText, Ui};

use super::edit_session::EditSession;
use super::{inspector_params, theme, widgets};
use isolith_scene::{DisplaySettings, ParamPath, Params, Shadowing};

/// The cards.
pub fn show(ui: &mut Ui, session: &mut EditSession) {
    ui.label(RichText::new("Scene").heading().color(theme::STRONG));
    widgets::card(ui, "World", |ui| {
        let mut names = Vec::new();
        let environment = &session.document.scene().environment;
        environment.visit("", &mut |prefix, param, _| names.push(format!("{prefix}{}", param.name)));
        for name in names.into_iter().filter(|name| !name.starts_with("shadowing")) {
            inspector_params::single(ui, session, ParamPath::of_environment(name));
        }
    });
    widgets::card(ui, "Shadows and occlusion", |ui| {
        for param in Shadowing::default().params() {
            inspector_params::single(ui, session, ParamPath::of_environment(format!("shadowing.{}", param.name)));
        }
    });
    widgets::card(ui, "Display", |ui| {
        for param in DisplaySettings::default().params() {
            inspector_params::single(ui, session, ParamPath::of_display(param.name));
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

const HINTS: [(&str, &str); 7] = [
    ("Shift A", "adds shapes, lights and more where the pointer is"),
    ("Drag", "the dots on a shape to change it, the arrows to move it"),
    ("Click", "something in the viewport or the outliner to select it"),
    ("Drag", "also a number sideways to change it, click it to type"),
    ("Select several", "with Shift, then join them with Ctrl G"),
    ("Subtract", "cuts an object out of what stands before it"),
    ("F3", "finds every command by its name"),
];
