//! Writes the dispatches of a frame down and hands them to the device.

use std::time::{Duration, Instant};

use super::upload::Groups;
use super::{CONE_GROUP, Frame, RAY_COUNTS, RenderError, Renderer, SUBTILE_COUNTS, SlotState};
use crate::flat::FlatScene;
use crate::geometry::Camera;
use crate::render::frame::plan::{Dispatch, Pass, SUBTILES, TILE};
use crate::render::passes::field::FieldPipelines;
use crate::render::pipelines::cache::PipelineChoice;
use crate::render::resources::uniforms::UNIFORM_STRIDE;

impl Renderer {
    pub(super) fn submit(&self, frame: &Frame, range: std::ops::Range<usize>) {
        let SlotState { targets, enlarged, groups } = self.slot(frame.slot);
        let groups = groups.as_ref().expect("begin binds");
        let descriptor = wgpu::CommandEncoderDescriptor { label: Some("frame") };
        let mut encoder = self.gpu.device.create_command_encoder(&descriptor);
        let dispatches = &frame.plan.dispatches;
        let mut at = range.start;
        while at < range.end {
            // One of them after the other, as far as they are recorded in one pass.
            let is_alike = |field_pass| matches!(field_pass, Pass::Mesh | Pass::Shade).then_some(field_pass);
            let kind = is_alike(dispatches[at].pass);
            let end = (at..range.end).find(|i| is_alike(dispatches[*i].pass) != kind).unwrap_or(range.end);
            match kind {
                Some(Pass::Mesh) => {
                    // No ray is left over yet.
                    encoder.clear_buffer(self.rays.buffer(), 0, Some(u64::from(frame.plan.lists.max(1)) * 4));
                    self.clear_pixel_counts(&mut encoder, targets.size);
                    self.mesh.record(&mut encoder, targets, &groups.view);
                }
                Some(_) => {
                    let own = [&groups.view, &groups.lights, &groups.shade];
                    self.shade.record(&mut encoder, &targets.color.view, own, dispatches[at..end].iter());
                }
                None => self.record_compute(&mut encoder, groups, frame, at..end),
            }
            at = end;
        }
        if range.end == dispatches.len() {
            self.record_debug_view(&mut encoder, frame);
            if !frame.overlay.is_empty() {
                let (device, enlarged) = (&self.gpu.device, enlarged.as_ref());
                self.overlay.record(device, &mut encoder, targets, enlarged, &groups.view, &frame.plan);
            }
        }
        self.gpu.queue.submit([encoder.finish()]);
    }

    /// Dispatches pipelines that have become ready over nothing, for this long: lavapipe compiles a pipeline, or reads what it
    /// has compiled, when it meets it, which would hold up the next picture. Whether there are more.
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
        let Some(groups) = self.slots.iter().flatten().find_map(|slot| slot.groups.as_ref()) else { return Ok(false) };
        for PipelineChoice { pipelines, .. } in choices {
            if has_prewarmed && start.elapsed() > time {
                return Ok(true);
            }
            let mut fresh = [Pass::Cone, Pass::Trace, Pass::Surface].to_vec();
            fresh.retain(|field_pass| pipelines.first_use(*field_pass as usize));
            if fresh.is_empty() {
                continue;
            }
            has_prewarmed = true;
            let mut encoder = self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_bind_group(0, &groups.view, &[]);
            pass.set_bind_group(1, &groups.scene, &[0, 0]);
            pass.set_bind_group(3, &groups.dispatch_params, &[0]);
            for field_pass in fresh {
                let (pipeline, targets) = of_field(&pipelines, groups, field_pass, false);
                pass.set_pipeline(pipeline);
                pass.set_bind_group(2, targets, &[]);
                pass.dispatch_workgroups(0, 0, 0);
            }
            drop(pass);
            self.gpu.queue.submit([encoder.finish()]);
            self.gpu.wait()?;
        }
        Ok(false)
    }

    fn record_compute(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        groups: &Groups,
        frame: &Frame,
        range: std::ops::Range<usize>,
    ) {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_bind_group(0, &groups.view, &[]);
        for at in range {
            let dispatch = &frame.plan.dispatches[at];
            pass.set_bind_group(3, &groups.dispatch_params, &[(at * UNIFORM_STRIDE) as u32]);
            match dispatch.pass {
                Pass::Hiz => {
                    pass.set_pipeline(self.hiz.pipeline());
                    pass.set_bind_group(1, self.hiz.scene(), &[]);
                    pass.set_bind_group(2, &groups.hiz, &[]);
                }
                _ => {
                    self.record_field(&mut pass, groups, frame, dispatch);
                    continue;
                }
            }
            let [x, y] = if dispatch.pass == Pass::Hiz {
                dispatch.tiles().map(|tiles| (tiles * SUBTILES).div_ceil(TILE))
            } else {
                dispatch.tiles()
            };
            pass.dispatch_workgroups(x, y, 1);
        }
    }

    /// A pass over one component.
    fn record_field(&self, pass: &mut wgpu::ComputePass<'_>, groups: &Groups, frame: &Frame, dispatch: &Dispatch) {
        let component = dispatch.params.component as usize;
        let pipelines = &frame.choices[component].pipelines;
        let (pipeline, targets) = of_field(pipelines, groups, dispatch.pass, dispatch.params.compacted == 1);
        pass.set_pipeline(pipeline);
        let subject = (component * UNIFORM_STRIDE) as u32;
        match frame.template_window(component) {
            Some(window) => pass.set_bind_group(1, &groups.templates, &[subject, window]),
            None => pass.set_bind_group(1, &groups.scene, &[subject, frame.rows[component]]),
        }
        pass.set_bind_group(2, targets, &[]);
        if dispatch.pass == Pass::Cone {
            let [x, y] = dispatch.tiles();
            pass.dispatch_workgroups((x * y).div_ceil(CONE_GROUP), 1, 1);
        } else {
            let list = dispatch.params.list as usize;
            let (counts, word) = match (dispatch.pass, dispatch.params.compacted) {
                (Pass::Surface, _) => (&self.ray_counts, list * RAY_COUNTS + 3),
                (_, 1) => (&self.ray_counts, list * RAY_COUNTS),
                _ => (&self.subtile_counts, list * SUBTILE_COUNTS),
            };
            pass.dispatch_workgroups_indirect(counts.buffer(), word as u64 * 4);
        }
    }
}

/// The pipeline and the targets of a pass over a component.
fn of_field<'g>(
    pipelines: &'g FieldPipelines,
    groups: &'g Groups,
    field_pass: Pass,
    compacted: bool,
) -> (&'g wgpu::ComputePipeline, &'g wgpu::BindGroup) {
    match field_pass {
        Pass::Cone => (&pipelines.cone, &groups.field.cone),
        Pass::Trace if compacted => (&pipelines.trace, &groups.field.compacted),
        Pass::Trace => (&pipelines.trace, &groups.field.trace),
        Pass::Surface => (&pipelines.surface, &groups.field.surface),
        Pass::Mesh | Pass::Hiz | Pass::Shade => unreachable!("these evaluate no field"),
    }
}

#[cfg(test)]
mod tests {
    use super::super::Slot;
    use super::*;
    use crate::flat::flatten;
    use crate::gallery;
    use crate::render::pipelines::cache::EvalMode;
    use crate::render::{Gpu, OverlaySettings};

    #[test]
    fn prewarmed_pipelines_are_not_first_used_by_a_picture() {
        let gpu = Gpu::headless().unwrap_or_else(|error| panic!("{error}"));
        let flat = flatten(&gallery::random(32, 3), 0.0).expect("within the limits");
        let camera = flat.default_camera(&[], 1.0);
        let is_fresh = |prewarmed: bool| {
            let mut renderer = Renderer::new(&gpu).unwrap_or_else(|error| panic!("{error}"));
            let mut begin = || {
                let frame = renderer.begin(Slot::Full, &flat, &[], &camera, [40, 40], OverlaySettings::default());
                (frame.expect("a frame"), renderer.is_preparing())
            };
            while begin().1 {
                std::thread::sleep(Duration::from_millis(10));
            }
            let (frame, _) = begin();
            // One after the other, as between two paintings of the window.
            while prewarmed
                && renderer.prewarm_pipelines(&flat, &camera, Duration::ZERO).expect("a device that answers")
            {
            }
            assert!(frame.choices.iter().any(|choice| choice.mode == EvalMode::StraightLine));
            frame.uses_fresh_pipelines(0..frame.plan.dispatches.len())
        };
        assert!(is_fresh(false));
        // Elsewhere drivers compile when a pipeline is built.
        assert_eq!(is_fresh(true), !gpu.is_software());
    }
}
