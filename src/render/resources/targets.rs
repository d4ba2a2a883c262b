//! The textures that the passes share, each of the picture's size.
//!
//! | target | format | written by | holds |
//! |---|---|---|---|
//! | depth | R32Float | mesh, trace | distance along the pixel's ray, [`BACKGROUND`] without a hit |
//! | visibility | R32Uint | mesh, trace | component, or `MESH_BIT` and mesh, or `NO_LEAF` |
//! | march | R32Float | trace | where a march continues in the next relaunch |
//! | normal | Rgba32Float | mesh, surface | unit normal in the world; length of the field's gradient, 0 for meshes |
//! | hiz | R32Float | hiz, trace | the farthest depth in each subtile of 4 by 4 pixels; the texture may be wider |
//! | base color | Rgba16Float | mesh | of meshes: the linear base color |
//! | material | Rgba32Uint | mesh, surface | of fields: `shaders/common/mixture.wgsl`; of meshes: `mesh_look.wgsl` there |
//! | color | Rgba8Unorm | shade, debug_view, overlay | the picture, sRGB encoded |
//! | leaf | R32Uint | mesh, surface | entry of the subtree-extent array; the value of visibility where no field is |
//!
//! With instancers a buffer holds which copy each pixel shows: see `shaders/copy/copied.wgsl`.
//!
//! `shaders/common/depth.wgsl` implements the same conventions.

use wgpu::{TextureFormat, TextureUsages};

use crate::frame::plan::SUBTILES;
use crate::frame::rect::TILE;

/// Depth of pixels without a hit.
pub const BACKGROUND: f32 = 1e30;

/// Bytes of the buffer of copies: two entries per pixel.
pub fn copied_bytes(size: [u32; 2]) -> u64 {
    u64::from(size[0]) * u64::from(size[1]) * 32
}

/// The targets of a picture, see the module.
#[derive(Debug)]
pub struct Targets {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// See the module's table.
    pub depth: Target,
    /// See the module's table.
    pub visibility: Target,
    /// See the module's table.
    pub march: Target,
    /// See the module's table.
    pub hiz: Target,
    /// See the module's table.
    pub normal: Target,
    /// See the module's table.
    pub base_color: Target,
    /// See the module's table.
    pub material: Target,
    /// See the module's table.
    pub leaf: Target,
    /// See the module's table.
    pub color: Target,
    /// See the module's table.
    pub hardware_depth: Target,
    /// Which copy each pixel shows, if the scene has instancers.
    pub copied: Option<wgpu::Buffer>,
}

/// A texture and its view.
#[derive(Debug)]
pub struct Target {
    /// The texture.
    pub texture: wgpu::Texture,
    /// A view of the whole texture.
    pub view: wgpu::TextureView,
}

impl Targets {
    /// New targets of `size` pixels, both at least 1.
    pub fn new(device: &wgpu::Device, size: [u32; 2]) -> Self {
        let compute = TextureUsages::STORAGE_BINDING | TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC;
        let both = compute | TextureUsages::RENDER_ATTACHMENT;
        let target = |label, format, usage| Target::new(device, label, size, format, usage);
        let subtiles = size.map(|v| no_power_of_two(v.div_ceil(TILE / SUBTILES)));
        Self {
            size,
            depth: target("depth", TextureFormat::R32Float, both),
            visibility: target("visibility", TextureFormat::R32Uint, both),
            march: target("march", TextureFormat::R32Float, compute | TextureUsages::COPY_DST),
            hiz: Target::new(device, "hiz", subtiles, TextureFormat::R32Float, both),
            normal: target("normal", TextureFormat::Rgba32Float, both),
            base_color: target("base color", TextureFormat::Rgba16Float, both),
            material: target("material", TextureFormat::Rgba32Uint, both),
            leaf: target("leaf", TextureFormat::R32Uint, compute | TextureUsages::COPY_DST),
            color: target("color", TextureFormat::Rgba8Unorm, both),
            hardware_depth: target("hardware depth", TextureFormat::Depth32Float, TextureUsages::RENDER_ATTACHMENT),
            copied: None,
        }
    }

    /// Makes the buffer of copies. Returns whether it was missing.
    pub fn keep_copied(&mut self, device: &wgpu::Device) -> bool {
        let is_missing = self.copied.is_none();
        if is_missing {
            self.copied = Some(device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("copied"),
                size: copied_bytes(self.size),
                usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }));
        }
        is_missing
    }
}

/// The number, or a larger one if it is a power of two. lavapipe seems to compile a pipeline once for textures with
/// such sides and once for all others: 3.8 s within a frame when a coarse picture had 8 tiles to a side for the first
/// time.
fn no_power_of_two(side: u32) -> u32 {
    if side.is_power_of_two() { side.max(2) + 1 } else { side }
}

impl Target {
    /// A target for display, of the same kind as the color target.
    pub fn shown(device: &wgpu::Device, size: [u32; 2]) -> Self {
        let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC | TextureUsages::RENDER_ATTACHMENT;
        Self::new(device, "shown", size, TextureFormat::Rgba8Unorm, usage)
    }

    /// The whole target as a binding.
    pub fn binding(&self) -> wgpu::BindingResource<'_> {
        wgpu::BindingResource::TextureView(&self.view)
    }

    /// Its size in pixels.
    pub fn size(&self) -> [u32; 2] {
        let size = self.texture.size();
        [size.width, size.height]
    }

    /// A new target of `size` pixels.
    pub fn new(
        device: &wgpu::Device,
        label: &str,
        size: [u32; 2],
        format: TextureFormat,
        usage: TextureUsages,
    ) -> Self {
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some(label),
            size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        });
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        Self { texture, view }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_side_is_a_power_of_two() {
        for side in 1..2000 {
            let wider = no_power_of_two(side);
            assert!(wider >= side && wider <= side + 2 && !wider.is_power_of_two(), "{side}");
        }
    }
}
