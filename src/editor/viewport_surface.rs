//! The surface under the pointer while the selection is moved onto it.

use egui::Pos2;
use glam::DVec3;

use super::bounds;
use super::picking::{PickedPoint, flat_without, pick_surface_in};
use super::projection::Projection;
use super::state::EditorState;
use super::transforms::onto_surface::SurfaceSnap;
use super::transforms::transform_drag::TransformDrag;
use isolith_field::FlatScene;

/// The ground counts within this many distances to the target.
const FARTHEST: f64 = 8.0;

/// The scene without what moves, flattened at the first look.
#[derive(Default)]
pub struct SurfaceUnderPointer {
    rest: Option<Option<FlatScene>>,
}

impl SurfaceUnderPointer {
    /// The point under the pointer with its normal, of a surface or of the ground; `None` if the move does not snap to
    /// surfaces, or if there is nothing.
    pub fn find(
        &mut self,
        state: &EditorState,
        projection: &Projection,
        pointer: Pos2,
        drag: &TransformDrag,
    ) -> Option<[DVec3; 2]> {
        if drag.surface == SurfaceSnap::Off {
            return None;
        }
        let ray = projection.ray(pointer);
        let rest = self.rest.get_or_insert_with(|| flat_without(state, &drag.ids())).as_ref();
        if let Some(PickedPoint { point, normal }) = rest.and_then(|rest| pick_surface_in(state, rest, &ray)) {
            return Some([point, normal]);
        }
        let t = -ray.origin.y / ray.direction.y;
        let reaches = t.is_finite() && t > 0.0 && t < FARTHEST * state.view.navigation.distance;
        reaches.then(|| [ray.at(t) * DVec3::new(1.0, 0.0, 1.0), DVec3::Y])
    }
}

/// The drag with what it needs to put the selection onto a surface.
pub fn with_bounds(state: &EditorState, drag: TransformDrag) -> TransformDrag {
    match bounds::of_nodes(state.session.document.scene(), state.derived.library(), &drag.ids()) {
        Some(bounds) => drag.standing_on(bounds),
        None => drag,
    }
}
