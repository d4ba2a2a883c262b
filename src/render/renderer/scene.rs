//! The scene on the device: arrays, rows, tapes, and their bind groups.

use std::sync::Arc;

use wgpu::{BindGroup, BindGroupLayout};

use crate::frame::copies_cost::cell_loops;
use crate::gpu::Gpu;
use crate::pipelines::key::PipelineKey;
use crate::resources::brick_texture::BrickTexture;
use crate::resources::buffers::{DataTexture, SyncedBuffer};
use crate::resources::layouts::{CopiesBindings, Layouts, PARAMS_FORMAT, SceneBindings, window};
use crate::resources::tape_texture::TapeTexture;
use crate::resources::uniforms::{GpuComponent, INSTANCER_STRIDE, strided};
use glam::DVec3;
use isolith_field::copies::{GpuInstancer, gpu_instancer, gpu_places};
use isolith_field::standpoint::{Standpoint, Standpoints};
use isolith_field::{CellTree, Component, FlatScene, ParamRow, ROW_ALIGNMENT};
use isolith_wgsl::{MAX_PIPELINE_ROWS, template_rows};

/// Bytes of a pipeline's window on the rows of its component. The buffer has as much room after the last row, so that
/// the window on the last component stays inside.
pub const PIPELINE_WINDOW: usize = MAX_PIPELINE_ROWS as usize * size_of::<ParamRow>();

/// Scene resources, see the module.
#[derive(Debug)]
pub struct SceneResources {
    layout: BindGroupLayout,
    nodes: SyncedBuffer,
    /// Rows for the windows of specialized pipelines.
    rows: SyncedBuffer,
    /// Rows for the windows of pipelines for templates.
    template_rows: SyncedBuffer,
    /// The same rows as a texture, for interpreter and tapes.
    params: DataTexture,
    tapes: TapeTexture,
    bricks: BrickTexture,
    components: SyncedBuffer,
    materials: SyncedBuffer,
    copies_layout: BindGroupLayout,
    instancers: SyncedBuffer,
    places: SyncedBuffer,
    /// The instancers whose copies carry textures, for pass `shade`.
    textured_instancers: SyncedBuffer,
    /// The instancers as the device has them.
    placed: Vec<GpuInstancer>,
}

/// What pass `shade` reads of the scene besides materials.
#[derive(Debug)]
pub struct ShadedScene {
    /// The bricks of models, which hold their looks.
    pub bricks: wgpu::TextureView,
    /// The instancers whose copies carry textures, and the places of all.
    pub copies: [wgpu::Buffer; 2],
}

impl SceneResources {
    /// Empty resources.
    pub fn new(device: &wgpu::Device, layouts: &Layouts) -> Self {
        Self {
            layout: layouts.scene.clone(),
            copies_layout: layouts.copies.clone(),
            instancers: SyncedBuffer::uniform(device, "instancers"),
            places: SyncedBuffer::storage(device, "places"),
            textured_instancers: SyncedBuffer::storage(device, "instancers with textures"),
            placed: Vec::new(),
            nodes: SyncedBuffer::storage(device, "nodes"),
            rows: SyncedBuffer::uniform(device, "rows"),
            template_rows: SyncedBuffer::uniform(device, "rows of templates"),
            params: DataTexture::new(device, "params", PARAMS_FORMAT),
            tapes: TapeTexture::new(device),
            bricks: BrickTexture::new(device),
            components: SyncedBuffer::uniform(device, "components"),
            materials: SyncedBuffer::storage(device, "materials"),
        }
    }

    /// Bytes uploaded so far.
    pub fn uploaded(&self) -> u64 {
        let own = [&self.nodes, &self.rows, &self.template_rows, &self.components, &self.materials];
        let buffers = own.into_iter().chain([&self.instancers, &self.places]).map(SyncedBuffer::uploaded);
        buffers.sum::<u64>() + self.params.uploaded() + self.tapes.uploaded() + self.bricks.uploaded()
    }

    /// Words of tapes that the device can hold.
    pub fn most_words(&self, device: &wgpu::Device) -> usize {
        self.tapes.most_words(device)
    }

    /// Uploads changed data. Returns whether a buffer was replaced, and for each component with a pipeline for a
    /// template the offset of its rows, in bytes.
    pub fn upload(
        &mut self,
        gpu: &Gpu,
        flat: &FlatScene,
        (eye, standpoints): (DVec3, &Standpoints<'_>),
        trees: &[Option<Arc<CellTree>>],
        keys: &[Option<PipelineKey>],
    ) -> (bool, Vec<Option<u32>>) {
        let Gpu { device, queue, .. } = gpu;
        let (windows, templates) = template_windows(flat, &standpoints.params, keys);
        let mut is_new = self.template_rows.set(device, queue, &templates);
        is_new |= self.tapes.hold(device, queue, trees);
        is_new |= self.bricks.hold(device, queue, &flat.bricks);
        let placed = |((component, at), tree): ((&Component, &Standpoint), &Option<Arc<CellTree>>)| {
            let gpu = GpuComponent::new(component, at);
            let place = tree.as_ref().and_then(|tree| Some((tree, self.tapes.place(tree)?)));
            place.map_or(gpu, |(tree, lists)| gpu.with_grid(tree, lists, at))
        };
        let components = strided(flat.components.iter().zip(&standpoints.all).zip(trees).map(placed));
        let params: &[u8] = bytemuck::cast_slice(&standpoints.params);
        let (rows_are_new, changed) =
            self.rows.set_with_room(device, queue, params, PIPELINE_WINDOW, size_of::<ParamRow>());
        let texture_is_new = self.params.reserve(device, params.len());
        if let Some(range) = if texture_is_new { Some(0..params.len()) } else { changed } {
            self.params.write(queue, range.start, &params[range]);
        }
        is_new |= rows_are_new || texture_is_new;
        let uploads = [
            self.nodes.set(device, queue, bytemuck::cast_slice(&flat.nodes)),
            self.components.set(device, queue, &components),
            self.materials.set(device, queue, bytemuck::cast_slice(&flat.materials)),
            self.upload_instancers(gpu, flat, eye),
        ];
        (is_new || uploads.contains(&true), windows)
    }

    /// Uploads the instancers as seen from `eye`. Returns whether a buffer was replaced.
    fn upload_instancers(&mut self, gpu: &Gpu, flat: &FlatScene, eye: DVec3) -> bool {
        let mut rows: Vec<[f32; 4]> = Vec::new();
        let mut bytes = vec![0; flat.instancers.len() * INSTANCER_STRIDE];
        self.placed.clear();
        for (instancer, slot) in flat.instancers.iter().zip(bytes.chunks_exact_mut(INSTANCER_STRIDE)) {
            let gpu = gpu_instancer(instancer, eye, rows.len() as u32);
            slot[..size_of::<GpuInstancer>()].copy_from_slice(bytemuck::bytes_of(&gpu));
            rows.extend_from_slice(gpu_places(instancer));
            self.placed.push(gpu);
        }
        bytes.resize(bytes.len().max(INSTANCER_STRIDE), 0);
        let Gpu { device, queue, .. } = gpu;
        let uploads =
            [self.instancers.set(device, queue, &bytes), self.places.set(device, queue, bytemuck::cast_slice(&rows))];
        let carries = flat.textures.are_carried()
            && self.textured_instancers.set(device, queue, bytemuck::cast_slice(&self.placed));
        carries || uploads.contains(&true)
    }

    /// The bind groups for types of instancers, like those of [`Self::bind`].
    pub fn bind_copies(&self, device: &wgpu::Device) -> [BindGroup; 2] {
        [&self.rows, &self.template_rows].map(|rows| {
            let group = CopiesBindings {
                nodes: self.nodes.binding(),
                params: self.params.binding(),
                subject: window(self.components.buffer(), size_of::<GpuComponent>()),
                rows: window(rows.buffer(), PIPELINE_WINDOW),
                tapes: self.tapes.binding(),
                bricks: self.bricks.binding(),
                instancer: window(self.instancers.buffer(), size_of::<GpuInstancer>()),
                places: self.places.binding(),
            };
            group.bind(device, &self.copies_layout)
        })
    }

    /// First word of the tapes of a component.
    pub fn place(&self, tree: &Arc<CellTree>) -> Option<u32> {
        self.tapes.place(tree)
    }

    /// The instancers, for queries of the whole scene, which have to find the components of their types.
    pub fn queried_instancers(&self, flat: &FlatScene) -> Vec<GpuInstancer> {
        let mut all = self.placed.clone();
        for (gpu, instancer) in all.iter_mut().zip(&flat.instancers) {
            gpu.cell_visits = cell_loops(instancer);
            gpu.components.fill(u32::MAX);
        }
        for (index, component) in flat.components.iter().enumerate() {
            if let Some(of) = component.instanced {
                all[of.instancer as usize].components[of.kind as usize] = index as u32;
            }
        }
        all
    }

    /// The places of all instancers.
    pub fn places(&self) -> wgpu::BindingResource<'_> {
        self.places.binding()
    }

    /// What pass `shade` reads of the scene besides materials.
    pub fn shaded(&self) -> ShadedScene {
        ShadedScene {
            bricks: self.bricks.view().clone(),
            copies: [&self.textured_instancers, &self.places].map(|buffer| buffer.buffer().clone()),
        }
    }

    /// All materials.
    pub fn materials(&self) -> wgpu::BindingResource<'_> {
        self.materials.binding()
    }

    /// The bind group with the rows of all components, and the one with the rows of templates.
    pub fn bind(&self, device: &wgpu::Device) -> [BindGroup; 2] {
        [&self.rows, &self.template_rows].map(|rows| {
            let group = SceneBindings {
                nodes: self.nodes.binding(),
                params: self.params.binding(),
                subject: window(self.components.buffer(), size_of::<GpuComponent>()),
                rows: window(rows.buffer(), PIPELINE_WINDOW),
                tapes: self.tapes.binding(),
                bricks: self.bricks.binding(),
            };
            group.bind(device, &self.layout)
        })
    }
}

/// The rows of components whose pipelines are for templates, and the offset of each in bytes. They end with room for a
/// whole window.
fn template_windows(
    flat: &FlatScene,
    params: &[ParamRow],
    keys: &[Option<PipelineKey>],
) -> (Vec<Option<u32>>, Vec<u8>) {
    let mut rows: Vec<ParamRow> = Vec::new();
    let window = |(component, key): (&Component, &Option<PipelineKey>)| {
        key.and_then(|key| key.template)?;
        rows.resize(rows.len().next_multiple_of(ROW_ALIGNMENT), [0.0; 4]);
        let first = rows.len();
        template_rows(flat, params, component, &mut rows);
        Some((first * size_of::<ParamRow>()) as u32)
    };
    let windows = flat.components.iter().zip(keys).map(window).collect();
    rows.resize(rows.len() + MAX_PIPELINE_ROWS as usize, [0.0; 4]);
    (windows, bytemuck::cast_slice(&rows).to_vec())
}
