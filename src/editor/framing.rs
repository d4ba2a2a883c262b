//! What the view looks at: framing, cameras of the scene, a document's first view.

use glam::DVec3;

use super::{Editor, bounds};
use crate::flat::debug_view::DepthRange;

impl Editor {
    /// Shows all of the selection.
    pub(super) fn frame_selected(&mut self) {
        let selection = self.session.document.selection().to_vec();
        if let Some(bounds) = bounds::of_nodes(self.session.document.scene(), &mut self.meshes, &selection) {
            self.navigation.frame(&bounds, self.aspect());
        }
    }

    /// Shows the whole scene.
    pub(super) fn frame_all(&mut self) {
        if let Some(bounds) = bounds::of_scene(self.session.document.scene(), &mut self.meshes) {
            self.navigation.frame(&bounds, self.aspect());
        }
    }

    /// Takes over the view of the selected camera, or of the one after the one looked through now.
    pub(super) fn look_through_camera(&mut self) {
        let cameras = &self.flat.scene.cameras;
        let eye = self.navigation.eye();
        let selected = self.session.document.selection().last();
        let here = cameras.iter().position(|c| c.camera.position.distance(eye) < 1e-9 * (1.0 + eye.length()));
        let wanted = cameras.iter().find(|c| Some(&c.id) == selected && here.is_none());
        let next = here.map_or(0, |i| (i + 1) % cameras.len().max(1));
        if let Some(camera) = wanted.or_else(|| cameras.get(next)) {
            let camera = camera.camera;
            let focus = self.focus();
            self.navigation.look_through(&camera, focus);
        }
    }

    /// The first view of a document: through its first camera, or all of it.
    pub(super) fn show_as_saved(&mut self) {
        self.navigation = super::Navigation::default();
        if self.flat.scene.cameras.is_empty() {
            self.frame_all();
        } else {
            self.look_through_camera();
        }
    }

    /// The distances at which the scene stands, in front of the eye.
    pub(super) fn depth_range(&mut self) -> DepthRange {
        let (meshes, _) = self.flat.scene.load_meshes(&mut self.meshes);
        DepthRange::of(&self.flat.scene.content(&meshes), self.navigation.eye())
    }

    /// The middle of the scene.
    fn focus(&mut self) -> DVec3 {
        bounds::of_scene(self.session.document.scene(), &mut self.meshes).map_or(DVec3::ZERO, |b| b.center())
    }

    fn aspect(&self) -> f64 {
        let [width, height] = self.viewport.size_px();
        f64::from(width) / f64::from(height)
    }
}
