//! The marks of charts: a color for each method, a shape for each quality.

use plotters::style::RGBColor;

use super::canvas::{ChartCanvas, Failed, PAPER};

/// Half the width of a mark, in pixels.
pub(super) const RADIUS: f64 = 6.5;
/// The color of the cross over wrong rows.
pub(super) const WRONG: RGBColor = RGBColor(0xc0, 0x00, 0x20);

/// The methods in the order of the legend. The colors stay distinct with red-green color blindness.
const METHODS: [(&str, RGBColor); 7] = [
    ("auto", RGBColor(0x1a, 0x1a, 0x1a)),
    ("straight-line", RGBColor(0xd5, 0x5e, 0x00)),
    ("tape", RGBColor(0x00, 0x8a, 0x66)),
    ("interpreter", RGBColor(0x00, 0x72, 0xb2)),
    ("baked", RGBColor(0xb8, 0x86, 0x00)),
    ("thesis", RGBColor(0xa8, 0x4a, 0x86)),
    ("limit", RGBColor(0x70, 0x70, 0x70)),
];
/// The color of methods that are not listed above.
const OTHERS: [RGBColor; 3] = [RGBColor(0x3a, 0xa6, 0xdd), RGBColor(0x7a, 0x5c, 0x3e), RGBColor(0x6a, 0x3d, 0x9a)];
/// The qualities in the order of the legend.
const QUALITIES: [&str; 3] = ["draft", "default", "fine"];

/// The color of a method.
pub(super) fn color(method: &str) -> RGBColor {
    let known = METHODS.iter().find(|(name, _)| *name == method).map(|(_, color)| *color);
    known.unwrap_or_else(|| OTHERS[method.bytes().map(usize::from).sum::<usize>() % OTHERS.len()])
}

/// A light tint of the color for lines behind the marks.
pub(super) fn faint(RGBColor(r, g, b): RGBColor) -> RGBColor {
    let mix = |c: u8| (f64::from(c) * 0.4 + 255.0 * 0.6) as u8;
    RGBColor(mix(r), mix(g), mix(b))
}

/// Unique names: first the known ones in their order, then the others in order of appearance.
fn ordered<'a>(
    known: impl Iterator<Item = &'static str>,
    names: impl Iterator<Item = &'a str> + Clone,
) -> Vec<&'a str> {
    let mut found: Vec<&str> = known.filter_map(|name| names.clone().find(|n| *n == name)).collect();
    for name in names {
        if !found.contains(&name) {
            found.push(name);
        }
    }
    found
}

/// The unique methods in the order of the legend.
pub(super) fn methods<'a>(names: impl Iterator<Item = &'a str> + Clone) -> Vec<&'a str> {
    ordered(METHODS.iter().map(|(name, _)| *name), names)
}

/// The unique qualities in the order of the legend.
pub(super) fn qualities<'a>(names: impl Iterator<Item = &'a str> + Clone) -> Vec<&'a str> {
    ordered(QUALITIES.into_iter(), names)
}

/// Draws the mark of a quality with a thin edge in the background color, which separates marks that touch.
pub(super) fn mark(canvas: &ChartCanvas<'_>, at: (f64, f64), quality: &str, color: RGBColor) -> Result<(), Failed> {
    for (grow, color) in [(1.3, PAPER), (0.0, color)] {
        let r = RADIUS + grow;
        match quality {
            "default" => canvas.disc(at, r - 0.3, color)?,
            // Polygons cover about the same area as the disc.
            "draft" => canvas.polygon(&corners(at, r * 1.22 + grow, 3, 0.0), color)?,
            "fine" => canvas.polygon(&corners(at, r * 1.2, 4, std::f64::consts::FRAC_PI_4), color)?,
            _ => canvas.polygon(&corners(at, r * 1.2, 4, 0.0), color)?,
        }
    }
    Ok(())
}

/// The corners of a regular polygon, the first of them above the center when `turn` is zero.
fn corners((x, y): (f64, f64), radius: f64, count: usize, turn: f64) -> Vec<(f64, f64)> {
    let angles = (0..count).map(|i| turn + i as f64 * std::f64::consts::TAU / count as f64);
    angles.map(|angle| (x + radius * angle.sin(), y - radius * angle.cos())).collect()
}

/// Crosses out a mark.
pub(super) fn cross(canvas: &ChartCanvas<'_>, (x, y): (f64, f64)) -> Result<(), Failed> {
    // Thin and long, so that the shape below stays recognizable.
    let r = RADIUS + 4.0;
    canvas.line(&[(x - r, y - r), (x + r, y + r)], WRONG, 1.7)?;
    canvas.line(&[(x - r, y + r), (x + r, y - r)], WRONG, 1.7)
}

/// Draws a ring around a mark.
pub(super) fn ring(canvas: &ChartCanvas<'_>, at: (f64, f64), color: RGBColor) -> Result<(), Failed> {
    canvas.circle(at, RADIUS + 5.5, color, 2.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_legend_has_an_order_and_takes_what_it_does_not_know() {
        let names = ["thesis", "novel", "auto", "thesis", "tape"];
        assert_eq!(methods(names.into_iter()), ["auto", "tape", "thesis", "novel"]);
        assert_eq!(qualities(["fine", "draft", "odd"].into_iter()), ["draft", "fine", "odd"]);
        assert_eq!(color("novel"), color("novel"));
    }

    #[test]
    fn known_methods_have_colors_of_their_own() {
        for (i, (_, a)) in METHODS.iter().enumerate() {
            assert!(METHODS[i + 1..].iter().all(|(_, b)| a != b));
        }
    }
}
