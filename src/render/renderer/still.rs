//! Whole pictures in one call: stills.

use std::sync::Arc;
use std::time::Duration;

use super::frame::Sampling;
use super::{Frame, RenderError, Renderer, Slot};
use crate::gpu::readback::{read_color, read_mesh_colors};
use crate::passes::overlay_settings::OverlaySettings;
use isolith_field::debug_view::{DepthRange, ViewMode};
use isolith_field::{FlatScene, GBuffer, HitTarget, Warning};
use isolith_geometry::{Camera, Lens};
use isolith_mesh::TriangleMesh;

/// How the light of an accumulated still is gathered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Film {
    /// Number of samples, at least 1.
    pub samples: u32,
    /// Whether the background is left out; alpha is coverage then.
    pub is_transparent: bool,
    /// The camera's lens.
    pub lens: Lens,
}

/// What a sample of a still shows: the scene at a moment.
#[derive(Clone, Copy, Debug)]
pub struct SampleMoment<'a> {
    /// The scene.
    pub flat: &'a FlatScene,
    /// Its meshes, parallel to those of the scene.
    pub meshes: &'a [Option<Arc<TriangleMesh>>],
    /// The camera.
    pub camera: &'a Camera,
}

/// Follows a still while it is rendered.
pub trait StillWatch {
    /// Called between dispatches with the fraction that is done; returns whether to continue.
    fn progress(&mut self, share: f32) -> bool;

    /// Whether to read back the mean of the samples so far, which takes a little time.
    fn wants_picture(&mut self) -> bool {
        false
    }

    /// Receives that mean, as sRGB and alpha, and its number of samples.
    fn picture(&mut self, _color: &[[u8; 4]], _samples: u32) {}
}

/// A watch that only counts.
struct ProgressOnly<'a>(&'a mut dyn FnMut(f32) -> bool);

impl StillWatch for ProgressOnly<'_> {
    fn progress(&mut self, share: f32) -> bool {
        self.0(share)
    }
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
        self.render_samples_for(film, flat, meshes, camera, size, &mut ProgressOnly(progress))
    }

    /// [`Renderer::render_samples`] for a watch that may also look at the picture while it refines.
    pub fn render_samples_for(
        &mut self,
        film: Film,
        flat: &FlatScene,
        meshes: &[Option<Arc<TriangleMesh>>],
        camera: &Camera,
        size: [u32; 2],
        watch: &mut dyn StillWatch,
    ) -> Result<(GBuffer, Vec<Warning>), RenderError> {
        self.render_moments_for(film, &[SampleMoment { flat, meshes, camera }], size, watch)
    }

    /// [`Renderer::render_samples_for`] of a scene that moves while the shutter is open: the first sample shows the first
    /// moment, the others take turns.
    ///
    /// # Panics
    /// There is no moment.
    pub fn render_moments_for(
        &mut self,
        film: Film,
        moments: &[SampleMoment<'_>],
        size: [u32; 2],
        watch: &mut dyn StillWatch,
    ) -> Result<(GBuffer, Vec<Warning>), RenderError> {
        let SampleMoment { flat, meshes, camera } = moments[0];
        let mut frame = self.begin(Slot::Full, flat, meshes, camera, size, OverlaySettings::default())?;
        self.accumulate(&mut frame, film.is_transparent);
        let samples = film.samples.max(1);
        let mut first = None;
        loop {
            while !frame.is_done() {
                let done = frame.samples() as f32 + frame.progress();
                if !watch.progress(done / samples as f32) {
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
            if watch.wants_picture() {
                watch.picture(&self.read_color_of(&frame)?, frame.samples());
            }
            if film.lens.is_open() || moments.len() > 1 {
                let (index, is_transparent) = (frame.samples(), film.is_transparent);
                let SampleMoment { flat, meshes, camera } = moments[index as usize % moments.len()];
                let view = film.lens.view(camera, size[1], index, samples);
                frame = self.begin_at(Slot::Full, flat, meshes, &view, size, OverlaySettings::default())?;
                self.set_sample(&mut frame, Sampling { index, is_transparent }, view.offset);
            } else {
                self.next_sample(&mut frame)?;
            }
        }
        let (buffers, warnings) = first.expect("there is a first sample");
        let radiance = self.read_radiance(&frame)?;
        let color = self.read_color_of(&frame)?;
        watch.progress(1.0);
        Ok((GBuffer { color, radiance, ..buffers }, warnings))
    }

    fn read_color_of(&self, frame: &Frame) -> Result<Vec<[u8; 4]>, RenderError> {
        Ok(read_color(&self.gpu, &self.resources.slot(frame.slot).targets.color)?)
    }

    /// The linear base color at the center of each pixel, black without a hit, with depths, normals and leaves: those of
    /// the first surfaces that have any opacity. `flat` is the scene as of [`FlatScene::in_base_colors`].
    pub fn render_base_colors(
        &mut self,
        flat: &FlatScene,
        meshes: &[Option<Arc<TriangleMesh>>],
        camera: &Camera,
        size: [u32; 2],
        progress: &mut dyn FnMut(f32) -> bool,
    ) -> Result<(Vec<[f32; 3]>, GBuffer), RenderError> {
        let mut frame = self.begin(Slot::Full, flat, meshes, camera, size, OverlaySettings::default())?;
        self.resources.show_first_surfaces(&self.gpu);
        self.accumulate(&mut frame, true);
        while !frame.is_done() {
            if !progress(frame.progress()) {
                return Err(RenderError::Canceled);
            }
            self.advance(&mut frame, Duration::ZERO)?;
        }
        let mut colors: Vec<_> = self.read_radiance(&frame)?.iter().map(|[r, g, b, _]| [*r, *g, *b]).collect();
        // The light that a mesh reflects depends on its own material, so its color is read where it is stored.
        let buffers = self.read(&frame)?;
        let of_meshes = read_mesh_colors(&self.gpu, &self.resources.slot(frame.slot).targets)?;
        for (pixel, color) in colors.iter_mut().enumerate() {
            if matches!(buffers.hit_target(pixel), HitTarget::Mesh(_)) {
                *color = of_meshes[pixel];
            }
        }
        Ok((colors, buffers))
    }
}
