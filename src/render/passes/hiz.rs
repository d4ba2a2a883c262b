//! Pass `hiz`: the farthest depth in each subtile after the meshes; only where there are meshes.

use wgpu::{BindGroup, BindGroupLayout, ComputePipeline, ShaderStages, TextureFormat};

use crate::render::resources::layouts::*;
use crate::render::resources::targets::Targets;
use crate::render::wgsl::{ShaderError, assemble_plain};

/// The pass.
#[derive(Debug)]
pub struct HizPass {
    pipeline: ComputePipeline,
    scene: BindGroup,
    targets: BindGroupLayout,
}

impl HizPass {
    /// Builds the pipeline.
    pub fn new(device: &wgpu::Device, layouts: &Layouts) -> Result<Self, ShaderError> {
        let stage = ShaderStages::COMPUTE;
        let entries = [read_texture(false), write_texture(TextureFormat::R32Float)];
        let targets = layout(device, "hiz targets", &[entry(0, stage, entries[0]), entry(1, stage, entries[1])]);
        let nothing = layout(device, "nothing", &[]);
        let groups = [&layouts.view, &nothing, &targets, &layouts.dispatch_params];
        let pipeline = compute_pipeline(device, "hiz", assemble_plain("hiz.wgsl")?, "hiz", &groups);
        Ok(Self { pipeline, scene: bind(device, "nothing", &nothing, &[]), targets })
    }

    /// The pass's own bind group.
    pub fn bind(&self, device: &wgpu::Device, targets: &Targets) -> BindGroup {
        let resources = [&targets.depth, &targets.hiz].map(|t| wgpu::BindingResource::TextureView(&t.view));
        bind(device, "hiz targets", &self.targets, &resources)
    }

    /// The pipeline.
    pub fn pipeline(&self) -> &ComputePipeline {
        &self.pipeline
    }

    /// Group 1, which is empty.
    pub fn scene(&self) -> &BindGroup {
        &self.scene
    }
}
