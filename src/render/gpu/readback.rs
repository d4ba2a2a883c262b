//! Copies targets and buffers back to the CPU.

use std::time::Duration;

use crate::gpu::{Gpu, GpuError};
use crate::resources::targets::{BACKGROUND, Target, Targets};
use isolith_field::{BACKGROUND_DEPTH, GBuffer};

/// How long to wait for the map callback once the device has finished all its work.
const CALL_BACK: Duration = Duration::from_secs(30);

/// The picture with depth, leaf and normal of every pixel.
pub fn read_buffers(gpu: &Gpu, targets: &Targets) -> Result<GBuffer, GpuError> {
    let [width, height] = targets.size;
    let depth: Vec<f32> = bytemuck::pod_collect_to_vec(&read_texture(gpu, &targets.depth, 4)?);
    let leaf: Vec<u32> = bytemuck::pod_collect_to_vec(&read_texture(gpu, &targets.leaf, 4)?);
    let normal: Vec<[f32; 4]> = bytemuck::pod_collect_to_vec(&read_texture(gpu, &targets.normal, 16)?);
    let color = read_color(gpu, &targets.color)?;
    Ok(GBuffer {
        width,
        height,
        depth: depth.iter().map(|d| if *d >= BACKGROUND { BACKGROUND_DEPTH } else { *d }).collect(),
        leaf,
        normal: normal.iter().map(|n| [n[0], n[1], n[2]]).collect(),
        color,
        radiance: Vec::new(),
    })
}

/// The mean of `samples` accumulated samples.
pub fn read_radiance(gpu: &Gpu, sum: &Target, samples: u32) -> Result<Vec<[f32; 4]>, GpuError> {
    let sums: Vec<[f32; 4]> = bytemuck::pod_collect_to_vec(&read_texture(gpu, sum, 16)?);
    Ok(sums.into_iter().map(|sum| sum.map(|value| value / samples as f32)).collect())
}

/// The colors of a target, row by row.
pub fn read_color(gpu: &Gpu, target: &Target) -> Result<Vec<[u8; 4]>, GpuError> {
    Ok(bytemuck::pod_collect_to_vec(&read_texture(gpu, target, 4)?))
}

/// The linear base colors of meshes, where one is seen.
pub fn read_mesh_colors(gpu: &Gpu, targets: &Targets) -> Result<Vec<[f32; 3]>, GpuError> {
    let halves: Vec<[u16; 4]> = bytemuck::pod_collect_to_vec(&read_texture(gpu, &targets.base_color, 8)?);
    Ok(halves.iter().map(|[r, g, b, _]| [*r, *g, *b].map(single)).collect())
}

/// An f16, which is not negative and finite, as f32.
fn single(half: u16) -> f32 {
    let (exponent, mantissa) = (i32::from(half >> 10 & 0x1f), f32::from(half & 0x3ff) / 1024.0);
    match exponent {
        0 => mantissa * 2.0_f32.powi(-14),
        _ => (1.0 + mantissa) * 2.0_f32.powi(exponent - 15),
    }
}

/// The texels of a target, row by row without padding.
fn read_texture(gpu: &Gpu, target: &Target, bytes_per_texel: u32) -> Result<Vec<u8>, GpuError> {
    let size = target.texture.size();
    let row = (size.width * bytes_per_texel) as usize;
    let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT as usize);
    let buffer = landing(gpu, (padded * size.height as usize) as u64);
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("read back") });
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(padded as u32),
        rows_per_image: Some(size.height),
    };
    encoder.copy_texture_to_buffer(
        target.texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo { buffer: &buffer, layout },
        size,
    );
    gpu.queue.submit([encoder.finish()]);
    let bytes = read_mapped(gpu, &buffer)?;
    Ok(bytes.chunks_exact(padded).flat_map(|r| &r[..row]).copied().collect())
}

/// The first `count` words of a buffer.
pub fn read_words(gpu: &Gpu, source: &wgpu::Buffer, count: usize) -> Result<Vec<u32>, GpuError> {
    read_words_at(gpu, source, 0, count)
}

/// `count` words of a buffer, from word `first` on.
pub fn read_words_at(gpu: &Gpu, source: &wgpu::Buffer, first: usize, count: usize) -> Result<Vec<u32>, GpuError> {
    if count == 0 {
        return Ok(Vec::new());
    }
    let size = count as u64 * 4;
    let buffer = landing(gpu, size);
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("read back") });
    encoder.copy_buffer_to_buffer(source, first as u64 * 4, &buffer, 0, size);
    gpu.queue.submit([encoder.finish()]);
    Ok(bytemuck::pod_collect_to_vec(&read_mapped(gpu, &buffer)?))
}

fn landing(gpu: &Gpu, size: u64) -> wgpu::Buffer {
    gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("read back"),
        size,
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

fn read_mapped(gpu: &Gpu, buffer: &wgpu::Buffer) -> Result<Vec<u8>, GpuError> {
    let slice = buffer.slice(..);
    let (sender, receiver) = std::sync::mpsc::channel();
    slice.map_async(wgpu::MapMode::Read, move |result| {
        // The receiver waits below. If it has given up, nobody needs the result.
        let _ = sender.send(result);
    });
    gpu.wait()?;
    // If several threads wait for one device, another of them may be about to run the callback.
    match receiver.recv_timeout(CALL_BACK) {
        Ok(Ok(())) => {}
        _ => return Err(GpuError::Refused("a buffer could not be read back".into())),
    }
    let mapped = slice.get_mapped_range().map_err(|e| GpuError::Refused(e.to_string()))?;
    Ok(mapped.to_vec())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_are_read_exactly() {
        for (half, value) in [(0, 0.0), (0x3c00, 1.0), (0x3800, 0.5), (0x3555, 0.33325195), (1, 2.0_f32.powi(-24))] {
            assert_eq!(single(half), value, "{half:x}");
        }
    }

    /// A thread's wait may end before another thread, which saw the work finish, has run the callback.
    #[test]
    fn many_threads_may_read_from_one_device() {
        let gpu = Gpu::headless().unwrap_or_else(|error| panic!("{error}"));
        std::thread::scope(|scope| {
            for thread in 0..32_u32 {
                let gpu = &gpu;
                scope.spawn(move || {
                    let words = [thread, thread + 1, thread * 7];
                    let source = gpu.device.create_buffer(&wgpu::BufferDescriptor {
                        label: Some("source"),
                        size: 12,
                        usage: wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
                        mapped_at_creation: false,
                    });
                    gpu.queue.write_buffer(&source, 0, bytemuck::cast_slice(&words));
                    for _ in 0..300 {
                        assert_eq!(read_words(gpu, &source, 3).expect("words"), words);
                    }
                });
            }
        });
    }
}
