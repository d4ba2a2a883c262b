//! The window with all steps of undo and redo; a click goes there.

use egui::{Context, Id, RichText, ScrollArea, Ui, Window};

use super::state::EditorState;
use super::theme;

/// The window.
pub(super) fn window_id() -> Id {
    Id::unique("history")
}

/// Shows the window if it is open.
pub fn show(state: &mut EditorState, ctx: &Context) {
    let mut open = state.show_history;
    if !open {
        return;
    }
    let place = state.view.rect.left_bottom() + egui::vec2(60.0, -380.0);
    let window = Window::new("History").id(window_id()).open(&mut open);
    let window = window.default_size([240.0, 320.0]).default_pos(place);
    let chosen = window.show(ctx, |ui| list(state, ui)).and_then(|shown| shown.inner).flatten();
    state.show_history = open;
    if let Some(steps) = chosen {
        go(state, steps);
    }
}

/// Undoes this many steps, or redoes them if negative.
fn go(state: &mut EditorState, steps: isize) {
    state.session.finish();
    for _ in 0..steps.unsigned_abs() {
        if steps > 0 {
            state.session.document.undo();
        } else {
            state.session.document.redo();
        }
    }
}

/// The steps from the first to the last; returns how many to undo.
fn list(state: &EditorState, ui: &mut Ui) -> Option<isize> {
    let document = &state.session.document;
    let undo: Vec<&str> = document.undo_labels().collect();
    let redo: Vec<&str> = document.redo_labels().collect();
    let (now, total) = (undo.len(), undo.len() + redo.len());
    let mut chosen = None;
    let height = theme::ROW_HEIGHT;
    ui.spacing_mut().item_spacing.y = 0.0;
    let scroll = ScrollArea::vertical().auto_shrink(false).stick_to_bottom(redo.is_empty());
    scroll.show_rows(ui, height, total + 1, |ui, rows| {
        for row in rows {
            let label = match row {
                0 => "Begin",
                _ if row <= now => undo[now - row],
                _ => redo[row - now - 1],
            };
            let color = if row > now { theme::FAINT } else { theme::TEXT };
            let text = RichText::new(label).color(color);
            let button = egui::Button::selectable(row == now, text).min_size(egui::vec2(ui.available_width(), height));
            let entry = ui.add(button.truncate());
            let name = format!("Step {row}: {label}");
            ui.ctx().accesskit_node_builder(entry.id, |node| node.set_label(name));
            if entry.clicked() && row != now {
                chosen = Some(now as isize - row as isize);
            }
        }
    });
    chosen
}
