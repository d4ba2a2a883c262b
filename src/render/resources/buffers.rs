//! Buffers and textures that mirror data of the CPU, and upload only what has changed.

use std::ops::Range;

/// A GPU buffer with a copy of its contents on the CPU.
#[derive(Debug)]
pub struct SyncedBuffer {
    label: &'static str,
    usage: wgpu::BufferUsages,
    buffer: wgpu::Buffer,
    held: Vec<u8>,
    uploaded: u64,
}

impl SyncedBuffer {
    /// An empty storage buffer.
    pub fn storage(device: &wgpu::Device, label: &'static str) -> Self {
        Self::new(device, label, wgpu::BufferUsages::STORAGE)
    }

    /// An empty uniform buffer.
    pub fn uniform(device: &wgpu::Device, label: &'static str) -> Self {
        Self::new(device, label, wgpu::BufferUsages::UNIFORM)
    }

    /// An empty buffer of data for each vertex or instance.
    pub fn vertex(device: &wgpu::Device, label: &'static str) -> Self {
        Self::new(device, label, wgpu::BufferUsages::VERTEX)
    }

    /// An empty storage buffer that the device writes and the CPU reads back.
    pub fn read_back(device: &wgpu::Device, label: &'static str) -> Self {
        Self::new(device, label, wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC)
    }

    /// An empty buffer for all uses: storage, uniform, copy in both directions.
    pub fn rows(device: &wgpu::Device, label: &'static str) -> Self {
        let usages = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_SRC;
        Self::new(device, label, usages)
    }

    /// An empty buffer for the arguments of indirect dispatches, which the device writes.
    pub fn indirect(device: &wgpu::Device, label: &'static str) -> Self {
        let usages = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::INDIRECT | wgpu::BufferUsages::COPY_SRC;
        Self::new(device, label, usages)
    }

    /// Uploads `bytes` whole, also over what the device has written. Returns whether the buffer was replaced.
    pub fn reset(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, bytes: &[u8]) -> bool {
        self.held.clear();
        self.set(device, queue, bytes)
    }

    /// Reserves `size` bytes with unspecified contents. Returns whether the buffer was replaced.
    pub fn reserve(&mut self, device: &wgpu::Device, size: usize) -> bool {
        let grown = size as u64 > self.buffer.size();
        if grown {
            self.buffer = create(device, self.label, self.usage, size.next_power_of_two());
            self.held.clear();
        }
        grown
    }

    fn new(device: &wgpu::Device, label: &'static str, usage: wgpu::BufferUsages) -> Self {
        let usage = usage | wgpu::BufferUsages::COPY_DST;
        Self { label, usage, buffer: create(device, label, usage, Self::LEAST), held: Vec::new(), uploaded: 0 }
    }

    /// Size of the smallest buffer, since a binding must not be empty.
    const LEAST: usize = 256;

    /// Sets the contents to `bytes` (a multiple of 4), and uploads the range between the first and the last difference.
    /// Returns whether the buffer was replaced, so that bind groups must be rebuilt.
    pub fn set(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, bytes: &[u8]) -> bool {
        self.set_with_room(device, queue, bytes, 0, 4).0
    }

    /// Like [`Self::set`], but reserves at least `room` bytes after `bytes`, with unspecified contents. Also returns
    /// the changed range, in whole units of `unit` bytes.
    pub fn set_with_room(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        bytes: &[u8],
        room: usize,
        unit: usize,
    ) -> (bool, Option<Range<usize>>) {
        let grown = self.reserve(device, bytes.len() + room);
        let changed = take_over(&mut self.held, bytes, unit);
        if let Some(range) = &changed {
            queue.write_buffer(&self.buffer, range.start as u64, &bytes[range.clone()]);
            self.uploaded += range.len() as u64;
        }
        (grown, changed)
    }

    /// The whole buffer as a binding.
    pub fn binding(&self) -> wgpu::BindingResource<'_> {
        self.buffer.as_entire_binding()
    }

    /// The buffer.
    pub fn buffer(&self) -> &wgpu::Buffer {
        &self.buffer
    }

    /// Bytes uploaded so far.
    pub fn uploaded(&self) -> u64 {
        self.uploaded
    }
}

/// A texture that holds data of the CPU in lines of texels.
#[derive(Debug)]
pub struct DataTexture {
    label: &'static str,
    format: wgpu::TextureFormat,
    texture: wgpu::Texture,
    view: wgpu::TextureView,
    uploaded: u64,
}

impl DataTexture {
    /// Texels in a line; `LINE` in `shaders/common/lines.wgsl`.
    pub const LINE: usize = 4096;

    /// An empty texture with texels of this format.
    pub fn new(device: &wgpu::Device, label: &'static str, format: wgpu::TextureFormat) -> Self {
        let (texture, view) = create_lines(device, label, format, 1);
        Self { label, format, texture, view, uploaded: 0 }
    }

    /// Capacity on this device, in bytes.
    pub fn most_bytes(&self, device: &wgpu::Device) -> usize {
        device.limits().max_texture_dimension_2d as usize * Self::LINE * self.texel()
    }

    /// Reserves `bytes`. Returns true if the texture was replaced; its contents are then lost.
    pub fn reserve(&mut self, device: &wgpu::Device, bytes: usize) -> bool {
        let lines = bytes.div_ceil(self.texel() * Self::LINE).max(1) as u32;
        let grown = lines > self.texture.height();
        if grown {
            let lines = lines.next_power_of_two().min(device.limits().max_texture_dimension_2d);
            (self.texture, self.view) = create_lines(device, self.label, self.format, lines);
        }
        grown
    }

    /// Writes whole texels from the byte `at` on: the end of a line, then whole lines, then the start of a line.
    pub fn write(&mut self, queue: &wgpu::Queue, at: usize, bytes: &[u8]) {
        let line = self.texel() * Self::LINE;
        let head = (at.next_multiple_of(line) - at).min(bytes.len());
        let whole = (bytes.len() - head) / line * line;
        for (from, to, width) in
            [(0, head, head), (head, head + whole, line), (head + whole, bytes.len(), bytes.len() - head - whole)]
        {
            self.write_lines(queue, at + from, &bytes[from..to], width);
        }
    }

    /// Writes lines of `width` bytes.
    fn write_lines(&mut self, queue: &wgpu::Queue, at: usize, bytes: &[u8], width: usize) {
        if bytes.is_empty() {
            return;
        }
        let (at, rows) = (at / self.texel(), (bytes.len() / width) as u32);
        let origin = wgpu::Origin3d { x: (at % Self::LINE) as u32, y: (at / Self::LINE) as u32, z: 0 };
        let target = wgpu::TexelCopyTextureInfo { origin, ..self.texture.as_image_copy() };
        let layout =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(width as u32), rows_per_image: Some(rows) };
        let size = wgpu::Extent3d { width: (width / self.texel()) as u32, height: rows, depth_or_array_layers: 1 };
        queue.write_texture(target, bytes, layout, size);
        self.uploaded += bytes.len() as u64;
    }

    /// The whole texture.
    pub fn view(&self) -> &wgpu::TextureView {
        &self.view
    }

    /// Bytes of a texel.
    pub fn texel(&self) -> usize {
        self.format.block_copy_size(None).expect("a format of colors") as usize
    }

    /// The whole texture as a binding.
    pub fn binding(&self) -> wgpu::BindingResource<'_> {
        wgpu::BindingResource::TextureView(&self.view)
    }

    /// Bytes uploaded so far.
    pub fn uploaded(&self) -> u64 {
        self.uploaded
    }
}

fn create_lines(
    device: &wgpu::Device,
    label: &str,
    format: wgpu::TextureFormat,
    lines: u32,
) -> (wgpu::Texture, wgpu::TextureView) {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width: DataTexture::LINE as u32, height: lines, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::STORAGE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
    (texture, view)
}

fn create(device: &wgpu::Device, label: &str, usage: wgpu::BufferUsages, size: usize) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: size.max(SyncedBuffer::LEAST) as u64,
        usage,
        mapped_at_creation: false,
    })
}

/// Sets `held` to `bytes`. Returns the range that differed, in whole units of `unit` bytes; `None` if nothing needs an
/// upload.
fn take_over(held: &mut Vec<u8>, bytes: &[u8], unit: usize) -> Option<Range<usize>> {
    let common = held.len().min(bytes.len());
    let same = common_prefix(&held[..common], &bytes[..common]);
    if same == bytes.len() {
        held.truncate(bytes.len());
        return None;
    }
    let tail = if held.len() == bytes.len() { common_suffix(&held[same..], &bytes[same..]) } else { 0 };
    held.resize(bytes.len(), 0);
    held[same..].copy_from_slice(&bytes[same..]);
    Some(same / unit * unit..(bytes.len() - tail).next_multiple_of(unit))
}

/// Length of the common prefix. Comparing blocks runs at the speed of memory.
fn common_prefix(a: &[u8], b: &[u8]) -> usize {
    const BLOCK: usize = 4096;
    let blocks = a.chunks(BLOCK).zip(b.chunks(BLOCK)).take_while(|(x, y)| x == y).count();
    let start = (blocks * BLOCK).min(a.len());
    start + a[start..].iter().zip(&b[start..]).take_while(|(x, y)| x == y).count()
}

/// Length of the common suffix.
fn common_suffix(a: &[u8], b: &[u8]) -> usize {
    const BLOCK: usize = 4096;
    let blocks = a.rchunks(BLOCK).zip(b.rchunks(BLOCK)).take_while(|(x, y)| x == y).count();
    let end = (blocks * BLOCK).min(a.len());
    let (a, b) = (&a[..a.len() - end], &b[..b.len() - end]);
    end + a.iter().rev().zip(b.iter().rev()).take_while(|(x, y)| x == y).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn common_parts_are_found_across_blocks() {
        let a: Vec<u8> = (0..20_000_u32).map(|i| (i % 251) as u8).collect();
        let mut b = a.clone();
        b[9_000] ^= 1;
        assert_eq!(common_prefix(&a, &b), 9_000);
        assert_eq!(common_suffix(&a, &b), 20_000 - 9_001);
        assert_eq!(common_prefix(&a, &a), 20_000);
        assert_eq!(common_suffix(&a, &a), 20_000);
        assert_eq!(common_prefix(&[], &[]), 0);
    }
}
