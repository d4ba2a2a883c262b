//! Records the passes of a frame, each under its label and, if timings are on, between two timestamps.

use super::frame::Frame;
use super::resources::{FrameResources, Groups, SlotState};
use super::scene::ShadedScene;
use super::timings::Stamps;
use crate::gpu::Gpu;
use crate::pipelines::field::{FieldPipelines, own_of};
use crate::recipe::{Extent, Pass};
use crate::resources::accumulation::Accumulation;
use crate::resources::targets::{Target, Targets};
use crate::resources::uniforms::{INSTANCER_STRIDE, UNIFORM_STRIDE};

/// Without timings, the passes that evaluate fields share one compute pass: beginning one for each of thousands of
/// components would take longer than some of the components.
const SHARED_LABEL: &str = "fields";

/// Records a submission, see the module.
#[derive(Debug)]
pub struct Recorder<'a> {
    /// The device.
    pub gpu: &'a Gpu,
    /// The frame.
    pub frame: &'a Frame,
    /// The buffers of the frame.
    pub resources: &'a FrameResources,
    /// The textures of the picture.
    pub targets: &'a Targets,
    /// Target of the enlarged coarse picture, if any.
    pub enlarged: Option<&'a Target>,
    /// Textures of accumulated samples, if there are any.
    pub accumulation: Option<&'a Accumulation>,
    groups: &'a Groups,
    encoder: wgpu::CommandEncoder,
    /// The open compute pass.
    open: Option<wgpu::ComputePass<'static>>,
    /// The pass of the recipe that is being recorded.
    current: Pass,
    stamps: Option<Stamps<'a>>,
    /// Passes with timestamps, in order.
    timed: Vec<Pass>,
}

impl<'a> Recorder<'a> {
    /// A recorder for the slot of `frame`. `stamps` limits how many passes can have timestamps.
    pub fn new(gpu: &'a Gpu, frame: &'a Frame, resources: &'a FrameResources, stamps: Option<Stamps<'a>>) -> Self {
        let SlotState { targets, enlarged, accumulation, groups } = resources.slot(frame.slot);
        let groups = groups.as_ref().expect("begin binds");
        let encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("frame") });
        let (open, current, timed) = (None, Pass::ALL[0], Vec::new());
        let (enlarged, accumulation) = (enlarged.as_ref(), accumulation.as_ref());
        Self { gpu, frame, resources, targets, enlarged, accumulation, groups, encoder, open, current, stamps, timed }
    }

    /// Whether there are timestamps left for another pass and for those over the finished picture.
    pub fn has_room(&self) -> bool {
        self.stamps.is_none_or(|stamps| self.timed.len() + Pass::ALL.len() <= stamps.room())
    }

    /// Begins a pass of the recipe.
    pub fn begin(&mut self, field_pass: Pass) {
        if self.stamps.is_some() || field_pass.extent() == Extent::Finished {
            self.open = None;
        }
        self.current = field_pass;
    }

    /// The bind group of the view, and the pass's own bind group with the index `own`.
    pub fn groups(&self, own: usize) -> [&'a wgpu::BindGroup; 2] {
        [&self.groups.view, &self.groups.own[self.current as usize][own]]
    }

    /// The bind group of the view.
    pub fn view(&self) -> &'a wgpu::BindGroup {
        &self.groups.view
    }

    /// What pass `shade` reads of the scene besides materials.
    pub fn shaded(&self) -> &'a ShadedScene {
        &self.groups.shaded
    }

    /// The bind group of the scene.
    pub fn scene(&self) -> &'a wgpu::BindGroup {
        &self.groups.scene
    }

    /// The compute pass for the dispatch `at` of the frame. Group 0 is the view, group 3 the dispatch.
    pub fn compute(&mut self, at: usize) -> &mut wgpu::ComputePass<'static> {
        let groups = self.groups;
        let pass = self.open();
        pass.set_bind_group(3, &groups.dispatch_params, &[(at * UNIFORM_STRIDE) as u32]);
        pass
    }

    /// The compute pass for a dispatch over the finished picture.
    pub fn open(&mut self) -> &mut wgpu::ComputePass<'static> {
        if self.open.is_none() {
            let timestamp_writes = self.stamp().map(|stamps| stamps.of_compute());
            let label = if self.stamps.is_some() || self.current.extent() == Extent::Finished {
                self.current.label()
            } else {
                SHARED_LABEL
            };
            let descriptor = wgpu::ComputePassDescriptor { label: Some(label), timestamp_writes };
            let mut pass = self.encoder.begin_compute_pass(&descriptor).forget_lifetime();
            pass.set_bind_group(0, &self.groups.view, &[]);
            self.open = Some(pass);
        }
        self.open.as_mut().expect("opened above")
    }

    /// The compute pass for a dispatch over a component, with the component's pipeline and the pass's own bind group
    /// `own`.
    pub fn component(
        &mut self,
        at: usize,
        own: usize,
        pipeline: impl FnOnce(&FieldPipelines) -> &wgpu::ComputePipeline,
    ) -> &mut wgpu::ComputePass<'static> {
        let (frame, groups) = (self.frame, self.groups);
        let dispatch = &frame.plan.dispatches[at];
        let component = dispatch.params.component as usize;
        let [_, targets] = self.groups(own);
        let pass = self.compute(at);
        pass.set_pipeline(pipeline(&frame.choices[component].pipelines));
        let subject = (component * UNIFORM_STRIDE) as u32;
        let window = frame.template_window(component);
        let rows = window.unwrap_or(frame.rows[component]);
        match (frame.instancers[component], &groups.copies) {
            (Some(instancer), Some(copies)) => {
                let instancer = instancer * INSTANCER_STRIDE as u32;
                pass.set_bind_group(1, &copies[usize::from(window.is_some())], &[subject, rows, instancer]);
            }
            _ if window.is_some() => pass.set_bind_group(1, &groups.templates, &[subject, rows]),
            _ => pass.set_bind_group(1, &groups.scene, &[subject, rows]),
        }
        pass.set_bind_group(2, targets, &[]);
        pass
    }

    /// The encoder for render passes, with their timestamps.
    pub fn drawing(&mut self) -> (&mut wgpu::CommandEncoder, Option<Stamps<'a>>) {
        self.open = None;
        let stamps = self.stamp();
        (&mut self.encoder, stamps)
    }

    /// Takes the next two timestamps.
    fn stamp(&mut self) -> Option<Stamps<'a>> {
        let stamps = self.stamps?.at(self.timed.len())?;
        self.timed.push(self.current);
        Some(stamps)
    }

    /// Submits the recorded passes. Returns those with timestamps, in order.
    pub fn submit(mut self) -> Vec<Pass> {
        self.open = None;
        if let Some(stamps) = self.stamps {
            stamps.resolve(&mut self.encoder, self.timed.len());
        }
        self.gpu.queue.submit([self.encoder.finish()]);
        self.timed
    }
}

/// Dispatches the never used ones of these pipelines over no work, which makes lavapipe compile them. Returns whether
/// there were any.
pub fn meet(gpu: &Gpu, groups: &Groups, pipelines: &FieldPipelines) -> bool {
    let fresh: Vec<Pass> =
        FieldPipelines::STAGES.into_iter().filter(|field_pass| pipelines.first_use(*field_pass as usize)).collect();
    if fresh.is_empty() {
        return false;
    }
    let label = Some("needs_prewarm pipelines");
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label });
    let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label, timestamp_writes: None });
    pass.set_bind_group(0, &groups.view, &[]);
    match &groups.copies {
        Some(copies) if pipelines.copies => pass.set_bind_group(1, &copies[0], &[0, 0, 0]),
        _ if pipelines.copies => return false,
        _ => pass.set_bind_group(1, &groups.scene, &[0, 0]),
    }
    pass.set_bind_group(3, &groups.dispatch_params, &[0]);
    for field_pass in fresh {
        pass.set_pipeline(pipelines.pipeline(field_pass));
        let own = own_of(field_pass, pipelines.copies, pipelines.veil);
        let Some(own) = groups.own[field_pass as usize].get(own) else { continue };
        pass.set_bind_group(2, own, &[]);
        pass.dispatch_workgroups(0, 0, 0);
    }
    drop(pass);
    gpu.queue.submit([encoder.finish()]);
    true
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::super::{Renderer, Slot};
    use crate::pipelines::cache::EvalMode;
    use crate::{Gpu, OverlaySettings};
    use isolith_field::flatten;
    use isolith_gallery as gallery;

    #[test]
    fn prewarmed_pipelines_are_not_first_used_by_a_picture() {
        let gpu = Gpu::headless().unwrap_or_else(|error| panic!("{error}"));
        let flat = flatten(&gallery::random(32, 3), 0.0).expect("within the limits");
        let camera = flat.default_camera(&[], 1.0);
        let is_fresh = |met: bool| {
            let mut renderer = Renderer::new(&gpu).unwrap_or_else(|error| panic!("{error}"));
            let mut begin = || {
                let frame = renderer.begin(Slot::Full, &flat, &[], &camera, [40, 40], OverlaySettings::default());
                (frame.expect("a frame"), renderer.is_preparing())
            };
            while begin().1 {
                std::thread::sleep(Duration::from_millis(10));
            }
            let (frame, _) = begin();
            // One after the other, as between two repaints of the window.
            while met && renderer.prewarm_pipelines(&flat, &camera, Duration::ZERO).expect("a device that answers") {}
            assert!(frame.choices.iter().any(|choice| choice.mode == EvalMode::StraightLine));
            frame.uses_fresh_pipelines(0..frame.plan.dispatches.len())
        };
        assert!(is_fresh(false));
        // Other drivers compile when a pipeline is built.
        assert_eq!(is_fresh(true), !gpu.is_software());
    }
}
