//! Views of a stress case: the whole node, or a view with difficult rays.

use glam::{DVec2, DVec3};

use super::node::StressPlacement;
use crate::field::eval::surface;
use crate::field::reference::trace::{TraceError, trace};
use crate::field::{FlatScene, view::THREE_QUARTER};
use crate::geometry::{Aabb, Camera};

/// The view of a stress case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum StressView {
    /// Shows the whole node.
    Whole,
    /// Looks along the surface, at an angle of about one degree.
    Grazing,
    /// From the middle of the bounds.
    Inside,
    /// Oblique, from a thousandth of a unit above the surface.
    Near,
    /// Shows the surroundings of this point of the node's own space, from the same distance as at the origin.
    At(DVec3),
}

/// Distance of `StressView::Near` from the surface, in meters.
const CLOSE: f64 = 1e-3;
/// Height of `StressView::Grazing` above the surface, as a fraction of the distance to its target.
const LOW: f64 = 0.02;

impl StressView {
    /// The camera of this view. `None` if the view needs a point of the surface and the center ray of the whole view
    /// misses it.
    ///
    /// # Errors
    /// A ray does not end.
    pub fn camera(self, flat: &FlatScene, place: StressPlacement, aspect: f64) -> Result<Option<Camera>, TraceError> {
        let endless = || flat.components.iter().any(|component| !component.bounds.is_finite());
        let around = |at| Aabb::from_center_half(at, DVec3::splat(place.scale));
        let content = match self {
            Self::At(local) => around(place.at + StressPlacement::turn() * local * place.scale),
            _ if endless() => around(place.at),
            _ => flat.content(&[]),
        };
        let mut whole = Camera::framing(&content, THREE_QUARTER, Camera::DEFAULT_FOV_Y, aspect);
        // The bounds of a rotated node are larger than the node.
        whole.fov_y *= 0.6;
        if matches!(self, Self::Whole | Self::At(_)) {
            return Ok(Some(whole));
        }
        let ray = whole.ray(DVec2::splat(0.5), DVec2::ONE);
        let Some(hit) = trace(flat, &ray, whole.near, whole.far)? else { return Ok(None) };
        let component = &flat.components[hit.component as usize];
        let point = ray.at(hit.t);
        let gradient = surface(flat, component, point - component.origin).gradient;
        let normal = gradient.try_normalize().unwrap_or(-ray.direction);
        let along = normal.any_orthonormal_vector();
        let size = content.half().length();
        let (eye, target) = match self {
            Self::Grazing => (point + (along + normal * LOW) * size, point),
            Self::Near => (point + normal * CLOSE, point + along * CLOSE),
            _ => (content.center(), point),
        };
        let mut camera = Camera::looking_at(eye, target, Camera::DEFAULT_FOV_Y);
        camera.near = 1e-3 * (target - eye).length().max(1e-6 * size);
        camera.far = 1e3 * size.max(CLOSE);
        Ok(Some(camera))
    }
}
