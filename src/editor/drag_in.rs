//! Dragging something new from the palette or the toolbar into the picture.

use egui::{Context, Id, Key, LayerId, Order, Painter, Pos2, Response, Stroke};
use glam::DVec3;

use super::commands::command::Command;
use super::handles::handle_paint::tag;
use super::overlay::paint_box;
use super::projection::Projection;
use super::state::EditorState;
use super::{placement, theme};
use isolith_geometry::Aabb;

/// Notes that the drag of a button that adds something has begun. Returns whether it has.
pub fn begin(state: &mut EditorState, response: &Response, command: Command) -> bool {
    if response.drag_started() {
        state.view.dragging_in = Some(command);
    }
    response.drag_started()
}

/// Shows where it would stand; returns the command once it is dropped in the picture. Call once a frame.
pub fn follow(state: &mut EditorState, ctx: &Context) -> Option<Command> {
    let command = state.view.dragging_in?;
    let (pointer, down, canceled) =
        ctx.input(|i| (i.pointer.latest_pos(), i.pointer.any_down(), i.key_pressed(Key::Escape)));
    let over = pointer.filter(|at| state.view.rect.contains(*at));
    if canceled || !down {
        state.view.dragging_in = None;
        state.view.add_at = over.filter(|_| !canceled);
        return state.view.add_at.map(|_| command);
    }
    if let Some(at) = pointer {
        let layer = LayerId::new(Order::Tooltip, Id::unique("drag in"));
        paint(state, &Painter::new(ctx.clone(), layer, ctx.content_rect()), at, over.is_some(), command);
    }
    None
}

/// Its bounds where it would stand, and its name beside the pointer.
fn paint(state: &EditorState, painter: &Painter, at: Pos2, is_over: bool, command: Command) {
    let name = &command.info().label;
    if !is_over {
        tag(painter, at, format!("{name}: drop it in the viewport"));
        return;
    }
    let projection = Projection::of(&state.view);
    let placing = placement::placing(state, Some(at));
    let bounds = match command {
        Command::AddShape(kind) => placement::sized(state, placement::remembered(state, kind), placing.point).bounds(),
        _ => Aabb::from_center_half(DVec3::ZERO, DVec3::splat(projection.meters_per_point(placing.point) * 12.0)),
    };
    let position = placement::position(state, &bounds, &placing);
    if bounds.is_finite() && !bounds.is_empty() {
        let corners = bounds.translated(position).corners().map(|corner| projection.to_screen(corner));
        let painter = painter.with_clip_rect(state.view.rect);
        paint_box(&painter, &corners, Stroke::new(1.5, theme::ACCENT));
    }
    tag(painter, at, name.clone());
}
