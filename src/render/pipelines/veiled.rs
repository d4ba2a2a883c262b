//! Bindings of the trace pass over components that rays may pass: those of the others, and what tells the opacity.

use wgpu::{BindGroup, BindGroupEntry, BindGroupLayout, BindingResource, ShaderStages, TextureFormat};

use super::field_buffers::FieldBuffers;
use crate::resources::layouts::{
    TEXELS_FORMAT, entry, layout, read_only_texture, read_storage, read_write_texture, write_storage, write_texture,
};
use crate::resources::targets::Targets;
use crate::resources::texture_resources::TextureBindings;
use isolith_wgsl::Veil;

const LABEL: &str = "trace targets of veils";
/// Places of the bindings, see `shaders/common/veil.wgsl`.
const COPIED: u32 = 9;
const MATERIALS: u32 = 10;
const TEXTURES: [u32; 3] = [11, 12, 13];

/// Layouts of the targets, without and with copies, for each [`Veil`] but none.
#[derive(Clone, Debug)]
pub struct VeiledLayouts([BindGroupLayout; 4]);

/// What the bindings hold besides those of other components.
#[derive(Clone, Debug)]
pub struct VeilBindings<'a> {
    /// The copies that pixels show, for types of instancers.
    pub copied: Option<&'a wgpu::Buffer>,
    /// The materials of the scene.
    pub materials: BindingResource<'a>,
    /// Its textures, if they give the opacity.
    pub textures: Option<TextureBindings<'a>>,
}

impl VeiledLayouts {
    /// Creates the layouts.
    pub fn new(device: &wgpu::Device) -> Self {
        let make = |veil, copies| {
            let plain = [
                read_write_texture(TextureFormat::R32Float),
                write_texture(TextureFormat::R32Uint),
                read_write_texture(TextureFormat::R32Float),
                write_texture(TextureFormat::R32Float),
                write_storage(),
                write_storage(),
                write_storage(),
                write_storage(),
                read_storage(),
            ];
            let of_copies = [(COPIED, write_storage())].into_iter().filter(|_| copies);
            let of_textures = [read_storage(), read_storage(), read_only_texture(TEXELS_FORMAT)];
            let of_textures = TEXTURES.into_iter().zip(of_textures).filter(|_| veil == Veil::Textured);
            let all = (0..).zip(plain).chain(of_copies).chain([(MATERIALS, read_storage())]).chain(of_textures);
            let entries: Vec<_> = all.map(|(at, ty)| entry(at, ShaderStages::COMPUTE, ty)).collect();
            layout(device, LABEL, &entries)
        };
        Self([
            make(Veil::Plain, false),
            make(Veil::Plain, true),
            make(Veil::Textured, false),
            make(Veil::Textured, true),
        ])
    }

    /// The layout for such a pipeline.
    pub fn layout(&self, veil: Veil, copies: bool) -> &BindGroupLayout {
        &self.0[2 * usize::from(veil == Veil::Textured) + usize::from(copies)]
    }

    /// Bind groups of the pass, as `bind_trace` of the other components makes them.
    pub fn bind(
        &self,
        device: &wgpu::Device,
        targets: &Targets,
        lists: FieldBuffers<'_>,
        own: &VeilBindings<'_>,
    ) -> [BindGroup; 2] {
        let VeilBindings { copied, materials, textures } = own;
        let veil = if textures.is_some() { Veil::Textured } else { Veil::Plain };
        [lists.ray_counts, lists.nothing].map(|ray_counts| {
            let plain = [
                targets.depth.binding(),
                targets.visibility.binding(),
                targets.march.binding(),
                targets.hiz.binding(),
                lists.subtiles.as_entire_binding(),
                lists.march_counts.as_entire_binding(),
                lists.rays.as_entire_binding(),
                ray_counts.as_entire_binding(),
                lists.subtile_counts.as_entire_binding(),
            ];
            let copied = copied.map(|copied| (COPIED, copied.as_entire_binding()));
            let textures = textures.clone().map(|TextureBindings { placed, sets, texels }| [placed, sets, texels]);
            let textures = textures.into_iter().flat_map(|resources| TEXTURES.into_iter().zip(resources));
            let all = (0..).zip(plain).chain(copied).chain([(MATERIALS, materials.clone())]).chain(textures);
            let entries: Vec<_> = all.map(|(binding, resource)| BindGroupEntry { binding, resource }).collect();
            let layout = self.layout(veil, own.copied.is_some());
            device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some(LABEL), layout, entries: &entries })
        })
    }
}
