//! A transform in progress: the pointer's way, or what is typed, as a motion of the selection.

use egui::{Pos2, Vec2};
use glam::{DMat3, DQuat, DVec3};

use super::kinds::{Constraint, Orientation, PivotPoint, TransformKind};
use super::onto_surface::{Standing, SurfaceSnap};
use super::starts::{LastMotion, SelectionMotion, Starts, turn_of};
use super::typed::Typed;
use crate::edit_session::EditSession;
use crate::numbers::number_text;
use crate::projection::Projection;
use crate::steps::{finest_step, rounded};
use isolith_geometry::{Aabb, Ray};
use isolith_scene::NodeId;

/// The modifiers that change how a drag follows.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Following {
    /// A tenth as far.
    pub precise: bool,
    /// The step of lengths in meters; 0 for none, and then factors have none either.
    pub snap: f64,
    /// The step of angles in degrees; 0 for none.
    pub angle_snap: f64,
    /// The surface under the pointer, with its normal, while the move snaps to it.
    pub surface: Option<[DVec3; 2]>,
}

/// Factors while snapping.
const FACTOR_STEP: f64 = 0.1;
/// Factors by the pointer keep this magnitude.
const LEAST_FACTOR: f64 = 1e-3;
/// Angles by the pointer, in degrees, and factors are multiples of these.
const FINEST_ANGLE: f64 = 0.1;
const FINEST_FACTOR: f64 = 0.001;
/// Nearer to the pivot the pointer's direction and distance mean nothing, in points.
const NEAREST: f32 = 6.0;

/// A transform in progress.
pub struct TransformDrag {
    /// What is done.
    pub kind: TransformKind,
    /// What it is limited to.
    pub constraint: Constraint,
    /// Whose axes it follows.
    pub orientation: Orientation,
    /// What is typed.
    pub typed: Typed,
    /// Whether a move goes onto the surface under the pointer.
    pub surface: SurfaceSnap,
    standing: Standing,
    /// The axes now.
    axes: DMat3,
    /// The axes of every orientation at the start.
    bases: [DMat3; Orientation::ALL.len()],
    starts: Starts,
    from: Pos2,
    last: Pos2,
    way: Vec2,
    angle: f64,
    motion: SelectionMotion,
    finest: f64,
}

/// The axes of an orientation in the world, as columns.
pub fn axes_of(session: &EditSession, orientation: Orientation, view: DQuat) -> DMat3 {
    let scene = session.document.scene();
    let active = session.document.selection().last().copied().and_then(|id| scene.node(id));
    let of = |id| DMat3::from_quat(turn_of(&scene.world_from_local(id).matrix3));
    match orientation {
        Orientation::World => DMat3::IDENTITY,
        Orientation::View => DMat3::from_quat(view),
        Orientation::Local => active.map_or(DMat3::IDENTITY, |node| of(node.id)),
        Orientation::Parent => active.and_then(|node| node.parent).map_or(DMat3::IDENTITY, of),
    }
}

impl TransformDrag {
    /// Starts a transform of the selection at the pointer; `view` is the rotation of the camera. `None` if nothing can
    /// be transformed.
    pub fn begin(
        session: &EditSession,
        kind: TransformKind,
        (orientation, view, point): (Orientation, DQuat, PivotPoint),
        pointer: Pos2,
    ) -> Option<Self> {
        let starts = Starts::new(session, point)?;
        let up = axes_of(session, Orientation::Local, view).col(1);
        Some(Self {
            kind,
            constraint: Constraint::Free,
            orientation,
            typed: Typed::default(),
            surface: SurfaceSnap::Off,
            standing: Standing { up, ..Standing::default() },
            axes: axes_of(session, orientation, view),
            bases: Orientation::ALL.map(|orientation| axes_of(session, orientation, view)),
            starts,
            from: pointer,
            last: pointer,
            way: Vec2::ZERO,
            angle: 0.0,
            motion: SelectionMotion::Offset(DVec3::ZERO),
            finest: 1e-9,
        })
    }

    /// The same limited to an axis or a plane.
    pub fn limited(mut self, constraint: Constraint) -> Self {
        self.constraint = constraint;
        self
    }

    /// The same for nodes with these bounds in the world.
    pub fn standing_on(mut self, bounds: Aabb) -> Self {
        self.standing.bounds = bounds;
        self
    }

    /// The nodes that move.
    pub fn ids(&self) -> Vec<NodeId> {
        self.starts.ids()
    }

    /// What has been done, to be repeated; `None` if nothing.
    pub fn last_motion(&self) -> Option<LastMotion> {
        let (pivot, is_individual) = (self.starts.pivot, self.starts.is_individual);
        let moves = self.motion != SelectionMotion::Offset(DVec3::ZERO);
        moves.then_some(LastMotion { motion: self.motion, axes: self.axes, pivot, is_individual })
    }

    /// Follows other axes from now on: those that they were at the start.
    pub fn set_orientation(&mut self, orientation: Orientation) {
        self.orientation = orientation;
        if let Some(index) = Orientation::ALL.iter().position(|other| *other == orientation) {
            self.axes = self.bases[index];
        }
    }

    /// The pivot in the world.
    pub fn pivot(&self) -> DVec3 {
        self.starts.pivot
    }

    /// The direction of an axis in the world.
    pub fn axis(&self, axis: usize) -> DVec3 {
        self.axes.col(axis.min(2))
    }

    /// Follows the pointer, unless a number is typed.
    pub fn follow(&mut self, projection: &Projection, view: DQuat, pointer: Pos2, following: Following) {
        let pace = if following.precise { 0.1 } else { 1.0 };
        self.finest = finest_step(projection.meters_per_point(self.pivot()));
        if let Some(center) = projection.to_screen(self.pivot()) {
            let (a, b) = (self.last - center, pointer - center);
            if a.length() > NEAREST && b.length() > NEAREST {
                // Counterclockwise; the screen's y points down.
                let turned = f64::from(a.y * b.x - a.x * b.y).atan2(f64::from(a.dot(b)));
                self.angle += turned.to_degrees() * f64::from(pace);
            }
        }
        self.way += (pointer - self.last) * pace;
        self.last = pointer;
        let surface = following.surface.filter(|_| self.kind == TransformKind::Move);
        let motion = match (self.typed.is_empty(), surface) {
            (true, Some(on)) => self.standing.motion(self.pivot(), on, self.surface, self.finest),
            (true, None) => self.pointed(projection, view, following),
            (false, _) => self.as_typed(view),
        };
        self.motion = motion.unwrap_or(self.motion);
    }

    /// Moves the nodes.
    pub fn apply(&self, session: &mut EditSession, widget: egui::Id) {
        self.starts.apply(session, widget, self.motion, &self.axes, self.finest);
    }

    /// Number of numbers that can be typed.
    pub fn numbers(&self) -> usize {
        match (self.kind, self.constraint) {
            (TransformKind::Move, Constraint::Free) => 3,
            (TransformKind::Move, Constraint::Plane(_)) => 2,
            _ => 1,
        }
    }

    /// The axis of a rotation.
    fn turn_axis(&self, view: DQuat) -> DVec3 {
        match self.constraint {
            Constraint::Free => view * DVec3::Z,
            Constraint::Axis(axis) | Constraint::Plane(axis) => self.axis(axis),
        }
    }

    fn stretch(&self, factor: f64) -> SelectionMotion {
        SelectionMotion::Stretch(DVec3::from([0, 1, 2].map(|axis| match self.constraint {
            Constraint::Axis(only) if only != axis => 1.0,
            Constraint::Plane(not) if not == axis => 1.0,
            _ => factor,
        })))
    }

    fn as_typed(&self, view: DQuat) -> Option<SelectionMotion> {
        let value = |index| self.typed.value(index);
        Some(match self.kind {
            TransformKind::Move => SelectionMotion::Offset(match self.constraint {
                Constraint::Free => self.axes * DVec3::new(value(0)?, value(1)?, value(2)?),
                Constraint::Axis(axis) => self.axis(axis) * value(0)?,
                Constraint::Plane(axis) => {
                    let [a, b] = [[1, 2], [0, 2], [0, 1]][axis.min(2)];
                    self.axis(a) * value(0)? + self.axis(b) * value(1)?
                }
            }),
            TransformKind::Rotate => SelectionMotion::Turn(self.turn_axis(view), value(0)?),
            TransformKind::Scale => {
                self.stretch(value(0).filter(|factor| factor.abs() >= LEAST_FACTOR * LEAST_FACTOR)?)
            }
        })
    }

    fn pointed(&self, projection: &Projection, view: DQuat, following: Following) -> Option<SelectionMotion> {
        let Following { snap, angle_snap, .. } = following;
        let snaps = snap > 0.0;
        match self.kind {
            TransformKind::Move => {
                let offset = self.axes.transpose() * self.offset(projection, view)?;
                let place = self.axes.transpose() * self.pivot();
                let mut along = offset.to_array();
                for (axis, along) in along.iter_mut().enumerate() {
                    *along = match self.constraint {
                        Constraint::Axis(only) if only != axis => 0.0,
                        Constraint::Plane(not) if not == axis => 0.0,
                        // In the world the grid is fixed.
                        _ if snaps && self.orientation == Orientation::World => {
                            rounded(place[axis] + *along, snap) - place[axis]
                        }
                        _ => rounded(*along, if snaps { snap } else { self.finest }),
                    };
                }
                Some(SelectionMotion::Offset(self.axes * DVec3::from(along)))
            }
            TransformKind::Rotate => {
                let axis = self.turn_axis(view);
                let side = if axis.dot(view * DVec3::Z) < 0.0 { -1.0 } else { 1.0 };
                let angle = rounded(self.angle * side, if angle_snap > 0.0 { angle_snap } else { FINEST_ANGLE });
                Some(SelectionMotion::Turn(axis, angle))
            }
            TransformKind::Scale => {
                let center = projection.to_screen(self.pivot())?;
                let start = self.from - center;
                let start = if start.length() < 2.0 * NEAREST { Vec2::X * (8.0 * NEAREST) } else { start };
                let now = start + self.way;
                let ratio = f64::from(now.length() / start.length()).copysign(f64::from(now.dot(start)));
                let factor = rounded(ratio, if snaps { FACTOR_STEP } else { FINEST_FACTOR });
                let least = if snaps { FACTOR_STEP } else { LEAST_FACTOR };
                Some(self.stretch(factor.abs().max(least).copysign(ratio)))
            }
        }
    }

    /// The offset in the world that the way of the pointer stands for.
    fn offset(&self, projection: &Projection, view: DQuat) -> Option<DVec3> {
        let pivot = self.pivot();
        let ray = projection.ray(projection.to_screen(pivot)? + self.way);
        let up = f64::from(-self.way.y) * projection.meters_per_point(pivot);
        let offset = match self.constraint {
            Constraint::Free => in_plane(pivot, view * DVec3::NEG_Z, &ray)? - pivot,
            // What points at the eye follows the pointer up and down.
            Constraint::Axis(axis) => nearest_on_line(pivot, self.axis(axis), &ray)
                .map_or_else(|| self.axis(axis) * up, |point| point - pivot),
            Constraint::Plane(axis) => in_plane(pivot, self.axis(axis), &ray)? - pivot,
        };
        offset.is_finite().then_some(offset)
    }

    /// What is done, by how much, for the tag beside the pointer.
    pub fn text(&self) -> String {
        let letters = self.constraint.letters();
        let space = |text: &str| if text.is_empty() { String::new() } else { format!(" {text}") };
        let name = format!("{}{}", self.kind.label(), space(letters));
        if let Some(text) = self.surface.text().filter(|_| self.kind == TransformKind::Move && self.typed.is_empty()) {
            return format!("{name}  {text}");
        }
        let amount = match self.motion {
            _ if !self.typed.is_empty() => self.typed.shown(self.numbers()),
            SelectionMotion::Offset(offset) | SelectionMotion::Onto(_, offset) => {
                let along =
                    (self.axes.transpose() * offset).to_array().map(|v| number_text(rounded(v, self.finest * 0.1)));
                match self.constraint {
                    Constraint::Axis(axis) => format!("{} m", along[axis.min(2)]),
                    _ => format!("{} m", along.join(", ")),
                }
            }
            SelectionMotion::Turn(_, degrees) => format!("{}°", number_text(degrees)),
            SelectionMotion::Stretch(factors) => {
                let shown = match self.constraint {
                    Constraint::Axis(axis) => factors[axis.min(2)],
                    Constraint::Plane(axis) => factors[(axis + 1) % 3],
                    Constraint::Free => factors.x,
                };
                format!("× {}", number_text(shown))
            }
        };
        let is_free = self.constraint == Constraint::Free && self.typed.is_empty();
        let axes = match self.orientation {
            Orientation::World => String::new(),
            _ if is_free => String::new(),
            other => format!("  ({})", other.label().to_lowercase()),
        };
        format!("{name}  {amount}{axes}")
    }
}

/// The point of a plane under the ray; `None` if the plane is seen nearly from its edge.
fn in_plane(through: DVec3, normal: DVec3, ray: &Ray) -> Option<DVec3> {
    const FLATTEST: f64 = 0.01;
    let slope = ray.direction.dot(normal);
    let t = (through - ray.origin).dot(normal) / slope;
    (slope.abs() > FLATTEST && t.is_finite() && t > 0.0).then(|| ray.at(t))
}

/// The point of the line through `origin` along the unit vector `axis` that is nearest to the ray; `None` if they are
/// nearly parallel.
fn nearest_on_line(origin: DVec3, axis: DVec3, ray: &Ray) -> Option<DVec3> {
    const NARROWEST: f64 = 1e-4;
    let between = origin - ray.origin;
    let cosine = axis.dot(ray.direction);
    let determinant = 1.0 - cosine * cosine;
    if determinant < NARROWEST {
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
        let point = in_plane(DVec3::ZERO, DVec3::NEG_Z, &ray).unwrap();
        assert!(point.z.abs() < 1e-12);
        let back = camera.project(point, size).unwrap().0;
        assert!((back - DVec2::new(100.0, 100.0)).length() < 1e-9);
        assert_eq!(in_plane(DVec3::ZERO, DVec3::Y, &Ray { origin: DVec3::Z, direction: DVec3::NEG_Z }), None);
    }

    #[test]
    fn a_line_toward_the_eye_cannot_be_dragged() {
        let ray = Ray { origin: DVec3::Z * 5.0, direction: DVec3::NEG_Z };
        assert_eq!(nearest_on_line(DVec3::ZERO, DVec3::Z, &ray), None);
    }
}
