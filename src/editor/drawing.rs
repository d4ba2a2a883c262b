//! Drawing a new shape by one drag. A view along a horizontal axis shows its outline: from the middle of its base to a
//! corner. Any other view shows its size: from its middle on the ground or on a surface. The wheel changes a detail.

use egui::{Event, Key, MouseWheelUnit, Painter, Pos2, Stroke, Ui};
use glam::{DQuat, DVec3};

use super::handles::handle_paint::tag;
use super::numbers::number_text;
use super::placement::{placing, remembered};
use super::projection::Projection;
use super::shape_change::{filling, tidied};
use super::state::EditorState;
use super::steps::{finest_step, rounded, rounded_point};
use super::transforms::kinds::Tool;
use super::view_state::PointerActivity;
use super::{insertion, theme};
use isolith_geometry::{Aabb, Ray, Transform};
use isolith_scene::{NodeId, ParamValue, Params, Shape, ShapeKind};

/// The details that the wheel changes: the first that a shape has.
const DETAILS: [&str; 6] = ["sides", "points", "top_radius", "rounding", "thickness", "cut"];
/// Points of a wheel's way that count as one notch.
const NOTCH: f32 = 50.0;
/// Least and greatest number of corners that the wheel chooses.
const CORNERS: [f64; 2] = [3.0, 64.0];
/// A step of a detail that does not snap: this part of the width.
const DETAIL_SHARE: f64 = 0.02;

/// The plane in which the pointer draws.
#[derive(Clone, Copy, Debug, PartialEq)]
enum DrawPlane {
    /// Across the view: width and height are drawn.
    Outline {
        /// The direction of the width in the world.
        right: DVec3,
        /// Across both.
        normal: DVec3,
    },
    /// On the ground or a surface: the width is drawn.
    Footprint {
        /// Away from the surface.
        normal: DVec3,
    },
}

/// A shape that is being drawn.
pub struct DrawDrag {
    kind: ShapeKind,
    plane: DrawPlane,
    /// The middle of the base, in the world.
    start: DVec3,
    /// How far the wheel has been turned, in notches.
    notches: f32,
    node: Option<NodeId>,
    text: String,
}

/// Whether commands that add shapes choose what is drawn instead.
pub fn chooses_shape(state: &EditorState) -> bool {
    state.view.tool == Tool::Draw && !state.view.is_dropping
}

/// The name of what the wheel changes while a shape of this kind is drawn.
pub fn detail_name(kind: ShapeKind) -> Option<&'static str> {
    let shape = kind.default_shape();
    DETAILS.into_iter().find_map(|name| shape.find(name)).map(|param| &*param.label)
}

/// Where a drawing would begin, and its plane.
fn origin(state: &EditorState, projection: &Projection, at: Pos2, ctrl: bool) -> Option<(DVec3, DrawPlane)> {
    let view = &state.view.navigation;
    let snap = state.view.snap.length_step(ctrl, view.distance);
    let plane = match view.axis() {
        Some(0 | 2) => DrawPlane::Outline { right: view.rotation * DVec3::X, normal: view.rotation * DVec3::Z },
        _ => {
            let placing = placing(state, Some(at));
            let normal = placing.normal.unwrap_or(DVec3::Y).normalize_or(DVec3::Y);
            let point = if normal == DVec3::Y && snap > 0.0 {
                let [x, z] = [placing.point.x, placing.point.z].map(|v| rounded(v, snap));
                DVec3::new(x, placing.point.y, z)
            } else {
                placing.point
            };
            return Some((point, DrawPlane::Footprint { normal }));
        }
    };
    let DrawPlane::Outline { normal, .. } = plane else { return None };
    // As far into the picture as the active node: parts of one thing meet.
    let scene = state.session.document.scene();
    let active = state.session.document.selection().last().filter(|id| scene.node(**id).is_some());
    let depth = active.map_or(view.target, |id| scene.world_from_local(*id).translation);
    let point = in_plane(depth, normal, &projection.ray(at))?;
    let step = if snap > 0.0 { snap } else { finest_step(projection.meters_per_point(point)) };
    // What the plane says is not changed by rounding.
    let deep = normal.abs().cmpgt(DVec3::splat(0.5));
    Some((DVec3::select(deep, point, rounded_point(point, step)), plane))
}

/// The point of a plane under the ray; `None` if the plane is seen nearly from its edge.
fn in_plane(through: DVec3, normal: DVec3, ray: &Ray) -> Option<DVec3> {
    const FLATTEST: f64 = 0.01;
    let slope = ray.direction.dot(normal);
    let t = (through - ray.origin).dot(normal) / slope;
    (slope.abs() > FLATTEST && t.is_finite() && t > 0.0).then(|| ray.at(t))
}

impl DrawDrag {
    /// Begins where the pointer was pressed.
    pub fn begin(state: &EditorState, projection: &Projection, at: Pos2, ctrl: bool) -> Option<Self> {
        let (start, plane) = origin(state, projection, at, ctrl)?;
        let kind = state.view.drawn;
        Some(Self { kind, plane, start, notches: 0.0, node: None, text: kind.label().to_owned() })
    }

    /// Takes the wheel and the arrow keys of a frame.
    pub fn turn(&mut self, ui: &Ui) {
        let by = |event: &Event| match event {
            Event::MouseWheel { unit: MouseWheelUnit::Point, delta, .. } => delta.y / NOTCH,
            Event::MouseWheel { delta, .. } => delta.y,
            Event::Key { key: Key::ArrowUp, pressed: true, .. } => 1.0,
            Event::Key { key: Key::ArrowDown, pressed: true, .. } => -1.0,
            _ => 0.0,
        };
        self.notches += ui.input(|i| i.events.iter().map(by).sum::<f32>());
    }

    /// Whether the wheel or the arrow keys have changed a detail.
    pub fn has_turned(&self) -> bool {
        self.notches != 0.0
    }

    /// Follows the pointer: the first frame in which the shape has a size adds it.
    pub fn follow(&mut self, state: &mut EditorState, projection: &Projection, at: Pos2, ctrl: bool, widget: egui::Id) {
        let distance = state.view.navigation.distance;
        let snap = state.view.snap.length_step(ctrl, distance);
        let finest = finest_step(projection.meters_per_point(self.start));
        let step = if snap > 0.0 { snap } else { finest };
        let Some((shape, transform)) = self.drawn(state, &projection.ray(at), step) else { return };
        let shape = self.with_detail(shape, snap);
        self.text = told(&shape);
        state.session.begin(widget);
        match self.node {
            Some(id) => insertion::redraw(state, widget, id, shape, transform),
            None => self.node = insertion::drawn(state, shape, transform),
        }
    }

    /// The shape and its transform in the world; `None` while it has no size.
    fn drawn(&self, state: &EditorState, ray: &Ray, step: f64) -> Option<(Shape, Transform)> {
        match self.plane {
            DrawPlane::Outline { right, normal } => {
                let now = in_plane(self.start, normal, ray)? - self.start;
                let along = |direction: DVec3| {
                    let from = self.start.dot(direction);
                    rounded(from + now.dot(direction), step) - from
                };
                let (width, height) = (along(right).abs(), along(DVec3::Y));
                if width < 0.5 * step || height.abs() < 0.5 * step {
                    return None;
                }
                let half = DVec3::new(width, 0.5 * height.abs(), width);
                let shape = filling(self.kind, &Aabb::from_center_half(DVec3::ZERO, half));
                let bounds =
                    Some(shape.bounds()).filter(Aabb::is_finite).unwrap_or(Aabb::from_center_half(DVec3::ZERO, half));
                let low = if height > 0.0 { bounds.min.y } else { bounds.max.y };
                let place = tidy_point(self.start - DVec3::Y * low);
                Some((shape, Transform::from_translation(place)))
            }
            DrawPlane::Footprint { normal } => {
                let radius = rounded((in_plane(self.start, normal, ray)? - self.start).length(), step);
                let shape = remembered(state, self.kind);
                let bounds = shape.bounds();
                let wide = bounds.half().x.max(bounds.half().z);
                if radius < 0.5 * step || !bounds.is_finite() || wide <= 0.0 {
                    return (radius >= 0.5 * step).then(|| (shape, Transform::from_translation(self.start)));
                }
                let shape = tidied(shape.with_lengths_times(radius / wide));
                let rotation = if normal == DVec3::Y {
                    DQuat::IDENTITY
                } else {
                    DQuat::from_rotation_arc(DVec3::Y, normal).normalize()
                };
                let place = self.start - normal * shape.bounds().min.y;
                let translation = if normal == DVec3::Y { tidy_point(place) } else { place };
                Some((shape, Transform { translation, rotation, ..Transform::IDENTITY }))
            }
        }
    }

    /// The shape with its detail as far as the wheel has been turned.
    fn with_detail(&self, mut shape: Shape, snap: f64) -> Shape {
        let Some(param) = DETAILS.into_iter().find_map(|name| shape.find(name)) else { return shape };
        let (Some(ParamValue::Scalar(value)), half) = (shape.get(param.name), shape.bounds().half()) else {
            return shape;
        };
        if self.notches == 0.0 {
            return shape;
        }
        let is_count = matches!(param.name, "sides" | "points");
        let width = half.x.max(half.z);
        let step = match () {
            () if is_count => 1.0,
            () if snap > 0.0 => snap,
            () => 10.0_f64.powf((width * DETAIL_SHARE).log10().floor()),
        };
        let [least, most] = param.limits.hard;
        let (least, most) = match param.name {
            _ if is_count => (least.max(CORNERS[0]), most.min(CORNERS[1])),
            "rounding" => (least, most.min(half.min_element())),
            "cut" => (least, most),
            _ => (least, most.min(width)),
        };
        let value = rounded(value + f64::from(self.notches.round()) * step, step);
        shape.set(param.name, ParamValue::Scalar(value.clamp(least, most.max(least))));
        shape
    }
}

/// Rounded to a micrometer.
fn tidy_point(point: DVec3) -> DVec3 {
    rounded_point(point, 1e-6)
}

/// The name of a shape and its size.
fn told(shape: &Shape) -> String {
    let bounds = shape.bounds();
    let name = shape.kind().label();
    if !bounds.is_finite() {
        return name.to_owned();
    }
    let size = (bounds.half() * 2.0).to_array().map(|v| number_text(rounded(v, 1e-4)));
    let detail = DETAILS.into_iter().find_map(|detail| shape.find(detail));
    let detail = detail.and_then(|param| match shape.get(param.name)? {
        ParamValue::Scalar(value) => {
            Some(format!("  {} {}", param.label.to_lowercase(), number_text(rounded(value, 1e-4))))
        }
        _ => None,
    });
    format!("{name}  {} m{}", size.join(" × "), detail.unwrap_or_default())
}

/// Paints where a drawing begins, and the sizes of the one in progress.
pub fn paint(
    state: &EditorState,
    ui: &Ui,
    painter: &Painter,
    projection: &Projection,
    drawn: Option<&DrawDrag>,
    pointer: Option<Pos2>,
) {
    if state.view.tool != Tool::Draw || state.view.pointer != PointerActivity::Drawing {
        return;
    }
    let Some(pointer) = pointer else { return };
    ui.ctx().set_cursor_icon(egui::CursorIcon::Crosshair);
    let start = match drawn {
        Some(drag) => Some(drag.start),
        // On surfaces the pointer says enough: looking for them takes time.
        None if state.view.navigation.axis().is_none_or(|axis| axis == 1) => None,
        None => origin(state, projection, pointer, ui.input(|i| i.modifiers.command)).map(|(start, _)| start),
    };
    if let Some(at) = start.and_then(|start| projection.to_screen(start)) {
        painter.circle(at, 3.5, *theme::ACCENT, Stroke::new(1.5, theme::ON_PICTURE));
    }
    if let Some(drag) = drawn {
        tag(painter, pointer, drag.text.clone());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_wheel_changes_a_detail_within_its_limits() {
        let drag = |notches: f32| DrawDrag {
            kind: ShapeKind::Cylinder,
            plane: DrawPlane::Footprint { normal: DVec3::Y },
            start: DVec3::ZERO,
            notches,
            node: None,
            text: String::new(),
        };
        let cylinder = Shape::Cylinder { radius: 0.375, height: 0.13, rounding: 0.0 };
        let rounding = |shape: &Shape| match shape {
            Shape::Cylinder { rounding, .. } => *rounding,
            _ => panic!("a cylinder"),
        };
        assert_eq!(drag(0.0).with_detail(cylinder.clone(), 0.005), cylinder);
        assert!((rounding(&drag(10.0).with_detail(cylinder.clone(), 0.005)) - 0.05).abs() < 1e-9);
        assert_eq!(rounding(&drag(-3.0).with_detail(cylinder.clone(), 0.005)), 0.0);
        assert_eq!(rounding(&drag(500.0).with_detail(cylinder, 0.005)), 0.065, "half of the height");
        let prism = ShapeKind::Prism.default_shape();
        let Shape::Prism { sides, .. } = drag(-90.0).with_detail(prism, 0.1) else { panic!("a prism") };
        assert_eq!(sides.0, 3.0);
    }

    #[test]
    fn the_hint_names_the_detail() {
        assert_eq!(detail_name(ShapeKind::Cylinder), Some("Bevel"));
        assert_eq!(detail_name(ShapeKind::Sphere), None);
    }
}
