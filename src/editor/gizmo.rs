//! The handles that move the selection: three arrows along the world's axes and a dot for the plane
//! that faces the eye. The mathematics is pure; the handles are painted over the picture.

use egui::{Painter, Pos2, Shape, Stroke, vec2};
use glam::{DAffine3, DMat3, DVec3};

use super::edit_session::EditSession;
use super::projection::Projection;
use super::{selection, theme};
use isolith_geometry::Ray;
use isolith_scene::NodeId;

/// A handle of the gizmo.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Handle {
    /// Along a world axis.
    Axis(usize),
    /// In the plane that faces the eye.
    Plane,
}

/// Length of the arrows and pick radius, in points.
const LENGTH: f32 = 78.0;
const GRAB: f32 = 8.0;
/// A shorter arrow points at the eye and cannot be dragged.
const SHORTEST: f32 = 14.0;

/// The mean of the selected nodes' origins in the world; `None` if no node can move.
pub fn pivot(session: &EditSession) -> Option<DVec3> {
    let scene = session.document.scene();
    let ids: Vec<_> =
        selection::roots(session).into_iter().filter(|id| selection::holder_of_lock(scene, *id).is_none()).collect();
    if ids.is_empty() {
        return None;
    }
    let sum: DVec3 = ids.iter().map(|id| scene.world_from_local(*id).translation).sum();
    Some(sum / ids.len() as f64)
}

/// Positions of the handles on the screen, in points.
pub struct Arrows {
    center: Pos2,
    tips: [Option<Pos2>; 3],
}

impl Arrows {
    /// The handles at a pivot; `None` if the pivot is behind the eye.
    pub fn new(pivot: DVec3, projection: &Projection) -> Option<Self> {
        let center = projection.to_screen(pivot)?;
        let length = projection.meters_per_point(pivot) * f64::from(LENGTH);
        let tips = std::array::from_fn(|axis| {
            let tip = projection.to_screen(pivot + DVec3::AXES[axis] * length)?;
            (tip.distance(center) >= SHORTEST).then_some(tip)
        });
        Some(Self { center, tips })
    }

    /// The position of the pivot, in points.
    pub fn center(&self) -> Pos2 {
        self.center
    }

    /// The handle under the pointer.
    pub fn handle_at(&self, pointer: Pos2) -> Option<Handle> {
        if pointer.distance(self.center) < GRAB {
            return Some(Handle::Plane);
        }
        let reach = |axis: usize| self.tips[axis].map(|tip| (axis, segment_distance(pointer, self.center, tip)));
        let nearest = (0..3).filter_map(reach).min_by(|a, b| a.1.total_cmp(&b.1));
        nearest.filter(|(_, distance)| *distance < GRAB).map(|(axis, _)| Handle::Axis(axis))
    }

    /// Paints the handles; the hovered or dragged one is brighter.
    pub fn paint(&self, painter: &Painter, lit: Option<Handle>) {
        for axis in 0..3 {
            let Some(tip) = self.tips[axis] else { continue };
            let on = lit == Some(Handle::Axis(axis));
            let color = if on { egui::Color32::WHITE } else { theme::AXES[axis] };
            let direction = (tip - self.center).normalized();
            let (start, neck) = (self.center + direction * 9.0, tip - direction * 11.0);
            let side = vec2(-direction.y, direction.x) * 4.5;
            painter.line_segment([start, neck], Stroke::new(4.5, egui::Color32::from_black_alpha(90)));
            painter.line_segment([start, neck], Stroke::new(2.25, color));
            painter.add(Shape::convex_polygon(vec![tip, neck + side, neck - side], color, Stroke::NONE));
        }
        let color = if lit == Some(Handle::Plane) { egui::Color32::WHITE } else { theme::TEXT };
        painter.circle(self.center, 4.5, color, Stroke::new(1.5, egui::Color32::from_black_alpha(130)));
    }
}

fn segment_distance(p: Pos2, a: Pos2, b: Pos2) -> f32 {
    let along = ((p - a).dot(b - a) / (b - a).length_sq().max(1e-6)).clamp(0.0, 1.0);
    p.distance(a + (b - a) * along)
}

/// A drag in progress.
pub struct Drag {
    /// The dragged handle.
    pub handle: Handle,
    /// Offset so far, in world space.
    pub offset: DVec3,
    pivot: DVec3,
    grabbed: DVec3,
    nodes: Vec<Start>,
}

/// A node's placement at the start of the drag.
struct Start {
    id: NodeId,
    translation: DVec3,
    parent_from_world: DMat3,
}

impl Drag {
    /// Starts a drag with the ray of the pointer; `forward` is the view direction.
    pub fn begin(session: &EditSession, handle: Handle, ray: &Ray, forward: DVec3) -> Option<Self> {
        let pivot = pivot(session)?;
        let scene = session.document.scene();
        let is_free = |id: &NodeId| selection::holder_of_lock(scene, *id).is_none();
        let nodes = selection::roots(session).into_iter().filter(is_free).filter_map(|id| scene.node(id));
        let nodes = nodes
            .map(|n| Start {
                id: n.id,
                translation: n.transform.translation,
                parent_from_world: n.parent.map_or(DAffine3::IDENTITY, |p| scene.world_from_local(p)).matrix3.inverse(),
            })
            .collect();
        let grabbed = grabbed_point(handle, pivot, ray, forward)?;
        Some(Self { handle, offset: DVec3::ZERO, pivot, grabbed, nodes })
    }

    /// Follows the pointer. `precise` moves a tenth as far; `snap` is a step in meters, 0 for none.
    pub fn follow(&mut self, ray: &Ray, forward: DVec3, precise: bool, snap: f64) {
        let Some(point) = grabbed_point(self.handle, self.pivot, ray, forward) else { return };
        let mut offset = (point - self.grabbed) * if precise { 0.1 } else { 1.0 };
        if snap > 0.0 {
            offset = (offset / snap).round() * snap;
        }
        if offset.is_finite() {
            self.offset = offset;
        }
    }

    /// Moves the nodes by the offset of the drag.
    pub fn apply(&self, session: &mut EditSession, widget: egui::Id) {
        for start in &self.nodes {
            let moved = start.translation + start.parent_from_world * self.offset;
            if moved.is_finite() {
                session.change(widget, &[start.id], |n| n.transform.translation = tidy(moved));
            }
        }
    }
}

/// Rounds to a hundred-thousandth of a meter, for tidy numbers in the inspector and the file.
fn tidy(v: DVec3) -> DVec3 {
    (v * 1e5).round() / 1e5
}

/// The point on the axis or plane of the handle under the ray.
fn grabbed_point(handle: Handle, pivot: DVec3, ray: &Ray, forward: DVec3) -> Option<DVec3> {
    match handle {
        Handle::Axis(axis) => nearest_on_line(pivot, DVec3::AXES[axis], ray),
        Handle::Plane => {
            let t = (pivot - ray.origin).dot(forward) / ray.direction.dot(forward);
            (t.is_finite() && t > 0.0).then(|| ray.at(t))
        }
    }
}

/// The point of the line through `origin` along the unit vector `axis` that is nearest to the ray;
/// `None` if they are parallel.
fn nearest_on_line(origin: DVec3, axis: DVec3, ray: &Ray) -> Option<DVec3> {
    let between = origin - ray.origin;
    let cosine = axis.dot(ray.direction);
    let determinant = 1.0 - cosine * cosine;
    if determinant < 1e-9 {
        return None;
    }
    let along = (cosine * between.dot(ray.direction) - between.dot(axis)) / determinant;
    Some(origin + axis * along)
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use isolith_geometry::Camera;

    #[test]
    fn an_axis_follows_the_pointer_exactly() {
        let camera = Camera::looking_at(DVec3::new(4.0, 3.0, 5.0), DVec3::ZERO, 0.8);
        let size = DVec2::new(600.0, 400.0);
        let pivot = DVec3::new(0.3, -0.2, 0.5);
        for axis in 0..3 {
            let wanted = pivot + DVec3::AXES[axis] * 0.7;
            let (pixel, _) = camera.project(wanted, size).unwrap();
            let point = nearest_on_line(pivot, DVec3::AXES[axis], &camera.ray(pixel, size)).unwrap();
            assert!((point - wanted).length() < 1e-9, "{axis}: {point}");
        }
    }

    #[test]
    fn the_plane_faces_the_eye() {
        let camera = Camera::looking_at(DVec3::new(0.0, 0.0, 5.0), DVec3::ZERO, 0.8);
        let size = DVec2::new(600.0, 400.0);
        let ray = camera.ray(DVec2::new(100.0, 100.0), size);
        let point = grabbed_point(Handle::Plane, DVec3::ZERO, &ray, DVec3::NEG_Z).unwrap();
        assert!(point.z.abs() < 1e-12);
        let back = camera.project(point, size).unwrap().0;
        assert!((back - DVec2::new(100.0, 100.0)).length() < 1e-9);
    }

    #[test]
    fn a_line_toward_the_eye_cannot_be_dragged() {
        let ray = Ray { origin: DVec3::Z * 5.0, direction: DVec3::NEG_Z };
        assert_eq!(nearest_on_line(DVec3::ZERO, DVec3::Z, &ray), None);
    }
}
