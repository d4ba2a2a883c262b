//! The picture as it stands after each pass over the parts of the scene.

use egui::{Align2, CornerRadius, FontId, Painter, Rect, vec2};

use super::pass_step::PassStep;
use super::state::EditorState;
use super::{theme, widgets};
use isolith_field::ComponentPass;

/// Margin around the text, in points.
const PADDING: f32 = 8.0;
/// Distance from the upper edge of the picture, in points.
const TOP: f32 = 14.0;

fn passes(state: &EditorState) -> Vec<ComponentPass> {
    state.flat().component_passes(state.view.navigation.camera().position)
}

/// Takes a step.
pub fn step(state: &mut EditorState, step: PassStep) {
    let count = passes(state).len() as u32;
    state.view.passes = step.stepped(state.view.passes, count);
}

/// Paints which pass the picture shows, if it is not whole.
pub fn paint(state: &EditorState, painter: &Painter, rect: Rect) {
    let Some(wanted) = state.view.passes else { return };
    let passes = passes(state);
    let at = (wanted as usize).min(passes.len());
    let last = at.checked_sub(1).and_then(|last| passes.get(last));
    let node = last.and_then(|pass| state.session.document.scene().node(pass.node));
    let name = node.map_or("", |node| &node.name);
    let text = format!("After pass {at} of {}: {}", passes.len(), widgets::elided(name, 32));
    let galley = painter.layout_no_wrap(text, FontId::proportional(13.0), *theme::TEXT);
    let card =
        Align2::CENTER_TOP.anchor_size(rect.center_top() + vec2(0.0, TOP), galley.size() + vec2(2.0, 1.0) * PADDING);
    painter.rect_filled(card, CornerRadius::same(7), theme::FLOATING.gamma_multiply(0.88));
    painter.galley(card.min + vec2(PADDING, 0.5 * PADDING), galley, *theme::TEXT);
}
