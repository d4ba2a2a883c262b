//! The pipelines of the passes that evaluate a component, `cone`, `trace` and `surface`, all three for one [`Evaluator`], and
//! what these passes bind.

use std::sync::atomic::{AtomicU32, Ordering};

use wgpu::{BindGroup, BindGroupLayout, ComputePipeline, TextureFormat};

use crate::recipe::Pass;
use crate::resources::layouts::*;
use crate::resources::targets::Targets;
use isolith_wgsl::{Evaluator, Options, ShaderError, assemble};

bindings! {
    /// Group 2 of the cone pass.
    ConeBindings, "cone targets", COMPUTE {
        hiz: read_texture(false),
        subtiles: write_storage(),
        subtile_counts: write_storage(),
        march_counts: write_storage(),
    }
}

bindings! {
    /// Group 2 of the trace pass.
    TraceBindings, "trace targets", COMPUTE {
        depth: read_write_texture(TextureFormat::R32Float),
        visibility: write_texture(TextureFormat::R32Uint),
        march: read_write_texture(TextureFormat::R32Float),
        hiz: write_texture(TextureFormat::R32Float),
        subtiles: write_storage(),
        march_counts: write_storage(),
        rays: write_storage(),
        ray_counts: write_storage(),
        subtile_counts: read_storage(),
    }
}

bindings! {
    /// Group 2 of the surface pass.
    SurfaceBindings, "surface targets", COMPUTE {
        depth: read_texture(false),
        visibility: read_texture(true),
        normal: write_texture(TextureFormat::Rgba32Float),
        material: write_texture(TextureFormat::Rgba32Uint),
        leaf: write_texture(TextureFormat::R32Uint),
        subtiles: read_storage(),
        ray_counts: read_storage(),
    }
}

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
    /// The passes that it has a pipeline for.
    pub const STAGES: [Pass; 3] = [Pass::Cone, Pass::Trace, Pass::Surface];

    /// Its pipeline for one of these.
    pub fn pipeline(&self, stage: Pass) -> &ComputePipeline {
        match stage {
            Pass::Cone => &self.cone,
            Pass::Trace => &self.trace,
            Pass::Surface => &self.surface,
            _ => unreachable!("{stage:?} evaluates no field"),
        }
    }

    /// Marks a pass as dispatched; true the first time.
    pub fn first_use(&self, pass: usize) -> bool {
        let bit = 1 << pass;
        self.used.fetch_or(bit, Ordering::Relaxed) & bit == 0
    }
}

/// Layouts of the targets of the three passes.
#[derive(Clone, Debug)]
pub struct FieldLayouts {
    cone: BindGroupLayout,
    trace: BindGroupLayout,
    surface: BindGroupLayout,
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
        Self {
            cone: ConeBindings::layout(device),
            trace: TraceBindings::layout(device),
            surface: SurfaceBindings::layout(device),
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
        let pipeline = |stage: Pass, entry_point: &str, targets: &BindGroupLayout| {
            let groups = [&layouts.view, &layouts.scene, targets, &layouts.dispatch_params];
            let text = assemble(stage.file(), evaluator, options)?;
            Ok(compute_pipeline(device, stage.label(), text, entry_point, &groups))
        };
        Ok(FieldPipelines {
            cone: pipeline(Pass::Cone, "cone", &self.cone)?,
            trace: pipeline(Pass::Trace, "trace", &self.trace)?,
            surface: pipeline(Pass::Surface, "surface_pass", &self.surface)?,
            used: AtomicU32::new(0),
        })
    }

    /// Binds what the cone pass works on.
    pub fn bind_cone(&self, device: &wgpu::Device, targets: &Targets, lists: FieldBuffers<'_>) -> BindGroup {
        let group = ConeBindings {
            hiz: targets.hiz.binding(),
            subtiles: lists.subtiles.as_entire_binding(),
            subtile_counts: lists.subtile_counts.as_entire_binding(),
            march_counts: lists.march_counts.as_entire_binding(),
        };
        group.bind(device, &self.cone)
    }

    /// Binds what the trace pass works on; then the same where the rays that are left are dispatched: what says how many
    /// must not be written then.
    pub fn bind_trace(&self, device: &wgpu::Device, targets: &Targets, lists: FieldBuffers<'_>) -> [BindGroup; 2] {
        [lists.ray_counts, lists.nothing].map(|ray_counts| {
            let group = TraceBindings {
                depth: targets.depth.binding(),
                visibility: targets.visibility.binding(),
                march: targets.march.binding(),
                hiz: targets.hiz.binding(),
                subtiles: lists.subtiles.as_entire_binding(),
                march_counts: lists.march_counts.as_entire_binding(),
                rays: lists.rays.as_entire_binding(),
                ray_counts: ray_counts.as_entire_binding(),
                subtile_counts: lists.subtile_counts.as_entire_binding(),
            };
            group.bind(device, &self.trace)
        })
    }

    /// Binds what the surface pass works on.
    pub fn bind_surface(&self, device: &wgpu::Device, targets: &Targets, lists: FieldBuffers<'_>) -> BindGroup {
        let group = SurfaceBindings {
            depth: targets.depth.binding(),
            visibility: targets.visibility.binding(),
            normal: targets.normal.binding(),
            material: targets.material.binding(),
            leaf: targets.leaf.binding(),
            subtiles: lists.subtiles.as_entire_binding(),
            ray_counts: lists.ray_counts.as_entire_binding(),
        };
        group.bind(device, &self.surface)
    }
}
