//! Pass `farthest`: the farthest depth in each quad after the meshes; only where there are meshes.

use wgpu::{BindGroup, BindGroupLayout, ComputePipeline, ShaderStages, TextureFormat};

use crate::render::kernel::{ShaderError, plain_source};
use crate::render::layouts::*;
use crate::render::targets::Targets;

/// The pass.
#[derive(Debug)]
pub struct FarthestPass {
    pipeline: ComputePipeline,
    scene: BindGroup,
    targets: BindGroupLayout,
}

impl FarthestPass {
    /// Builds the kernel.
    pub fn new(device: &wgpu::Device, layouts: &Layouts) -> Result<Self, ShaderError> {
        let stage = ShaderStages::COMPUTE;
        let entries = [read_texture(false), write_texture(TextureFormat::R32Float)];
        let targets = layout(device, "farthest targets", &[entry(0, stage, entries[0]), entry(1, stage, entries[1])]);
        let nothing = layout(device, "nothing", &[]);
        let groups = [&layouts.view, &nothing, &targets, &layouts.work];
        let pipeline = compute_pipeline(device, "farthest", plain_source("farthest.wgsl")?, "farthest", &groups);
        Ok(Self { pipeline, scene: bind(device, "nothing", &nothing, &[]), targets })
    }

    /// The pass's own bind group.
    pub fn bind(&self, device: &wgpu::Device, targets: &Targets) -> BindGroup {
        let resources = [&targets.depth, &targets.farthest].map(|t| wgpu::BindingResource::TextureView(&t.view));
        bind(device, "farthest targets", &self.targets, &resources)
    }

    /// The kernel.
    pub fn pipeline(&self) -> &ComputePipeline {
        &self.pipeline
    }

    /// Group 1, which is empty.
    pub fn scene(&self) -> &BindGroup {
        &self.scene
    }
}
