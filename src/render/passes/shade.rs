//! Pass `shade`: lighting of the hits, and the background.

use std::ops::Range;
use std::sync::OnceLock;

use wgpu::{BindGroup, BindGroupLayout, RenderPipeline};

use super::display::SumBindings;
use super::frame_pass::{Building, FramePass};
use crate::recipe::Pass;
use crate::renderer::Frame;
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
    /// Group 2.
    ShadeBindings, "shade targets", FRAGMENT {
        depth: read_texture(false),
        normal: read_texture(false),
        base_color: read_texture(false),
        material: read_texture(true),
        visibility: read_texture(true),
    }
}

/// The pass.
#[derive(Debug)]
pub struct ShadePass {
    layout: wgpu::PipelineLayout,
    /// Layout of pipelines for one of several samples.
    sample_layout: wgpu::PipelineLayout,
    /// For scenes without and with materials that have the layers of OpenPBR.
    variants: [Variant; 2],
    lights: BindGroupLayout,
    targets: BindGroupLayout,
    sum: BindGroupLayout,
}

/// The pipelines of one source, built on first use.
#[derive(Debug)]
struct Variant {
    source: String,
    module: OnceLock<wgpu::ShaderModule>,
    /// For pictures of a single sample, by view transform.
    pipelines: [OnceLock<RenderPipeline>; ViewTransform::ALL.len()],
    /// For one of several samples.
    sample: OnceLock<RenderPipeline>,
}

impl Variant {
    fn new(layers: bool) -> Result<Self, ShaderError> {
        let options = Options { layers, ..Options::default() };
        let source = assemble(Pass::Shade.file(), &Evaluator::Interpreter(OpSet::none()), options)?;
        Ok(Self { source, module: OnceLock::new(), pipelines: Default::default(), sample: OnceLock::new() })
    }

    fn module(&self, device: &wgpu::Device) -> &wgpu::ShaderModule {
        let source = || wgpu::ShaderSource::Wgsl(self.source.as_str().into());
        let descriptor = || wgpu::ShaderModuleDescriptor { label: Some(Pass::Shade.label()), source: source() };
        self.module.get_or_init(|| device.create_shader_module(descriptor()))
    }
}

/// Entry points by view transform.
const ENTRY_POINTS: [&str; ViewTransform::ALL.len()] =
    ["shade_fragment", "shade_agx_fragment", "shade_neutral_fragment"];

impl FramePass for ShadePass {
    fn new(Building { device, layouts, .. }: Building<'_>) -> Result<Self, ShaderError> {
        let (lights, targets) = (LightBindings::layout(device), ShadeBindings::layout(device));
        let sum = SumBindings::layout(device);
        let layout = pipeline_layout(device, Pass::Shade.label(), &[&layouts.view, &lights, &targets]);
        let sample_layout = pipeline_layout(device, "shade sample", &[&layouts.view, &lights, &targets, &sum]);
        let variants = [Variant::new(false)?, Variant::new(true)?];
        Ok(Self { layout, sample_layout, variants, lights, targets, sum })
    }

    fn bind(&self, device: &wgpu::Device, bound: &Bound<'_>) -> Vec<BindGroup> {
        let lights = LightBindings {
            lights: bound.resources.lights(),
            materials: bound.materials.clone(),
            mesh_materials: bound.resources.mesh_materials(),
        };
        let targets = ShadeBindings {
            depth: bound.targets.depth.binding(),
            normal: bound.targets.normal.binding(),
            base_color: bound.targets.base_color.binding(),
            material: bound.targets.material.binding(),
            visibility: bound.targets.visibility.binding(),
        };
        vec![lights.bind(device, &self.lights), targets.bind(device, &self.targets)]
    }

    fn record(&self, recorder: &mut Recorder<'_>, dispatches: Range<usize>) {
        let (frame, targets) = (recorder.frame, recorder.targets);
        let ([view, lights], [_, textures]) = (recorder.groups(0), recorder.groups(1));
        let device = &recorder.gpu.device;
        let sampled = frame.sampling.zip(recorder.accumulation);
        let sum = sampled.map(|(sampling, accumulation)| {
            SumBindings { sum: accumulation.sum_before(sampling.index).binding() }.bind(device, &self.sum)
        });
        let (pipeline, target) = match sampled {
            Some((sampling, accumulation)) => (self.sample(device, frame), accumulation.sum(sampling.index)),
            None => (self.single(device, frame), &targets.color),
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

impl ShadePass {
    fn single(&self, device: &wgpu::Device, frame: &Frame) -> &RenderPipeline {
        let (variant, at) = (self.variant(frame), frame.view_transform as usize);
        let build = || screen_pipeline(device, variant.module(device), ENTRY_POINTS[at], &self.layout, None);
        variant.pipelines[at].get_or_init(build)
    }

    fn sample(&self, device: &wgpu::Device, frame: &Frame) -> &RenderPipeline {
        let (variant, entry_point) = (self.variant(frame), "shade_sample_fragment");
        let module = || variant.module(device);
        let build = || screen_pipeline_to(SUM_FORMAT, device, module(), entry_point, &self.sample_layout, None);
        variant.sample.get_or_init(build)
    }

    fn variant(&self, frame: &Frame) -> &Variant {
        &self.variants[usize::from(frame.has_layers)]
    }
}
