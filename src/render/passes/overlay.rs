//! Pass `overlay`: grid and outline of the selection, over the finished picture; only the editor asks for it.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;
use wgpu::{BindGroup, BindGroupLayout, ShaderStages, TextureFormat};

use crate::flat::FlatScene;
use crate::render::buffers::Mirror;
use crate::render::kernel::{ShaderError, plain_source};
use crate::render::layouts::*;
use crate::render::targets::Targets;
use crate::scene::NodeId;

/// What is drawn over the picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OverlaySettings {
    /// A grid on the ground.
    pub grid: bool,
    /// An outline around these nodes.
    pub outline: Vec<NodeId>,
}

impl OverlaySettings {
    /// Whether there is nothing to draw.
    pub fn is_empty(&self) -> bool {
        !self.grid && self.outline.is_empty()
    }
}

/// What the shader reads.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Overlay {
    /// The eye, its x and z reduced to one coarse cell.
    pub eye: [f32; 3],
    /// Side of a fine cell, in metres.
    pub cell: f32,
    /// 1 to draw the grid.
    pub grid: u32,
    /// 1 to draw the outline.
    pub outline: u32,
    /// Where the X axis runs in the reduced grid.
    pub axis_x: f32,
    /// Where the Z axis runs in the reduced grid.
    pub axis_z: f32,
    /// Bits before those of the meshes.
    pub leaf_count: u32,
    /// Unused.
    pub padding_0: u32,
    /// Unused.
    pub padding_1: u32,
    /// Unused.
    pub padding_2: u32,
}

/// The pass.
#[derive(Debug)]
pub struct OverlayPass {
    pipeline: wgpu::RenderPipeline,
    own: BindGroupLayout,
    targets: BindGroupLayout,
    uniform: Mirror,
    selected: Mirror,
    own_group: Option<BindGroup>,
}

impl OverlayPass {
    /// Builds the pipeline.
    pub fn new(device: &wgpu::Device, layouts: &Layouts) -> Result<Self, ShaderError> {
        let stage = ShaderStages::FRAGMENT;
        let own = layout(device, "overlay", &[entry(0, stage, uniform(false)), entry(1, stage, read_storage())]);
        let targets = layout(
            device,
            "overlay targets",
            &[entry(0, stage, read_texture(false)), entry(1, stage, read_texture(true))],
        );
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("overlay"),
            source: wgpu::ShaderSource::Wgsl(plain_source("overlay.wgsl")?.into()),
        });
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("overlay"),
            layout: Some(&pipeline_layout(device, "overlay", &[&layouts.view, &own, &targets])),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("overlay_vertex"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: None,
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("overlay_fragment"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &[Some(wgpu::ColorTargetState {
                    format: TextureFormat::Rgba8Unorm,
                    blend: Some(wgpu::BlendState::ALPHA_BLENDING),
                    write_mask: wgpu::ColorWrites::COLOR,
                })],
            }),
            multiview_mask: None,
            cache: None,
        });
        let uniform = Mirror::uniform(device, "overlay");
        let selected = Mirror::storage(device, "selected");
        Ok(Self { pipeline, own, targets, uniform, selected, own_group: None })
    }

    /// Uploads what is to be drawn, seen from `eye`, `distance` away from what is looked at.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        flat: &FlatScene,
        settings: &OverlaySettings,
        eye: DVec3,
    ) {
        // The cell follows the eye's height in powers of ten.
        let cell = 10.0_f64.powf(eye.y.abs().max(1e-3).log10().floor()) * 0.1;
        let period = cell * 100.0;
        let reduced = DVec3::new(eye.x.rem_euclid(period), eye.y, eye.z.rem_euclid(period));
        let overlay = Overlay {
            eye: reduced.as_vec3().to_array(),
            cell: cell as f32,
            grid: u32::from(settings.grid),
            outline: u32::from(!settings.outline.is_empty()),
            axis_x: (reduced.z - eye.z) as f32,
            axis_z: (reduced.x - eye.x) as f32,
            leaf_count: flat.nodes.len() as u32,
            padding_0: 0,
            padding_1: 0,
            padding_2: 0,
        };
        let changed = self.uniform.set(device, queue, bytemuck::bytes_of(&overlay));
        let bits = selected_bits(flat, &settings.outline);
        let changed = self.selected.set(device, queue, bytemuck::cast_slice(&bits)) || changed;
        if changed || self.own_group.is_none() {
            let resources = [self.uniform.binding(), self.selected.binding()];
            self.own_group = Some(bind(device, "overlay", &self.own, &resources));
        }
    }

    /// Draws over `targets.color`.
    pub fn record(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        targets: &Targets,
        view: &BindGroup,
    ) {
        let Some(own) = &self.own_group else { return };
        let inputs = [&targets.depth, &targets.leaf].map(|t| wgpu::BindingResource::TextureView(&t.view));
        let inputs = bind(device, "overlay targets", &self.targets, &inputs);
        let ops = wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store };
        let view_of = &targets.color.view;
        let color = wgpu::RenderPassColorAttachment { view: view_of, depth_slice: None, resolve_target: None, ops };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("overlay"),
            color_attachments: &[Some(color)],
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, view, &[]);
        pass.set_bind_group(1, own, &[]);
        pass.set_bind_group(2, &inputs, &[]);
        pass.draw(0..3, 0..1);
    }
}

/// One bit for each entry of the subtree-extent array, then one for each mesh.
fn selected_bits(flat: &FlatScene, outline: &[NodeId]) -> Vec<u32> {
    let selected: std::collections::HashSet<NodeId> = outline.iter().copied().collect();
    let ids = flat.ids.iter().chain(flat.meshes.iter().map(|m| &m.id));
    let mut bits = vec![0_u32; (flat.nodes.len() + flat.meshes.len()).div_ceil(32).max(1)];
    if !selected.is_empty() {
        for (i, _) in ids.enumerate().filter(|(_, id)| selected.contains(id)) {
            bits[i / 32] |= 1 << (i % 32);
        }
    }
    bits
}
