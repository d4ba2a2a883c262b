//! Pass `shade`: lighting of the hits, and the background.

use std::ops::Range;
use std::sync::OnceLock;

use wgpu::{BindGroup, BindGroupLayout};

use super::frame_pass::{Building, FramePass};
use crate::recipe::Pass;
use crate::renderer::recorder::Recorder;
use crate::renderer::resources::Bound;
use crate::resources::layouts::*;
use crate::resources::texture_resources::TextureBindings;
use crate::resources::uniforms::DispatchParams;
use isolith_wgsl::{ShaderError, assemble_featured, assemble_plain};

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
    pipeline: wgpu::RenderPipeline,
    /// For scenes with textures; made for the first one.
    textured: OnceLock<wgpu::RenderPipeline>,
    view: BindGroupLayout,
    lights: BindGroupLayout,
    targets: BindGroupLayout,
    textures: BindGroupLayout,
    /// The source of `textured`.
    textured_source: String,
}

/// Index of the group of textures.
const TEXTURES: u32 = 3;

fn pipeline(device: &wgpu::Device, source: String, groups: &[&BindGroupLayout]) -> wgpu::RenderPipeline {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(Pass::Shade.label()),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    let layout = pipeline_layout(device, Pass::Shade.label(), groups);
    screen_pipeline(device, &module, "shade_fragment", &layout, None)
}

impl FramePass for ShadePass {
    fn new(Building { device, layouts, .. }: Building<'_>) -> Result<Self, ShaderError> {
        let (lights, targets) = (LightBindings::layout(device), ShadeBindings::layout(device));
        Ok(Self {
            pipeline: pipeline(device, assemble_plain(Pass::Shade.file())?, &[&layouts.view, &lights, &targets]),
            textured: OnceLock::new(),
            view: layouts.view.clone(),
            lights,
            targets,
            textures: TextureBindings::layout(device),
            textured_source: assemble_featured(Pass::Shade.file(), &["TEXTURES"])?,
        })
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
        if let Some(textures) = bound.resources.textures() {
            groups.push(textures.bind(device, &self.textures));
            let layouts = [&self.view, &self.lights, &self.targets, &self.textures];
            self.textured.get_or_init(|| pipeline(device, self.textured_source.clone(), &layouts));
        }
        groups
    }

    fn record(&self, recorder: &mut Recorder<'_>, dispatches: Range<usize>) {
        let (frame, targets) = (recorder.frame, recorder.targets);
        let ([view, lights], [_, textures]) = (recorder.groups(0), recorder.groups(1));
        let images = (recorder.own_groups() > 2).then(|| recorder.groups(2)[1]);
        let (encoder, stamps) = recorder.drawing();
        let stamps = stamps.map(|stamps| stamps.of_drawing());
        let mut pass = screen_pass(encoder, Pass::Shade.label(), &targets.color.view, stamps);
        match (images, self.textured.get()) {
            (Some(images), Some(textured)) => {
                pass.set_pipeline(textured);
                pass.set_bind_group(TEXTURES, images, &[]);
            }
            _ => pass.set_pipeline(&self.pipeline),
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
