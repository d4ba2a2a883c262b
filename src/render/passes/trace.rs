//! Pass `trace`: a component against the depth target. Interpreted; built for [`Features`].

use wgpu::{BindGroup, BindGroupLayout, ComputePipeline, ShaderStages, TextureFormat};

use crate::render::layouts::*;
use crate::render::shader::{Features, ShaderError, source};
use crate::render::targets::Targets;

/// The pass.
#[derive(Debug)]
pub struct TracePass {
    pipeline: ComputePipeline,
    targets: BindGroupLayout,
}

impl TracePass {
    /// Builds the kernel.
    pub fn new(device: &wgpu::Device, layouts: &Layouts, features: &Features) -> Result<Self, ShaderError> {
        let stage = ShaderStages::COMPUTE;
        let targets = layout(
            device,
            "trace targets",
            &[
                entry(0, stage, read_write_texture(TextureFormat::R32Float)),
                entry(1, stage, write_texture(TextureFormat::R32Uint)),
                entry(2, stage, read_write_texture(TextureFormat::R32Float)),
                entry(3, stage, write_storage()),
            ],
        );
        let groups = [&layouts.view, &layouts.scene, &targets, &layouts.work];
        let pipeline = compute_pipeline(device, "trace", source("trace.wgsl", features)?, "trace", &groups);
        Ok(Self { pipeline, targets })
    }

    /// The pass's own bind group.
    pub fn bind(&self, device: &wgpu::Device, targets: &Targets, unfinished: &wgpu::Buffer) -> BindGroup {
        let view = wgpu::BindingResource::TextureView;
        let resources = [
            view(&targets.depth.view),
            view(&targets.owner.view),
            view(&targets.march.view),
            unfinished.as_entire_binding(),
        ];
        bind(device, "trace targets", &self.targets, &resources)
    }

    /// The kernel.
    pub fn pipeline(&self) -> &ComputePipeline {
        &self.pipeline
    }
}
