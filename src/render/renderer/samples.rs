//! Accumulation: further samples of a frame at other places within each pixel, whose mean is the picture.
//!
//! The first sample goes through the pixels' centers. Later ones trace the whole picture again with the same plan; each
//! uploads the view, and resets the lists that the passes fill.

use std::time::Duration;

use glam::DVec2;

use super::frame::{Frame, Sampling};
use super::going_on::GoingOn;
use super::{RenderError, Renderer};
use crate::gpu::Gpu;
use crate::gpu::readback::read_radiance;
use isolith_geometry::pixel_jitter;

impl Renderer {
    /// Makes the frame the first sample of an accumulated picture. If it is complete already, only its light is
    /// computed again.
    pub fn accumulate(&mut self, frame: &mut Frame, is_transparent: bool) {
        self.resources.keep_accumulation(&self.gpu.device, frame.slot);
        if frame.is_done() {
            frame.skip_to_shading();
        }
        self.set_sample(frame, Sampling { index: 0, is_transparent }, DVec2::ZERO);
    }

    /// Begins the next sample of a frame whose sample is complete.
    ///
    /// # Panics
    /// The frame does not accumulate.
    pub fn next_sample(&mut self, frame: &mut Frame) -> Result<(), RenderError> {
        let sampling = frame.sampling.expect("a frame that accumulates");
        self.gpu.check()?;
        if sampling.index == 0 {
            let Gpu { device, queue, .. } = &self.gpu;
            let descriptor = wgpu::CommandEncoderDescriptor { label: Some("keep the first sample") };
            let mut encoder = device.create_command_encoder(&descriptor);
            let slot = self.resources.slot(frame.slot);
            slot.accumulation.as_ref().expect("accumulate makes it").keep(&mut encoder, &slot.targets);
            queue.submit([encoder.finish()]);
        }
        let index = sampling.index + 1;
        self.set_sample(frame, Sampling { index, ..sampling }, pixel_jitter(index));
        // Pipelines may have become ready since the last sample.
        self.pipelines.refresh(&frame.keys, &mut frame.choices);
        if let Some(planned) = frame.going_on.planned {
            frame.plan.dispatches.truncate(planned);
            self.resources.set_work(&self.gpu, &frame.plan.dispatches);
        }
        let components = frame.origins.len();
        let size = self.resources.slot(frame.slot).targets.size;
        if self.resources.reset_lists(&self.gpu, &frame.plan, components, size) {
            self.resources.forget_groups();
            let device = &self.gpu.device;
            self.resources.bind(device, frame.slot, &self.scene, |bound| self.passes.bind(device, bound));
        }
        (frame.next, frame.seconds_done, frame.measured) = (0, 0.0, Some(Duration::ZERO));
        frame.going_on = GoingOn::default();
        self.timings.begin();
        Ok(())
    }

    /// Makes a frame that has just begun show the samples that `shown` has accumulated of the same picture, under the
    /// marks of its own. The frame traces nothing, and may go on with the next sample.
    pub fn resume_samples(&mut self, frame: &mut Frame, shown: &Frame) {
        match (shown.sampling, shown.samples()) {
            (Some(sampling), complete @ 1..) => {
                (frame.next, frame.measured) = (frame.plan.dispatches.len(), None);
                // Nothing is traced, so the offset does not matter.
                self.set_sample(frame, Sampling { index: complete - 1, ..sampling }, DVec2::ZERO);
            }
            _ => frame.skip_to_shading(),
        }
    }

    /// Mean of the accumulated samples: linear light, multiplied by coverage, and coverage.
    pub fn read_radiance(&self, frame: &Frame) -> Result<Vec<[f32; 4]>, RenderError> {
        let slot = self.resources.slot(frame.slot);
        let (Some(sampling), Some(accumulation)) = (frame.sampling, &slot.accumulation) else { return Ok(Vec::new()) };
        Ok(read_radiance(&self.gpu, accumulation.sum(sampling.index), sampling.index + 1)?)
    }

    /// Makes the frame render this sample, moved by `offset` pixels.
    pub(super) fn set_sample(&mut self, frame: &mut Frame, sampling: Sampling, offset: DVec2) {
        frame.sampling = Some(sampling);
        frame.shade_features.sparse = false;
        self.resources.set_sample(&self.gpu, sampling.index, sampling.is_transparent, offset);
    }
}
