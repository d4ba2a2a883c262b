//! Pass `shade`: lighting of the hits, and the background.

use std::ops::Range;
use std::sync::OnceLock;

use wgpu::{BindGroup, BindGroupLayout};

use super::frame_pass::{Building, FramePass};
use crate::recipe::Pass;
use crate::renderer::recorder::Recorder;
use crate::renderer::resources::{Bound, FrameResources};
use crate::resources::layouts::*;
use crate::resources::uniforms::DispatchParams;
use isolith_wgsl::{Evaluator, OpSet, Options, ShaderError, assemble};

bindings! {
    /// Group 1.
    LightBindings, "lights", FRAGMENT {
        lights: read_storage(),
        materials: read_storage(),
        mesh_materials: read_storage(),
        environment_map: read_storage(),
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

/// A pipeline of the pass.
fn pipeline(
    device: &wgpu::Device,
    layout: &wgpu::PipelineLayout,
    options: Options,
) -> Result<wgpu::RenderPipeline, ShaderError> {
    let text = assemble(Pass::Shade.file(), &Evaluator::Interpreter(OpSet::none()), options)?;
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(Pass::Shade.label()),
        source: wgpu::ShaderSource::Wgsl(text.into()),
    });
    Ok(screen_pipeline(device, &module, "shade_fragment", layout, None))
}

/// The pass.
#[derive(Debug)]
pub struct ShadePass {
    /// Without area lights or with them, and both for gradients, then for other environments. Those after the first
    /// are built when a scene needs them.
    pipelines: [OnceLock<wgpu::RenderPipeline>; 4],
    layout: wgpu::PipelineLayout,
    lights: BindGroupLayout,
    targets: BindGroupLayout,
}

impl ShadePass {
    fn pipeline(&self, device: &wgpu::Device, [area_lights, image_lit]: [bool; 2]) -> &wgpu::RenderPipeline {
        self.pipelines[usize::from(area_lights) + 2 * usize::from(image_lit)].get_or_init(|| {
            let options = Options { area_lights, image_lit, ..Options::default() };
            pipeline(device, &self.layout, options).expect("the files of the other pipeline are there")
        })
    }
}

impl FramePass for ShadePass {
    fn new(Building { device, layouts, .. }: Building<'_>) -> Result<Self, ShaderError> {
        let (lights, targets) = (LightBindings::layout(device), ShadeBindings::layout(device));
        let layout = pipeline_layout(device, Pass::Shade.label(), &[&layouts.view, &lights, &targets]);
        let first = pipeline(device, &layout, Options::default())?;
        let pipelines = [OnceLock::from(first), OnceLock::new(), OnceLock::new(), OnceLock::new()];
        Ok(Self { pipelines, layout, lights, targets })
    }

    fn bind(&self, device: &wgpu::Device, bound: &Bound<'_>) -> Vec<BindGroup> {
        let lights = LightBindings {
            lights: bound.resources.lights(),
            materials: bound.materials.clone(),
            mesh_materials: bound.resources.mesh_materials(),
            environment_map: bound.resources.environment_map(),
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
        let FrameResources { has_area_lights, is_image_lit, .. } = *recorder.resources;
        let pipeline = self.pipeline(&recorder.gpu.device, [has_area_lights, is_image_lit]);
        let (encoder, stamps) = recorder.drawing();
        let stamps = stamps.map(|stamps| stamps.of_drawing());
        let mut pass = screen_pass(encoder, Pass::Shade.label(), &targets.color.view, stamps);
        pass.set_pipeline(pipeline);
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
