//! The measures of the grid: numbers at the lines of a view along an axis, and the size of a cell in every view.

use egui::{Align2, FontId, Ui, pos2, vec2};
use glam::DVec3;

use super::numbers::number_text;
use super::projection::Projection;
use super::state::EditorState;
use super::theme;
use super::units::LengthUnit;

/// Size of the numbers, in points.
const TEXT: f32 = 11.0;
/// Least distance of two numbers, in points.
const APART: f32 = 44.0;
/// Most numbers along an edge.
const MOST: i64 = 100;

/// Paints the measures over the picture.
pub fn paint(state: &EditorState, ui: &Ui, projection: &Projection) {
    let unit = LengthUnit::of(ui.ctx());
    let grid = state.view.grid(unit.meters());
    let rect = state.view.rect;
    let painter = ui.painter_at(rect);
    let (font, color) = (FontId::proportional(TEXT), theme::ON_PICTURE);
    let shade = |at, align, text: &str| {
        painter.text(at + vec2(1.0, 1.0), align, text, font.clone(), egui::Color32::from_black_alpha(170));
        painter.text(at, align, text, font.clone(), color);
    };
    let text = format!("Grid {} {}", number_text(grid.cell / unit.meters()), unit.sign());
    shade(rect.left_bottom() + vec2(10.0, -22.0), Align2::LEFT_BOTTOM, &text);
    if state.view.navigation.axis().is_none() {
        return;
    }
    let (target, axes) = (state.view.navigation.target, [0, 1, 2].into_iter().filter(|axis| *axis != grid.axis));
    for axis in axes {
        let screen = |value: f64| {
            let mut at = target;
            at[axis] = value;
            projection.to_screen(at)
        };
        let direction = state.view.navigation.rotation.inverse() * DVec3::AXES[axis];
        let is_across = direction.x.abs() > 0.5;
        let coarse = grid.cell * 10.0;
        let Some([from, to]) = screen(0.0).zip(screen(coarse)).map(|(a, b)| [a, b]) else { continue };
        let spacing = if is_across { (to.x - from.x).abs() } else { (to.y - from.y).abs() };
        // Every cell, every second, every fifth, or every tenth one.
        let step = [1.0, 2.0, 5.0, 10.0].into_iter().find(|step| spacing * step >= APART).unwrap_or(10.0);
        let near = (target[axis] / (coarse * f64::from(step))).round() as i64;
        for index in near - MOST..=near + MOST {
            let value = index as f64 * coarse * f64::from(step);
            let Some(at) = screen(value).filter(|at| {
                rect.shrink(24.0).contains(if is_across {
                    pos2(at.x, rect.center().y)
                } else {
                    pos2(rect.center().x, at.y)
                })
            }) else {
                continue;
            };
            let text = number_text(value / unit.meters());
            if is_across {
                shade(pos2(at.x + 3.0, rect.bottom() - 5.0), Align2::LEFT_BOTTOM, &text);
            } else {
                shade(pos2(rect.left() + 58.0, at.y - 1.0), Align2::LEFT_BOTTOM, &text);
            }
        }
    }
}
