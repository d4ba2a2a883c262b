//! Pass `shade`: light on what the passes before have found, and the background.

use wgpu::{BindGroup, BindGroupLayout, ShaderStages};

use crate::flat::{FILE_SHININESS, FlatMaterial, FlatScene};
use crate::render::frame::plan::Dispatch;
use crate::render::resources::layouts::*;
use crate::render::resources::targets::Targets;
use crate::render::resources::uniforms::DispatchParams;
use crate::render::wgsl::{ShaderError, assemble_plain};

/// The pass.
#[derive(Debug)]
pub struct ShadePass {
    pipeline: wgpu::RenderPipeline,
    lights: BindGroupLayout,
    targets: BindGroupLayout,
}

impl ShadePass {
    /// Builds the pipeline.
    pub fn new(device: &wgpu::Device, layouts: &Layouts) -> Result<Self, ShaderError> {
        let stage = ShaderStages::FRAGMENT;
        let lights = layout(device, "lights", &[entry(0, stage, read_storage()), entry(1, stage, read_storage())]);
        let targets = layout(
            device,
            "shade targets",
            &[
                entry(0, stage, read_texture(false)),
                entry(1, stage, read_texture(false)),
                entry(2, stage, read_texture(false)),
                entry(3, stage, read_texture(false)),
                entry(4, stage, read_texture(true)),
            ],
        );
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("shade"),
            source: wgpu::ShaderSource::Wgsl(assemble_plain("shade.wgsl")?.into()),
        });
        let layout = pipeline_layout(device, "shade", &[&layouts.view, &lights, &targets]);
        let pipeline = screen_pipeline(device, &module, "shade_fragment", &layout, None);
        Ok(Self { pipeline, lights, targets })
    }

    /// The pass's own bind group.
    pub fn bind(&self, device: &wgpu::Device, targets: &Targets) -> BindGroup {
        let views = [&targets.depth, &targets.normal, &targets.diffuse, &targets.emission, &targets.visibility];
        let resources = views.map(|t| wgpu::BindingResource::TextureView(&t.view));
        bind(device, "shade targets", &self.targets, &resources)
    }

    /// The bind group of the lights and of what [`mesh_emissions`] gives.
    pub fn bind_lights(&self, device: &wgpu::Device, resources: [wgpu::BindingResource<'_>; 2]) -> BindGroup {
        bind(device, "lights", &self.lights, &resources)
    }

    /// Draws the pixels of these dispatches.
    pub fn record<'p>(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        color: &wgpu::TextureView,
        groups: [&BindGroup; 3],
        dispatches: impl Iterator<Item = &'p Dispatch>,
    ) {
        let mut pass = screen_pass(encoder, "shade", color);
        pass.set_pipeline(&self.pipeline);
        for (at, group) in (0..).zip(groups) {
            pass.set_bind_group(at, group, &[]);
        }
        for DispatchParams { origin, end, .. } in dispatches.map(|dispatch| dispatch.params) {
            pass.set_scissor_rect(origin[0], origin[1], end[0] - origin[0], end[1] - origin[1]);
            pass.draw(0..3, 0..1);
        }
    }
}

/// Emission and shininess of each mesh: of the material that stands for its own ones, where there is one.
pub fn mesh_emissions(flat: &FlatScene) -> Vec<[f32; 4]> {
    let of = |material: &FlatMaterial| {
        let [r, g, b] = material.emission;
        [r, g, b, material.shininess]
    };
    let own = [0.0, 0.0, 0.0, FILE_SHININESS as f32];
    flat.meshes.iter().map(|m| m.material.map_or(own, |i| of(&flat.materials[i as usize]))).collect()
}
