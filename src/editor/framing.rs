//! Moves the view: framing, cameras of the scene, the first view of a document.

use glam::DVec3;

use super::navigation::Navigation;
use super::state::EditorState;
use super::{bounds, camera_view};
use isolith_field::debug_view::DepthRange;

impl EditorState {
    /// Frames the selection.
    pub(super) fn frame_selected(&mut self) {
        let selection = self.session.document.selection().to_vec();
        if let Some(bounds) = bounds::of_nodes(self.session.document.scene(), self.derived.library(), &selection) {
            self.view.navigation.frame(&bounds, self.view.aspect());
        }
    }

    /// Frames the whole scene.
    pub(super) fn frame_all(&mut self) {
        if let Some(bounds) = bounds::of_scene(self.session.document.scene(), self.derived.library()) {
            self.view.navigation.frame(&bounds, self.view.aspect());
        }
    }

    /// Takes over the view of the selected camera, or of the one after the current camera.
    pub(super) fn look_through_camera(&mut self) {
        let cameras = &self.derived.flat().cameras;
        let eye = self.view.navigation.eye();
        let selected = self.session.document.selection().last();
        let here = cameras.iter().position(|c| c.camera.position.distance(eye) < 1e-9 * (1.0 + eye.length()));
        let wanted = cameras.iter().find(|c| Some(&c.id) == selected && here.is_none());
        let next = here.map_or(0, |i| (i + 1) % cameras.len().max(1));
        if let Some(id) = wanted.or_else(|| cameras.get(next)).map(|camera| camera.id) {
            let focus = self.focus();
            camera_view::look_through(self, id, focus);
        }
    }

    /// Sets the first view of a document: its first camera, or the whole scene.
    pub(super) fn show_as_saved(&mut self) {
        self.view.navigation = Navigation::default();
        self.view.through = None;
        if self.derived.flat().cameras.is_empty() {
            self.frame_all();
        } else if let Some(camera) = self.derived.flat().cameras.first().map(|camera| camera.camera) {
            let focus = self.focus();
            self.view.navigation.look_through(&camera, focus);
        }
    }

    /// The range of distances from the eye that the scene occupies.
    pub(super) fn depth_range(&self) -> DepthRange {
        let meshes = self.derived.flat().known_meshes(self.derived.library());
        DepthRange::of(&self.derived.flat().content(&meshes), self.view.navigation.eye())
    }

    /// The center of the scene.
    fn focus(&self) -> DVec3 {
        bounds::of_scene(self.session.document.scene(), self.derived.library()).map_or(DVec3::ZERO, |b| b.center())
    }
}
