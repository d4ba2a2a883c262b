//! Paints the handles: guides, dots, and the value beside the one in use.

use egui::accesskit::Role;
use egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Sense, Shape, Stroke, Ui, WidgetInfo, vec2};

use super::value_drag::with_unit;
use super::value_handle::{HandleKey, HandleSet, HandleTarget, ValueHandle, grab_rect};
use crate::theme;

const SHADE: Color32 = Color32::from_black_alpha(150);

/// Paints the handles; `lit` is the hovered or dragged one.
pub fn paint(painter: &Painter, set: &HandleSet, lit: Option<HandleKey>) {
    for line in set.guides.iter().filter(|line| line.len() > 1) {
        painter.add(Shape::line(line.clone(), Stroke::new(3.0, Color32::from_black_alpha(60))));
        painter.add(Shape::line(line.clone(), Stroke::new(1.25, theme::HANDLE.gamma_multiply(0.75))));
    }
    let (others, used): (Vec<_>, Vec<_>) = set.handles.iter().partition(|handle| Some(handle.key) != lit);
    for handle in others {
        dot(painter, handle, false);
    }
    for handle in used {
        if let Some(foot) = handle.foot {
            painter.add(Shape::dashed_line(&[foot, handle.at], Stroke::new(1.25, theme::HANDLE), 4.0, 3.0));
        }
        dot(painter, handle, true);
    }
}

fn dot(painter: &Painter, handle: &ValueHandle, lit: bool) {
    let color = match handle.target {
        _ if lit => Color32::WHITE,
        HandleTarget::Side(direction, _) => theme::AXES[(0..3).find(|axis| direction[*axis] != 0.0).unwrap_or(0)],
        HandleTarget::Row(_) | HandleTarget::Place => theme::ON_PICTURE,
        HandleTarget::Number | HandleTarget::NewRow(_) => theme::HANDLE,
    };
    let size = if lit { 6.0 } else { 4.5 };
    match handle.target {
        HandleTarget::NewRow(_) => {
            painter.circle(handle.at, size, SHADE, Stroke::new(1.25, color));
            let arm = 2.25;
            painter.line_segment([handle.at - vec2(arm, 0.0), handle.at + vec2(arm, 0.0)], Stroke::new(1.25, color));
            painter.line_segment([handle.at - vec2(0.0, arm), handle.at + vec2(0.0, arm)], Stroke::new(1.25, color));
        }
        HandleTarget::Side(..) => {
            let square = Rect::from_center_size(handle.at, vec2(size, size) * 1.7);
            painter.rect_filled(square.expand(1.5), 2.5, SHADE);
            painter.rect_filled(square, 1.5, color);
        }
        _ => {
            painter.circle_filled(handle.at, size + 1.5, SHADE);
            painter.circle_filled(handle.at, size, color);
        }
    }
}

/// The name and the value of a handle.
pub fn text_of(handle: &ValueHandle) -> String {
    match handle.target {
        HandleTarget::Number | HandleTarget::Side(..) => {
            format!("{} {}", handle.label, with_unit(handle.value, handle.param.limits.unit))
        }
        HandleTarget::NewRow(_) => "New point: drag or click".to_owned(),
        HandleTarget::Place | HandleTarget::Row(_) => handle.label.clone(),
    }
}

/// Paints a text beside a position, within the picture.
pub fn tag(painter: &Painter, at: Pos2, text: String) {
    let galley = painter.layout_no_wrap(text, FontId::proportional(13.0), *theme::TEXT);
    let size = galley.size() + vec2(14.0, 8.0);
    let inside = painter.clip_rect().shrink(4.0);
    let mut corner = at + vec2(16.0, -size.y - 8.0);
    corner.x = corner.x.min(inside.right() - size.x).max(inside.left());
    corner.y = corner.y.min(inside.bottom() - size.y).max(inside.top());
    let rect = Rect::from_min_size(corner, size);
    painter.rect(
        rect,
        5.0,
        theme::BAR.gamma_multiply(0.94),
        Stroke::new(1.0, theme::RESTING),
        egui::StrokeKind::Inside,
    );
    let place = Align2::CENTER_CENTER.align_size_within_rect(galley.size(), rect);
    painter.galley(place.min, galley, *theme::TEXT);
}

/// Names the handles for readers of the screen.
pub fn announce(ui: &Ui, set: &HandleSet) {
    for handle in &set.handles {
        let id = ui.scope_id().with(("handle", handle.key.row, handle.key.part));
        let response = ui.interact(grab_rect(handle.at), id, Sense::hover());
        let label = format!("Handle: {}", handle.label);
        response.widget_info(|| match handle.target {
            HandleTarget::Number | HandleTarget::Side(..) => WidgetInfo::slider(true, handle.value, &label),
            _ => WidgetInfo::labeled(Role::Slider, true, &label),
        });
    }
}
