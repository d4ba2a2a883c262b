//! Pass `shade`: lighting of the hits, and the background.

use std::ops::Range;
use std::sync::OnceLock;

use wgpu::{BindGroup, BindGroupLayout, RenderPipeline};

use super::display::SumBindings;
use super::frame_pass::{Building, FramePass};
use crate::recipe::Pass;
use crate::renderer::recorder::Recorder;
use crate::renderer::resources::Bound;
use crate::resources::accumulation::SUM_FORMAT;
use crate::resources::layouts::*;
use crate::resources::uniforms::DispatchParams;
use isolith_scene::ViewTransform;
use isolith_wgsl::{Evaluator, OpSet, Options, ShaderError, assemble};

bindings! {
    /// Group 1.
    LightBindings, "lights", FRAGMENT {
        lights: read_storage(),
        materials: read_storage(),
        mesh_materials: read_storage(),
    }
}

bindings! {
    /// Group 1 in scenes with shadows or occlusion.
    ShadowedLightBindings, "lights with shadows", FRAGMENT {
        lights: read_storage(),
        materials: read_storage(),
        mesh_materials: read_storage(),
        settings: uniform(false),
        shares: read_storage(),
    }
}

bindings! {
    /// Group 2.
    ShadeBindings, "shade targets", FRAGMENT {
        depth: read_texture(false),
        normal: read_texture(false),
        base_color: read_texture(false),
        material: read_texture(true),
        visibility: read_texture(true),
    }
}

/// The pipelines with, or without, shadows and occlusion.
#[derive(Debug)]
struct ShadePipelines {
    module: wgpu::ShaderModule,
    layout: wgpu::PipelineLayout,
    /// Layout of [`Self::sample`].
    sample_layout: wgpu::PipelineLayout,
    /// For pictures of a single sample, by view transform; built on first use.
    pipelines: [OnceLock<RenderPipeline>; ViewTransform::ALL.len()],
    /// For one of several samples.
    sample: OnceLock<RenderPipeline>,
}

/// The pass.
#[derive(Debug)]
pub struct ShadePass {
    plain: ShadePipelines,
    /// For scenes with shadows or occlusion, once there was one.
    shadowed: Option<ShadePipelines>,
    view: BindGroupLayout,
    lights: BindGroupLayout,
    shadowed_lights: BindGroupLayout,
    targets: BindGroupLayout,
    sum: BindGroupLayout,
}

/// Entry points by view transform.
const ENTRY_POINTS: [&str; ViewTransform::ALL.len()] =
    ["shade_fragment", "shade_agx_fragment", "shade_neutral_fragment"];

impl ShadePass {
    /// Makes the pipelines for scenes with shadows or occlusion.
    ///
    /// # Errors
    /// A shader file is missing.
    pub fn prepare(&mut self, device: &wgpu::Device) -> Result<(), ShaderError> {
        if self.shadowed.is_none() {
            let groups = [&self.view, &self.shadowed_lights, &self.targets, &self.sum];
            self.shadowed = Some(ShadePipelines::new(device, groups, true)?);
        }
        Ok(())
    }
}

impl FramePass for ShadePass {
    fn new(Building { device, layouts, .. }: Building<'_>) -> Result<Self, ShaderError> {
        let (lights, targets) = (LightBindings::layout(device), ShadeBindings::layout(device));
        let sum = SumBindings::layout(device);
        let plain = ShadePipelines::new(device, [&layouts.view, &lights, &targets, &sum], false)?;
        let (view, shadowed_lights) = (layouts.view.clone(), ShadowedLightBindings::layout(device));
        Ok(Self { plain, shadowed: None, view, lights, shadowed_lights, targets, sum })
    }

    fn bind(&self, device: &wgpu::Device, bound: &Bound<'_>) -> Vec<BindGroup> {
        let (lights, materials) = (bound.resources.lights(), bound.materials.clone());
        let (mesh_materials, shadows) = (bound.resources.mesh_materials(), &bound.resources.shadows);
        let lights = if shadows.used.is_on() {
            let (settings, shares) = (shadows.settings.binding(), shadows.shares.binding());
            let all = ShadowedLightBindings { lights, materials, mesh_materials, settings, shares };
            all.bind(device, &self.shadowed_lights)
        } else {
            LightBindings { lights, materials, mesh_materials }.bind(device, &self.lights)
        };
        let targets = ShadeBindings {
            depth: bound.targets.depth.binding(),
            normal: bound.targets.normal.binding(),
            base_color: bound.targets.base_color.binding(),
            material: bound.targets.material.binding(),
            visibility: bound.targets.visibility.binding(),
        };
        vec![lights, targets.bind(device, &self.targets)]
    }

    fn record(&self, recorder: &mut Recorder<'_>, dispatches: Range<usize>) {
        let (frame, targets) = (recorder.frame, recorder.targets);
        let ([view, lights], [_, textures]) = (recorder.groups(0), recorder.groups(1));
        let device = &recorder.gpu.device;
        let sampled = frame.sampling.zip(recorder.accumulation);
        let sum = sampled.map(|(sampling, accumulation)| {
            SumBindings { sum: accumulation.sum_before(sampling.index).binding() }.bind(device, &self.sum)
        });
        let shadowed = self.shadowed.as_ref().filter(|_| recorder.resources.shadows.used.is_on());
        let pipelines = shadowed.unwrap_or(&self.plain);
        let (pipeline, target) = match sampled {
            Some((sampling, accumulation)) => (pipelines.sample(device), accumulation.sum(sampling.index)),
            None => (pipelines.single(device, frame.view_transform), &targets.color),
        };
        let (encoder, stamps) = recorder.drawing();
        let stamps = stamps.map(|stamps| stamps.of_drawing());
        let mut pass = screen_pass(encoder, Pass::Shade.label(), &target.view, stamps);
        pass.set_pipeline(pipeline);
        if let Some(sum) = &sum {
            pass.set_bind_group(3, sum, &[]);
        }
        for (at, group) in (0..).zip([view, lights, textures]) {
            pass.set_bind_group(at, group, &[]);
        }
        for DispatchParams { origin, end, .. } in
            frame.plan.dispatches[dispatches].iter().map(|dispatch| dispatch.params)
        {
            pass.set_scissor_rect(origin[0], origin[1], end[0] - origin[0], end[1] - origin[1]);
            pass.draw(0..3, 0..1);
        }
    }
}

impl ShadePipelines {
    /// Without pipelines yet. `groups`: view, lights, targets, sum.
    fn new(device: &wgpu::Device, groups: [&BindGroupLayout; 4], shadowed: bool) -> Result<Self, ShaderError> {
        let nothing = Evaluator::Interpreter(OpSet::none());
        let text = assemble(Pass::Shade.file(), &nothing, Options { shadowed, ..Options::default() })?;
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(Pass::Shade.label()),
            source: wgpu::ShaderSource::Wgsl(text.into()),
        });
        let layout = pipeline_layout(device, Pass::Shade.label(), &groups[..3]);
        let sample_layout = pipeline_layout(device, "shade sample", &groups);
        Ok(Self { module, layout, sample_layout, pipelines: Default::default(), sample: OnceLock::new() })
    }

    fn single(&self, device: &wgpu::Device, transform: ViewTransform) -> &RenderPipeline {
        let at = transform as usize;
        self.pipelines[at].get_or_init(|| screen_pipeline(device, &self.module, ENTRY_POINTS[at], &self.layout, None))
    }

    fn sample(&self, device: &wgpu::Device) -> &RenderPipeline {
        let entry_point = "shade_sample_fragment";
        let build = || screen_pipeline_to(SUM_FORMAT, device, &self.module, entry_point, &self.sample_layout, None);
        self.sample.get_or_init(build)
    }
}
