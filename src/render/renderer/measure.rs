//! What is asked of a finished frame: counts, buffers, and the limit for measuring.

use super::pixel_counts::COMPONENT_COUNTS;
use super::{Frame, RenderError, Renderer, SUBTILE_COUNTS, Slot};
use crate::flat::GBuffer;
use crate::render::frame::plan::{Dispatch, Pass};
use crate::render::gpu::Gpu;
use crate::render::gpu::readback::{read_buffers, read_color, read_words_at};
use crate::render::passes::overlay::OverlaySettings;
use crate::render::resources::uniforms::{DispatchParams, strided};

/// What pipelines that count have counted.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Evaluations of fields by rays.
    pub steps: u64,
    /// Rays that were started, once for each component that they meet.
    pub rays: u64,
    /// Evaluations of fields by cones.
    pub cone_steps: u64,
    /// Subtiles that the cones have left, of all components.
    pub subtiles: u64,
    /// Evaluations by rays and cones, for each component.
    pub of_components: Vec<u64>,
    /// Cells of tapes that rays and cones looked up, for each component.
    pub cells: Vec<u64>,
    /// Entries of tapes that they read, for each component.
    pub entries: Vec<u64>,
}

impl Renderer {
    /// The least work that the picture of a finished frame needs: every ray starts at its true depth and
    /// evaluates the field once to confirm it, then come normals and light as usual. Only for measuring.
    pub fn begin_limit(&mut self, frame: &Frame) -> Frame {
        let confirm = |dispatch: &Dispatch| {
            let dispatch_params =
                DispatchParams { relaunch: 1, last_relaunch: 1, max_steps: 1, compacted: 0, ..dispatch.params };
            match dispatch.pass {
                Pass::Trace if dispatch.params.relaunch == 0 => Some(Dispatch { params: dispatch_params, ..*dispatch }),
                Pass::Surface | Pass::Shade => Some(*dispatch),
                _ => None,
            }
        };
        let mut plan = frame.plan.clone();
        plan.dispatches = frame.planned().iter().filter_map(confirm).collect();
        let Gpu { device, queue, .. } = &self.gpu;
        self.dispatch_params.set(device, queue, &strided(plan.dispatches.iter().map(|dispatch| dispatch.params)));
        let targets = &self.slot(frame.slot).targets;
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let size = targets.depth.texture.size();
        let (from, to) = (targets.depth.texture.as_image_copy(), targets.march.texture.as_image_copy());
        encoder.copy_texture_to_texture(from, to, size);
        queue.submit([encoder.finish()]);
        let seconds = frame.cost_model.seconds(plan.cost());
        let overlay = OverlaySettings::default();
        let mut limit = Frame { plan, next: 0, seconds_done: 0.0, seconds, measured: None, overlay, ..frame.clone() };
        limit.end_as_planned();
        limit
    }

    /// Sets what a frame has counted to nothing.
    pub fn forget_counts(&mut self, frame: &Frame) {
        let size = self.slot(frame.slot).targets.size;
        self.reset_counts(frame.origins.len(), size);
        let mut encoder = self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        self.clear_pixel_counts(&mut encoder, size);
        self.gpu.queue.submit([encoder.finish()]);
    }

    /// What a frame has counted, with pipelines that count.
    pub fn counts(&self, frame: &Frame) -> Result<Counts, RenderError> {
        let words = self.component_counts(frame)?;
        let lists =
            read_words_at(&self.gpu, self.subtile_counts.buffer(), 0, frame.plan.lists as usize * SUBTILE_COUNTS)?;
        let sum = |i: usize| lists.chunks_exact(SUBTILE_COUNTS).map(|c| u64::from(c[i])).sum();
        let of_each = |i: usize| words.iter().map(|c| u64::from(c[i])).collect::<Vec<_>>();
        let mut of_components = of_each(1);
        for dispatch in frame.planned().iter().filter(|dispatch| dispatch.pass == Pass::Cone) {
            of_components[dispatch.params.component as usize] +=
                u64::from(lists[dispatch.params.list as usize * SUBTILE_COUNTS + 3]);
        }
        Ok(Counts {
            steps: of_each(1).iter().sum(),
            rays: of_each(2).iter().sum(),
            cone_steps: sum(3),
            subtiles: sum(4),
            of_components,
            cells: of_each(3),
            entries: of_each(4),
        })
    }

    /// What was counted for each component.
    pub(super) fn component_counts(&self, frame: &Frame) -> Result<Vec<[u32; COMPONENT_COUNTS]>, RenderError> {
        let count = frame.origins.len() * COMPONENT_COUNTS;
        let words = read_words_at(&self.gpu, self.march_counts.buffer(), 0, count)?;
        Ok(words.as_chunks().0.to_vec())
    }

    /// Depth, normals and leaves of a finished frame, and its picture if it was shaded.
    pub fn read(&self, frame: &Frame) -> Result<GBuffer, RenderError> {
        Ok(read_buffers(&self.gpu, &self.slot(frame.slot).targets)?)
    }

    /// The picture in a slot as it is shown, enlarged where [`OverlaySettings::shown_at`] says so.
    pub fn read_shown(&self, slot: Slot) -> Result<Vec<[u8; 4]>, RenderError> {
        let state = self.slot(slot);
        Ok(read_color(&self.gpu, state.enlarged.as_ref().unwrap_or(&state.targets.color))?)
    }
}
