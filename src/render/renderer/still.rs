//! Whole pictures in one call: stills.

use std::sync::Arc;
use std::time::Duration;

use super::{RenderError, Renderer, Slot};
use crate::gpu::readback::read_color;
use crate::passes::overlay_settings::OverlaySettings;
use isolith_field::debug_view::{DepthRange, ViewMode};
use isolith_field::{FlatScene, GBuffer, Warning};
use isolith_geometry::Camera;
use isolith_mesh::TriangleMesh;

/// How the light of an accumulated still is gathered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Film {
    /// Number of samples, at least 1.
    pub samples: u32,
    /// Whether the background is left out; alpha is coverage then.
    pub is_transparent: bool,
}

impl Renderer {
    /// Renders a whole scene, one sample at the center of each pixel. Between dispatches it calls `progress` with the
    /// fraction that is done; `progress` returns whether to continue.
    pub fn render(
        &mut self,
        flat: &FlatScene,
        meshes: &[Option<Arc<TriangleMesh>>],
        camera: &Camera,
        size: [u32; 2],
        progress: &mut dyn FnMut(f32) -> bool,
    ) -> Result<(GBuffer, Vec<Warning>), RenderError> {
        self.render_as(ViewMode::Shaded, flat, meshes, camera, size, progress)
    }

    /// Renders with another view mode. View modes that show counts need a renderer that counts.
    pub fn render_as(
        &mut self,
        view_mode: ViewMode,
        flat: &FlatScene,
        meshes: &[Option<Arc<TriangleMesh>>],
        camera: &Camera,
        size: [u32; 2],
        progress: &mut dyn FnMut(f32) -> bool,
    ) -> Result<(GBuffer, Vec<Warning>), RenderError> {
        let mut frame = self.begin(Slot::Full, flat, meshes, camera, size, OverlaySettings::default())?;
        self.debug_view(&mut frame, view_mode, flat, &DepthRange::of(&flat.content(meshes), camera.position))?;
        while !frame.is_done() {
            if !progress(frame.progress()) {
                return Err(RenderError::Canceled);
            }
            self.advance(&mut frame, Duration::ZERO)?;
        }
        progress(1.0);
        Ok((self.read(&frame)?, self.unfinished_rays(&frame)?))
    }

    /// Renders a whole scene by the mean of several samples, with its linear light. Depth, normals and leaves are those
    /// of a single sample, as of [`Renderer::render`]; so are the warnings.
    pub fn render_samples(
        &mut self,
        film: Film,
        flat: &FlatScene,
        meshes: &[Option<Arc<TriangleMesh>>],
        camera: &Camera,
        size: [u32; 2],
        progress: &mut dyn FnMut(f32) -> bool,
    ) -> Result<(GBuffer, Vec<Warning>), RenderError> {
        let mut frame = self.begin(Slot::Full, flat, meshes, camera, size, OverlaySettings::default())?;
        self.accumulate(&mut frame, film.is_transparent);
        let samples = film.samples.max(1);
        let mut first = None;
        loop {
            while !frame.is_done() {
                let done = frame.samples() as f32 + frame.progress();
                if !progress(done / samples as f32) {
                    return Err(RenderError::Canceled);
                }
                self.advance(&mut frame, Duration::ZERO)?;
            }
            if first.is_none() {
                first = Some((self.read(&frame)?, self.unfinished_rays(&frame)?));
            }
            if frame.samples() >= samples {
                break;
            }
            self.next_sample(&mut frame)?;
        }
        let (buffers, warnings) = first.expect("there is a first sample");
        let radiance = self.read_radiance(&frame)?;
        let color = read_color(&self.gpu, &self.resources.slot(frame.slot).targets.color)?;
        progress(1.0);
        Ok((GBuffer { color, radiance, ..buffers }, warnings))
    }
}
