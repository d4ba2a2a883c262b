//! The passes that evaluate a component: `cone`, `trace`, `surface`. One pipeline holds all three, built
//! for one [`Evaluator`].

use std::sync::atomic::{AtomicU32, Ordering};

use wgpu::{BindGroup, BindGroupLayout, ComputePipeline, ShaderStages, TextureFormat};

use crate::render::resources::layouts::*;
use crate::render::resources::targets::Targets;
use crate::render::wgsl::{Evaluator, Options, ShaderError, assemble};

/// The pipelines of one evaluator.
#[derive(Debug)]
pub struct FieldPipelines {
    /// Which subtiles of the picture a component touches, and from where on.
    pub cone: ComputePipeline,
    /// Hits within these subtiles.
    pub trace: ComputePipeline,
    /// Normal, material and leaf of the hits.
    pub surface: ComputePipeline,
    /// One bit for each pass that was dispatched.
    used: AtomicU32,
}

impl FieldPipelines {
    /// Marks a pass as dispatched; true the first time.
    pub fn first_use(&self, pass: usize) -> bool {
        let bit = 1 << pass;
        self.used.fetch_or(bit, Ordering::Relaxed) & bit == 0
    }
}

/// Layouts of the targets of the three passes.
#[derive(Debug)]
pub struct FieldLayouts {
    cone: BindGroupLayout,
    trace: BindGroupLayout,
    surface: BindGroupLayout,
}

/// Bind groups for the targets of the three passes.
#[derive(Debug)]
pub struct FieldGroups {
    /// Of [`FieldPipelines::cone`].
    pub cone: BindGroup,
    /// Of [`FieldPipelines::trace`].
    pub trace: BindGroup,
    /// The same where the rays that are left are dispatched: what says how many must not be written then.
    pub compacted: BindGroup,
    /// Of [`FieldPipelines::surface`].
    pub surface: BindGroup,
}

/// Buffers that the passes hand on to each other.
#[derive(Clone, Copy, Debug)]
pub struct FieldBuffers<'a> {
    /// Subtiles that the cones have left, list after list; then those with hits.
    pub subtiles: &'a wgpu::Buffer,
    /// For each list the arguments of its indirect dispatch, and how many there are.
    pub subtile_counts: &'a wgpu::Buffer,
    /// Pixels whose march goes on, list after list.
    pub rays: &'a wgpu::Buffer,
    /// For each list the arguments of its indirect dispatches over these, and over subtiles with hits.
    pub ray_counts: &'a wgpu::Buffer,
    /// Any other buffer.
    pub nothing: &'a wgpu::Buffer,
    /// What was counted: see `shaders/common/counts.wgsl`.
    pub march_counts: &'a wgpu::Buffer,
}

impl FieldLayouts {
    /// Makes them.
    pub fn new(device: &wgpu::Device) -> Self {
        let numbered = |types: &[wgpu::BindingType]| -> Vec<_> {
            let stage = ShaderStages::COMPUTE;
            types.iter().enumerate().map(|(i, ty)| entry(i as u32, stage, *ty)).collect()
        };
        let cone = [read_texture(false), write_storage(), write_storage(), write_storage()];
        let trace = [
            read_write_texture(TextureFormat::R32Float),
            write_texture(TextureFormat::R32Uint),
            read_write_texture(TextureFormat::R32Float),
            write_texture(TextureFormat::R32Float),
            write_storage(),
            write_storage(),
            write_storage(),
            write_storage(),
            read_storage(),
        ];
        let surface = [
            read_texture(false),
            read_texture(true),
            write_texture(TextureFormat::Rgba32Float),
            write_texture(TextureFormat::Rgba16Float),
            write_texture(TextureFormat::Rgba16Float),
            write_texture(TextureFormat::R32Uint),
            read_storage(),
            read_storage(),
        ];
        Self {
            cone: layout(device, "cone targets", &numbered(&cone)),
            trace: layout(device, "trace targets", &numbered(&trace)),
            surface: layout(device, "surface targets", &numbered(&surface)),
        }
    }

    /// Builds the pipeline of an evaluator.
    ///
    /// # Errors
    /// A shader file is missing. What the driver thinks of the source is reported to the device.
    pub fn build(
        &self,
        device: &wgpu::Device,
        layouts: &Layouts,
        evaluator: &Evaluator,
        options: Options,
    ) -> Result<FieldPipelines, ShaderError> {
        let pipeline = |name: &str, entry_point: &str, targets: &BindGroupLayout| {
            let groups = [&layouts.view, &layouts.scene, targets, &layouts.dispatch_params];
            let text = assemble(&format!("{name}.wgsl"), evaluator, options)?;
            Ok(compute_pipeline(device, name, text, entry_point, &groups))
        };
        Ok(FieldPipelines {
            cone: pipeline("cone", "cone", &self.cone)?,
            trace: pipeline("trace", "trace", &self.trace)?,
            surface: pipeline("surface", "surface_pass", &self.surface)?,
            used: AtomicU32::new(0),
        })
    }

    /// Binds the targets.
    pub fn bind(&self, device: &wgpu::Device, targets: &Targets, lists: FieldBuffers<'_>) -> FieldGroups {
        let texture = wgpu::BindingResource::TextureView;
        let cone = [
            texture(&targets.hiz.view),
            lists.subtiles.as_entire_binding(),
            lists.subtile_counts.as_entire_binding(),
            lists.march_counts.as_entire_binding(),
        ];
        let trace = [
            texture(&targets.depth.view),
            texture(&targets.visibility.view),
            texture(&targets.march.view),
            texture(&targets.hiz.view),
            lists.subtiles.as_entire_binding(),
            lists.march_counts.as_entire_binding(),
            lists.rays.as_entire_binding(),
            lists.ray_counts.as_entire_binding(),
            lists.subtile_counts.as_entire_binding(),
        ];
        let mut compacted = trace.clone();
        compacted[7] = lists.nothing.as_entire_binding();
        let surface = [
            texture(&targets.depth.view),
            texture(&targets.visibility.view),
            texture(&targets.normal.view),
            texture(&targets.diffuse.view),
            texture(&targets.emission.view),
            texture(&targets.leaf.view),
            lists.subtiles.as_entire_binding(),
            lists.ray_counts.as_entire_binding(),
        ];
        FieldGroups {
            cone: bind(device, "cone targets", &self.cone, &cone),
            trace: bind(device, "trace targets", &self.trace, &trace),
            compacted: bind(device, "trace targets", &self.trace, &compacted),
            surface: bind(device, "surface targets", &self.surface, &surface),
        }
    }
}
