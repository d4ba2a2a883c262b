//! The window of the preferences: theme, scale, units, samples and keys.

use std::path::Path;

use egui::{Button, Context, Id, Modal, RichText, Ui, vec2};

use super::dialogs::Purpose;
use super::key_editor::KeyRequest;
use super::keymap::Keymap;
use super::messages::Message;
use super::palette::ColorTheme;
use super::preferences_window::Page;
use super::root::Editor;
use super::state::EditorState;
use super::units::LengthUnit;
use super::{theme, widgets};
use isolith_document::{export_keys, import_keys};

/// Size of the window, in points; smaller in a small window.
const SIZE: egui::Vec2 = vec2(600.0, 520.0);

/// The scales of the user interface that are offered.
const SCALES: [(f32, &str); 9] = [
    (0.75, "75 %"),
    (0.9, "90 %"),
    (1.0, "100 %"),
    (1.1, "110 %"),
    (1.25, "125 %"),
    (1.5, "150 %"),
    (1.75, "175 %"),
    (2.0, "200 %"),
    (2.5, "250 %"),
];

/// The budgets for bricks of models that are offered, in MiB.
const BRICKS: [(u32, &str); 5] = [(16, "16"), (32, "32"), (64, "64"), (128, "128"), (256, "256")];

/// The samples that are offered.
const SAMPLES: [(u32, &str); 5] = [(1, "1"), (16, "16"), (64, "64"), (256, "256"), (1024, "1024")];

impl Editor {
    /// Shows the preferences if they are open.
    pub(super) fn show_preferences(&mut self, ctx: &Context) {
        if !self.preferences_window.is_open() {
            return;
        }
        self.preferences_window.keys.take_key(ctx, &mut self.state);
        let window = &mut self.preferences_window;
        let state = &mut self.state;
        let mut request = None;
        let mut done = false;
        let frame = egui::Frame::window(&ctx.global_style()).inner_margin(18.0);
        let response = Modal::new(Id::unique("preferences")).frame(frame).show(ctx, |ui| {
            let room = ui.ctx().content_rect().size() - vec2(60.0, 100.0);
            ui.set_width(SIZE.x.min(room.x));
            ui.horizontal(|ui| {
                ui.label(RichText::new("Preferences").heading().color(theme::STRONG));
                ui.add_space(16.0);
                for page in Page::ALL {
                    if ui.add(Button::selectable(window.page == page, page.label())).clicked() {
                        window.page = page;
                    }
                }
            });
            ui.add_space(10.0);
            let height = SIZE.y.min(room.y) - 80.0;
            ui.allocate_ui(vec2(ui.available_width(), height), |ui| {
                ui.set_min_height(height);
                match window.page {
                    Page::General => general(state, ui),
                    Page::Keys => request = window.keys.show(state, ui),
                }
            });
            ui.add_space(10.0);
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                done = ui.add(Button::new("Close").min_size(vec2(96.0, 28.0))).clicked();
                ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
                    ui.label(RichText::new("Kept for the next start").color(theme::WEAK));
                });
            });
        });
        if done || response.should_close() {
            window.close();
        }
        match request {
            Some(KeyRequest::Export) => self.choose(Purpose::ExportKeys, ctx),
            Some(KeyRequest::Import) => self.choose(Purpose::ImportKeys, ctx),
            None => {}
        }
    }
}

impl Editor {
    /// Writes the changed keys to a file.
    pub(super) fn export_keys(&mut self, path: &Path) {
        let keymap = self.state.keymap().label();
        let keys = self.state.preferences.values().keys.get(keymap).cloned().unwrap_or_default();
        self.report(match export_keys(path, keymap, &keys) {
            Ok(()) => Message::success(format!("The keymap is in {}.", path.display())),
            Err(error) => Message::error(format!("The keymap could not be written: {error}.")),
        });
    }

    /// Reads changed keys from a file.
    pub(super) fn import_keys(&mut self, path: &Path) {
        match import_keys(path) {
            Ok((name, keys)) => {
                let keymap = Keymap::named(&name);
                self.state.use_keymap(keymap);
                self.state.preferences.change(|values| {
                    values.keys.insert(keymap.label().to_owned(), keys);
                });
                self.report(Message::success(format!("The keys are those of {}.", path.display())));
            }
            Err(error) => self.report(Message::error(format!("{} is no keymap: {error}.", path.display()))),
        }
    }
}

/// Rows below a title.
fn section(ui: &mut Ui, title: &str, add: impl FnOnce(&mut Ui)) {
    ui.label(RichText::new(title).strong().color(theme::STRONG));
    ui.add_space(2.0);
    add(ui);
    ui.add_space(8.0);
}

/// Theme, scale, units and samples.
fn general(state: &mut EditorState, ui: &mut Ui) {
    let values = state.preferences.values().clone();
    section(ui, "Appearance", |ui| {
        widgets::row(ui, "Theme", "The colors of the window", |ui| {
            let current = ColorTheme::named(&values.theme);
            let help = |theme| match theme {
                ColorTheme::Dark => "Light text on a dark background",
                ColorTheme::Light => "Dark text on a light background",
            };
            let chosen = widgets::choice(ui, "Theme", Some(current), &ColorTheme::ALL, ColorTheme::label, help).1;
            if let Some(theme) = chosen {
                state.preferences.change(|values| values.theme = theme.label().to_owned());
            }
        });
        widgets::row(ui, "Scale", "Size of texts and controls; Ctrl + and Ctrl − change it, too", |ui| {
            let scales: Vec<_> = (0..SCALES.len()).collect();
            let current = SCALES.iter().position(|(scale, _)| *scale == values.scale);
            let chosen = widgets::choice(ui, "Scale", current, &scales, |index| SCALES[index].1, |_| "").1;
            if let Some(index) = chosen {
                state.preferences.change(|values| values.scale = SCALES[index].0);
            }
        });
    });
    ui.add_space(8.0);
    section(ui, "Editing", |ui| {
        widgets::row(ui, "Unit of length", "The fields show lengths in it; a typed length may name another", |ui| {
            let current = LengthUnit::named(&values.unit);
            let label = LengthUnit::label;
            let chosen = widgets::choice(ui, "Unit of length", Some(current), &LengthUnit::ALL, label, |_| "").1;
            if let Some(unit) = chosen {
                state.preferences.change(|values| values.unit = unit.sign().to_owned());
            }
        });
    });
    ui.add_space(8.0);
    section(ui, "Viewport", |ui| {
        widgets::row(ui, "Samples", "Samples per pixel that add up while nothing changes", |ui| {
            let samples: Vec<_> = (0..SAMPLES.len()).collect();
            let current = SAMPLES.iter().position(|(count, _)| *count == state.view.samples);
            let chosen = widgets::choice(ui, "Samples", current, &samples, |index| SAMPLES[index].1, |_| "").1;
            if let Some(index) = chosen {
                state.view.samples = SAMPLES[index].0;
                state.preferences.change(|values| values.samples = Some(SAMPLES[index].0));
            }
        });
        let help = "MiB of graphics memory for models that are fields; beyond them the largest get coarser voxels";
        widgets::row(ui, "Model bricks", help, |ui| {
            let budgets: Vec<_> = (0..BRICKS.len()).collect();
            let most = values.brick_mebibytes.unwrap_or(BRICKS[BRICKS.len() - 1].0);
            let current = BRICKS.iter().position(|(mebibytes, _)| *mebibytes == most);
            let chosen = widgets::choice(ui, "Model bricks", current, &budgets, |index| BRICKS[index].1, |_| "").1;
            if let Some(index) = chosen {
                state.derived.set_brick_budget(BRICKS[index].0);
                state.preferences.change(|values| values.brick_mebibytes = Some(BRICKS[index].0));
            }
        });
    });
}
