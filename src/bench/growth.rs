//! The chart of run time against the number of nodes.

use image::RgbImage;
use plotters::style::RGBColor;

use super::axes::{LogAxis, Plane, SOFT_INK, Words};
use super::canvas::{ChartCanvas, Failed, LEFT, PAPER, canvas, text_width};
use super::chart::{LEAST_TIME, LEGEND, SIZE, TITLE, nothing};
use super::legend::{DASH, DOTS, LegendGroup, Sign, legend, title};
use super::marks::{color, mark, methods};
use super::row::{AUTO, BenchRow, DEFAULT, LIMIT};

/// The guide goes through the point of `auto` whose scene is nearest to this number of nodes.
const GUIDE_NODES: f64 = 145.0;
/// The guide shows the target: this many times the nodes ...
const TIMES_NODES: f64 = 8.0;
/// ... take at most this many times the time.
const TIMES_TIME: f64 = 2.5;
const GUIDE: RGBColor = SOFT_INK;
const LABEL_EM: f64 = 14.5;

/// The curve of a method, in logarithms of nodes and time.
struct Curve<'a> {
    method: &'a str,
    /// Every measurement.
    points: Vec<(f64, f64)>,
    /// One point for each number of nodes; for several scenes, the mean of their logarithms.
    line: Vec<(f64, f64)>,
}

/// Draws the CPU time of each method against the number of nodes, both logarithmic, at the default quality, or at the
/// first quality in the rows if the default is missing. Skips rows without a finite time or without nodes. A dotted
/// line shows the target: 2.5 times the time for 8 times the nodes.
pub fn growth(rows: &[BenchRow]) -> RgbImage {
    let names = || rows.iter().map(|row| row.quality.as_str());
    let quality = names().find(|name| *name == DEFAULT).or_else(|| names().next()).unwrap_or(DEFAULT);
    let drawn: Vec<&BenchRow> =
        rows.iter().filter(|row| row.quality == quality && row.cpu_ms.is_finite() && row.nodes > 0).collect();
    let curves: Vec<Curve<'_>> = methods(drawn.iter().map(|row| row.method.as_str()))
        .into_iter()
        .map(|method| Curve::new(method, drawn.iter().copied().filter(|row| row.method == method)))
        .collect();
    canvas(SIZE, |canvas| draw(canvas, &drawn, &curves, quality))
}

impl<'a> Curve<'a> {
    fn new(method: &'a str, rows: impl Iterator<Item = &'a BenchRow>) -> Self {
        let mut points: Vec<(f64, f64)> =
            rows.map(|row| ((row.nodes as f64).log10(), row.cpu_ms.max(LEAST_TIME).log10())).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let same = points.chunk_by(|a, b| a.0 == b.0);
        let line = same.map(|s| (s[0].0, s.iter().map(|point| point.1).sum::<f64>() / s.len() as f64)).collect();
        Self { method, points, line }
    }
}

fn draw(canvas: &ChartCanvas<'_>, rows: &[&BenchRow], curves: &[Curve<'_>], quality: &str) -> Result<(), Failed> {
    title(canvas, "Growth of the run time with the number of nodes", &below(rows, quality))?;
    let points = || curves.iter().flat_map(|curve| &curve.points);
    let x = with_room_for_names(LogAxis::around(points().map(|point| point.0)));
    let axes = (x, LogAxis::around(points().map(|point| point.1)));
    let words = Words { x: "nodes", y: "CPU time (ms)", floor: None };
    let plane = Plane::draw(canvas, axes, [TITLE, LEGEND], &words)?;
    if curves.is_empty() {
        nothing(canvas, &plane)?;
    }
    let guide = guide(curves, axes);
    if let Some([from, to]) = guide {
        canvas.dashed([plane.at(from.0, from.1), plane.at(to.0, to.1)], GUIDE, 1.5, DOTS)?;
    }
    // Draw the first methods of the legend last, above the others.
    for curve in curves.iter().rev() {
        draw_curve(canvas, &plane, curve, quality)?;
    }
    draw_names(canvas, &plane, curves)?;
    let [_, top, right, _] = plane.edges();
    legend(canvas, (right + 22.0, top + 10.0), f64::from(LEGEND) - 32.0, &groups(curves, guide.is_some()))
}

/// The axis, extended at its end for the names of the methods beside their last points.
fn with_room_for_names(axis: LogAxis) -> LogAxis {
    LogAxis { high: axis.high + (axis.high - axis.low) * 0.07, ..axis }
}

/// The line below the title: the common properties of all points.
fn below(rows: &[&BenchRow], quality: &str) -> String {
    let sizes = || rows.iter().map(|row| row.size);
    match (sizes().min(), sizes().max()) {
        (Some(least), Some(most)) if least == most => {
            let [wrong, grazing] = [|row: &BenchRow| row.wrong_share, |row: &BenchRow| row.grazing_share]
                .map(|share| rows.iter().map(|row| share(row)).fold(0.0, f64::max) * 100.0);
            format!("{least} × {least} pixels, {quality} quality; at most {wrong:.4} % wrong, {grazing:.4} % grazing.")
        }
        (Some(least), Some(most)) => {
            format!("{least} × {least} to {most} × {most} pixels, {quality} quality: not all points compare.")
        }
        _ => "CPU time against nodes".into(),
    }
}

/// The ends of the guide, clipped at the edges of the plane.
fn guide(curves: &[Curve<'_>], (x, y): (LogAxis, LogAxis)) -> Option<[(f64, f64); 2]> {
    let auto = curves.iter().find(|curve| curve.method == AUTO)?;
    let far = |point: &(f64, f64)| (10_f64.powf(point.0) - GUIDE_NODES).abs();
    let through = *auto.line.iter().min_by(|a, b| far(a).total_cmp(&far(b)))?;
    let slope = TIMES_TIME.log10() / TIMES_NODES.log10();
    let x_at = |height: f64| through.0 + (height - through.1) / slope;
    let ends = [x.low.max(x_at(y.low)), x.high.min(x_at(y.high))];
    Some(ends.map(|x| (x, through.1 + (x - through.0) * slope)))
}

fn draw_curve(canvas: &ChartCanvas<'_>, plane: &Plane<'_>, curve: &Curve<'_>, quality: &str) -> Result<(), Failed> {
    let color = color(curve.method);
    let path: Vec<(f64, f64)> = curve.line.iter().map(|point| plane.at(point.0, point.1)).collect();
    if curve.method == LIMIT {
        for pair in path.windows(2) {
            canvas.dashed([pair[0], pair[1]], color, 2.0, DASH)?;
        }
    } else {
        canvas.line(&path, color, 2.2)?;
    }
    curve.points.iter().try_for_each(|point| mark(canvas, plane.at(point.0, point.1), quality, color))
}

/// Draws the name of each method beside its last point; names that would overlap move apart.
fn draw_names(canvas: &ChartCanvas<'_>, plane: &Plane<'_>, curves: &[Curve<'_>]) -> Result<(), Failed> {
    let [_, _, right, _] = plane.edges();
    let mut names: Vec<(f64, f64, &str)> = curves
        .iter()
        .filter_map(|curve| curve.line.last().map(|last| (plane.at(last.0, last.1), curve.method)))
        .map(|((x, y), method)| (x, y, method))
        .collect();
    names.sort_by(|a, b| a.1.total_cmp(&b.1));
    let heights = apart(&names.iter().map(|name| name.1).collect::<Vec<f64>>(), LABEL_EM * 1.2);
    for ((x, _, method), y) in names.into_iter().zip(heights) {
        let x = (x + 13.0).min(right - 4.0 - text_width(method, LABEL_EM));
        let half = LABEL_EM * 0.55;
        canvas.rectangle([x - 2.0, y - half, x + text_width(method, LABEL_EM) + 2.0, y + half], PAPER)?;
        canvas.text(method, (x, y), LABEL_EM, color(method), LEFT)?;
    }
    Ok(())
}

/// Sorted heights, moved apart as little as possible so that each is at least `gap` from the one before.
fn apart(heights: &[f64], gap: f64) -> Vec<f64> {
    // Heights that collide become one stack, centered on the mean of the original heights of its members.
    let mut stacks: Vec<(f64, usize)> = Vec::new();
    for &height in heights {
        let mut stack = (height, 1);
        while let Some(&(middle, count)) = stacks.last() {
            let need = gap * (count + stack.1) as f64 / 2.0;
            if stack.0 - middle >= need {
                break;
            }
            stacks.pop();
            let sum = middle * count as f64 + stack.0 * stack.1 as f64;
            stack = (sum / (count + stack.1) as f64, count + stack.1);
        }
        stacks.push(stack);
    }
    let spread =
        |(middle, count): (f64, usize)| (0..count).map(move |i| middle + (i as f64 - (count - 1) as f64 / 2.0) * gap);
    stacks.into_iter().flat_map(spread).collect()
}

fn groups<'a>(curves: &[Curve<'a>], guided: bool) -> [LegendGroup<'a>; 2] {
    let method = |curve: &Curve<'a>| {
        let color = color(curve.method);
        let sign = if curve.method == LIMIT { Sign::Dashed(color) } else { Sign::Stroke(color) };
        (sign, curve.method.to_string())
    };
    let promise = [
        (Sign::Dotted(GUIDE), format!("{TIMES_TIME} times the time")),
        (Sign::More, format!("for {TIMES_NODES} times the nodes")),
    ];
    [
        LegendGroup { heading: "method", entries: curves.iter().map(method).collect() },
        LegendGroup { heading: "", entries: promise.into_iter().filter(|_| guided).collect() },
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::samples::{row, scene};

    #[test]
    fn the_guide_goes_through_auto_at_its_slope() {
        let rows: Vec<BenchRow> = [37, 145, 577].into_iter().flat_map(|n| scene(&format!("random-{n}"), n)).collect();
        let auto = Curve::new(AUTO, rows.iter().filter(|row| row.is_the_default()));
        let through = auto.line[1];
        let axes = (LogAxis { low: 1.0, high: 3.5 }, LogAxis { low: -1.0, high: 3.0 });
        let [from, to] = guide(&[auto], axes).unwrap();
        assert!((10_f64.powf(through.0) - 145.0).abs() < 1e-6);
        let slope = (to.1 - from.1) / (to.0 - from.0);
        assert!((10_f64.powf(slope * 8_f64.log10()) - 2.5).abs() < 1e-9);
        assert!((from.1 + (through.0 - from.0) * slope - through.1).abs() < 1e-9);
        assert!(guide(&[], axes).is_none());
    }

    #[test]
    fn scenes_with_the_same_nodes_are_one_point_of_the_line() {
        let rows = [row("a", 10, "auto", "default", 1.0, 0.1), row("b", 10, "auto", "default", 100.0, 0.1)];
        let curve = Curve::new("auto", rows.iter());
        assert_eq!(curve.line, [(1.0, 1.0)]);
        assert_eq!(curve.points.len(), 2);
    }

    #[test]
    fn names_are_moved_apart_but_no_more_than_needed() {
        assert_eq!(apart(&[0.0, 100.0], 10.0), [0.0, 100.0]);
        assert_eq!(apart(&[50.0, 50.0], 10.0), [45.0, 55.0]);
        assert_eq!(apart(&[0.0, 4.0, 8.0, 60.0], 10.0), [-6.0, 4.0, 14.0, 60.0]);
        assert!(apart(&[], 10.0).is_empty());
    }

    #[test]
    fn nothing_and_little_can_be_drawn() {
        let few = [row("a", 0, "auto", "fine", 3.0, 0.0), row("b", 7, "auto", "fine", f64::NAN, 0.0)];
        for rows in [&few[..0], &few[..1], &few[1..], &[row("a", 9, "auto", "draft", 0.0, 0.0)]] {
            assert_eq!(growth(rows).dimensions(), SIZE);
        }
    }
}
