//! Pass `mesh`: clears the targets that fields and meshes share, and draws the meshes into them.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::{Arc, Weak};

use wgpu::VertexFormat::{Float32x3, Float32x4};
use wgpu::util::DeviceExt as _;
use wgpu::{BindGroup, BindGroupLayout, BufferUsages, ShaderStages, TextureFormat};

use super::frame_pass::{Building, FramePass};
use super::mesh_copies::DrawnCopies;
pub use super::mesh_instance::Instance;
use super::mesh_instance::{CopyInstance, PlacedInstance};
use super::mesh_textures::{samplers, upload_texture};
use crate::gpu::Gpu;
use crate::recipe::Pass;
use crate::renderer::recorder::Recorder;
use crate::renderer::timings::Stamps;
use crate::resources::buffers::SyncedBuffer;
use crate::resources::layouts::*;
use crate::resources::targets::{BACKGROUND, Targets};
use isolith_field::standpoint::ray_origin_depth;
use isolith_field::{FlatScene, NO_LEAF, Warning};
use isolith_geometry::Camera;
use isolith_mesh::{MeshPart, Sampler, Surface, Texture, TextureUse, TriangleMesh};
use isolith_wgsl::{ShaderError, assemble_plain};

/// The pass and the uploaded meshes.
#[derive(Debug)]
pub struct MeshPass {
    pipelines: [MeshPipeline; 2],
    /// The same for copies; made when the first ones are drawn.
    copy_pipelines: Option<[MeshPipeline; 2]>,
    copies: DrawnCopies,
    view_layout: BindGroupLayout,
    instance_layout: BindGroupLayout,
    /// A sampler for each kind of texture lookup.
    samplers: HashMap<Sampler, wgpu::Sampler>,
    instances: SyncedBuffer,
    instance_group: Option<BindGroup>,
    /// By the address of the mesh on the CPU. Dropped together with that mesh.
    uploaded: HashMap<usize, Uploaded>,
    /// By the address of the texture on the CPU and whether it holds colors: the same may hold colors here and numbers
    /// there. Poses of a model share them. Dropped together with that texture.
    textures: HashMap<(usize, bool), (Weak<Texture>, wgpu::TextureView)>,
    draws: Vec<Draw>,
}

/// A draw of one part.
#[derive(Clone, Copy, Debug)]
struct Draw {
    /// Index into [`MeshPass::uploaded`].
    mesh: usize,
    /// Index into [`Uploaded::parts`].
    part: usize,
    /// Offset of its instance.
    offset: u32,
    /// Whether the file's own material is drawn, and has textures besides that of the base color.
    is_mapped: bool,
    /// Its copies among all that are drawn, if it is the type of an instancer.
    copies: Option<[u32; 2]>,
}

/// Alignment of dynamic offsets.
const STRIDE: usize = 512;
const _: () = assert!(size_of::<Instance>() <= STRIDE);

/// A pipeline with the layout of its textures: for surfaces with a texture of the base color at most, and for those
/// with more.
#[derive(Debug)]
struct MeshPipeline {
    pipeline: wgpu::RenderPipeline,
    textures: BindGroupLayout,
}

#[derive(Debug)]
struct Uploaded {
    mesh: Weak<TriangleMesh>,
    positions: wgpu::Buffer,
    normals: wgpu::Buffer,
    colors: wgpu::Buffer,
    uvs: wgpu::Buffer,
    /// Made if a part is mapped.
    tangents: Option<wgpu::Buffer>,
    indices: wgpu::Buffer,
    parts: Vec<UploadedPart>,
}

/// A part with its textures: for each pipeline that may draw it.
#[derive(Clone, Debug)]
struct UploadedPart {
    indices: Range<u32>,
    plain: BindGroup,
    mapped: Option<BindGroup>,
}

impl FramePass for MeshPass {
    fn new(Building { device, layouts, .. }: Building<'_>) -> Result<Self, ShaderError> {
        let both = ShaderStages::VERTEX_FRAGMENT;
        let instance_layout = layout(device, "mesh instance", &[entry(0, both, uniform(true))]);
        let plain = MeshPipeline::new(device, &layouts.view, &instance_layout, [false, false])?;
        let mapped = MeshPipeline::new(device, &layouts.view, &instance_layout, [true, false])?;
        Ok(Self {
            pipelines: [plain, mapped],
            copy_pipelines: None,
            copies: DrawnCopies::new(device),
            view_layout: layouts.view.clone(),
            instance_layout,
            samplers: samplers(device),
            instances: SyncedBuffer::uniform(device, "mesh instances"),
            instance_group: None,
            uploaded: HashMap::new(),
            textures: HashMap::new(),
            draws: Vec::new(),
        })
    }

    fn record(&self, recorder: &mut Recorder<'_>, _: Range<usize>) {
        let (lists, resources) = (recorder.frame.plan.lists, recorder.resources);
        let (targets, view) = (recorder.targets, recorder.view());
        let (encoder, stamps) = recorder.drawing();
        resources.clear(encoder, lists, targets.size);
        if let Some(copied) = &targets.copied {
            encoder.clear_buffer(copied, 0, None);
        }
        self.draw(encoder, targets, view, stamps);
        let [from, to] = [&targets.visibility, &targets.leaf].map(|target| target.texture.as_image_copy());
        encoder.copy_texture_to_texture(from, to, targets.visibility.texture.size());
    }
}

impl MeshPass {
    /// Uploads the meshes of the frame. `meshes` is parallel to `flat.meshes`, with `None` for files that could not be
    /// read; `materials` holds the index of the material of each part.
    pub fn prepare(
        &mut self,
        gpu: &Gpu,
        flat: &FlatScene,
        meshes: &[Option<Arc<TriangleMesh>>],
        materials: &[Vec<u32>],
        camera: &Camera,
        size: [u32; 2],
    ) -> Result<(), ShaderError> {
        let Gpu { device, queue, .. } = gpu;
        self.uploaded.retain(|_, u| u.mesh.strong_count() > 0);
        self.textures.retain(|_, (texture, _)| texture.strong_count() > 0);
        self.draws.clear();
        self.copies.clear();
        let mut bytes = Vec::new();
        for (index, (placed, mesh)) in flat.meshes.iter().zip(meshes).enumerate() {
            let Some(mesh) = mesh else { continue };
            let key = Arc::as_ptr(mesh) as usize;
            if !self.uploaded.contains_key(&key) {
                self.upload_textures(device, queue, mesh);
                let uploaded = self.upload(device, queue, mesh);
                self.uploaded.insert(key, uploaded);
            }
            let is_own = placed.material.is_none();
            let (placed, copies) = if placed.instanced.is_some() {
                let Some((shared, range)) = self.copies.add(flat, (index, mesh), camera, size) else { continue };
                (shared, Some(range))
            } else {
                let seen = mesh.bounds.transformed(&placed.world_from_local).translated(-camera.position);
                let depth = ray_origin_depth(&seen, camera, size);
                (PlacedInstance::new(flat, placed, index, camera, depth), None)
            };
            let mut last = None;
            for (part, look) in mesh.parts.iter().enumerate() {
                let instance = placed.of_part(look, materials[index][part]);
                let is_mapped = is_own && look.surface.has_maps();
                // Most parts of a mesh differ only in their texture, which is not part of the instance.
                if last != Some(instance) {
                    self.draws.push(Draw { mesh: key, part, offset: bytes.len() as u32, is_mapped, copies });
                    bytes.extend_from_slice(bytemuck::bytes_of(&instance));
                    bytes.resize(bytes.len().next_multiple_of(STRIDE), 0);
                    last = Some(instance);
                } else {
                    let offset = self.draws.last().map_or(0, |draw| draw.offset);
                    self.draws.push(Draw { mesh: key, part, offset, is_mapped, copies });
                }
            }
        }
        // The window on an instance must fit even if there is none.
        bytes.resize(bytes.len().max(STRIDE), 0);
        if self.instances.set(device, queue, &bytes) || self.instance_group.is_none() {
            let binding = window(self.instances.buffer(), size_of::<Instance>());
            self.instance_group = Some(bind(device, "mesh instances", &self.instance_layout, &[binding]));
        }
        if self.copies.is_empty() {
            return Ok(());
        }
        self.copies.upload(gpu);
        if self.copy_pipelines.is_none() {
            let of = |is_mapped| MeshPipeline::new(device, &self.view_layout, &self.instance_layout, [is_mapped, true]);
            self.copy_pipelines = Some([of(false)?, of(true)?]);
        }
        Ok(())
    }

    /// Warnings about meshes of which only the nearest copies are drawn.
    pub fn warnings(&self, flat: &FlatScene) -> Vec<Warning> {
        self.copies.warnings(flat)
    }

    /// Clears the shared targets and draws the meshes.
    fn draw(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        targets: &Targets,
        view: &BindGroup,
        stamps: Option<Stamps<'_>>,
    ) {
        let [first, last] = stamps.map_or([None, None], |stamps| stamps.of_several().map(Some));
        // `hiz` has another size, so it needs a render pass of its own, which only clears.
        drop(encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("clear hiz"),
            color_attachments: &[cleared(&targets.hiz.view, f64::from(BACKGROUND))],
            timestamp_writes: first,
            ..Default::default()
        }));
        let all = [
            cleared(&targets.depth.view, f64::from(BACKGROUND)),
            cleared(&targets.visibility.view, f64::from(NO_LEAF)),
            cleared(&targets.normal.view, 0.0),
            cleared(&targets.base_color.view, 0.0),
            cleared(&targets.material.view, 0.0),
        ];
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(Pass::Mesh.label()),
            // The last two hold nothing but the look of meshes.
            color_attachments: if self.draws.is_empty() { &all[..3] } else { &all },
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &targets.hardware_depth.view,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Discard }),
                stencil_ops: None,
            }),
            timestamp_writes: last,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        let Some(instances) = &self.instance_group else { return };
        if self.draws.is_empty() {
            return;
        }
        pass.set_bind_group(0, view, &[]);
        let (mut bound, mut set) = (None, None);
        for Draw { mesh: key, part, offset, is_mapped, copies } in &self.draws {
            let mesh = &self.uploaded[key];
            let kind = (*is_mapped, copies.is_some());
            if set != Some(kind) {
                let made = if copies.is_some() { self.copy_pipelines.as_ref() } else { Some(&self.pipelines) };
                let Some(made) = made else { continue };
                pass.set_pipeline(&made[usize::from(*is_mapped)].pipeline);
                (set, bound) = (Some(kind), None);
            }
            pass.set_bind_group(1, instances, &[*offset]);
            if bound != Some(key) {
                if copies.is_some() {
                    // Behind the buffers of a vertex.
                    pass.set_vertex_buffer(if *is_mapped { 5 } else { 4 }, self.copies.buffer().slice(..));
                }
                let buffers = [&mesh.positions, &mesh.normals, &mesh.colors, &mesh.uvs];
                let tangents = mesh.tangents.iter().filter(|_| *is_mapped || copies.is_none());
                for (slot, buffer) in buffers.into_iter().chain(tangents).enumerate() {
                    pass.set_vertex_buffer(slot as u32, buffer.slice(..));
                }
                pass.set_index_buffer(mesh.indices.slice(..), wgpu::IndexFormat::Uint32);
                bound = Some(key);
            }
            let UploadedPart { indices, plain, mapped } = &mesh.parts[*part];
            pass.set_bind_group(2, mapped.as_ref().filter(|_| *is_mapped).unwrap_or(plain), &[]);
            let [from, to] = copies.unwrap_or([0, 1]);
            pass.draw_indexed(indices.clone(), 0, from..to);
        }
    }

    fn upload(&self, device: &wgpu::Device, queue: &wgpu::Queue, mesh: &Arc<TriangleMesh>) -> Uploaded {
        let buffer = |label, contents: &[u8], usage| {
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: Some(label), contents, usage })
        };
        let parts = self.bind_textures(device, queue, mesh);
        let mut tangents = mesh.tangents.clone();
        tangents.resize(mesh.positions.len(), [0.0; 4]);
        let tangents = parts.iter().any(|part| part.mapped.is_some()).then_some(tangents);
        Uploaded {
            mesh: Arc::downgrade(mesh),
            positions: buffer("positions", bytemuck::cast_slice(&mesh.positions), BufferUsages::VERTEX),
            normals: buffer("normals", bytemuck::cast_slice(&mesh.normals), BufferUsages::VERTEX),
            colors: buffer("colors", bytemuck::cast_slice(&mesh.colors), BufferUsages::VERTEX),
            uvs: buffer("uvs", bytemuck::cast_slice(&mesh.uvs), BufferUsages::VERTEX),
            tangents: tangents
                .map(|tangents| buffer("tangents", bytemuck::cast_slice(&tangents), BufferUsages::VERTEX)),
            indices: buffer("indices", bytemuck::cast_slice(&mesh.indices), BufferUsages::INDEX),
            parts,
        }
    }

    /// Uploads the textures of a mesh.
    fn upload_textures(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, mesh: &TriangleMesh) {
        let all = mesh.parts.iter().flat_map(|part| [&colors(&part.surface)[..], &numbers(&part.surface)[..]].concat());
        for (texture_use, is_color) in all {
            let Some(texture) = texture_use.map(|texture_use| &mesh.textures[texture_use.texture]) else { continue };
            let make = || (Arc::downgrade(texture), upload_texture(device, queue, texture, is_color));
            self.textures.entry((Arc::as_ptr(texture) as usize, is_color)).or_insert_with(make);
        }
    }

    /// Binds the textures of each part of a mesh.
    fn bind_textures(&self, device: &wgpu::Device, queue: &wgpu::Queue, mesh: &TriangleMesh) -> Vec<UploadedPart> {
        let white = upload_texture(device, queue, &Texture { width: 1, height: 1, rgba: vec![255; 4] }, true);
        let view_of = |texture: usize, is_color: bool| {
            &self.textures[&(Arc::as_ptr(&mesh.textures[texture]) as usize, is_color)].1
        };
        // Many parts share their textures.
        let mut groups: HashMap<Vec<Option<(usize, Sampler)>>, BindGroup> = HashMap::new();
        let mut group = |uses: &[(Option<TextureUse>, bool)], pipeline: usize| {
            let make = || {
                let resources: Vec<_> = uses
                    .iter()
                    .flat_map(|(texture_use, is_color)| {
                        let view = texture_use.map_or(&white, |texture_use| view_of(texture_use.texture, *is_color));
                        let sampler =
                            &self.samplers[&texture_use.map_or(Sampler::default(), |texture_use| texture_use.sampler)];
                        [wgpu::BindingResource::TextureView(view), wgpu::BindingResource::Sampler(sampler)]
                    })
                    .collect();
                bind(device, "mesh textures", &self.pipelines[pipeline].textures, &resources)
            };
            let key = uses.iter().map(|(texture_use, _)| texture_use.map(|one| (one.texture, one.sampler))).collect();
            groups.entry(key).or_insert_with(make).clone()
        };
        let part = |MeshPart { indices, surface, .. }: &MeshPart| {
            let [base, emissive] = colors(surface);
            let [metal_rough, normal, occlusion] = numbers(surface);
            let all = [base, metal_rough, normal, occlusion, emissive];
            let mapped = surface.has_maps().then(|| group(&all, 1));
            UploadedPart { indices: indices.clone(), plain: group(&all[..1], 0), mapped }
        };
        mesh.parts.iter().map(part).collect()
    }
}

/// The textures of a surface that hold colors.
fn colors(surface: &Surface) -> [(Option<TextureUse>, bool); 2] {
    [(surface.base_color, true), (surface.emissive, true)]
}

/// Those that hold numbers.
fn numbers(surface: &Surface) -> [(Option<TextureUse>, bool); 3] {
    [(surface.metal_rough, false), (surface.normal, false), (surface.occlusion, false)]
}

/// An attachment that is cleared to `value`.
fn cleared(view: &wgpu::TextureView, value: f64) -> Option<wgpu::RenderPassColorAttachment<'_>> {
    let load = wgpu::LoadOp::Clear(wgpu::Color { r: value, g: 0.0, b: 0.0, a: 0.0 });
    let ops = wgpu::Operations { load, store: wgpu::StoreOp::Store };
    Some(wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops })
}

impl MeshPipeline {
    fn new(
        device: &wgpu::Device,
        view: &BindGroupLayout,
        instance: &BindGroupLayout,
        [is_mapped, is_copied]: [bool; 2],
    ) -> Result<Self, ShaderError> {
        let filtered = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: true },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let sampling = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
        let count = if is_mapped { 5 } else { 1 };
        let texture = |i: u32| {
            [entry(2 * i, ShaderStages::FRAGMENT, filtered), entry(2 * i + 1, ShaderStages::FRAGMENT, sampling)]
        };
        let entries: Vec<_> = (0..count).flat_map(texture).collect();
        let textures = layout(device, "mesh textures", &entries);
        let entry_points = match (is_mapped, is_copied) {
            (false, false) => ["mesh_vertex", "mesh_fragment"],
            (true, false) => ["mesh_mapped_vertex", "mesh_mapped_fragment"],
            (false, true) => ["mesh_copy_vertex", "mesh_fragment"],
            (true, true) => ["mesh_mapped_copy_vertex", "mesh_mapped_fragment"],
        };
        // Position, normal, color, texture coordinates, tangent.
        let formats = [Float32x3, Float32x3, Float32x4, Float32x4, Float32x4];
        let formats = if is_mapped { &formats[..] } else { &formats[..4] };
        let pipeline = build_pipeline(device, &[view, instance, &textures], entry_points, (formats, is_copied))?;
        Ok(Self { pipeline, textures })
    }
}

fn build_pipeline(
    device: &wgpu::Device,
    groups: &[&BindGroupLayout],
    [vertex, fragment]: [&str; 2],
    (formats, is_copied): (&[wgpu::VertexFormat], bool),
) -> Result<wgpu::RenderPipeline, ShaderError> {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("mesh"),
        source: wgpu::ShaderSource::Wgsl(assemble_plain(Pass::Mesh.file())?.into()),
    });
    let attributes: Vec<_> = formats
        .iter()
        .enumerate()
        .map(|(i, format)| [wgpu::VertexAttribute { format: *format, offset: 0, shader_location: i as u32 }])
        .collect();
    let mut vertex_buffers: Vec<_> = attributes
        .iter()
        .map(|attribute| {
            Some(wgpu::VertexBufferLayout {
                array_stride: attribute[0].format.size(),
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: attribute,
            })
        })
        .collect();
    let rows = CopyInstance::attributes();
    if is_copied {
        vertex_buffers.push(Some(CopyInstance::layout(&rows)));
    }
    use TextureFormat::{R32Float, R32Uint, Rgba16Float, Rgba32Float, Rgba32Uint};
    let targets = [R32Float, R32Uint, Rgba32Float, Rgba16Float, Rgba32Uint];
    Ok(device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("mesh"),
        layout: Some(&pipeline_layout(device, "mesh", groups)),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some(vertex),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &vertex_buffers,
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: TextureFormat::Depth32Float,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Greater),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(fragment),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &targets.map(|format| Some(format.into())),
        }),
        multiview_mask: None,
        cache: None,
    }))
}
