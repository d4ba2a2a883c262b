//! The chart of one scene: cost and error of each method and quality.

use image::RgbImage;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::axes::{INK, LogAxis, Plane, SOFT_INK, Words};
use super::canvas::{ChartCanvas, Failed, LEFT, PAPER, canvas, fitting, text_width};
use super::frontier::frontier;
use super::labels::{LabelPlace, Obstacles, Wish, along, around};
use super::legend::{DASH, FRONTIER, FRONTIER_WIDTH, LegendGroup, Sign, TITLE_EM, TITLE_WIDTH, legend, title};
use super::marks::{RADIUS, color, cross, faint, mark, methods, qualities, ring};
use super::row::{BenchRow, DEFAULT, LIMIT};
use crate::field::reference::accuracy::MAX_WRONG_SHARE;

/// Width and height of a chart, in pixels.
pub(super) const SIZE: (u32, u32) = (1100, 760);
/// Width of the legend with its margins, in pixels.
pub(super) const LEGEND: u32 = 236;
/// Height of the title with its margins, in pixels.
pub(super) const TITLE: u32 = 84;
/// Smaller errors, in pixel footprints, are drawn at this value, because zero has no logarithm.
const LEAST_ERROR: f64 = 1e-6;
/// Smaller times, in milliseconds, are drawn at this value.
pub(super) const LEAST_TIME: f64 = 1e-3;
const LABEL_EM: f64 = 14.5;

/// A measurement as a point, in logarithms of its error and its time.
struct Dot<'a> {
    row: &'a BenchRow,
    x: f64,
    y: f64,
}

impl Dot<'_> {
    /// Whether too many pixels are wrong, or their number is unknown.
    fn is_wrong(&self) -> bool {
        self.row.wrong_share.is_nan() || self.row.wrong_share > MAX_WRONG_SHARE
    }

    /// The label at the mark. It omits the default quality, so that most labels are short.
    fn label(&self) -> String {
        if self.row.is_the_default() {
            return format!("default ({})", self.row.method);
        }
        if self.row.quality == DEFAULT {
            self.row.method.clone()
        } else {
            format!("{} {}", self.row.method, self.row.quality)
        }
    }
}

/// Draws the CPU time of every method and quality against the error of its picture, both logarithmic. The rows are
/// those of one scene at one size; rows with a time or error that is not finite are skipped.
///
/// The Pareto frontier joins the points that no other point beats. It skips the method `limit`, which is not
/// selectable, and rows with too many wrong pixels: depth errors cover only pixels where both pictures show a surface,
/// so they say little there.
pub fn time_against_error(rows_of_one_scene: &[BenchRow]) -> RgbImage {
    let dots: Vec<Dot<'_>> = rows_of_one_scene
        .iter()
        .filter(|row| row.cpu_ms.is_finite() && row.depth_p99.is_finite())
        .map(|row| Dot { row, x: row.depth_p99.max(LEAST_ERROR).log10(), y: row.cpu_ms.max(LEAST_TIME).log10() })
        .collect();
    canvas(SIZE, |canvas| draw(canvas, rows_of_one_scene, &dots))
}

fn draw(canvas: &ChartCanvas<'_>, rows: &[BenchRow], dots: &[Dot<'_>]) -> Result<(), Failed> {
    let (headline, below) = words(rows, dots.len());
    title(canvas, &headline, &below)?;
    let floor = LEAST_ERROR.log10();
    let x = match dots {
        [] => LogAxis { low: -4.5, high: 0.5 },
        _ => LogAxis::around(dots.iter().map(|dot| dot.x)),
    };
    let axes = (x, LogAxis::around(dots.iter().map(|dot| dot.y)));
    let words = Words {
        x: "depth error, 99th percentile (pixel footprints)",
        y: "CPU time (ms)",
        floor: dots.iter().any(|dot| dot.x == floor).then_some((floor, "≤ 0.000001")),
    };
    let plane = Plane::draw(canvas, axes, [TITLE, LEGEND], &words)?;
    if dots.is_empty() {
        nothing(canvas, &plane)?;
    }
    let lines = draw_lines(canvas, &plane, dots)?;
    draw_dots(canvas, &plane, dots)?;
    draw_labels(canvas, &plane, dots, lines)?;
    let [_, top, right, _] = plane.edges();
    legend(canvas, (right + 22.0, top + 10.0), f64::from(LEGEND) - 32.0, &groups(dots))
}

fn words(rows: &[BenchRow], drawn: usize) -> (String, String) {
    let Some(first) = rows.first() else { return ("Run time against error".into(), String::new()) };
    let grazing = rows.iter().map(|row| row.grazing_share).fold(0.0, f64::max) * 100.0;
    let below =
        format!("Further down is faster, further left is more exact. At most {grazing:.4} % of the pixels graze.");
    let left_out = match rows.len() - drawn {
        0 => String::new(),
        1 => " One row without finite numbers is left out.".into(),
        count => format!(" {count} rows without finite numbers are left out."),
    };
    let facts = format!(", {} × {} pixels, {}", first.size, first.size, first.node_count());
    // Truncate a long name instead of the facts after it.
    let name = fitting(&first.scene, TITLE_EM, TITLE_WIDTH - text_width(&facts, TITLE_EM));
    (name + &facts, below + &left_out)
}

/// Draws the note that there are no measurements.
pub(super) fn nothing(canvas: &ChartCanvas<'_>, plane: &Plane<'_>) -> Result<(), Failed> {
    let [left, top, right, bottom] = plane.edges();
    let middle = Pos { h_pos: HPos::Center, v_pos: VPos::Center };
    let at = ((left + right) / 2.0, (top + bottom) / 2.0);
    canvas.rectangle([at.0 - 90.0, at.1 - 18.0, at.0 + 90.0, at.1 + 18.0], PAPER)?;
    canvas.text("no measurements", at, 20.0, SOFT_INK, middle)
}

/// Draws the lines behind the marks, and returns points along them that labels should avoid.
fn draw_lines(canvas: &ChartCanvas<'_>, plane: &Plane<'_>, dots: &[Dot<'_>]) -> Result<Vec<(f64, f64)>, Failed> {
    let mut lines: Vec<Vec<(f64, f64)>> = Vec::new();
    let choices: Vec<&Dot<'_>> = dots.iter().filter(|dot| dot.row.method != LIMIT && !dot.is_wrong()).collect();
    let points: Vec<(f64, f64)> = choices.iter().map(|dot| (dot.x, dot.y)).collect();
    let best: Vec<(f64, f64)> = frontier(&points).into_iter().map(|i| plane.at(points[i].0, points[i].1)).collect();
    canvas.line(&best, FRONTIER, FRONTIER_WIDTH)?;
    best.iter().try_for_each(|at| canvas.disc(*at, RADIUS + 4.5, FRONTIER))?;
    lines.push(best);
    if let Some(limit) = limit(dots) {
        let [left, _, right, _] = plane.edges();
        let y = plane.at(limit.x, limit.y).1;
        canvas.dashed([(left, y), (right, y)], color(LIMIT), 2.0, DASH)?;
        lines.push(vec![(left, y), (right, y)]);
    }
    for method in methods(dots.iter().map(|dot| dot.row.method.as_str())) {
        let mut own: Vec<&Dot<'_>> = dots.iter().filter(|dot| dot.row.method == method).collect();
        own.sort_by(|a, b| a.y.total_cmp(&b.y));
        let path: Vec<(f64, f64)> = own.iter().map(|dot| plane.at(dot.x, dot.y)).collect();
        canvas.line(&path, faint(color(method)), 1.7)?;
        lines.push(path);
    }
    Ok(lines.iter().flat_map(|line| line.windows(2)).flat_map(|pair| along(pair[0], pair[1])).collect())
}

/// The limit drawn as a line across the plane: that at the default quality, or else the lowest.
fn limit<'a, 'b>(dots: &'a [Dot<'b>]) -> Option<&'a Dot<'b>> {
    let mut limits: Vec<&Dot<'_>> = dots.iter().filter(|dot| dot.row.method == LIMIT).collect();
    limits.sort_by(|a, b| (a.row.quality != DEFAULT).cmp(&(b.row.quality != DEFAULT)).then(a.y.total_cmp(&b.y)));
    limits.first().copied()
}

/// Draws the marks, the default row above the others, so that it stays visible.
fn draw_dots(canvas: &ChartCanvas<'_>, plane: &Plane<'_>, dots: &[Dot<'_>]) -> Result<(), Failed> {
    let mut order: Vec<&Dot<'_>> = dots.iter().collect();
    order.sort_by_key(|dot| dot.row.is_the_default());
    for dot in order {
        let at = plane.at(dot.x, dot.y);
        mark(canvas, at, &dot.row.quality, color(&dot.row.method))?;
        if dot.is_wrong() {
            cross(canvas, at)?;
        }
        if dot.row.is_the_default() {
            ring(canvas, at, INK)?;
        }
    }
    Ok(())
}

fn draw_labels(
    canvas: &ChartCanvas<'_>,
    plane: &Plane<'_>,
    dots: &[Dot<'_>],
    lines: Vec<(f64, f64)>,
) -> Result<(), Failed> {
    // Place the most important labels first: the default row, then the default quality, then the rest.
    let mut order: Vec<&Dot<'_>> = dots.iter().collect();
    order.sort_by_key(|dot| (!dot.row.is_the_default(), dot.row.quality != DEFAULT));
    let texts: Vec<String> = order.iter().map(|dot| dot.label()).collect();
    let reach = |dot: &Dot<'_>| if dot.row.is_the_default() { RADIUS + 6.5 } else { RADIUS + 2.0 };
    let wishes: Vec<Wish> = order
        .iter()
        .zip(&texts)
        .map(|(dot, text)| Wish {
            at: plane.at(dot.x, dot.y),
            size: (text_width(text, LABEL_EM) + 4.0, LABEL_EM * 1.15),
            reach: reach(dot),
        })
        .collect();
    let [left, top, right, bottom] = plane.edges();
    let taken = wishes.iter().map(|wish| around(wish.at, wish.reach)).collect();
    let inside = [left + 4.0, top + 4.0, right - 4.0, bottom - 4.0];
    let places = Obstacles { inside, taken, lines }.place(&wishes);
    for (((dot, text), wish), place) in order.iter().zip(&texts).zip(&wishes).zip(places) {
        if let Some(place) = place {
            draw_label(canvas, dot, text, wish, &place)?;
        }
    }
    Ok(())
}

fn draw_label(
    canvas: &ChartCanvas<'_>,
    dot: &Dot<'_>,
    text: &str,
    wish: &Wish,
    place: &LabelPlace,
) -> Result<(), Failed> {
    let [left, top, _, bottom] = place.edges;
    canvas.rectangle(place.edges, PAPER)?;
    if let Some(end) = place.leader {
        let length = (end.0 - wish.at.0).hypot(end.1 - wish.at.1);
        let toward = |d: f64| {
            let t = d / length;
            (wish.at.0 + (end.0 - wish.at.0) * t, wish.at.1 + (end.1 - wish.at.1) * t)
        };
        canvas.line(&[toward(wish.reach), toward(length - 1.0)], faint(color(&dot.row.method)), 1.0)?;
    }
    canvas.text(text, (left + 2.0, (top + bottom) / 2.0), LABEL_EM, color(&dot.row.method), LEFT)
}

fn groups<'a>(dots: &[Dot<'a>]) -> [LegendGroup<'a>; 3] {
    let method = |name: &'a str| (Sign::Stroke(color(name)), name.to_string());
    let quality = |name: &'a str| (Sign::Shape(name), name.to_string());
    let mut other = Vec::new();
    if dots.iter().any(|dot| dot.row.is_the_default()) {
        other.push((Sign::Ring, "the default".to_string()));
    }
    if !dots.is_empty() {
        other.push((Sign::Frontier, "frontier (unbeaten)".into()));
    }
    if let Some(limit) = limit(dots) {
        other.push((Sign::Dashed(color(LIMIT)), format!("limit ({})", limit.row.quality)));
    }
    if dots.iter().any(Dot::is_wrong) {
        other.push((Sign::Cross, "wrong beyond 0.01 %".into()));
    }
    [
        LegendGroup {
            heading: "method",
            entries: methods(dots.iter().map(|d| d.row.method.as_str())).into_iter().map(method).collect(),
        },
        LegendGroup {
            heading: "quality",
            entries: qualities(dots.iter().map(|d| d.row.quality.as_str())).into_iter().map(quality).collect(),
        },
        LegendGroup { heading: "", entries: other },
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::samples::{row, scene};

    fn has(image: &RgbImage, color: plotters::style::RGBColor) -> bool {
        image.pixels().any(|pixel| pixel.0 == [color.0, color.1, color.2])
    }

    #[test]
    fn every_method_shows_its_color() {
        let rows = scene("random-145", 145);
        let image = time_against_error(&rows);
        assert_eq!(image.dimensions(), SIZE);
        for method in methods(rows.iter().map(|row| row.method.as_str())) {
            assert!(has(&image, color(method)), "{method} is not to be seen");
        }
        assert!(has(&image, FRONTIER) && has(&image, super::super::marks::WRONG));
    }

    #[test]
    fn nothing_and_little_can_be_drawn() {
        for rows in [vec![], vec![row("a", 1, "auto", "default", 3.0, 0.0)]] {
            assert_eq!(time_against_error(&rows).dimensions(), SIZE);
        }
        let mut exact = scene("exact", 4);
        exact.iter_mut().for_each(|row| row.depth_p99 = 0.0);
        assert!(has(&time_against_error(&exact), color("tape")));
    }

    #[test]
    fn what_is_not_finite_is_left_out_and_told() {
        let mut rows =
            vec![row("a", 1, "auto", "default", f64::INFINITY, 0.1), row("a", 1, "auto", "fine", 2.0, f64::NAN)];
        assert!(words(&rows, 0).1.ends_with("2 rows without finite numbers are left out."));
        time_against_error(&rows);
        rows.push(row("a", 1, "odd", "odd", 0.0, 1e300));
        rows.push(row("a", 0, "odd", "odd", 1e300, 0.0));
        time_against_error(&rows);
    }
}
