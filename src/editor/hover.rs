//! The node under the pointer, marked before a click selects it.

use std::time::{Duration, Instant};

use egui::{Color32, Painter, Pos2, Stroke};

use super::bounds;
use super::choice_walk::representative;
use super::overlay::paint_box;
use super::projection::Projection;
use super::state::EditorState;
use super::viewport_click::hit_at;
use isolith_geometry::Camera;
use isolith_scene::NodeId;

/// The share of the time that looking for the node may take.
const SHARE: u32 = 8;

/// What was found under the pointer, and for which picture.
#[derive(Default)]
pub struct Hover {
    looked: Option<(Pos2, Camera, u64)>,
    node: Option<NodeId>,
    /// Where looking is slow, it waits.
    rests: Option<(Instant, Duration)>,
}

impl Hover {
    /// Looks under the pointer, unless nothing has moved since or looking takes too much of the time.
    pub fn look(&mut self, state: &EditorState, projection: &Projection, pointer: Option<Pos2>) {
        let Some(at) = pointer else {
            *self = Self { rests: self.rests, ..Self::default() };
            return;
        };
        let now = (at, state.view.navigation.camera(), state.session.document.revision());
        let is_resting = self.rests.is_some_and(|(since, length)| since.elapsed() < length);
        if self.looked == Some(now) || is_resting {
            return;
        }
        let start = Instant::now();
        let scene = state.session.document.scene();
        self.node = hit_at(state, projection, at).map(|id| representative(scene, state.view.entered, id));
        self.looked = Some(now);
        self.rests = Some((Instant::now(), start.elapsed() * SHARE));
    }

    /// Paints the corners of its box, unless it is selected.
    pub fn paint(&self, state: &EditorState, painter: &Painter, projection: &Projection) {
        let Some(id) = self.node.filter(|id| !state.session.document.selection().contains(id)) else { return };
        let scene = state.session.document.scene();
        let Some((world_from_local, bounds)) = bounds::oriented(scene, state.derived.library(), id) else { return };
        let corners = bounds.corners().map(|c| projection.to_screen(world_from_local.transform_point3(c)));
        // A dark line below a light one is seen on every color.
        paint_box(painter, &corners, Stroke::new(3.0, Color32::from_black_alpha(90)));
        paint_box(painter, &corners, Stroke::new(1.25, Color32::from_white_alpha(190)));
    }
}
