//! The bar at the left of the viewport: the tools, and whose axes they follow, and around what they turn.

use egui::{Align, Button, Frame, Layout, Rect, Ui, UiBuilder, vec2};
use egui_material_icons::MaterialIcon;
use egui_material_icons::icons::ICON_GRID_3X3;

use super::kinds::Tool;
use crate::commands::command::Command;
use crate::commands::entries::menu_entries;
use crate::commands::info::Menu;
use crate::numbers::number_text;
use crate::snapping::SnapSettings;
use crate::state::{EditorState, Request};
use crate::{icons, theme};

/// Distance from the edges of the viewport, in points.
const MARGIN: f32 = 10.0;
/// Size of a button, in points.
const BUTTON: egui::Vec2 = vec2(30.0, 28.0);

/// Shows the bar over the picture.
pub fn show(state: &mut EditorState, ui: &mut Ui) {
    let corner = state.view.rect.left_top() + vec2(MARGIN, MARGIN);
    let room = Rect::from_min_size(corner, vec2(BUTTON.x + 4.0, 8.0 * (BUTTON.y + 2.0) + 15.0));
    let mut bar = ui.new_child(UiBuilder::new().max_rect(room).layout(Layout::top_down(Align::Min)));
    let frame = Frame::new().fill(theme::FLOATING.gamma_multiply(0.88)).corner_radius(7.0).inner_margin(2.0);
    let chosen = frame.show(&mut bar, |ui| {
        ui.spacing_mut().item_spacing.y = 2.0;
        let mut chosen = None;
        for tool in Tool::ALL {
            let is_on = state.view.tool == tool;
            let color = if is_on { theme::ACCENT } else { theme::TEXT };
            let text = icons::tool_icon(tool).rich_text().size(17.0).color(color);
            let button = Button::new(text).min_size(BUTTON).selected(is_on).frame_when_inactive(is_on);
            let response = ui.add(button);
            ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(tool.label()));
            if response.on_hover_text(Command::UseTool(tool).info().tooltip(ui.ctx())).clicked() {
                chosen = Some(Command::UseTool(tool));
            }
        }
        divider(ui);
        let (orientation, pivot) = (state.view.orientation, state.view.pivot);
        let axes = format!("Axes of the tools: {}\n{}", orientation.label().to_lowercase(), orientation.help());
        let around = format!("Pivot of the tools: {}\n{}", pivot.label().to_lowercase(), pivot.help());
        let axes_icon = icons::orientation_icon(orientation);
        let chosen = choice(state, ui, ("Orientation", axes_icon, axes, false), Menu::Orientation).or(chosen);
        let chosen = choice(state, ui, ("Pivot", icons::pivot_icon(pivot), around, false), Menu::Pivot).or(chosen);
        let snap = &state.view.snap;
        choice(state, ui, ("Snapping", ICON_GRID_3X3, snap_text(snap), snap.is_on), Menu::Snap).or(chosen)
    });
    state.requests.extend(chosen.inner.map(Request::Run));
}

/// When drags snap, and to what.
fn snap_text(snap: &SnapSettings) -> String {
    let lengths =
        snap.length.map_or("a step that suits the view".to_owned(), |step| format!("{} m", number_text(step)));
    let when = if snap.is_on { "always, freely with Ctrl" } else { "with Ctrl" };
    format!("Snapping: {when}\nLengths to {lengths}, angles to {}°", number_text(snap.angle))
}

/// A line between the tools and what they follow.
fn divider(ui: &mut Ui) {
    let (rect, _) = ui.allocate_exact_size(vec2(BUTTON.x, 5.0), egui::Sense::hover());
    ui.painter().hline(rect.x_range().shrink(5.0), rect.center().y, (1.0, theme::FAINT.gamma_multiply(0.6)));
}

/// A menu of choices; its button shows the icon of the one in use, and a corner that says that there are others.
fn choice(
    state: &EditorState,
    ui: &mut Ui,
    (name, icon, help, is_on): (&str, MaterialIcon, String, bool),
    menu: Menu,
) -> Option<Command> {
    ui.spacing_mut().button_padding.x = 2.0;
    let color = if is_on { theme::ACCENT } else { theme::WEAK };
    let opener = Button::new(icon.rich_text().size(17.0).color(color));
    let opener = opener.min_size(BUTTON).frame_when_inactive(false);
    let (button, menu) = egui::containers::menu::MenuButton::from_button(opener).ui(ui, |ui| {
        ui.spacing_mut().button_padding.x = 8.0;
        ui.set_min_width(190.0);
        menu_entries(ui, state, menu)
    });
    ui.ctx().accesskit_node_builder(button.id, |node| node.set_label(name.to_owned()));
    let corner = button.rect.right_bottom() - vec2(4.0, 4.0);
    let triangle = vec![corner, corner - vec2(4.0, 0.0), corner - vec2(0.0, 4.0)];
    ui.painter().add(egui::Shape::convex_polygon(triangle, *theme::WEAK, egui::Stroke::NONE));
    button.on_hover_text(help);
    menu.and_then(|menu| menu.inner)
}
