//! The bar at the top: menus, then the buttons used most.

use egui::{Button, Color32, MenuBar, Response, RichText, Ui, vec2};
use egui_material_icons::icons::ICON_VISIBILITY;

use super::commands::{self, CommandId, Icon, Menu};
use super::dialogs::Intent;
use super::{Editor, icons, legend, theme, widgets};
use crate::flat::debug_view::ViewMode;
use crate::scene::ShapeKind;

/// Shows the bar.
pub fn show(editor: &mut Editor, ui: &mut Ui) {
    let mut chosen = None;
    MenuBar::new().ui(ui, |ui| {
        ui.label(RichText::new("Isolith").strong().color(theme::ACCENT));
        ui.add_space(6.0);
        for (name, menu) in [("File", Menu::File), ("Edit", Menu::Edit), ("Add", Menu::Add), ("View", Menu::View)] {
            ui.menu_button(name, |ui| {
                ui.set_min_width(230.0);
                let room = widgets::room_below(ui);
                widgets::scrolling(ui, room, |ui| menu_content(editor, ui, menu, &mut chosen));
            });
        }
    });
    ui.add_space(3.0);
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = vec2(3.0, 3.0);
        buttons(editor, ui, theme::TEXT, &["Undo", "Redo"], &mut chosen);
        divider(ui);
        for &kind in ShapeKind::ALL {
            if shape_button(ui, kind).clicked() {
                chosen = Some(CommandId::named(kind.label()));
            }
        }
        divider(ui);
        buttons(editor, ui, theme::LIGHT, &["Sun", "Point light", "Spot light"], &mut chosen);
        buttons(editor, ui, theme::MESH, &["Mesh…"], &mut chosen);
        divider(ui);
        buttons(editor, ui, theme::GROUP, &["Union", "Intersect", "Subtract", "Toggle subtract", "Group"], &mut chosen);
        divider(ui);
        buttons(editor, ui, theme::TEXT, &["Duplicate", "Delete"], &mut chosen);
        divider(ui);
        buttons(editor, ui, theme::TEXT, &["Frame all", "Frame selected"], &mut chosen);
        divider(ui);
        let color = if editor.view_mode == ViewMode::Shaded { theme::TEXT } else { theme::ACCENT };
        let name = legend::capitalized(editor.view_mode.name());
        let text = (ICON_VISIBILITY.rich_text().size(17.0).color(color), RichText::new(name).color(color));
        let button = ui.menu_button(text, |ui| view_modes(editor, ui, &mut chosen)).response;
        ui.ctx().accesskit_node_builder(button.id, |node| node.set_label("Viewport shading"));
        button.on_hover_text("Viewport shading");
    });
    if let Some(command) = chosen {
        command.run(editor, &ui.ctx().clone());
    }
}

fn menu_content(editor: &mut Editor, ui: &mut Ui, menu: Menu, chosen: &mut Option<CommandId>) {
    if menu == Menu::File {
        file_lists(editor, ui);
    }
    if let Some(command) = commands::menu_entries(ui, editor, menu) {
        *chosen = Some(command);
    }
    if menu == Menu::View {
        ui.separator();
        ui.menu_button("Viewport shading", |ui| view_modes(editor, ui, chosen));
    }
}

/// The choice of what the picture shows.
fn view_modes(editor: &Editor, ui: &mut Ui, chosen: &mut Option<CommandId>) {
    ui.set_min_width(190.0);
    let room = widgets::room_below(ui);
    widgets::scrolling(ui, room, |ui| {
        *chosen = commands::menu_entries(ui, editor, Menu::ViewMode).or(*chosen);
        ui.separator();
        ui.menu_button("Debug", |ui| {
            ui.set_min_width(190.0);
            *chosen = commands::menu_entries(ui, editor, Menu::Debug).or(*chosen);
        });
    });
}

fn divider(ui: &mut Ui) {
    ui.add_space(3.0);
    let (rect, _) = ui.allocate_exact_size(vec2(1.0, 26.0), egui::Sense::hover());
    ui.painter().vline(rect.center().x, rect.y_range().shrink(4.0), (1.0, theme::FAINT.gamma_multiply(0.6)));
    ui.add_space(3.0);
}

fn square(ui: &mut Ui, enabled: bool, button: Button<'_>, name: &str) -> Response {
    let response = ui.add_enabled(enabled, button.min_size(vec2(30.0, 26.0)).frame_when_inactive(false));
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(name.to_owned()));
    response
}

fn buttons(editor: &Editor, ui: &mut Ui, color: Color32, names: &[&str], chosen: &mut Option<CommandId>) {
    for name in names {
        let id = CommandId::named(name);
        let command = id.get();
        let text = match command.icon {
            Some(Icon::Material(icon)) => icon.rich_text().size(17.0).color(color),
            _ => RichText::new(*name),
        };
        let response = square(ui, id.enabled(editor), Button::new(text), name);
        let tooltip = match *name {
            "Undo" => with_step(command.tooltip(ui.ctx()), editor.session.document.undo_label()),
            "Redo" => with_step(command.tooltip(ui.ctx()), editor.session.document.redo_label()),
            _ => command.tooltip(ui.ctx()),
        };
        if response.on_hover_text(&tooltip).on_disabled_hover_text(tooltip).clicked() {
            *chosen = Some(id);
        }
    }
}

/// The tooltip with the step that it is about.
fn with_step(tooltip: String, step: Option<&str>) -> String {
    step.map_or(tooltip.clone(), |step| format!("{tooltip}: {step}"))
}

fn shape_button(ui: &mut Ui, kind: ShapeKind) -> Response {
    let response = square(ui, true, Button::new(""), &format!("Add {}", kind.label().to_lowercase()));
    let color = if response.hovered() { egui::Color32::WHITE } else { theme::OBJECT };
    icons::paint_shape(ui.painter(), icons::centered(response.rect, 17.0), kind, color);
    response.on_hover_text(format!("Add: {}\n{}", kind.label(), kind.help()))
}

/// Most characters of a file's name in a menu.
const MOST_NAME: usize = 40;

/// The examples that are test scenes, or those that are not; returns the one chosen.
fn example_entries(editor: &Editor, ui: &mut Ui, are_tests: bool) -> Option<Intent> {
    let mut chosen = None;
    for (index, example) in editor.examples.iter().enumerate().filter(|(_, example)| example.is_test == are_tests) {
        if ui.button(&example.name).clicked() {
            chosen = Some(Intent::Example(index));
        }
    }
    chosen
}

/// Recent files and examples, at the top of the File menu.
fn file_lists(editor: &mut Editor, ui: &mut Ui) {
    let mut intent = None;
    ui.add_enabled_ui(!editor.recent.paths().is_empty(), |ui| {
        ui.menu_button("Open recent", |ui| {
            widgets::scrolling(ui, widgets::room_beside(&ui.ctx().clone()), |ui| {
                for path in editor.recent.paths() {
                    let name = path.file_name().map_or_else(|| path.to_string_lossy(), |n| n.to_string_lossy());
                    let name = widgets::elided(&name, MOST_NAME);
                    if ui.button(name).on_hover_text(path.display().to_string()).clicked() {
                        intent = Some(Intent::Open(path.clone()));
                    }
                }
            });
        });
    });
    ui.add_enabled_ui(!editor.examples.is_empty(), |ui| {
        ui.menu_button("Examples", |ui| {
            widgets::scrolling(ui, widgets::room_beside(&ui.ctx().clone()), |ui| {
                intent = example_entries(editor, ui, false).or(intent.take());
                if editor.examples.iter().any(|example| example.is_test) {
                    ui.separator();
                    ui.menu_button("Test scenes", |ui| {
                        intent = example_entries(editor, ui, true).or(intent.take());
                    });
                }
            });
        });
    });
    ui.separator();
    if let Some(intent) = intent {
        ui.close();
        editor.intend(intent, &ui.ctx().clone());
    }
}
