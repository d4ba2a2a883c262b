//! The list of what lies below the pointer, after a click with Alt.

use egui::{Align2, Button, Color32, Context, Frame, Id, Key, Modal, Modifiers, RichText, ScrollArea, vec2};

use super::commands::entries::ICON_ROOM;
use super::state::EditorState;
use super::{icons, theme, widgets};

/// Width of the list, and longest name in characters.
const WIDTH: f32 = 240.0;
const MOST_NAME: usize = 28;

/// Shows the list if there is one; a choice selects the node, with Shift it adds to the selection.
pub fn show(state: &mut EditorState, ctx: &Context) {
    let Some(list) = state.view.below.clone() else { return };
    let escape = ctx.input_mut(|i| i.consume_key(Modifiers::NONE, Key::Escape));
    let id = Id::unique("what lies below the pointer");
    let screen = ctx.content_rect();
    let room = (screen.bottom() - list.at.y - 40.0).max(120.0);
    let corner = list.at.min(screen.max - vec2(WIDTH + 30.0, 160.0)).max(screen.min);
    let response = Modal::new(id)
        .area(Modal::default_area(id).anchor(Align2::LEFT_TOP, corner - screen.min))
        .backdrop_color(Color32::TRANSPARENT)
        .frame(Frame::popup(&ctx.global_style()).inner_margin(6.0))
        .show(ctx, |ui| {
            ui.set_width(WIDTH);
            ui.spacing_mut().item_spacing.y = 1.0;
            let mut chosen = None;
            ScrollArea::vertical().max_height(room).auto_shrink([false, true]).show(ui, |ui| {
                let scene = state.session.document.scene();
                for node in list.nodes.iter().filter_map(|id| scene.node(*id)) {
                    let group = node.parent.and_then(|parent| scene.node(parent));
                    let group = group.map_or(String::new(), |group| widgets::elided(&group.name, 12).to_string());
                    let name = widgets::elided(&node.name, MOST_NAME).to_string();
                    let is_on = state.session.document.selection().contains(&node.id);
                    let button = Button::selectable(is_on, (RichText::new(ICON_ROOM), RichText::new(name)))
                        .min_size(vec2(WIDTH, 26.0))
                        .shortcut_text(RichText::new(group).color(theme::WEAK));
                    let response = ui.add(button);
                    let icon = response.rect.left_center() + vec2(ui.spacing().button_padding.x + 10.0, 0.0);
                    let square = egui::Rect::from_center_size(icon, egui::Vec2::splat(16.0));
                    icons::paint_node(ui.painter(), icons::centered(square, 16.0), node);
                    let label = format!("Below the pointer: {}", node.name);
                    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(label));
                    if response.clicked() {
                        chosen = Some(node.id);
                    }
                }
            });
            chosen
        });
    if let Some(id) = response.inner {
        let mut selection = state.session.document.selection().to_vec();
        if !ctx.input(|i| i.modifiers.shift) {
            selection.clear();
        }
        selection.retain(|other| *other != id);
        selection.push(id);
        state.session.document.select(selection);
    }
    if escape || response.inner.is_some() || response.backdrop_response.clicked() {
        state.view.below = None;
    }
}
