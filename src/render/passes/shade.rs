//! Pass `shade`: light on what the passes before have found, and the background.

use wgpu::{BindGroup, BindGroupLayout, ComputePipeline, ShaderStages, TextureFormat};

use crate::flat::truth::FILE_MATERIAL;
use crate::flat::{FlatMaterial, FlatScene};
use crate::render::kernel::{ShaderError, plain_source};
use crate::render::layouts::*;
use crate::render::targets::Targets;

/// The pass.
#[derive(Debug)]
pub struct ShadePass {
    pipeline: ComputePipeline,
    lights: BindGroupLayout,
    targets: BindGroupLayout,
}

impl ShadePass {
    /// Builds the kernel.
    pub fn new(device: &wgpu::Device, layouts: &Layouts) -> Result<Self, ShaderError> {
        let stage = ShaderStages::COMPUTE;
        let lights = layout(device, "lights", &[entry(0, stage, read_storage()), entry(1, stage, read_storage())]);
        let targets = layout(
            device,
            "shade targets",
            &[
                entry(0, stage, read_texture(false)),
                entry(1, stage, read_texture(false)),
                entry(2, stage, read_texture(false)),
                entry(3, stage, read_texture(false)),
                entry(4, stage, write_texture(TextureFormat::Rgba8Unorm)),
                entry(5, stage, read_texture(true)),
                entry(6, stage, write_texture(TextureFormat::R32Uint)),
            ],
        );
        let groups = [&layouts.view, &lights, &targets, &layouts.work];
        let pipeline = compute_pipeline(device, "shade", plain_source("shade.wgsl")?, "shade", &groups);
        Ok(Self { pipeline, lights, targets })
    }

    /// The pass's own bind group.
    pub fn bind(&self, device: &wgpu::Device, targets: &Targets) -> BindGroup {
        let views = [
            &targets.depth,
            &targets.normal,
            &targets.diffuse,
            &targets.emission,
            &targets.color,
            &targets.owner,
            &targets.leaf,
        ];
        let resources = views.map(|t| wgpu::BindingResource::TextureView(&t.view));
        bind(device, "shade targets", &self.targets, &resources)
    }

    /// The bind group of the lights and of what [`mesh_emissions`] gives.
    pub fn bind_lights(&self, device: &wgpu::Device, resources: [wgpu::BindingResource<'_>; 2]) -> BindGroup {
        bind(device, "lights", &self.lights, &resources)
    }

    /// The kernel.
    pub fn pipeline(&self) -> &ComputePipeline {
        &self.pipeline
    }
}

/// Emission and shininess of each mesh: of the material that stands for its own ones, where there is one.
pub fn mesh_emissions(flat: &FlatScene) -> Vec<[f32; 4]> {
    let of = |material: &FlatMaterial| {
        let [r, g, b] = material.emission;
        [r, g, b, material.shininess]
    };
    let own = [0.0, 0.0, 0.0, FILE_MATERIAL.shininess as f32];
    flat.meshes.iter().map(|m| m.material.map_or(own, |i| of(&flat.materials[i as usize]))).collect()
}
