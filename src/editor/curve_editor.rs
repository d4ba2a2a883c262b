//! The response curve of a mask: presets, and a plot whose points are dragged.

use egui::{Id, Pos2, Rect, Response, Role, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};

use super::instancing::{instancer, instancer_mut};
use super::multi_edit::MultiEdit;
use super::{theme, widgets};
use isolith_scene::{CurvePreset, MAX_CURVE_POINTS, MIN_CURVE_GAP, MIN_CURVE_POINTS, Node, ResponseCurve};

/// Height of the plot in points.
const HEIGHT: f32 = 76.0;
/// Between the plot and its frame.
const MARGIN: f32 = 6.0;
/// Radius of a point, and how near a press must be.
const POINT: f32 = 4.0;
const NEAR: f32 = 9.0;
/// Pieces of the line.
const PIECES: usize = 64;

const LABEL: &str = "Response curve";
const HELP: &str = "What becomes of the mask: its share before from left to right, its share after from bottom to top. \
                    Drag points; double-click adds a point, or removes the one there";

/// The curve of the mask at `index`.
pub fn show(ui: &mut Ui, edit: &mut MultiEdit<'_>, index: usize) {
    let curve_of = |node: &Node| Some(instancer(node)?.masks.get(index)?.curve.clone());
    let Some(curve) = curve_of(edit.active()) else { return };
    let is_common = edit.common(curve_of).is_some();
    let preset = CurvePreset::ALL.into_iter().find(|preset| is_common && preset.curve() == curve);
    let (widget, chosen) = widgets::row(ui, "Response", "Ready-made curves", |ui| {
        widgets::choice(ui, "Response", preset, &CurvePreset::ALL, CurvePreset::label, CurvePreset::help)
    });
    if let Some(chosen) = chosen {
        set(edit, widget, index, &chosen.curve());
    }
    let smooth = |node: &Node| curve_of(node).is_some_and(|curve| curve.smooth);
    edit.toggle(
        ui,
        ("Smooth", "", "The curve is smooth; else it is straight from point to point"),
        smooth,
        |node, on| {
            if let Some(slot) = instancer_mut(node).and_then(|instancer| instancer.masks.get_mut(index)) {
                slot.curve.smooth = on;
            }
        },
    );
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::click_and_drag());
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, LABEL));
    let plot = Plot { rect: rect.shrink(MARGIN) };
    let held = held_point(ui, &plot, &curve, &response);
    plot.paint(ui, rect, &curve, held.or_else(|| plot.point_under(&curve, response.hover_pos())));
    if let Some(changed) = answer(&plot, &curve, held, &response) {
        set(edit, response.id, index, &changed);
    }
    response.on_hover_text(HELP);
}

fn set(edit: &mut MultiEdit<'_>, widget: Id, index: usize, curve: &ResponseCurve) {
    edit.change(widget, |node| {
        if let Some(slot) = instancer_mut(node).and_then(|instancer| instancer.masks.get_mut(index)) {
            slot.curve = curve.clone();
        }
    });
}

/// The point that is being dragged.
fn held_point(ui: &Ui, plot: &Plot, curve: &ResponseCurve, response: &Response) -> Option<usize> {
    let key = response.id.with("held");
    if response.drag_started() {
        let held = plot.point_under(curve, ui.input(|i| i.pointer.press_origin()));
        ui.data_mut(|d| d.insert_temp(key, held));
    }
    if !response.dragged() {
        return None;
    }
    ui.data(|d| d.get_temp::<Option<usize>>(key)).flatten().filter(|held| *held < curve.points.len())
}

/// The curve after what the pointer does to it.
fn answer(plot: &Plot, curve: &ResponseCurve, held: Option<usize>, response: &Response) -> Option<ResponseCurve> {
    let at = response.interact_pointer_pos()?;
    if let Some(held) = held {
        return Some(moved(curve, held, plot.value_at(at)));
    }
    if !response.double_clicked() {
        return None;
    }
    match plot.point_under(curve, Some(at)) {
        Some(point) => without(curve, point),
        None => with(curve, plot.value_at(at)),
    }
}

/// With a point elsewhere, between its neighbors.
fn moved(curve: &ResponseCurve, point: usize, [x, y]: [f64; 2]) -> ResponseCurve {
    let mut curve = curve.clone();
    // A little more than the least gap, so that rounding takes nothing from it.
    let gap = 2.0 * MIN_CURVE_GAP;
    let low = point.checked_sub(1).map_or(0.0, |left| curve.points[left][0] + gap);
    let high = curve.points.get(point + 1).map_or(1.0, |right| right[0] - gap);
    curve.points[point] = [x.min(high).max(low), y];
    curve
}

/// With another point; `None` if there are many, or one is there.
fn with(curve: &ResponseCurve, [x, y]: [f64; 2]) -> Option<ResponseCurve> {
    let mut curve = curve.clone();
    if curve.points.len() >= MAX_CURVE_POINTS {
        return None;
    }
    let at = curve.points.partition_point(|point| point[0] < x);
    curve.points.insert(at, [x, y]);
    curve.fault().is_none().then_some(curve)
}

/// Without a point; `None` if there are few.
fn without(curve: &ResponseCurve, point: usize) -> Option<ResponseCurve> {
    let mut curve = curve.clone();
    if curve.points.len() <= MIN_CURVE_POINTS {
        return None;
    }
    curve.points.remove(point);
    Some(curve)
}

/// Where the curve is shown.
struct Plot {
    rect: Rect,
}

impl Plot {
    fn place_of(&self, [x, y]: [f64; 2]) -> Pos2 {
        pos2(self.rect.left() + self.rect.width() * x as f32, self.rect.bottom() - self.rect.height() * y as f32)
    }

    fn value_at(&self, place: Pos2) -> [f64; 2] {
        let across = (place.x - self.rect.left()) / self.rect.width();
        let up = (self.rect.bottom() - place.y) / self.rect.height();
        // Steps that the eye can tell apart keep files short.
        [across, up].map(|share| (f64::from(share).clamp(0.0, 1.0) * 1_000.0).round() / 1_000.0)
    }

    fn point_under(&self, curve: &ResponseCurve, place: Option<Pos2>) -> Option<usize> {
        let place = place?;
        let away = |at: &usize| self.place_of(curve.points[*at]).distance(place);
        let nearest = (0..curve.points.len()).min_by(|a, b| away(a).total_cmp(&away(b)))?;
        (away(&nearest) <= NEAR).then_some(nearest)
    }

    fn paint(&self, ui: &Ui, frame: Rect, curve: &ResponseCurve, marked: Option<usize>) {
        let painter = ui.painter();
        painter.rect_filled(frame, theme::RADIUS, *theme::DEEP);
        for quarter in 1..4 {
            let share = 0.25 * f64::from(quarter);
            painter.vline(self.place_of([share, 0.0]).x, self.rect.y_range(), (1.0, *theme::LINE));
            painter.hline(self.rect.x_range(), self.place_of([0.0, share]).y, (1.0, *theme::LINE));
        }
        let along = |i: usize| {
            let x = i as f64 / PIECES as f64;
            self.place_of([x, curve.value(x)])
        };
        let mut line: Vec<Pos2> = (0..=PIECES).map(along).collect();
        line.extend(curve.points.iter().map(|point| self.place_of(*point)));
        line.sort_by(|a, b| a.x.total_cmp(&b.x));
        painter.line(line, Stroke::new(1.5, *theme::ACCENT));
        for (at, point) in curve.points.iter().enumerate() {
            let (radius, color) = if marked == Some(at) { (POINT + 1.5, theme::HANDLE) } else { (POINT, *theme::TEXT) };
            painter.circle_filled(self.place_of(*point), radius, color);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_stay_between_their_neighbors_and_within_their_number() {
        let curve = CurvePreset::Ease.curve();
        for target in [[0.0, 0.3], [1.0, 0.3], [0.5, 1.0]] {
            for point in 0..curve.points.len() {
                assert_eq!(moved(&curve, point, target).fault(), None, "{point} to {target:?}");
            }
        }
        let mut many = curve.clone();
        while let Some(more) = with(&many, [many.points.len() as f64 * 0.09 + 0.02, 0.5]) {
            many = more;
        }
        assert_eq!(many.points.len(), MAX_CURVE_POINTS);
        let mut few = curve;
        while let Some(less) = without(&few, 0) {
            few = less;
        }
        assert_eq!(few.points.len(), MIN_CURVE_POINTS);
        assert_eq!(with(&few, few.points[0]), None, "a point is there");
    }
}
