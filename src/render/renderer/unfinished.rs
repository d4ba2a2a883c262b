//! Rays that have not come to an end within the steps of a plan: traced again with more, and reported where that does not do.

use super::pixel_counts::COMPONENT_COUNTS;
use super::{Frame, RAY_COUNTS, RenderError, Renderer, SUBTILE_COUNTS, SlotState};
use crate::flat::Warning;
use crate::render::frame::cost_model::Cost;
use crate::render::frame::plan::{Dispatch, LONGER, Pass};
use crate::render::gpu::Gpu;
use crate::render::resources::uniforms::strided;

/// How the rays of a frame go on that have not ended as planned.
#[derive(Clone, Debug, Default)]
pub(super) struct GoingOn {
    /// How many of [`LONGER`] were tried.
    pub(super) times: usize,
    /// Pieces of the plan before any ray went on.
    planned: Option<usize>,
    /// Rays without an end by component, as far as that was asked.
    unfinished: Option<Vec<u32>>,
}

impl Frame {
    /// The dispatches that were planned before any ray went on.
    pub(super) fn planned(&self) -> &[Dispatch] {
        &self.plan.dispatches[..self.going_on.planned.unwrap_or(self.plan.dispatches.len())]
    }
}

/// Of a list of subtiles before its cones, and of what its rays leave; see `shaders/common/subtiles.wgsl`.
pub(super) const NO_SUBTILES: [u32; SUBTILE_COUNTS] = [0, 1, 1, 0, 0];
pub(super) const NO_RAYS: [u32; RAY_COUNTS] = [0, 1, 1, 0, 1, 1, 0];

impl Renderer {
    /// Where rays of a frame that is done have not ended, has it trace their components again with more steps. Nothing is
    /// lost by that but time: what was found stays, and only what is nearer is added.
    pub(super) fn go_on(&mut self, frame: &mut Frame) -> Result<(), RenderError> {
        let Some(times) = LONGER.get(frame.going_on.times) else { return Ok(()) };
        let unfinished = self.count_unfinished(frame)?;
        let is_meant = |component: u32| unfinished[component as usize] > 0;
        if unfinished.iter().any(|count| *count > 0) {
            let planned = *frame.going_on.planned.get_or_insert(frame.plan.dispatches.len());
            frame.plan.dispatches.truncate(planned);
            let again = frame.plan.again(is_meant, *times);
            if planned + again.len() <= self.max_dispatches() {
                let cost = again.iter().fold(Cost::default(), |sum, dispatch| sum + dispatch.cost);
                frame.seconds += frame.cost_model.seconds(cost);
                frame.plan.dispatches.extend(again);
                frame.going_on.times += 1;
                frame.measured = None;
                self.prepare_again(frame, planned, &is_meant);
                return Ok(());
            }
            frame.next = planned;
        }
        frame.end_as_planned();
        frame.going_on.unfinished = Some(unfinished);
        Ok(())
    }

    /// Uploads the dispatches from `planned` on, and has nothing be counted for what they trace.
    fn prepare_again(&mut self, frame: &mut Frame, planned: usize, is_meant: &dyn Fn(u32) -> bool) {
        frame.next = planned;
        let Gpu { device, queue, .. } = &self.gpu;
        let write = |buffer: &wgpu::Buffer, word: usize, words: &[u32]| {
            queue.write_buffer(buffer, word as u64 * 4, bytemuck::cast_slice(words));
        };
        for component in (0..frame.origins.len()).filter(|at| is_meant(*at as u32)) {
            write(self.march_counts.buffer(), component * COMPONENT_COUNTS, &[0]);
        }
        for dispatch in frame.plan.dispatches[planned..].iter().filter(|dispatch| dispatch.pass == Pass::Cone) {
            let list = dispatch.params.list as usize;
            write(self.subtile_counts.buffer(), list * SUBTILE_COUNTS, &NO_SUBTILES);
            write(self.ray_counts.buffer(), list * RAY_COUNTS, &NO_RAYS);
            write(self.rays.buffer(), list, &[0]);
        }
        if self.dispatch_params.set(
            device,
            queue,
            &strided(frame.plan.dispatches.iter().map(|dispatch| dispatch.params)),
        ) {
            self.slots.iter_mut().flatten().for_each(|state| state.groups = None);
            let groups = self.bind_all(&self.slot(frame.slot).targets);
            if let Some(SlotState { groups: bound, .. }) = &mut self.slots[frame.slot as usize] {
                *bound = Some(groups);
            }
        }
    }

    fn count_unfinished(&self, frame: &Frame) -> Result<Vec<u32>, RenderError> {
        Ok(self.component_counts(frame)?.iter().map(|counts| counts[0]).collect())
    }

    /// Which components had rays that did not come to an end within the steps allowed.
    pub fn unfinished_rays(&self, frame: &Frame) -> Result<Vec<Warning>, RenderError> {
        let counts = match &frame.going_on.unfinished {
            Some(counts) => counts.clone(),
            None => self.count_unfinished(frame)?,
        };
        let warnings = counts.iter().zip(&frame.origins).filter(|(count, _)| **count > 0).map(|(count, id)| Warning {
            node: *id,
            name: String::new(),
            reason: format!("{count} rays did not come to an end within the steps allowed; they show what lies behind"),
        });
        Ok(warnings.collect())
    }
}
