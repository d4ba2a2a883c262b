//! Pass `inspect`: what was found or counted, as colours over the finished picture; only where a look is asked for.

use bytemuck::{Pod, Zeroable};
use wgpu::{BindGroup, BindGroupLayout, ComputePipeline, ShaderStages, TextureFormat};

use crate::flat::FlatScene;
use crate::flat::inspect::{Look, Span, id_color};
use crate::render::buffers::Mirror;
use crate::render::kernel::{ShaderError, plain_source};
use crate::render::layouts::*;
use crate::render::schedule::TILE;
use crate::render::targets::Targets;

/// What the shader reads.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Inspect {
    /// The number of the [`Look`].
    pub look: u32,
    /// Counts above this, or distances from here on, have the last colour.
    pub top: f32,
    /// Distances up to here have the first colour, in metres.
    pub bottom: f32,
    /// Distance between two lines of equal distance, in metres.
    pub spacing: f32,
    /// Where the colours of the meshes begin.
    pub first_mesh: u32,
    /// Where the colours of the components begin.
    pub first_component: u32,
    /// Unused.
    pub padding_0: u32,
    /// Unused.
    pub padding_1: u32,
}

/// The pass.
#[derive(Debug)]
pub struct InspectPass {
    pipeline: ComputePipeline,
    own: BindGroupLayout,
    targets: BindGroupLayout,
    uniform: Mirror,
    colors: Mirror,
}

impl InspectPass {
    /// Builds the kernel.
    ///
    /// # Errors
    /// A shader file is missing.
    pub fn new(device: &wgpu::Device, layouts: &Layouts) -> Result<Self, ShaderError> {
        let numbered = |types: &[wgpu::BindingType]| -> Vec<_> {
            types.iter().enumerate().map(|(i, ty)| entry(i as u32, ShaderStages::COMPUTE, *ty)).collect()
        };
        let own = layout(device, "inspect", &numbered(&[uniform(false), read_storage(), read_storage()]));
        let types = [
            read_texture(false),
            read_texture(false),
            read_texture(true),
            read_texture(true),
            write_texture(TextureFormat::Rgba8Unorm),
        ];
        let targets = layout(device, "inspect targets", &numbered(&types));
        let groups = [&layouts.view, &own, &targets];
        let pipeline = compute_pipeline(device, "inspect", plain_source("inspect.wgsl")?, "inspect", &groups);
        let (uniform, colors) = (Mirror::uniform(device, "inspect"), Mirror::storage(device, "look colors"));
        Ok(Self { pipeline, own, targets, uniform, colors })
    }

    /// Uploads what the look needs; distances are coloured within `span`.
    pub fn prepare(&mut self, gpu: (&wgpu::Device, &wgpu::Queue), flat: &FlatScene, look: Look, span: &Span) {
        let (device, queue) = gpu;
        let top = if look == Look::Distance { span.top as f32 } else { look.top() };
        let first_mesh = flat.ids.len() as u32;
        let inspect = Inspect {
            look: look as u32,
            top,
            bottom: span.bottom as f32,
            spacing: span.spacing as f32,
            first_mesh,
            first_component: first_mesh + flat.meshes.len() as u32,
            padding_0: 0,
            padding_1: 0,
        };
        self.uniform.set(device, queue, bytemuck::bytes_of(&inspect));
        if matches!(look, Look::Nodes | Look::Components) {
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
        let own = bind(device, "inspect", &self.own, &own);
        let textures = [&targets.depth, &targets.normal, &targets.owner, &targets.leaf, &targets.color];
        let textures = textures.map(|t| wgpu::BindingResource::TextureView(&t.view));
        let textures = bind(device, "inspect targets", &self.targets, &textures);
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, view, &[]);
        pass.set_bind_group(1, &own, &[]);
        pass.set_bind_group(2, &textures, &[]);
        let [x, y] = targets.size.map(|side| side.div_ceil(TILE));
        pass.dispatch_workgroups(x, y, 1);
    }
}
