//! The legend in the corner of the viewport: explains the colors of a view mode.

use egui::{Align2, Color32, CornerRadius, FontId, Mesh, Painter, Pos2, Rect, pos2, vec2};
use glam::Vec3;

use super::theme;
use isolith_field::debug_view::{DepthRange, Legend, ViewMode};

/// Margin outside and padding inside the legend, in points.
const MARGIN: f32 = 12.0;
/// Width of the color bar, in points.
const BAR_WIDTH: f32 = 250.0;
const BAR_HEIGHT: f32 = 12.0;
const LINE: f32 = 18.0;

/// Paints the legend of `view_mode` into the lower left corner of `rect`; none for the lit picture.
pub fn paint(painter: &Painter, rect: Rect, view_mode: ViewMode, depth_range: &DepthRange) {
    let legend = view_mode.legend(depth_range);
    if legend.unit.is_empty() {
        return;
    }
    let bar = if legend.bar.is_empty() { 0.0 } else { BAR_HEIGHT + LINE + 4.0 };
    let swatches = if legend.swatches.is_empty() { 0.0 } else { LINE + 4.0 };
    let size = vec2(BAR_WIDTH + 2.0 * MARGIN + 8.0, 2.0 * LINE + 10.0 + bar + swatches + MARGIN);
    let card = Rect::from_min_size(rect.left_bottom() + vec2(MARGIN, -MARGIN - size.y), size);
    painter.rect_filled(card, CornerRadius::same(8), theme::FLOATING.gamma_multiply(0.88));
    let mut at = card.min + vec2(MARGIN + 4.0, MARGIN - 2.0);
    let title = capitalized(view_mode.name());
    painter.text(at, Align2::LEFT_TOP, title, FontId::proportional(14.0), *theme::TEXT);
    at.y += LINE + 1.0;
    painter.text(at, Align2::LEFT_TOP, &legend.unit, FontId::proportional(12.0), *theme::WEAK);
    at.y += LINE + 3.0;
    if !legend.bar.is_empty() {
        paint_bar(painter, at, &legend);
        at.y += bar;
    }
    paint_swatches(painter, at, &legend);
}

/// Capitalizes a name for a title.
pub fn capitalized(name: &str) -> String {
    let mut letters = name.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

fn paint_bar(painter: &Painter, at: Pos2, legend: &Legend) {
    let rect = Rect::from_min_size(at, vec2(BAR_WIDTH, BAR_HEIGHT));
    let last = (legend.bar.len() - 1).max(1) as f32;
    let mut mesh = Mesh::default();
    for (i, color) in legend.bar.iter().enumerate() {
        let x = rect.left() + rect.width() * i as f32 / last;
        mesh.colored_vertex(pos2(x, rect.top()), color32(*color));
        mesh.colored_vertex(pos2(x, rect.bottom()), color32(*color));
        if i > 0 {
            let v = 2 * i as u32;
            mesh.add_triangle(v - 2, v - 1, v);
            mesh.add_triangle(v - 1, v, v + 1);
        }
    }
    painter.add(mesh);
    for (share, number) in &legend.ticks {
        let x = rect.left() + rect.width() * share;
        painter.vline(x, rect.bottom()..=rect.bottom() + 4.0, (1.0, theme::WEAK));
        // Keep the numbers at the ends within the card.
        let (align, x) = match *share {
            share if share < 0.02 => (Align2::LEFT_TOP, x - 1.0),
            share if share > 0.98 => (Align2::RIGHT_TOP, x + 1.0),
            _ => (Align2::CENTER_TOP, x),
        };
        painter.text(pos2(x, rect.bottom() + 5.0), align, number, FontId::proportional(11.5), *theme::TEXT);
    }
}

fn paint_swatches(painter: &Painter, mut at: Pos2, legend: &Legend) {
    for (color, name) in &legend.swatches {
        let square = Rect::from_min_size(at + vec2(0.0, 2.0), vec2(BAR_HEIGHT, BAR_HEIGHT));
        painter.rect_filled(square, CornerRadius::same(3), color32(*color));
        let text = at + vec2(BAR_HEIGHT + 5.0, 1.0);
        let text = painter.text(text, Align2::LEFT_TOP, name, FontId::proportional(11.5), *theme::TEXT);
        at.x = text.right() + 14.0;
    }
}

fn color32(color: Vec3) -> Color32 {
    let [r, g, b] = color.to_array().map(|v| (v * 255.0).round() as u8);
    Color32::from_rgb(r, g, b)
}
