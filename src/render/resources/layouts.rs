//! Bind group layouts. Group 0 is the view, 1 the scene, 2 the pass's own targets, 3 the dispatch.
//!
//! `bindings!` declares the bindings of a group once; the layout and the bind group follow from it.

use wgpu::{BindGroupLayout, BindGroupLayoutEntry, BindingType, BufferBindingType, ShaderStages};
use wgpu::{StorageTextureAccess as Access, TextureFormat as Format};

/// Format of the texture of rows.
pub const PARAMS_FORMAT: Format = Format::Rgba32Float;
/// Format of the texture of tapes.
pub const TAPES_FORMAT: Format = Format::Rg32Uint;
/// Format of the texture of distance bricks.
pub const BRICKS_FORMAT: Format = Format::Rgba32Uint;

/// Format of the texture of images.
pub const TEXELS_FORMAT: Format = Format::R32Uint;

/// Declares a group as a struct of resources, with fields in the order of the bindings, and its layout.
macro_rules! bindings {
    ($(#[$doc:meta])* $name:ident, $label:literal, $stages:ident { $($(#[$field_doc:meta])* $field:ident: $type:expr,)* }) => {
        $(#[$doc])*
        #[derive(Clone, Debug)]
        pub struct $name<'a> {
            $($(#[$field_doc])* pub $field: wgpu::BindingResource<'a>,)*
        }

        impl $name<'_> {
            /// The layout of the group.
            pub fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
                let types = [$($type),*];
                let entries: Vec<_> = (0..).zip(types).map(|(at, ty)| entry(at, wgpu::ShaderStages::$stages, ty)).collect();
                layout(device, $label, &entries)
            }

            /// The bind group.
            pub fn bind(self, device: &wgpu::Device, layout: &wgpu::BindGroupLayout) -> wgpu::BindGroup {
                bind(device, $label, layout, &[$(self.$field),*])
            }
        }
    };
}
pub(crate) use bindings;

bindings! {
    /// Group 1 of the field passes.
    SceneBindings, "scene", COMPUTE {
        /// The subtree-extent array.
        nodes: read_storage(),
        /// All rows.
        params: read_only_texture(PARAMS_FORMAT),
        /// The component, at a dynamic offset.
        subject: uniform(true),
        /// The component's own rows again, at a dynamic offset.
        rows: uniform(true),
        /// Tapes.
        tapes: read_only_texture(TAPES_FORMAT),
        /// Distance bricks of models.
        bricks: read_only_texture(BRICKS_FORMAT),
    }
}

bindings! {
    /// Group 1 of the field passes over types of instancers: the same and the instancer.
    CopiesBindings, "scene with copies", COMPUTE {
        /// The subtree-extent array.
        nodes: read_storage(),
        /// All rows.
        params: read_only_texture(PARAMS_FORMAT),
        /// The component, at a dynamic offset.
        subject: uniform(true),
        /// The component's own rows again, at a dynamic offset.
        rows: uniform(true),
        /// Tapes.
        tapes: read_only_texture(TAPES_FORMAT),
        /// Distance bricks of models.
        bricks: read_only_texture(BRICKS_FORMAT),
        /// The instancer, at a dynamic offset.
        instancer: uniform(true),
        /// Places of all instancers that have lists of them.
        places: read_storage(),
    }
}

/// Layouts that several passes share.
#[derive(Clone, Debug)]
pub struct Layouts {
    /// Group 0: `View`.
    pub view: BindGroupLayout,
    /// Group 1 of the field passes: [`SceneBindings`].
    pub scene: BindGroupLayout,
    /// The same for types of instancers: [`CopiesBindings`].
    pub copies: BindGroupLayout,
    /// Group 3: `DispatchParams`, at a dynamic offset.
    pub dispatch_params: BindGroupLayout,
}

impl Layouts {
    /// Creates the layouts.
    pub fn new(device: &wgpu::Device) -> Self {
        let everywhere = ShaderStages::COMPUTE | ShaderStages::VERTEX_FRAGMENT;
        Self {
            view: layout(device, "view", &[entry(0, everywhere, uniform(false))]),
            scene: SceneBindings::layout(device),
            copies: CopiesBindings::layout(device),
            dispatch_params: layout(device, "dispatch_params", &[entry(0, ShaderStages::COMPUTE, uniform(true))]),
        }
    }
}

/// A layout with these entries.
pub fn layout(device: &wgpu::Device, label: &str, entries: &[BindGroupLayoutEntry]) -> BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries })
}

/// An entry of a layout.
pub fn entry(binding: u32, visibility: ShaderStages, ty: BindingType) -> BindGroupLayoutEntry {
    BindGroupLayoutEntry { binding, visibility, ty, count: None }
}

/// A uniform buffer.
pub fn uniform(has_dynamic_offset: bool) -> BindingType {
    BindingType::Buffer { ty: BufferBindingType::Uniform, has_dynamic_offset, min_binding_size: None }
}

/// A read-only storage buffer.
pub fn read_storage() -> BindingType {
    BindingType::Buffer {
        ty: BufferBindingType::Storage { read_only: true },
        has_dynamic_offset: false,
        min_binding_size: None,
    }
}

/// A writable storage buffer.
pub fn write_storage() -> BindingType {
    BindingType::Buffer {
        ty: BufferBindingType::Storage { read_only: false },
        has_dynamic_offset: false,
        min_binding_size: None,
    }
}

/// A write-only storage texture.
pub fn write_texture(format: Format) -> BindingType {
    storage_texture(format, Access::WriteOnly)
}

/// A read-write storage texture.
pub fn read_write_texture(format: Format) -> BindingType {
    storage_texture(format, Access::ReadWrite)
}

/// A storage texture for reading.
pub fn read_only_texture(format: Format) -> BindingType {
    storage_texture(format, Access::ReadOnly)
}

fn storage_texture(format: Format, access: Access) -> BindingType {
    BindingType::StorageTexture { access, format, view_dimension: wgpu::TextureViewDimension::D2 }
}

/// A texture for single texel loads.
pub fn read_texture(unsigned: bool) -> BindingType {
    BindingType::Texture {
        sample_type: if unsigned {
            wgpu::TextureSampleType::Uint
        } else {
            wgpu::TextureSampleType::Float { filterable: false }
        },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    }
}

/// `size` bytes of a buffer at a dynamic offset.
pub fn window(buffer: &wgpu::Buffer, size: usize) -> wgpu::BindingResource<'_> {
    let size = std::num::NonZeroU64::new(size as u64);
    wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer, offset: 0, size })
}

/// A bind group of views and buffers, in the order of their bindings.
pub fn bind(
    device: &wgpu::Device,
    label: &str,
    layout: &BindGroupLayout,
    resources: &[wgpu::BindingResource<'_>],
) -> wgpu::BindGroup {
    let entries: Vec<_> = resources
        .iter()
        .enumerate()
        .map(|(i, resource)| wgpu::BindGroupEntry { binding: i as u32, resource: resource.clone() })
        .collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some(label), layout, entries: &entries })
}

/// A compute pipeline for `entry_point` of `source`.
pub fn compute_pipeline(
    device: &wgpu::Device,
    label: &str,
    source: String,
    entry_point: &str,
    layouts: &[&BindGroupLayout],
) -> wgpu::ComputePipeline {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(label),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(label),
        layout: Some(&pipeline_layout(device, label, layouts)),
        module: &module,
        entry_point: Some(entry_point),
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    })
}

/// A pipeline that draws all pixels of the picture by `entry_point` of `module`, which includes `common/screen.wgsl`.
pub fn screen_pipeline(
    device: &wgpu::Device,
    module: &wgpu::ShaderModule,
    entry_point: &str,
    layout: &wgpu::PipelineLayout,
    blend: Option<wgpu::BlendState>,
) -> wgpu::RenderPipeline {
    screen_pipeline_to(Format::Rgba8Unorm, device, module, entry_point, layout, blend)
}

/// The same for a target of another format.
pub fn screen_pipeline_to(
    format: Format,
    device: &wgpu::Device,
    module: &wgpu::ShaderModule,
    entry_point: &str,
    layout: &wgpu::PipelineLayout,
    blend: Option<wgpu::BlendState>,
) -> wgpu::RenderPipeline {
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(entry_point),
        layout: Some(layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("screen_vertex"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(entry_point),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(wgpu::ColorTargetState {
                format,
                blend,
                // Drawing over the picture must leave it opaque.
                write_mask: if blend.is_some() { wgpu::ColorWrites::COLOR } else { wgpu::ColorWrites::ALL },
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// Begins a render pass over the picture.
pub fn screen_pass<'e>(
    encoder: &'e mut wgpu::CommandEncoder,
    label: &str,
    color: &wgpu::TextureView,
    timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
) -> wgpu::RenderPass<'e> {
    let ops = wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store };
    let color = wgpu::RenderPassColorAttachment { view: color, depth_slice: None, resolve_target: None, ops };
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(label),
        color_attachments: &[Some(color)],
        timestamp_writes,
        ..Default::default()
    })
}

/// The layout of a pipeline with these groups.
pub fn pipeline_layout(device: &wgpu::Device, label: &str, layouts: &[&BindGroupLayout]) -> wgpu::PipelineLayout {
    let groups: Vec<_> = layouts.iter().map(|l| Some(*l)).collect();
    device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(label),
        bind_group_layouts: &groups,
        immediate_size: 0,
    })
}
