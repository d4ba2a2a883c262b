//! Pass `mesh`: clears the targets that fields and meshes share, and draws the meshes into them.

use std::borrow::Cow;
use std::collections::HashMap;
use std::ops::Range;
use std::sync::{Arc, Weak};

use bytemuck::{Pod, Zeroable};
use glam::{DAffine3, DVec3};
use wgpu::util::DeviceExt as _;
use wgpu::{BindGroup, BindGroupLayout, BufferUsages, ShaderStages, TextureFormat};

use super::frame_pass::{Building, FramePass};
use crate::recipe::Pass;
use crate::renderer::recorder::Recorder;
use crate::renderer::timings::Stamps;
use crate::resources::buffers::SyncedBuffer;
use crate::resources::layouts::*;
use crate::resources::targets::{BACKGROUND, Targets};
use isolith_field::standpoint::ray_origin_depth;
use isolith_field::{FlatMesh, FlatScene, MESH_BIT, NO_LEAF};
use isolith_geometry::Camera;
use isolith_mesh::{MeshPart, Sampler, Surface, Texture, TriangleMesh, Wrap};
use isolith_wgsl::{ShaderError, assemble_plain};

/// The pass and the uploaded meshes.
#[derive(Debug)]
pub struct MeshPass {
    pipeline: wgpu::RenderPipeline,
    instance_layout: BindGroupLayout,
    texture_layout: BindGroupLayout,
    /// A sampler for each kind of texture lookup.
    samplers: HashMap<Sampler, wgpu::Sampler>,
    instances: SyncedBuffer,
    instance_group: Option<BindGroup>,
    /// By the address of the mesh on the CPU. Dropped together with that mesh.
    uploaded: HashMap<usize, Uploaded>,
    draws: Vec<Draw>,
}

/// A part of a placed mesh, in the layout of the shader.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Instance {
    /// First row of the matrix from mesh space to world space, relative to the eye or to the point of
    /// `ray_origin_depth`.
    pub eye_from_local_x: [f32; 4],
    /// Second row.
    pub eye_from_local_y: [f32; 4],
    /// Third row.
    pub eye_from_local_z: [f32; 4],
    /// First row of the normal matrix.
    pub normal_x: [f32; 4],
    /// Second row.
    pub normal_y: [f32; 4],
    /// Third row.
    pub normal_z: [f32; 4],
    /// Factor of the vertex colors and their opacity.
    pub color: [f32; 4],
    /// Row that computes the texture's U from the vertices' texture coordinates.
    pub texture_x: [f32; 4],
    /// Row that computes the texture's V.
    pub texture_y: [f32; 4],
    /// Base color, used if `overridden` is 1.
    pub base_color: [f32; 3],
    /// Value for the visibility target.
    pub visibility: u32,
    /// 1: `base_color` replaces the mesh's own colors.
    pub overridden: u32,
    /// 1: the placement mirrors the mesh, which reverses the winding of its triangles.
    pub mirrored: u32,
    /// Opacity below which there is no surface; negative: the surface is everywhere.
    pub alpha_cutoff: f32,
    /// Distance from the eye to the point that positions are relative to, see `shaders/common/ray.wgsl`.
    pub ray_origin_depth: f32,
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
}

/// Alignment of dynamic offsets.
const STRIDE: usize = 256;

#[derive(Debug)]
struct Uploaded {
    mesh: Weak<TriangleMesh>,
    positions: wgpu::Buffer,
    normals: wgpu::Buffer,
    colors: wgpu::Buffer,
    uvs: wgpu::Buffer,
    indices: wgpu::Buffer,
    parts: Vec<(Range<u32>, BindGroup)>,
}

impl FramePass for MeshPass {
    fn new(Building { device, layouts, .. }: Building<'_>) -> Result<Self, ShaderError> {
        let both = ShaderStages::VERTEX_FRAGMENT;
        let instance_layout = layout(device, "mesh instance", &[entry(0, both, uniform(true))]);
        let filtered = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: true },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let sampling = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
        let texture_layout = layout(
            device,
            "mesh texture",
            &[entry(0, ShaderStages::FRAGMENT, filtered), entry(1, ShaderStages::FRAGMENT, sampling)],
        );
        let pipeline = build_pipeline(device, &[&layouts.view, &instance_layout, &texture_layout])?;
        Ok(Self {
            pipeline,
            instance_layout,
            texture_layout,
            samplers: samplers(device),
            instances: SyncedBuffer::uniform(device, "mesh instances"),
            instance_group: None,
            uploaded: HashMap::new(),
            draws: Vec::new(),
        })
    }

    fn record(&self, recorder: &mut Recorder<'_>, _: Range<usize>) {
        let (lists, resources) = (recorder.frame.plan.lists, recorder.resources);
        let (targets, view) = (recorder.targets, recorder.view());
        let (encoder, stamps) = recorder.drawing();
        resources.clear(encoder, lists, targets.size);
        self.draw(encoder, targets, view, stamps);
        let [from, to] = [&targets.visibility, &targets.leaf].map(|target| target.texture.as_image_copy());
        encoder.copy_texture_to_texture(from, to, targets.visibility.texture.size());
    }
}

impl MeshPass {
    /// Uploads the meshes of the frame. `meshes` is parallel to `flat.meshes`, with `None` for files that could not be
    /// read.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        flat: &FlatScene,
        meshes: &[Option<Arc<TriangleMesh>>],
        camera: &Camera,
        size: [u32; 2],
    ) {
        self.uploaded.retain(|_, u| u.mesh.strong_count() > 0);
        self.draws.clear();
        let mut bytes = Vec::new();
        for (index, (placed, mesh)) in flat.meshes.iter().zip(meshes).enumerate() {
            let Some(mesh) = mesh else { continue };
            let key = Arc::as_ptr(mesh) as usize;
            if !self.uploaded.contains_key(&key) {
                let uploaded = self.upload(device, queue, mesh);
                self.uploaded.insert(key, uploaded);
            }
            let seen = mesh.bounds.transformed(&placed.world_from_local).translated(-camera.position);
            let placed = PlacedInstance::new(flat, placed, index, camera, ray_origin_depth(&seen, camera, size));
            let mut last = None;
            for (part, look) in mesh.parts.iter().enumerate() {
                let instance = placed.of_part(look);
                // Most parts of a mesh differ only in their texture, which is not part of the instance.
                if last != Some(instance) {
                    self.draws.push(Draw { mesh: key, part, offset: bytes.len() as u32 });
                    bytes.extend_from_slice(bytemuck::bytes_of(&instance));
                    bytes.resize(bytes.len().next_multiple_of(STRIDE), 0);
                    last = Some(instance);
                } else {
                    let offset = self.draws.last().map_or(0, |draw| draw.offset);
                    self.draws.push(Draw { mesh: key, part, offset });
                }
            }
        }
        if self.instances.set(device, queue, &bytes) || self.instance_group.is_none() {
            let binding = window(self.instances.buffer(), size_of::<Instance>());
            self.instance_group = Some(bind(device, "mesh instances", &self.instance_layout, &[binding]));
        }
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
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(Pass::Mesh.label()),
            color_attachments: &[
                cleared(&targets.depth.view, f64::from(BACKGROUND)),
                cleared(&targets.visibility.view, f64::from(NO_LEAF)),
                cleared(&targets.normal.view, 0.0),
                cleared(&targets.base_color.view, 0.0),
            ],
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
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, view, &[]);
        let mut bound = None;
        for Draw { mesh: key, part, offset } in &self.draws {
            let mesh = &self.uploaded[key];
            pass.set_bind_group(1, instances, &[*offset]);
            if bound != Some(key) {
                let buffers = [&mesh.positions, &mesh.normals, &mesh.colors, &mesh.uvs];
                for (slot, buffer) in buffers.into_iter().enumerate() {
                    pass.set_vertex_buffer(slot as u32, buffer.slice(..));
                }
                pass.set_index_buffer(mesh.indices.slice(..), wgpu::IndexFormat::Uint32);
                bound = Some(key);
            }
            let (range, texture) = &mesh.parts[*part];
            pass.set_bind_group(2, texture, &[]);
            pass.draw_indexed(range.clone(), 0, 0..1);
        }
    }

    fn upload(&self, device: &wgpu::Device, queue: &wgpu::Queue, mesh: &Arc<TriangleMesh>) -> Uploaded {
        let buffer = |label, contents: &[u8], usage| {
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: Some(label), contents, usage })
        };
        let white = Texture { width: 1, height: 1, rgba: vec![255; 4] };
        let white = upload_texture(device, queue, &white);
        let views: Vec<_> = mesh.textures.iter().map(|texture| upload_texture(device, queue, texture)).collect();
        // Many parts share a texture.
        let mut groups: HashMap<(Option<usize>, Sampler), BindGroup> = HashMap::new();
        let mut group = |Surface { texture, sampler, .. }: Surface| {
            let make = || {
                let view = wgpu::BindingResource::TextureView(texture.map_or(&white, |i| &views[i]));
                let sampler = wgpu::BindingResource::Sampler(&self.samplers[&sampler]);
                bind(device, "mesh texture", &self.texture_layout, &[view, sampler])
            };
            groups.entry((texture, sampler)).or_insert_with(make).clone()
        };
        let parts = mesh.parts.iter().map(|part| (part.indices.clone(), group(part.surface))).collect();
        Uploaded {
            mesh: Arc::downgrade(mesh),
            positions: buffer("positions", bytemuck::cast_slice(&mesh.positions), BufferUsages::VERTEX),
            normals: buffer("normals", bytemuck::cast_slice(&mesh.normals), BufferUsages::VERTEX),
            colors: buffer("colors", bytemuck::cast_slice(&mesh.colors), BufferUsages::VERTEX),
            uvs: buffer("uvs", bytemuck::cast_slice(&mesh.uvs), BufferUsages::VERTEX),
            indices: buffer("indices", bytemuck::cast_slice(&mesh.indices), BufferUsages::INDEX),
            parts,
        }
    }
}

fn upload_texture(device: &wgpu::Device, queue: &wgpu::Queue, texture: &Texture) -> wgpu::TextureView {
    let texture = fitting(texture, device.limits().max_texture_dimension_2d);
    let descriptor = wgpu::TextureDescriptor {
        label: Some("base color"),
        size: wgpu::Extent3d { width: texture.width, height: texture.height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: TextureFormat::Rgba8UnormSrgb,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    };
    let order = wgpu::util::TextureDataOrder::LayerMajor;
    device
        .create_texture_with_data(queue, &descriptor, order, &texture.rgba)
        .create_view(&wgpu::TextureViewDescriptor::default())
}

/// The texture, halved until it fits the device's limit.
fn fitting(texture: &Texture, longest: u32) -> Cow<'_, Texture> {
    let mut fitting = Cow::Borrowed(texture);
    while fitting.width.max(fitting.height) > longest {
        let [width, height] = [fitting.width, fitting.height].map(|side| side.div_ceil(2));
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let start = |(x, y): (u32, u32)| 4 * (2 * y as usize * fitting.width as usize + 2 * x as usize);
        let rgba = pixels.map(start).flat_map(|at| fitting.rgba[at..at + 4].iter().copied()).collect();
        fitting = Cow::Owned(Texture { width, height, rgba });
    }
    fitting
}

fn samplers(device: &wgpu::Device) -> HashMap<Sampler, wgpu::Sampler> {
    const WRAPS: [Wrap; 3] = [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp];
    let address = |wrap| match wrap {
        Wrap::Repeat => wgpu::AddressMode::Repeat,
        Wrap::Mirror => wgpu::AddressMode::MirrorRepeat,
        Wrap::Clamp => wgpu::AddressMode::ClampToEdge,
    };
    let ways = WRAPS.iter().flat_map(|u| WRAPS.iter().map(move |v| [*u, *v]));
    let ways = ways.flat_map(|wrap| [false, true].map(|nearest| Sampler { wrap, nearest }));
    ways.map(|way| {
        let filter = if way.nearest { wgpu::FilterMode::Nearest } else { wgpu::FilterMode::Linear };
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("mesh"),
            address_mode_u: address(way.wrap[0]),
            address_mode_v: address(way.wrap[1]),
            mag_filter: filter,
            min_filter: filter,
            ..Default::default()
        });
        (way, sampler)
    })
    .collect()
}

/// An attachment that is cleared to `value`.
fn cleared(view: &wgpu::TextureView, value: f64) -> Option<wgpu::RenderPassColorAttachment<'_>> {
    let load = wgpu::LoadOp::Clear(wgpu::Color { r: value, g: 0.0, b: 0.0, a: 0.0 });
    let ops = wgpu::Operations { load, store: wgpu::StoreOp::Store };
    Some(wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops })
}

/// A placed mesh: the data that its parts share.
struct PlacedInstance {
    eye_from_local: DAffine3,
    /// The instance of a part at the mesh's own origin with default appearance.
    common: Instance,
}

impl PlacedInstance {
    fn new(flat: &FlatScene, placed: &FlatMesh, index: usize, camera: &Camera, ray_origin_depth: f64) -> Self {
        let eye = camera.position + camera.rotation * DVec3::NEG_Z * ray_origin_depth;
        let m = DAffine3 { translation: placed.world_from_local.translation - eye, ..placed.world_from_local };
        // Normals transform by the inverse transpose; only their direction matters.
        let n = m.matrix3.inverse().transpose();
        let n = n * (1.0 / n.x_axis.abs().max(n.y_axis.abs()).max(n.z_axis.abs()).max_element());
        let normal_row = |i: usize| {
            let r = n.row(i);
            [r.x as f32, r.y as f32, r.z as f32, 0.0]
        };
        let material = placed.material.map(|i| flat.materials[i as usize]);
        let common = Instance {
            normal_x: normal_row(0),
            normal_y: normal_row(1),
            normal_z: normal_row(2),
            base_color: material.map_or([1.0; 3], |m| m.base_color),
            visibility: MESH_BIT | index as u32,
            overridden: u32::from(material.is_some()),
            mirrored: u32::from(m.matrix3.determinant() < 0.0),
            ray_origin_depth: ray_origin_depth as f32,
            ..Instance::zeroed()
        };
        Self { eye_from_local: m, common }
    }

    fn of_part(&self, part: &MeshPart) -> Instance {
        let MeshPart { origin, surface, .. } = part;
        let m = &self.eye_from_local;
        let translation = m.translation + m.matrix3 * *origin;
        let row = |i: usize| {
            let r = m.matrix3.row(i);
            [r.x as f32, r.y as f32, r.z as f32, translation[i] as f32]
        };
        let [texture_x, texture_y] = surface.texture_from_uv.map(|[a, b, c]| [a, b, c, 0.0]);
        Instance {
            eye_from_local_x: row(0),
            eye_from_local_y: row(1),
            eye_from_local_z: row(2),
            color: surface.color,
            texture_x,
            texture_y,
            alpha_cutoff: surface.alpha_cutoff.unwrap_or(-1.0),
            ..self.common
        }
    }
}

fn build_pipeline(device: &wgpu::Device, groups: &[&BindGroupLayout]) -> Result<wgpu::RenderPipeline, ShaderError> {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("mesh"),
        source: wgpu::ShaderSource::Wgsl(assemble_plain(Pass::Mesh.file())?.into()),
    });
    use wgpu::VertexFormat::{Float32x2, Float32x3, Float32x4};
    // Position, normal, color, texture coordinate.
    let formats = [Float32x3, Float32x3, Float32x4, Float32x2];
    let attributes: Vec<_> = formats
        .iter()
        .enumerate()
        .map(|(i, format)| [wgpu::VertexAttribute { format: *format, offset: 0, shader_location: i as u32 }])
        .collect();
    let vertex_buffers: Vec<_> = attributes
        .iter()
        .map(|attribute| {
            Some(wgpu::VertexBufferLayout {
                array_stride: attribute[0].format.size(),
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: attribute,
            })
        })
        .collect();
    let targets =
        [TextureFormat::R32Float, TextureFormat::R32Uint, TextureFormat::Rgba32Float, TextureFormat::Rgba16Float];
    Ok(device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("mesh"),
        layout: Some(&pipeline_layout(device, "mesh", groups)),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("mesh_vertex"),
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
            entry_point: Some("mesh_fragment"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &targets.map(|format| Some(format.into())),
        }),
        multiview_mask: None,
        cache: None,
    }))
}
