//! The distance bricks of all models in one texture, as the arrays of the scene order them.

use super::buffers::DataTexture;
use super::layouts::BRICKS_FORMAT;
use isolith_field::FlatBricks;

/// The texture of bricks, see the module.
#[derive(Debug)]
pub struct BrickTexture {
    texture: DataTexture,
    held: FlatBricks,
}

impl BrickTexture {
    /// An empty texture.
    pub fn new(device: &wgpu::Device) -> Self {
        Self { texture: DataTexture::new(device, "bricks", BRICKS_FORMAT), held: FlatBricks::default() }
    }

    /// Stores these bricks; those that keep their place are not uploaded again. Returns whether the texture was
    /// replaced.
    pub fn hold(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, bricks: &FlatBricks) -> bool {
        let texel = self.texture.texel();
        let grown = self.texture.reserve(device, bricks.texels() * texel);
        let same = |(new, old): &(&std::sync::Arc<_>, &std::sync::Arc<_>)| std::sync::Arc::ptr_eq(new, old);
        let kept = if grown { 0 } else { bricks.all().iter().zip(self.held.all()).take_while(same).count() };
        let mut at = 0;
        for (index, held) in bricks.all().iter().enumerate() {
            for run in held.runs() {
                if index >= kept {
                    self.texture.write(queue, at * texel, bytemuck::cast_slice(run));
                }
                at += run.len();
            }
        }
        self.held = bricks.clone();
        grown
    }

    /// The whole texture as a view.
    pub fn view(&self) -> &wgpu::TextureView {
        self.texture.view()
    }

    /// The whole texture as a binding.
    pub fn binding(&self) -> wgpu::BindingResource<'_> {
        self.texture.binding()
    }

    /// Bytes uploaded so far.
    pub fn uploaded(&self) -> u64 {
        self.texture.uploaded()
    }
}
