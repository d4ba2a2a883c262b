//! The textures of materials on the device. They exist from the first scene on that uses some.

use crate::gpu::Gpu;
use crate::resources::buffers::{DataTexture, SyncedBuffer};
use crate::resources::layouts::TEXELS_FORMAT;
use isolith_field::{FlatImage, FlatScene, gpu_textures, texel_words};
use isolith_geometry::Camera;

/// The textures as bindings.
#[derive(Clone, Debug)]
pub struct TextureBindings<'a> {
    /// Where each entry of the materials has its textures.
    pub placed: wgpu::BindingResource<'a>,
    /// What the textures show.
    pub sets: wgpu::BindingResource<'a>,
    /// All images.
    pub texels: wgpu::BindingResource<'a>,
}

/// The resources, see the module.
#[derive(Debug, Default)]
pub struct TextureResources {
    held: Option<Held>,
    /// Whether the scene at hand uses textures.
    is_used: bool,
}

#[derive(Debug)]
struct Held {
    placed: SyncedBuffer,
    sets: SyncedBuffer,
    texels: DataTexture,
    /// The images in `texels`.
    images: Vec<FlatImage>,
}

impl TextureResources {
    /// Uploads what has changed. Returns whether bind groups must be rebuilt.
    pub fn upload(&mut self, gpu: &Gpu, flat: &FlatScene, camera: &Camera) -> bool {
        let Gpu { device, queue, .. } = gpu;
        let placed = gpu_textures(flat, camera);
        let was_used = std::mem::replace(&mut self.is_used, !placed.is_empty());
        if !self.is_used {
            return was_used;
        }
        let held = self.held.get_or_insert_with(|| Held {
            placed: SyncedBuffer::storage(device, "placed textures"),
            sets: SyncedBuffer::storage(device, "texture sets"),
            texels: DataTexture::new(device, "texels", TEXELS_FORMAT),
            images: Vec::new(),
        });
        let mut is_new = !was_used;
        is_new |= held.placed.set(device, queue, bytemuck::cast_slice(&placed));
        is_new |= held.sets.set(device, queue, bytemuck::cast_slice(&flat.textures.sets));
        if held.images != flat.textures.images {
            let words = texel_words(&flat.textures.images);
            let bytes: &[u8] = bytemuck::cast_slice(&words);
            is_new |= held.texels.reserve(device, bytes.len());
            held.texels.write(queue, 0, bytes);
            held.images.clone_from(&flat.textures.images);
        }
        is_new
    }

    /// The bindings, if the scene uses textures.
    pub fn bindings(&self) -> Option<TextureBindings<'_>> {
        let held = self.held.as_ref().filter(|_| self.is_used)?;
        Some(TextureBindings {
            placed: held.placed.binding(),
            sets: held.sets.binding(),
            texels: held.texels.binding(),
        })
    }
}
