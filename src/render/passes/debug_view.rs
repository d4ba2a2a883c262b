//! Pass `debug_view`: hits or counts as colors over the finished picture. It runs only if a view mode asks for it.

use std::ops::Range;

use bytemuck::{Pod, Zeroable};
use wgpu::{BindGroup, BindGroupLayout, ComputePipeline, TextureFormat};

use super::frame_pass::{Building, FramePass};
use crate::frame::rect::TILE;
use crate::recipe::Pass;
use crate::renderer::recorder::Recorder;
use crate::renderer::resources::Bound;
use crate::resources::buffers::SyncedBuffer;
use crate::resources::layouts::*;
use isolith_field::FlatScene;
use isolith_field::debug_view::{DepthRange, ViewMode, id_color};
use isolith_wgsl::{ShaderError, assemble_plain};

bindings! {
    /// Group 1.
    DebugViewBindings, "debug view", COMPUTE {
        settings: uniform(false),
        counted: read_storage(),
        colors: read_storage(),
    }
}

bindings! {
    /// Group 2.
    DebugViewTargets, "debug view targets", COMPUTE {
        depth: read_texture(false),
        normal: read_texture(false),
        visibility: read_texture(true),
        leaf: read_texture(true),
        color: write_texture(TextureFormat::Rgba8Unorm),
    }
}

/// Parameters of the shader.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct DebugView {
    /// Code of the [`ViewMode`].
    pub view_mode: u32,
    /// Counts above this, and distances from here on, have the last color.
    pub top: f32,
    /// Distances up to here have the first color, in meters.
    pub bottom: f32,
    /// Spacing of the isolines, in meters.
    pub spacing: f32,
    /// Index of the first mesh color.
    pub first_mesh: u32,
    /// Index of the first component color.
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
    /// Uploads the data of the view mode. Colors of distances span `depth_range`.
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
}

impl FramePass for DebugViewPass {
    fn new(Building { device, layouts, .. }: Building<'_>) -> Result<Self, ShaderError> {
        let (own, targets) = (DebugViewBindings::layout(device), DebugViewTargets::layout(device));
        let (text, groups) = (assemble_plain(Pass::DebugView.file())?, [&layouts.view, &own, &targets]);
        let pipeline = compute_pipeline(device, Pass::DebugView.label(), text, "debug_view", &groups);
        let (uniform, colors) =
            (SyncedBuffer::uniform(device, "debug view"), SyncedBuffer::storage(device, "debug view colors"));
        Ok(Self { pipeline, own, targets, uniform, colors })
    }

    fn bind(&self, device: &wgpu::Device, bound: &Bound<'_>) -> Vec<BindGroup> {
        let textures = DebugViewTargets {
            depth: bound.targets.depth.binding(),
            normal: bound.targets.normal.binding(),
            visibility: bound.targets.visibility.binding(),
            leaf: bound.targets.leaf.binding(),
            color: bound.targets.color.binding(),
        };
        vec![textures.bind(device, &self.targets)]
    }

    fn record(&self, recorder: &mut Recorder<'_>, _: Range<usize>) {
        if recorder.frame.view_mode == ViewMode::Shaded {
            return;
        }
        // The view mode's data are uploaded on request, after the frame has bound its groups.
        let own = DebugViewBindings {
            settings: self.uniform.binding(),
            counted: recorder.resources.counts.buffer().as_entire_binding(),
            colors: self.colors.binding(),
        };
        let own = own.bind(&recorder.gpu.device, &self.own);
        let ([_, textures], size) = (recorder.groups(0), recorder.targets.size);
        let pass = recorder.open();
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(1, &own, &[]);
        pass.set_bind_group(2, textures, &[]);
        let [x, y] = size.map(|side| side.div_ceil(TILE));
        pass.dispatch_workgroups(x, y, 1);
    }
}
