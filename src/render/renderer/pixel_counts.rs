//! Counters of components and pixels. Those of pixels follow at the end of the buffer. If the pipelines do not count,
//! the buffer has no room for them, and no pass writes them.

use crate::frame::rect::TILE;
use crate::gpu::readback::read_words_at;
use crate::gpu::{Gpu, GpuError};
use crate::resources::buffers::SyncedBuffer;

/// Counters of each component: rays without an end, evaluations by rays, started rays, and, by rays and cones, tape
/// cells and entries read. `COMPONENT_COUNTS` in `shaders/common/counts.wgsl`.
pub const COMPONENT_COUNTS: usize = 5;
/// Counters of each pixel and each tile. `PIXEL_COUNTS` in `shaders/common/counts.wgsl`.
pub const PIXEL_COUNTS: usize = 4;

/// Counters of rays or cones.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TraceCounts {
    /// Evaluations of fields.
    pub evaluations: u32,
    /// Started rays, one for each component that a ray meets; 0 for cones.
    pub rays: u32,
    /// Tape cells looked up.
    pub cells: u32,
    /// Tape entries read.
    pub entries: u32,
}

/// Counters of each pixel of a picture, over all components. They leave out normals, which take one evaluation for each
/// pixel that shows a field.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PixelCounts {
    /// Width and height of the picture.
    pub size: [u32; 2],
    /// Counters of the rays of each pixel, row by row from the upper left corner.
    pub pixels: Vec<TraceCounts>,
    /// Counters of the cones of each tile of 8 by 8 pixels. A cone serves all pixels of its tile, so they count apart.
    pub tiles: Vec<TraceCounts>,
}

/// Distribution of a number over the pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Distribution {
    /// Mean of all pixels.
    pub mean: f64,
    /// 99th percentile.
    pub p99: f64,
    /// Maximum.
    pub max: f64,
}

impl PixelCounts {
    /// Distribution of the evaluations by the rays of a pixel.
    pub fn steps(&self) -> Distribution {
        let mut all: Vec<u32> = self.pixels.iter().map(|pixel| pixel.evaluations).collect();
        all.sort_unstable();
        let Some(max) = all.last() else { return Distribution::default() };
        let mean = all.iter().map(|v| f64::from(*v)).sum::<f64>() / all.len() as f64;
        Distribution { mean, p99: f64::from(all[(all.len() - 1) * 99 / 100]), max: f64::from(*max) }
    }

    /// A pixel's own rays, plus a 64th of the cones of its tile.
    pub fn with_cones(&self, x: u32, y: u32, of: impl Fn(&TraceCounts) -> u32) -> f64 {
        let [width, _] = self.size;
        let tile = (y / TILE * width.div_ceil(TILE) + x / TILE) as usize;
        let own = of(&self.pixels[(y * width + x) as usize]);
        f64::from(own) + f64::from(of(&self.tiles[tile])) / f64::from(TILE * TILE)
    }

    /// Rays and cones, averaged over all pixels.
    pub fn per_pixel(&self, of: impl Fn(&TraceCounts) -> u32) -> f64 {
        let sum: u64 = self.pixels.iter().chain(&self.tiles).map(|counted| u64::from(of(counted))).sum();
        sum as f64 / self.pixels.len().max(1) as f64
    }
}

/// The buffer of counters: first those of components; if pipelines count, then those of pixels and tiles.
#[derive(Debug)]
pub struct MarchCounts {
    words: SyncedBuffer,
    /// Whether pipelines count.
    pub is_on: bool,
}

impl MarchCounts {
    /// A buffer without counters.
    pub fn new(device: &wgpu::Device, is_on: bool) -> Self {
        Self { words: SyncedBuffer::read_back(device, "march counts"), is_on }
    }

    /// The buffer.
    pub fn buffer(&self) -> &wgpu::Buffer {
        self.words.buffer()
    }

    /// Words for the pixels and tiles of a picture of this size; none if the pipelines do not count.
    fn pixel_words(&self, size: [u32; 2]) -> usize {
        let of = |sides: [u32; 2]| sides[0] as usize * sides[1] as usize;
        if self.is_on { (of(size) + of(size.map(|side| side.div_ceil(TILE)))) * PIXEL_COUNTS } else { 0 }
    }

    /// Whether the counters of such a picture fit into a binding of `most` bytes.
    pub fn fit(&self, components: usize, size: [u32; 2], most: u64) -> bool {
        let words = components * COMPONENT_COUNTS + self.pixel_words(size);
        (words as u64 * 4).next_power_of_two() <= most
    }

    /// Makes room for the counters of `components` components and a picture of this size, and resets those of the
    /// components. Returns true if the buffer was replaced.
    pub fn reset(&mut self, gpu: &Gpu, components: usize, size: [u32; 2]) -> bool {
        let nothing = vec![0; components * COMPONENT_COUNTS * 4];
        let bytes = nothing.len() + self.pixel_words(size) * 4;
        let grown = self.words.reserve(&gpu.device, bytes);
        self.words.reset(&gpu.device, &gpu.queue, &nothing) || grown
    }

    /// Resets the counters of pixels and tiles.
    pub fn clear_pixels(&self, encoder: &mut wgpu::CommandEncoder, size: [u32; 2]) {
        let bytes = self.pixel_words(size) as u64 * 4;
        if bytes > 0 {
            encoder.clear_buffer(self.buffer(), self.buffer().size() - bytes, Some(bytes));
        }
    }

    /// Reads the counters of each component.
    pub fn of_components(&self, gpu: &Gpu, components: usize) -> Result<Vec<[u32; COMPONENT_COUNTS]>, GpuError> {
        let words = read_words_at(gpu, self.buffer(), 0, components * COMPONENT_COUNTS)?;
        Ok(words.as_chunks().0.to_vec())
    }

    /// Reads the counters of each pixel of a picture of this size; empty if the pipelines do not count.
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
