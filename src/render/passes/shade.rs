//! Pass `shade`: lighting of the hits, and the background.

use std::ops::Range;

use wgpu::{BindGroup, BindGroupLayout};

use super::frame_pass::{Building, FramePass};
use crate::recipe::Pass;
use crate::renderer::recorder::Recorder;
use crate::renderer::resources::Bound;
use crate::resources::layouts::*;
use crate::resources::uniforms::DispatchParams;
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

bindings! {
    /// Group 3, in scenes with shadows or occlusion.
    ShareBindings, "shadow shares", FRAGMENT {
        settings: uniform(false),
        shares: read_storage(),
    }
}

/// The pass.
#[derive(Debug)]
pub struct ShadePass {
    pipeline: wgpu::RenderPipeline,
    /// The pipeline for scenes with shadows or occlusion, once there was one.
    shadowed: Option<wgpu::RenderPipeline>,
    view: BindGroupLayout,
    shares: BindGroupLayout,
    lights: BindGroupLayout,
    targets: BindGroupLayout,
}

impl ShadePass {
    /// Builds the pipeline for scenes with shadows or occlusion.
    ///
    /// # Errors
    /// A shader file is missing.
    pub fn prepare(&mut self, device: &wgpu::Device) -> Result<(), ShaderError> {
        if self.shadowed.is_none() {
            let groups = [&self.view, &self.lights, &self.targets, &self.shares];
            self.shadowed = Some(build(device, &groups, true)?);
        }
        Ok(())
    }
}

fn build(
    device: &wgpu::Device,
    groups: &[&BindGroupLayout],
    shadowed: bool,
) -> Result<wgpu::RenderPipeline, ShaderError> {
    let nothing = Evaluator::Interpreter(OpSet::none());
    let text = assemble(Pass::Shade.file(), &nothing, Options { shadowed, ..Options::default() })?;
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(Pass::Shade.label()),
        source: wgpu::ShaderSource::Wgsl(text.into()),
    });
    let layout = pipeline_layout(device, Pass::Shade.label(), groups);
    Ok(screen_pipeline(device, &module, "shade_fragment", &layout, None))
}

impl FramePass for ShadePass {
    fn new(Building { device, layouts, .. }: Building<'_>) -> Result<Self, ShaderError> {
        let (lights, targets) = (LightBindings::layout(device), ShadeBindings::layout(device));
        let shares = ShareBindings::layout(device);
        let pipeline = build(device, &[&layouts.view, &lights, &targets], false)?;
        Ok(Self { pipeline, shadowed: None, view: layouts.view.clone(), shares, lights, targets })
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
        let mut groups = vec![lights.bind(device, &self.lights), targets.bind(device, &self.targets)];
        let shadows = &bound.resources.shadows;
        if shadows.used.is_on() {
            let shares = ShareBindings { settings: shadows.settings.binding(), shares: shadows.shares.binding() };
            groups.push(shares.bind(device, &self.shares));
        }
        groups
    }

    fn record(&self, recorder: &mut Recorder<'_>, dispatches: Range<usize>) {
        let (frame, targets) = (recorder.frame, recorder.targets);
        let ([view, lights], [_, textures]) = (recorder.groups(0), recorder.groups(1));
        let shadowed = self.shadowed.as_ref().filter(|_| recorder.resources.shadows.used.is_on());
        let shares = shadowed.map(|_| recorder.groups(2)[1]);
        let (encoder, stamps) = recorder.drawing();
        let stamps = stamps.map(|stamps| stamps.of_drawing());
        let mut pass = screen_pass(encoder, Pass::Shade.label(), &targets.color.view, stamps);
        pass.set_pipeline(shadowed.unwrap_or(&self.pipeline));
        for (at, group) in (0..).zip([view, lights, textures]) {
            pass.set_bind_group(at, group, &[]);
        }
        if let Some(shares) = shares {
            pass.set_bind_group(3, shares, &[]);
        }
        for DispatchParams { origin, end, .. } in
            frame.plan.dispatches[dispatches].iter().map(|dispatch| dispatch.params)
        {
            pass.set_scissor_rect(origin[0], origin[1], end[0] - origin[0], end[1] - origin[1]);
            pass.draw(0..3, 0..1);
        }
    }
}
