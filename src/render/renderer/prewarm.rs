//! What makes pictures of something that moves quick: pipelines that are met before a frame needs them, and light for
//! some pixels only.

use std::time::{Duration, Instant};

use super::recorder::meet;
use super::shadows::ShadowWork;
use super::{RenderError, Renderer};
use isolith_field::FlatScene;
use isolith_geometry::Camera;

impl Renderer {
    /// Sets whether shadows of frames are computed for every second pixel along each axis and occlusion for every fourth, and
    /// taken from these between: for pictures of something that moves. Samples of a picture have them for all.
    pub fn set_sparse_light(&mut self, is_on: bool) {
        self.sparse_light = is_on;
    }

    /// Sets whether frames are drawn without shadows and occlusion until their pipelines are built beside: so that no frame
    /// waits for them.
    pub fn set_late_shadows(&mut self, is_on: bool) {
        self.late_shadows = is_on;
    }

    /// Whether the pipelines of shadows are there, or frames are to wait for them.
    pub(super) fn shadows_are_ready(&mut self, flat: &FlatScene, work: &ShadowWork) -> bool {
        let (kind, used) = work.pipelines(flat, !flat.meshes.is_empty());
        !self.late_shadows || self.passes.shadow.is_ready(&self.gpu, &kind, used, self.pipelines.options())
    }

    /// Takes pipelines of shadows that have become ready. Returns whether pictures are to be drawn again.
    pub fn collect_shadows(&mut self) -> bool {
        self.passes.shadow.collect()
    }

    /// Whether pipelines of shadows are being built, and pictures lack them.
    pub fn awaits_shadows(&self) -> bool {
        self.passes.shadow.is_building()
    }

    /// Prewarms pipelines that have become ready, for about this time: lavapipe compiles a pipeline, or loads the
    /// compiled code, at its first dispatch, which would delay the next picture. Returns whether there are more.
    pub fn prewarm_pipelines(
        &mut self,
        flat: &FlatScene,
        camera: &Camera,
        time: Duration,
    ) -> Result<bool, RenderError> {
        if !self.gpu.is_software() {
            return Ok(false);
        }
        let (start, mut has_prewarmed) = (Instant::now(), false);
        let choices = self.choose(flat, camera)?.choices;
        let Some(groups) = self.resources.any_groups() else { return Ok(false) };
        for choice in choices {
            if has_prewarmed && start.elapsed() > time {
                return Ok(true);
            }
            if meet(&self.gpu, groups, &choice.pipelines) {
                has_prewarmed = true;
                self.gpu.wait()?;
            }
        }
        Ok(false)
    }
}
