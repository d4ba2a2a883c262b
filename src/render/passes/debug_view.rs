//! Pass `debug_view`: what was found or counted, as colors over the finished picture; only where a view mode is asked for.

use bytemuck::{Pod, Zeroable};
use wgpu::{BindGroup, BindGroupLayout, ComputePipeline, ShaderStages, TextureFormat};

use crate::flat::FlatScene;
use crate::flat::debug_view::{DepthRange, ViewMode, id_color};
use crate::render::frame::plan::TILE;
use crate::render::resources::buffers::SyncedBuffer;
use crate::render::resources::layouts::*;
use crate::render::resources::targets::Targets;
use crate::render::wgsl::{ShaderError, assemble_plain};

/// What the shader reads.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct DebugView {
    /// The number of the [`ViewMode`].
    pub view_mode: u32,
    /// Counts above this, or distances from here on, have the last color.
    pub top: f32,
    /// Distances up to here have the first color, in meters.
    pub bottom: f32,
    /// Distance between two lines of equal distance, in meters.
    pub spacing: f32,
    /// Where the colors of the meshes begin.
    pub first_mesh: u32,
    /// Where the colors of the components begin.
    pub first_component: u32,
    /// Unused.
    pub padding_0: u32,
    /// Unused.
    pub padding_1: u32,
}

/// The pass.
#[derive(Debug)]
pub struct DebugViewPass {
    pipeline: ComputePipeline,
    own: BindGroupLayout,
    targets: BindGroupLayout,
    uniform: SyncedBuffer,
    colors: SyncedBuffer,
}

impl DebugViewPass {
    /// Builds the pipeline.
    ///
    /// # Errors
    /// A shader file is missing.
    pub fn new(device: &wgpu::Device, layouts: &Layouts) -> Result<Self, ShaderError> {
        let numbered = |types: &[wgpu::BindingType]| -> Vec<_> {
            types.iter().enumerate().map(|(i, ty)| entry(i as u32, ShaderStages::COMPUTE, *ty)).collect()
        };
        let own = layout(device, "debug view", &numbered(&[uniform(false), read_storage(), read_storage()]));
        let types = [
            read_texture(false),
            read_texture(false),
            read_texture(true),
            read_texture(true),
            write_texture(TextureFormat::Rgba8Unorm),
        ];
        let targets = layout(device, "debug view targets", &numbered(&types));
        let groups = [&layouts.view, &own, &targets];
        let pipeline =
            compute_pipeline(device, "debug view", assemble_plain("debug_view.wgsl")?, "debug_view", &groups);
        let (uniform, colors) =
            (SyncedBuffer::uniform(device, "debug view"), SyncedBuffer::storage(device, "debug view colors"));
        Ok(Self { pipeline, own, targets, uniform, colors })
    }

    /// Uploads what the view mode needs; distances are colored within `depth_range`.
    pub fn prepare(
        &mut self,
        gpu: (&wgpu::Device, &wgpu::Queue),
        flat: &FlatScene,
        view_mode: ViewMode,
        depth_range: &DepthRange,
    ) {
        let (device, queue) = gpu;
        let top = if view_mode == ViewMode::Distance { depth_range.top as f32 } else { view_mode.top() };
        let first_mesh = flat.ids.len() as u32;
        let debug_view = DebugView {
            view_mode: view_mode as u32,
            top,
            bottom: depth_range.bottom as f32,
            spacing: depth_range.spacing as f32,
            first_mesh,
            first_component: first_mesh + flat.meshes.len() as u32,
            padding_0: 0,
            padding_1: 0,
        };
        self.uniform.set(device, queue, bytemuck::bytes_of(&debug_view));
        if matches!(view_mode, ViewMode::Nodes | ViewMode::Components) {
            let components = flat.components.iter().map(|c| flat.ids[c.first as usize]);
            let ids = flat.ids.iter().copied().chain(flat.meshes.iter().map(|m| m.id)).chain(components);
            let colors: Vec<[u8; 4]> = ids.map(|id| id_color(id.0)).map(|[r, g, b]| [r, g, b, 255]).collect();
            self.colors.set(device, queue, bytemuck::cast_slice(&colors));
        }
    }

    /// Writes over `targets.color`. `counts` is the buffer of counts.
    pub fn record(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        targets: &Targets,
        view: &BindGroup,
        counts: &wgpu::Buffer,
    ) {
        let own = [self.uniform.binding(), counts.as_entire_binding(), self.colors.binding()];
        let own = bind(device, "debug view", &self.own, &own);
        let textures = [&targets.depth, &targets.normal, &targets.visibility, &targets.leaf, &targets.color];
        let textures = textures.map(|t| wgpu::BindingResource::TextureView(&t.view));
        let textures = bind(device, "debug view targets", &self.targets, &textures);
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, view, &[]);
        pass.set_bind_group(1, &own, &[]);
        pass.set_bind_group(2, &textures, &[]);
        let [x, y] = targets.size.map(|side| side.div_ceil(TILE));
        pass.dispatch_workgroups(x, y, 1);
    }
}
