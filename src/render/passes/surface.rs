//! Pass `surface`: normal, material and leaf, once per hit pixel. Interpreted; built for [`Features`].

use wgpu::{BindGroup, BindGroupLayout, ComputePipeline, ShaderStages, TextureFormat};

use crate::render::layouts::*;
use crate::render::shader::{Features, ShaderError, source};
use crate::render::targets::Targets;

/// The pass.
#[derive(Debug)]
pub struct SurfacePass {
    pipeline: ComputePipeline,
    targets: BindGroupLayout,
}

impl SurfacePass {
    /// Builds the kernel.
    pub fn new(device: &wgpu::Device, layouts: &Layouts, features: &Features) -> Result<Self, ShaderError> {
        let stage = ShaderStages::COMPUTE;
        let targets = layout(
            device,
            "surface targets",
            &[
                entry(0, stage, read_texture(false)),
                entry(1, stage, read_texture(true)),
                entry(2, stage, write_texture(TextureFormat::Rgba32Float)),
                entry(3, stage, write_texture(TextureFormat::Rgba16Float)),
                entry(4, stage, write_texture(TextureFormat::Rgba16Float)),
                entry(5, stage, write_texture(TextureFormat::R32Uint)),
            ],
        );
        let groups = [&layouts.view, &layouts.scene, &targets, &layouts.work];
        let pipeline = compute_pipeline(device, "surface", source("surface.wgsl", features)?, "surface_pass", &groups);
        Ok(Self { pipeline, targets })
    }

    /// The pass's own bind group.
    pub fn bind(&self, device: &wgpu::Device, targets: &Targets) -> BindGroup {
        let views =
            [&targets.depth, &targets.owner, &targets.normal, &targets.diffuse, &targets.emission, &targets.leaf];
        let resources = views.map(|t| wgpu::BindingResource::TextureView(&t.view));
        bind(device, "surface targets", &self.targets, &resources)
    }

    /// The kernel.
    pub fn pipeline(&self) -> &ComputePipeline {
        &self.pipeline
    }
}
