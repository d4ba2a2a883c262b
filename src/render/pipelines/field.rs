//! The pipelines of the passes that evaluate a component (`cone`, `trace`, `surface`), all three for one [`Evaluator`],
//! and the bindings of these passes.

use std::sync::atomic::{AtomicU32, Ordering};

use wgpu::{BindGroup, BindGroupLayout, ComputePipeline, TextureFormat};

use super::field_buffers::FieldBuffers;
use crate::pipelines::veiled::VeiledLayouts;
use crate::recipe::Pass;
use crate::resources::layouts::*;
use crate::resources::targets::Targets;
use isolith_wgsl::{Evaluator, Options, ShaderError, Veil, assemble};

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
    /// Group 2 of the trace pass over copies.
    TraceCopiesBindings, "trace targets with copies", COMPUTE {
        depth: read_write_texture(TextureFormat::R32Float),
        visibility: write_texture(TextureFormat::R32Uint),
        march: read_write_texture(TextureFormat::R32Float),
        hiz: write_texture(TextureFormat::R32Float),
        subtiles: write_storage(),
        march_counts: write_storage(),
        rays: write_storage(),
        ray_counts: write_storage(),
        subtile_counts: read_storage(),
        copied: write_storage(),
    }
}

bindings! {
    /// Group 2 of the surface pass over copies.
    SurfaceCopiesBindings, "surface targets with copies", COMPUTE {
        depth: read_texture(false),
        visibility: read_texture(true),
        normal: write_texture(TextureFormat::Rgba32Float),
        material: write_texture(TextureFormat::Rgba32Uint),
        leaf: write_texture(TextureFormat::R32Uint),
        subtiles: read_storage(),
        ray_counts: read_storage(),
        copied: write_storage(),
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
    /// Finds the subtiles that a component touches, and the distance at which rays start there.
    pub cone: ComputePipeline,
    /// Finds hits within these subtiles.
    pub trace: ComputePipeline,
    /// Computes normal, material and leaf of the hits.
    pub surface: ComputePipeline,
    /// Whether they draw types of instancers.
    pub copies: bool,
    /// What rays may pass.
    pub veil: Veil,
    /// One bit for each pass that has been dispatched.
    used: AtomicU32,
}

impl FieldPipelines {
    /// The passes with a pipeline here.
    pub const STAGES: [Pass; 3] = [Pass::Cone, Pass::Trace, Pass::Surface];

    /// The pipeline of one of these passes.
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

/// The shader of a pass. The cone pass over copies evaluates nothing and has a file of its own.
pub fn field_file(stage: Pass, options: Options) -> &'static str {
    if options.copies && stage == Pass::Cone { "copy/cone.wgsl" } else { stage.file() }
}

/// The first own bind group of a pass for pipelines for types of instancers, and for those that rays may pass.
pub fn own_of(pass: Pass, copies: bool, veil: Veil) -> usize {
    match pass {
        Pass::Trace => 4 * usize::from(veil != Veil::None) + 2 * usize::from(copies),
        Pass::Surface => usize::from(copies),
        _ => 0,
    }
}

/// Layouts of the targets of the three passes.
#[derive(Clone, Debug)]
pub struct FieldLayouts {
    cone: BindGroupLayout,
    trace: BindGroupLayout,
    surface: BindGroupLayout,
    trace_copies: BindGroupLayout,
    surface_copies: BindGroupLayout,
    veiled: VeiledLayouts,
}

impl FieldLayouts {
    /// Creates the layouts.
    pub fn new(device: &wgpu::Device) -> Self {
        Self {
            cone: ConeBindings::layout(device),
            trace: TraceBindings::layout(device),
            surface: SurfaceBindings::layout(device),
            trace_copies: TraceCopiesBindings::layout(device),
            surface_copies: SurfaceCopiesBindings::layout(device),
            veiled: VeiledLayouts::new(device),
        }
    }

    /// Builds the pipelines of an evaluator.
    ///
    /// # Errors
    /// A shader file is missing. The device reports what the driver rejects in the source.
    pub fn build(
        &self,
        device: &wgpu::Device,
        layouts: &Layouts,
        evaluator: &Evaluator,
        options: Options,
    ) -> Result<FieldPipelines, ShaderError> {
        let pipeline = |stage: Pass, entry_point: &str, targets: &BindGroupLayout| {
            let scene = if options.copies { &layouts.copies } else { &layouts.scene };
            let groups = [&layouts.view, scene, targets, &layouts.dispatch_params];
            let text = assemble(field_file(stage, options), evaluator, options)?;
            Ok(compute_pipeline(device, stage.label(), text, entry_point, &groups))
        };
        Ok(FieldPipelines {
            cone: pipeline(Pass::Cone, "cone", &self.cone)?,
            trace: pipeline(Pass::Trace, "trace", self.of_trace(options))?,
            surface: pipeline(
                Pass::Surface,
                "surface_pass",
                if options.copies { &self.surface_copies } else { &self.surface },
            )?,
            copies: options.copies,
            veil: options.veil,
            used: AtomicU32::new(0),
        })
    }

    /// The layout of the targets of the trace pass.
    fn of_trace(&self, options: Options) -> &BindGroupLayout {
        match (options.veil, options.copies) {
            (Veil::None, false) => &self.trace,
            (Veil::None, true) => &self.trace_copies,
            (veil, copies) => self.veiled.layout(veil, copies),
        }
    }

    /// Those for components that rays may pass.
    pub fn veiled(&self) -> &VeiledLayouts {
        &self.veiled
    }

    /// Bind group of the cone pass.
    pub fn bind_cone(&self, device: &wgpu::Device, targets: &Targets, lists: FieldBuffers<'_>) -> BindGroup {
        let group = ConeBindings {
            hiz: targets.hiz.binding(),
            subtiles: lists.subtiles.as_entire_binding(),
            subtile_counts: lists.subtile_counts.as_entire_binding(),
            march_counts: lists.march_counts.as_entire_binding(),
        };
        group.bind(device, &self.cone)
    }

    /// Bind groups of the trace pass: the usual one, and one for dispatches over the unfinished rays, which must not
    /// write the buffer that holds their indirect arguments.
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

    /// Bind groups of the trace pass over copies, like [`Self::bind_trace`].
    pub fn bind_trace_copies(
        &self,
        device: &wgpu::Device,
        targets: &Targets,
        lists: FieldBuffers<'_>,
        copied: &wgpu::Buffer,
    ) -> [BindGroup; 2] {
        [lists.ray_counts, lists.nothing].map(|ray_counts| {
            let group = TraceCopiesBindings {
                depth: targets.depth.binding(),
                visibility: targets.visibility.binding(),
                march: targets.march.binding(),
                hiz: targets.hiz.binding(),
                subtiles: lists.subtiles.as_entire_binding(),
                march_counts: lists.march_counts.as_entire_binding(),
                rays: lists.rays.as_entire_binding(),
                ray_counts: ray_counts.as_entire_binding(),
                subtile_counts: lists.subtile_counts.as_entire_binding(),
                copied: copied.as_entire_binding(),
            };
            group.bind(device, &self.trace_copies)
        })
    }

    /// Bind group of the surface pass over copies.
    pub fn bind_surface_copies(
        &self,
        device: &wgpu::Device,
        targets: &Targets,
        lists: FieldBuffers<'_>,
        copied: &wgpu::Buffer,
    ) -> BindGroup {
        let group = SurfaceCopiesBindings {
            depth: targets.depth.binding(),
            visibility: targets.visibility.binding(),
            normal: targets.normal.binding(),
            material: targets.material.binding(),
            leaf: targets.leaf.binding(),
            subtiles: lists.subtiles.as_entire_binding(),
            ray_counts: lists.ray_counts.as_entire_binding(),
            copied: copied.as_entire_binding(),
        };
        group.bind(device, &self.surface_copies)
    }

    /// Bind group of the surface pass.
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
