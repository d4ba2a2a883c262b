//! The gizmo of the selection: arrows and squares to move, rings to rotate, cubes to scale. Its handles are painted over
//! the picture; `transforms` follows a drag of one.

use std::f64::consts::TAU;

use egui::{Color32, Painter, Pos2, Rect, Shape, Stroke, vec2};
use glam::{DMat3, DVec3};

use super::projection::Projection;
use super::theme;
use super::transforms::kinds::{Constraint, TransformKind};

/// Length of the arrows and pick radius, in points.
const LENGTH: f32 = 78.0;
const GRAB: f32 = 8.0;
/// A shorter arrow points at the eye and cannot be dragged.
const SHORTEST: f32 = 14.0;
/// Near and far edge of the squares, in lengths of the arrows.
const SQUARE: [f64; 2] = [0.3, 0.52];
/// The least area of a square, in square points: else it is seen from its edge.
const LEAST_AREA: f32 = 60.0;
/// Corners of a ring.
const CORNERS: usize = 64;
/// Radius of the ring around the view, in lengths of the arrows.
const OUTER: f32 = 1.18;

const SHADE: Color32 = Color32::from_black_alpha(90);

/// The handles on the screen, in points.
pub struct Gizmo {
    kind: TransformKind,
    center: Pos2,
    tips: [Option<Pos2>; 3],
    squares: [Option<[Pos2; 4]>; 3],
    /// The halves of the rings that face the eye.
    rings: [Vec<Pos2>; 3],
}

impl Gizmo {
    /// The handles at a pivot along the `axes`, the columns; `None` if the pivot is behind the eye.
    pub fn new(
        kind: TransformKind,
        pivot: DVec3,
        axes: &DMat3,
        toward_eye: DVec3,
        projection: &Projection,
    ) -> Option<Self> {
        let center = projection.to_screen(pivot)?;
        let length = projection.meters_per_point(pivot) * f64::from(LENGTH);
        let at = |offset: DVec3| projection.to_screen(pivot + offset * length);
        let mut gizmo = Self { kind, center, tips: [None; 3], squares: [None; 3], rings: Default::default() };
        for axis in 0..3 {
            let (u, v) = (axes.col((axis + 1) % 3), axes.col((axis + 2) % 3));
            if kind == TransformKind::Rotate {
                let point = |i: usize| {
                    let (sine, cosine) = (TAU * i as f64 / CORNERS as f64).sin_cos();
                    u * cosine + v * sine
                };
                // Starts where the ring turns to the eye, so that the visible half is one line.
                let first =
                    (0..CORNERS).find(|i| point(*i).dot(toward_eye) < 0.0 && point(i + 1).dot(toward_eye) >= 0.0);
                let half = (0..CORNERS).map(|i| point(i + first.map_or(0, |first| first + 1)));
                gizmo.rings[axis] = half.filter(|p| p.dot(toward_eye) >= -1e-9).filter_map(at).collect();
                continue;
            }
            gizmo.tips[axis] = at(axes.col(axis)).filter(|tip| tip.distance(center) >= SHORTEST);
            if kind == TransformKind::Move {
                let [near, far] = SQUARE;
                let corners = [(near, near), (far, near), (far, far), (near, far)].map(|(a, b)| at(u * a + v * b));
                if let [Some(a), Some(b), Some(c), Some(d)] = corners {
                    let area = (c - a).x * (d - b).y - (c - a).y * (d - b).x;
                    gizmo.squares[axis] = (area.abs() > 2.0 * LEAST_AREA).then_some([a, b, c, d]);
                }
            }
        }
        Some(gizmo)
    }

    /// The position of the pivot, in points.
    pub fn center(&self) -> Pos2 {
        self.center
    }

    /// The handle under the pointer.
    pub fn handle_at(&self, pointer: Pos2) -> Option<Constraint> {
        let from_center = pointer.distance(self.center);
        if self.kind != TransformKind::Rotate && from_center < GRAB {
            return Some(Constraint::Free);
        }
        let lines = (0..3).filter_map(|axis| {
            let tip = self.tips[axis].map(|tip| segment_distance(pointer, self.center, tip));
            let ring = self.rings[axis].windows(2).map(|pair| segment_distance(pointer, pair[0], pair[1]));
            tip.into_iter().chain(ring).min_by(f32::total_cmp).map(|distance| (axis, distance))
        });
        let nearest = lines.min_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, distance)| *distance < GRAB);
        if let Some((axis, _)) = nearest {
            return Some(Constraint::Axis(axis));
        }
        let is_in = |axis: &usize| self.squares[*axis].is_some_and(|corners| is_within(pointer, &corners));
        if let Some(axis) = (0..3).find(is_in) {
            return Some(Constraint::Plane(axis));
        }
        let on_outer = self.kind == TransformKind::Rotate && (from_center - LENGTH * OUTER).abs() < GRAB;
        on_outer.then_some(Constraint::Free)
    }

    /// Paints the handles; the hovered or dragged one is brighter.
    pub fn paint(&self, painter: &Painter, lit: Option<Constraint>) {
        for axis in 0..3 {
            let on = lit == Some(Constraint::Axis(axis));
            let color = if on { Color32::WHITE } else { theme::AXES[axis] };
            self.paint_square(painter, axis, lit == Some(Constraint::Plane(axis)));
            if self.rings[axis].len() > 1 {
                painter.add(Shape::line(self.rings[axis].clone(), Stroke::new(4.5, SHADE)));
                painter.add(Shape::line(self.rings[axis].clone(), Stroke::new(2.25, color)));
            }
            if let Some(tip) = self.tips[axis] {
                self.paint_arrow(painter, tip, color);
            }
        }
        let color = if lit == Some(Constraint::Free) { Color32::WHITE } else { theme::ON_PICTURE };
        match self.kind {
            TransformKind::Move => {
                painter.circle(self.center, 4.5, color, Stroke::new(1.5, Color32::from_black_alpha(130)));
            }
            TransformKind::Scale => paint_cube(painter, self.center, 5.0, color),
            TransformKind::Rotate => {
                painter.circle_stroke(self.center, LENGTH * OUTER, Stroke::new(1.75, color.gamma_multiply(0.8)));
                painter.circle_filled(self.center, 2.5, color);
            }
        }
    }

    fn paint_arrow(&self, painter: &Painter, tip: Pos2, color: Color32) {
        let direction = (tip - self.center).normalized();
        let (start, neck) = (self.center + direction * 9.0, tip - direction * 11.0);
        let side = vec2(-direction.y, direction.x) * 4.5;
        painter.line_segment([start, neck], Stroke::new(4.5, SHADE));
        painter.line_segment([start, neck], Stroke::new(2.25, color));
        if self.kind == TransformKind::Scale {
            paint_cube(painter, tip - direction * 6.0, 5.0, color);
        } else {
            painter.add(Shape::convex_polygon(vec![tip, neck + side, neck - side], color, Stroke::NONE));
        }
    }

    fn paint_square(&self, painter: &Painter, axis: usize, on: bool) {
        let Some(corners) = self.squares[axis] else { return };
        let color = if on { Color32::WHITE } else { theme::AXES[axis] };
        let stroke = Stroke::new(1.25, color);
        painter.add(Shape::convex_polygon(corners.to_vec(), color.gamma_multiply(if on { 0.5 } else { 0.28 }), stroke));
    }
}

fn paint_cube(painter: &Painter, at: Pos2, half: f32, color: Color32) {
    let square = Rect::from_center_size(at, egui::Vec2::splat(2.0 * half));
    painter.rect_filled(square.expand(1.5), 2.5, SHADE);
    painter.rect_filled(square, 1.5, color);
}

/// Paints an axis through a point as a line across the picture.
pub fn paint_axis(painter: &Painter, projection: &Projection, through: DVec3, direction: DVec3, axis: usize) {
    let length = projection.meters_per_point(through) * 1e4;
    // Toward the eye a line ends before it.
    let end = |side: f64| {
        let lengths = (0..12).map(|halved| side * length * 0.5_f64.powi(halved));
        lengths.filter_map(|length| projection.to_screen(through + direction * length)).next()
    };
    if let (Some(a), Some(b)) = (end(-1.0), end(1.0)) {
        painter.line_segment([a, b], Stroke::new(1.25, theme::AXES[axis.min(2)].gamma_multiply(0.8)));
    }
}

fn segment_distance(p: Pos2, a: Pos2, b: Pos2) -> f32 {
    let along = ((p - a).dot(b - a) / (b - a).length_sq().max(1e-6)).clamp(0.0, 1.0);
    p.distance(a + (b - a) * along)
}

/// Whether a point is within a convex polygon.
fn is_within(p: Pos2, corners: &[Pos2; 4]) -> bool {
    let side = |i: usize| {
        let (a, b) = (corners[i], corners[(i + 1) % 4]);
        (b - a).x * (p - a).y - (b - a).y * (p - a).x
    };
    let sides = [side(0), side(1), side(2), side(3)];
    sides.iter().all(|v| *v >= 0.0) || sides.iter().all(|v| *v <= 0.0)
}

/// A position in the middle of a square, for tests of what is under the pointer.
#[cfg(test)]
fn middle(corners: &[Pos2; 4]) -> Pos2 {
    egui::pos2(corners.iter().map(|c| c.x).sum::<f32>() / 4.0, corners.iter().map(|c| c.y).sum::<f32>() / 4.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view_state::ViewState;

    fn seen(kind: TransformKind) -> Gizmo {
        let view = ViewState::default();
        let toward = view.navigation.rotation * DVec3::Z;
        let projection = Projection::new(&view, 1.0);
        Gizmo::new(kind, DVec3::ZERO, &DMat3::IDENTITY, toward, &projection).unwrap()
    }

    #[test]
    fn each_handle_is_found_where_it_is_painted() {
        let moving = seen(TransformKind::Move);
        assert_eq!(moving.handle_at(moving.center), Some(Constraint::Free));
        for axis in 0..3 {
            assert_eq!(moving.handle_at(moving.tips[axis].unwrap()), Some(Constraint::Axis(axis)));
            assert_eq!(moving.handle_at(middle(&moving.squares[axis].unwrap())), Some(Constraint::Plane(axis)));
        }
        let turning = seen(TransformKind::Rotate);
        assert_eq!(turning.handle_at(turning.center), None);
        assert_eq!(turning.handle_at(turning.center + vec2(0.0, LENGTH * OUTER)), Some(Constraint::Free));
        for axis in 0..3 {
            let ring = &turning.rings[axis];
            assert!((CORNERS / 2 - 1..=CORNERS / 2 + 2).contains(&ring.len()), "half a ring: {}", ring.len());
            let gaps = ring.windows(2).map(|pair| pair[0].distance(pair[1])).fold(0.0, f32::max);
            assert!(gaps < 0.2 * LENGTH, "one line: {gaps}");
            assert_eq!(turning.handle_at(ring[ring.len() / 3]), Some(Constraint::Axis(axis)));
        }
        assert_eq!(moving.handle_at(moving.center + vec2(300.0, 0.0)), None);
    }
}
