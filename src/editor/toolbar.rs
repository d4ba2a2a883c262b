//! The bar at the top: menus and the most common buttons.

use egui::{Button, MenuBar, Response, RichText, Ui, vec2};
use egui_material_icons::icons::ICON_ADD;

use super::add_palette::favorites;
use super::commands::command::Command;
use super::commands::entries::{menu_entries, shading_entries};
use super::commands::info::{Icon, Menu};
use super::intent::Intent;
use super::panel::{Panel, PanelPlace};
use super::state::{EditorState, PanelEntry, Request};
use super::{drag_in, drawing, icons, theme, widgets};
use isolith_scene::{Operator, ShapeKind};

/// The panel of the toolbar.
pub struct Toolbar;

impl Panel for Toolbar {
    fn id(&self) -> &'static str {
        "toolbar"
    }

    fn title(&self) -> &'static str {
        "Toolbar"
    }

    fn place(&self) -> PanelPlace {
        PanelPlace::Top
    }

    fn ui(&mut self, state: &mut EditorState, ui: &mut Ui) {
        let chosen = show(state, ui);
        state.requests.extend(chosen.map(Request::Run));
    }
}

/// Submenus of View.
const SUBMENUS: [(&str, Menu); 8] = [
    ("Look along", Menu::Sides),
    ("Split view", Menu::Split),
    ("Bookmarks", Menu::Bookmarks),
    ("Transform", Menu::Tool),
    ("Orientation", Menu::Orientation),
    ("Pivot", Menu::Pivot),
    ("Snapping", Menu::Snap),
    ("Keymap", Menu::Keymap),
];

/// Shows the bar; returns the chosen command.
fn show(state: &mut EditorState, ui: &mut Ui) -> Option<Command> {
    let mut chosen = None;
    MenuBar::new().ui(ui, |ui| {
        ui.label(RichText::new("Isolith").strong().color(theme::ACCENT));
        ui.add_space(6.0);
        for (name, menu) in
            [("File", Menu::File), ("Edit", Menu::Edit), ("Add", Menu::Add), ("View", Menu::View), ("Help", Menu::Help)]
        {
            ui.menu_button(name, |ui| {
                ui.set_min_width(230.0);
                let room = widgets::room_below(ui);
                widgets::scrolling(ui, room, |ui| menu_content(state, ui, menu, &mut chosen));
            });
        }
    });
    ui.add_space(3.0);
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = vec2(3.0, 3.0);
        buttons(state, ui, theme::TEXT, &[Command::Undo, Command::Redo], &mut chosen);
        divider(ui);
        for command in favorites(state) {
            let button = favorite_button(ui, command, drawing::chooses_shape(state).then_some(state.view.drawn));
            drag_in::begin(state, &button, command);
            if button.clicked() {
                chosen = Some(command);
            }
        }
        let text = (ICON_ADD.rich_text().size(17.0).color(theme::ACCENT), RichText::new("Add"));
        let response = ui.add(Button::new(text).min_size(vec2(60.0, 26.0)));
        ui.ctx().accesskit_node_builder(response.id, |node| node.set_label("Add something"));
        if response.on_hover_text(Command::AddAtPointer.info().tooltip(ui.ctx())).clicked() {
            chosen = Some(Command::AddAtPointer);
        }
        divider(ui);
        let [unite, intersect, subtract] =
            [Operator::Union, Operator::Intersection, Operator::Difference].map(Command::Join);
        let roles = [unite, intersect, subtract, Command::ToggleSubtract, Command::Group];
        buttons(state, ui, theme::GROUP, &roles, &mut chosen);
        divider(ui);
        buttons(state, ui, theme::TEXT, &[Command::Duplicate, Command::Delete], &mut chosen);
        divider(ui);
        buttons(state, ui, theme::TEXT, &[Command::FrameAll, Command::FrameSelected], &mut chosen);
    });
    chosen
}

fn menu_content(state: &mut EditorState, ui: &mut Ui, menu: Menu, chosen: &mut Option<Command>) {
    if menu == Menu::File {
        file_lists(state, ui);
    }
    if menu == Menu::View {
        ui.menu_button("Panels", |ui| panels(state, ui));
        *chosen = ui.menu_button("Shading", |ui| shading_entries(ui, state)).inner.flatten().or(*chosen);
        for (name, menu) in SUBMENUS {
            let inner = ui.menu_button(name, |ui| menu_entries(ui, state, menu)).inner;
            *chosen = inner.flatten().or(*chosen);
        }
        ui.separator();
    }
    if let Some(command) = menu_entries(ui, state, menu) {
        *chosen = Some(command);
    }
    if menu == Menu::Edit {
        ui.separator();
        for (name, menu) in [
            ("Select", Menu::Select),
            ("Paste only", Menu::PastePart),
            ("Combine", Menu::Combine),
            ("Arrange", Menu::Arrange),
            ("Convert", Menu::Convert),
            ("Links and materials", Menu::Sharing),
            ("Instancer presets", Menu::Presets),
        ] {
            let inner = ui.menu_button(name, |ui| menu_entries(ui, state, menu)).inner;
            *chosen = inner.flatten().or(*chosen);
        }
    }
}

/// Toggles for the panels.
fn panels(state: &mut EditorState, ui: &mut Ui) {
    for &PanelEntry { id, title, is_open } in &state.panels {
        if ui.add(Button::new(title).selected(is_open)).clicked() {
            state.requests.push(Request::TogglePanel(id));
        }
    }
    ui.separator();
    if ui.button("Reset layout").on_hover_text(Command::ResetLayout.info().tooltip(ui.ctx())).clicked() {
        state.requests.push(Request::ResetLayout);
    }
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

fn buttons(
    state: &EditorState,
    ui: &mut Ui,
    color: theme::ThemeColor,
    commands: &[Command],
    chosen: &mut Option<Command>,
) {
    for &command in commands {
        let info = command.info();
        let text = match info.icon {
            Some(Icon::Material(icon)) => icon.rich_text().size(17.0).color(color),
            _ => RichText::new(&info.label),
        };
        let response = square(ui, command.is_enabled(state), Button::new(text), &info.label);
        let tooltip = match command {
            Command::Undo => with_step(info.tooltip(ui.ctx()), state.session.document.undo_label()),
            Command::Redo => with_step(info.tooltip(ui.ctx()), state.session.document.redo_label()),
            _ => info.tooltip(ui.ctx()),
        };
        if response.on_hover_text(&tooltip).on_disabled_hover_text(tooltip).clicked() {
            *chosen = Some(command);
        }
    }
}

/// Adds the step to the tooltip.
fn with_step(tooltip: String, step: Option<&str>) -> String {
    step.map_or(tooltip.clone(), |step| format!("{tooltip}: {step}"))
}

/// A button that adds a favorite, or chooses it for the draw tool, which draws `drawn` now.
fn favorite_button(ui: &mut Ui, command: Command, drawn: Option<ShapeKind>) -> Response {
    let info = command.info();
    let is_drawn = drawn.map(Command::AddShape) == Some(command);
    let button = Button::new("").sense(egui::Sense::click_and_drag());
    let response = square(ui, true, button, &format!("Add {}", info.label.to_lowercase()));
    let rect = icons::centered(response.rect, 17.0);
    let hovered = response.hovered();
    if is_drawn {
        let line = egui::Stroke::new(1.5, theme::ACCENT);
        ui.painter().rect_stroke(response.rect, f32::from(theme::RADIUS), line, egui::StrokeKind::Inside);
    }
    match info.icon {
        Some(Icon::Shape(kind)) => {
            let color = if hovered { *theme::STRONG } else { *theme::OBJECT };
            icons::paint_shape(ui.painter(), rect, kind, color);
        }
        Some(Icon::Material(icon)) => {
            let color = if hovered { *theme::STRONG } else { *theme::LIGHT };
            icons::paint_icon(ui.painter(), rect, icon, color);
        }
        None => {}
    }
    let does = if drawn.is_some() { "Draw" } else { "Add" };
    let help = format!("{does}: {}\n{}\nDrag it into the viewport to choose the place", info.label, info.help);
    response.on_hover_text(help)
}

/// Maximum number of characters of a file's name in a menu.
const MOST_NAME: usize = 40;

/// Entries for the test scenes or for the other examples; returns the chosen one.
fn example_entries(state: &EditorState, ui: &mut Ui, are_tests: bool) -> Option<Intent> {
    let mut chosen = None;
    for (index, example) in state.examples.iter().enumerate().filter(|(_, example)| example.is_test == are_tests) {
        if ui.button(&example.name).clicked() {
            chosen = Some(Intent::Example(index));
        }
    }
    chosen
}

/// Recent files and examples, at the top of the File menu.
fn file_lists(state: &mut EditorState, ui: &mut Ui) {
    let mut intent = None;
    ui.add_enabled_ui(!state.files.recent().paths().is_empty(), |ui| {
        ui.menu_button("Open recent", |ui| {
            widgets::scrolling(ui, widgets::room_beside(&ui.ctx().clone()), |ui| {
                for path in state.files.recent().paths() {
                    let name = path.file_name().map_or_else(|| path.to_string_lossy(), |n| n.to_string_lossy());
                    let name = widgets::elided(&name, MOST_NAME);
                    if ui.button(name).on_hover_text(path.display().to_string()).clicked() {
                        intent = Some(Intent::Open(path.clone()));
                    }
                }
            });
        });
    });
    ui.add_enabled_ui(!state.examples.is_empty(), |ui| {
        ui.menu_button("Examples", |ui| {
            widgets::scrolling(ui, widgets::room_beside(&ui.ctx().clone()), |ui| {
                intent = example_entries(state, ui, false).or(intent.take());
                if state.examples.iter().any(|example| example.is_test) {
                    ui.separator();
                    ui.menu_button("Test scenes", |ui| {
                        intent = example_entries(state, ui, true).or(intent.take());
                    });
                }
            });
        });
    });
    ui.separator();
    if let Some(intent) = intent {
        ui.close();
        state.requests.push(Request::Intend(intent));
    }
}
