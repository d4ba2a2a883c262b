//! Properties of a driver that only a trial shows.

use crate::frame::plan::MAX_ITERATIONS;
use crate::gpu::readback::read_words;
use crate::gpu::{Gpu, GpuError};
use crate::resources::buffers::SyncedBuffer;
use crate::resources::layouts::{bind, compute_pipeline, entry, layout, write_storage};
use isolith_wgsl::assemble_plain;

/// Iterations that the trial loop asks for.
const TRIED: u32 = 100_000;

/// How many iterations of a loop the driver executes, of 100 000: lavapipe 22 ends every loop after 65 535 without an
/// error. Fails if they are fewer than the renderer needs.
pub fn loop_iterations(gpu: &Gpu) -> Result<u32, GpuError> {
    let device = &gpu.device;
    let group_layout = layout(device, "driver", &[entry(0, wgpu::ShaderStages::COMPUTE, write_storage())]);
    let text = assemble_plain("driver.wgsl").map_err(|e| GpuError::Refused(e.to_string()))?;
    let pipeline = compute_pipeline(device, "driver", text, "driver_count_iterations", &[&group_layout]);
    let mut counted = SyncedBuffer::read_back(device, "counted");
    counted.set(device, &gpu.queue, bytemuck::cast_slice(&[0, TRIED, 0, 0]));
    let group = bind(device, "driver", &group_layout, &[counted.binding()]);
    let label = Some("driver");
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label });
    {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label, timestamp_writes: None });
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(1, 1, 1);
    }
    gpu.queue.submit([encoder.finish()]);
    let done = read_words(gpu, counted.buffer(), 1)?[0];
    if done < MAX_ITERATIONS {
        let reason = format!("the driver ends loops after {done} iterations; {MAX_ITERATIONS} are needed");
        return Err(GpuError::NoDevice { adapter: gpu.info.name.clone(), reason });
    }
    Ok(done)
}
