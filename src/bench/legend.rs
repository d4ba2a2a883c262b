//! The title of a chart, and its legend of colors and shapes in a column beside the plane.

use plotters::style::RGBColor;

use super::axes::{INK, SOFT_INK};
use super::canvas::{ChartCanvas, Failed, LEFT, fitting};
use super::marks::{RADIUS, cross, mark, ring};

/// Color of the frontier.
pub(super) const FRONTIER: RGBColor = RGBColor(0x9f, 0xc5, 0xe8);
/// Width of the frontier, in pixels.
pub(super) const FRONTIER_WIDTH: f64 = 6.0;
/// Dash and gap of the lines for bounds, in pixels.
pub(super) const DASH: [f64; 2] = [9.0, 6.0];
/// Dot and gap of guide lines, in pixels.
pub(super) const DOTS: [f64; 2] = [1.5, 3.5];

/// Size of the letters of the title, in pixels.
pub(super) const TITLE_EM: f64 = 23.0;
/// Width available for the title, in pixels.
pub(super) const TITLE_WIDTH: f64 = 1056.0;

const EM: f64 = 15.0;
const LINE: f64 = 24.0;
/// Distance from the middle of a sign to its text.
const GAP: f64 = 24.0;

/// The sign before the text of an entry.
pub(super) enum Sign<'a> {
    /// A stroke in the color of a method.
    Stroke(RGBColor),
    /// The shape of a quality.
    Shape(&'a str),
    /// The frontier line.
    Frontier,
    /// The ring around the default row.
    Ring,
    /// The cross over rows with too many wrong pixels.
    Cross,
    /// A dashed line.
    Dashed(RGBColor),
    /// A dotted line.
    Dotted(RGBColor),
    /// No sign: the text continues the entry above.
    More,
}

/// A group of entries below a heading.
pub(super) struct LegendGroup<'a> {
    /// The heading; empty for a gap without text.
    pub heading: &'a str,
    /// The signs and their meanings.
    pub entries: Vec<(Sign<'a>, String)>,
}

/// Draws the groups from `at` downward, in a column of `width`.
pub(super) fn legend(
    canvas: &ChartCanvas<'_>,
    at: (f64, f64),
    width: f64,
    groups: &[LegendGroup<'_>],
) -> Result<(), Failed> {
    let (x, mut y) = at;
    for group in groups.iter().filter(|group| !group.entries.is_empty()) {
        if !group.heading.is_empty() {
            canvas.text(group.heading, (x, y), EM, SOFT_INK, LEFT)?;
            y += LINE;
        }
        for (sign, words) in &group.entries {
            draw_sign(canvas, (x + 11.0, y), sign)?;
            canvas.text(&fitting(words, EM, width - 11.0 - GAP), (x + 11.0 + GAP, y), EM, INK, LEFT)?;
            y += LINE;
        }
        y += LINE * 0.6;
    }
    Ok(())
}

fn draw_sign(canvas: &ChartCanvas<'_>, at: (f64, f64), sign: &Sign<'_>) -> Result<(), Failed> {
    let ends = [(at.0 - 12.0, at.1), (at.0 + 12.0, at.1)];
    match sign {
        Sign::Stroke(color) => canvas.line(&ends, *color, 5.0),
        Sign::Shape(quality) => mark(canvas, at, quality, SOFT_INK),
        Sign::Frontier => {
            canvas.line(&ends, FRONTIER, FRONTIER_WIDTH)?;
            canvas.disc(at, RADIUS + 2.0, FRONTIER)
        }
        Sign::Ring => ring(canvas, at, INK),
        Sign::Cross => cross(canvas, at),
        Sign::Dashed(color) => canvas.dashed(ends, *color, 2.0, DASH),
        Sign::Dotted(color) => canvas.dashed(ends, *color, 1.5, DOTS),
        Sign::More => Ok(()),
    }
}

/// Draws the title of a chart and the line below it, both clipped at the edge of the chart.
pub(super) fn title(canvas: &ChartCanvas<'_>, title: &str, below: &str) -> Result<(), Failed> {
    canvas.text(&fitting(title, TITLE_EM, TITLE_WIDTH), (22.0, 32.0), TITLE_EM, INK, LEFT)?;
    canvas.text(&fitting(below, EM, TITLE_WIDTH), (22.0, 60.0), EM, SOFT_INK, LEFT)
}
