//! What each pixel took, counted on the device. The counts stand at the end of the buffer of counts; without pipelines
//! that count there is no room for them, and nothing is written.

use crate::frame::plan::TILE;
use crate::gpu::readback::read_words_at;
use crate::gpu::{Gpu, GpuError};
use crate::resources::buffers::SyncedBuffer;

/// Words that are counted for each component: rays without an end, evaluations by rays, rays started, and by rays and
/// cones cells and tape entries read. `COMPONENT_COUNTS` in `shaders/common/counts.wgsl`.
pub const COMPONENT_COUNTS: usize = 5;
/// Words that are counted for each pixel and each tile. `PIXEL_COUNTS` in `shaders/common/counts.wgsl`.
pub const PIXEL_COUNTS: usize = 4;

/// What rays or cones took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TraceCounts {
    /// Evaluations of fields.
    pub evaluations: u32,
    /// Rays started, one for each component that is met; 0 for cones.
    pub rays: u32,
    /// Cells of tapes that were looked up.
    pub cells: u32,
    /// Entries of tapes that were read.
    pub entries: u32,
}

/// What each pixel of a picture took, of all components together. Normals are not counted: they are one evaluation
/// for each pixel that shows a field.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PixelCounts {
    /// Width and height of the picture.
    pub size: [u32; 2],
    /// By rays, for each pixel, row by row from the upper left corner.
    pub pixels: Vec<TraceCounts>,
    /// By cones, for each tile of 8 by 8 pixels; a cone looks for all of them, so they are counted apart.
    pub tiles: Vec<TraceCounts>,
}

/// How a number is spread over the pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Distribution {
    /// Of all pixels.
    pub mean: f64,
    /// 99 of 100 pixels have no more.
    pub p99: f64,
    /// The most.
    pub max: f64,
}

impl PixelCounts {
    /// Evaluations by the rays of a pixel.
    pub fn steps(&self) -> Distribution {
        let mut all: Vec<u32> = self.pixels.iter().map(|pixel| pixel.evaluations).collect();
        all.sort_unstable();
        let Some(max) = all.last() else { return Distribution::default() };
        let mean = all.iter().map(|v| f64::from(*v)).sum::<f64>() / all.len() as f64;
        Distribution { mean, p99: f64::from(all[(all.len() - 1) * 99 / 100]), max: f64::from(*max) }
    }

    /// A pixel's share, a 64th, of what the cones of its tile took, with what its own rays took.
    pub fn with_cones(&self, x: u32, y: u32, of: impl Fn(&TraceCounts) -> u32) -> f64 {
        let [width, _] = self.size;
        let tile = (y / TILE * width.div_ceil(TILE) + x / TILE) as usize;
        let own = of(&self.pixels[(y * width + x) as usize]);
        f64::from(own) + f64::from(of(&self.tiles[tile])) / f64::from(TILE * TILE)
    }

    /// By rays and cones, over all pixels.
    pub fn per_pixel(&self, of: impl Fn(&TraceCounts) -> u32) -> f64 {
        let sum: u64 = self.pixels.iter().chain(&self.tiles).map(|counted| u64::from(of(counted))).sum();
        sum as f64 / self.pixels.len().max(1) as f64
    }
}

/// The buffer of counts: of components at its beginning; where pipelines count, of pixels and tiles at its end.
#[derive(Debug)]
pub struct MarchCounts {
    words: SyncedBuffer,
    /// Whether pipelines count.
    pub is_on: bool,
}

impl MarchCounts {
    /// No counts yet.
    pub fn new(device: &wgpu::Device, is_on: bool) -> Self {
        Self { words: SyncedBuffer::read_back(device, "march counts"), is_on }
    }

    /// The buffer.
    pub fn buffer(&self) -> &wgpu::Buffer {
        self.words.buffer()
    }

    /// Words that a picture of this size needs for its pixels and tiles; none where nobody counts.
    fn pixel_words(&self, size: [u32; 2]) -> usize {
        let of = |sides: [u32; 2]| sides[0] as usize * sides[1] as usize;
        if self.is_on { (of(size) + of(size.map(|side| side.div_ceil(TILE)))) * PIXEL_COUNTS } else { 0 }
    }

    /// Whether a binding of so many bytes can hold the counts of such a picture.
    pub fn fit(&self, components: usize, size: [u32; 2], most: u64) -> bool {
        let words = components * COMPONENT_COUNTS + self.pixel_words(size);
        (words as u64 * 4).next_power_of_two() <= most
    }

    /// Makes room for the counts of so many components and a picture of this size, and sets those of the components
    /// to nothing. True where the buffer is another one.
    pub fn reset(&mut self, gpu: &Gpu, components: usize, size: [u32; 2]) -> bool {
        let nothing = vec![0; components * COMPONENT_COUNTS * 4];
        let bytes = nothing.len() + self.pixel_words(size) * 4;
        let grown = self.words.reserve(&gpu.device, bytes);
        self.words.reset(&gpu.device, &gpu.queue, &nothing) || grown
    }

    /// Sets what pixels and tiles took to nothing.
    pub fn clear_pixels(&self, encoder: &mut wgpu::CommandEncoder, size: [u32; 2]) {
        let bytes = self.pixel_words(size) as u64 * 4;
        if bytes > 0 {
            encoder.clear_buffer(self.buffer(), self.buffer().size() - bytes, Some(bytes));
        }
    }

    /// What was counted for each component.
    pub fn of_components(&self, gpu: &Gpu, components: usize) -> Result<Vec<[u32; COMPONENT_COUNTS]>, GpuError> {
        let words = read_words_at(gpu, self.buffer(), 0, components * COMPONENT_COUNTS)?;
        Ok(words.as_chunks().0.to_vec())
    }

    /// What each pixel of a picture of this size took; empty where pipelines do not count.
    pub fn of_pixels(&self, gpu: &Gpu, size: [u32; 2]) -> Result<PixelCounts, GpuError> {
        let count = self.pixel_words(size);
        let first = self.buffer().size() as usize / 4 - count;
        let words = read_words_at(gpu, self.buffer(), first, count)?;
        let counted = |w: &[u32]| TraceCounts { evaluations: w[0], rays: w[1], cells: w[2], entries: w[3] };
        let mut pixels: Vec<TraceCounts> = words.chunks_exact(PIXEL_COUNTS).map(counted).collect();
        let tiles = pixels.split_off(if count == 0 { 0 } else { size[0] as usize * size[1] as usize });
        Ok(PixelCounts { size, pixels, tiles })
    }
}
