//! Textures of a picture whose samples accumulate: 40 bytes for each pixel, only once it does.

use wgpu::{TextureFormat, TextureUsages};

use super::targets::{Target, Targets};

/// Format of the sums: f32, since 16 bits would lose the light of single samples in the sum of many.
pub const SUM_FORMAT: TextureFormat = TextureFormat::Rgba32Float;

/// The textures, see the module.
#[derive(Debug)]
pub struct Accumulation {
    /// Linear light and coverage, summed: each sample reads one and writes the other, because not every device can
    /// blend into this format.
    sums: [Target; 2],
    /// Depth of the first sample, for marks over the picture.
    pub depth: Target,
    /// Leaf of the first sample.
    pub leaf: Target,
}

impl Accumulation {
    /// Textures for a picture of `size` pixels.
    pub fn new(device: &wgpu::Device, size: [u32; 2]) -> Self {
        let read = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC;
        let sum = |label| Target::new(device, label, size, SUM_FORMAT, read | TextureUsages::RENDER_ATTACHMENT);
        let kept = |label, format| Target::new(device, label, size, format, read | TextureUsages::COPY_DST);
        Self {
            sums: ["even sum", "odd sum"].map(sum),
            depth: kept("first depth", TextureFormat::R32Float),
            leaf: kept("first leaf", TextureFormat::R32Uint),
        }
    }

    /// The sum of the samples up to this one.
    pub fn sum(&self, index: u32) -> &Target {
        &self.sums[index as usize % 2]
    }

    /// The sum of the samples before this one.
    pub fn sum_before(&self, index: u32) -> &Target {
        self.sum(index + 1)
    }

    /// Keeps depth and leaf of the first sample.
    pub fn keep(&self, encoder: &mut wgpu::CommandEncoder, targets: &Targets) {
        for (from, to) in [(&targets.depth, &self.depth), (&targets.leaf, &self.leaf)] {
            encoder.copy_texture_to_texture(
                from.texture.as_image_copy(),
                to.texture.as_image_copy(),
                from.texture.size(),
            );
        }
    }
}
