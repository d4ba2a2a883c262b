//! Places copies and walks along rays on the GPU, for the tests that compare it with the CPU.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;
use wgpu::ShaderStages;

use crate::gpu::Gpu;
use crate::gpu::readback::read_words;
use crate::renderer::RenderError;
use crate::resources::buffers::SyncedBuffer;
use crate::resources::layouts::{bind, compute_pipeline, entry, layout, read_storage, uniform, write_storage};
use isolith_field::copies::{FlatInstancer, gpu_instancer, gpu_places};
use isolith_wgsl::assemble_plain;

/// A cell or a place, or a ray.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct CopyQuery {
    /// The cell, relative to the anchor; a place is its first number.
    pub cell: [i32; 3],
    /// The type that is asked for.
    pub kind: u32,
    /// Origin of the ray, relative to the eye.
    pub origin: [f32; 3],
    /// Radius of the cone at distance 1.
    pub spread: f32,
    /// Unit direction.
    pub direction: [f32; 3],
    /// End of the ray.
    pub far: f32,
}

/// What the shader finds.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct CopyAnswer {
    /// Absolute cell.
    pub cell: [i32; 3],
    /// Its type, or `u32::MAX`.
    pub kind: u32,
    /// Its place, relative to that of the anchor.
    pub position: [f32; 3],
    /// Change of the hue by dynamics.
    pub hue: f32,
    /// Quaternion.
    pub rotation: [f32; 4],
    /// Along its own axes.
    pub scale: [f32; 3],
    /// Factor of the dynamics.
    pub emission: f32,
    /// Hue, saturation, value, roughness of the material.
    pub color: [f32; 4],
    /// Another material, or `u32::MAX`.
    pub replaced: u32,
    /// Factor on the emission.
    pub glow: f32,
    /// Copies along the ray; `u32::MAX` if the walk was not at its end.
    pub visits: u32,
    /// Sum of the distances where the ray enters their spheres.
    pub entries: f32,
}

/// The copies of cells or places.
///
/// # Errors
/// The device fails.
pub fn placed(
    gpu: &Gpu,
    instancer: &FlatInstancer,
    eye: DVec3,
    queries: &[CopyQuery],
) -> Result<Vec<CopyAnswer>, RenderError> {
    run(gpu, "probe_cells", instancer, eye, queries)
}

/// The copies along rays.
///
/// # Errors
/// The device fails.
pub fn walked(
    gpu: &Gpu,
    instancer: &FlatInstancer,
    eye: DVec3,
    queries: &[CopyQuery],
) -> Result<Vec<CopyAnswer>, RenderError> {
    run(gpu, "probe_walks", instancer, eye, queries)
}

fn run(
    gpu: &Gpu,
    entry_point: &'static str,
    instancer: &FlatInstancer,
    eye: DVec3,
    queries: &[CopyQuery],
) -> Result<Vec<CopyAnswer>, RenderError> {
    let Gpu { device, queue, .. } = gpu;
    let stage = ShaderStages::COMPUTE;
    let uploaded = |mut buffer: SyncedBuffer, bytes: &[u8]| {
        buffer.set_with_room(device, queue, bytes, 0, 4);
        buffer
    };
    let rows = |bytes: &[u8]| uploaded(SyncedBuffer::rows(device, "probe"), bytes);
    let output = vec![0; queries.len().next_multiple_of(64) * size_of::<CopyAnswer>()];
    let (input, output) = (rows(bytemuck::cast_slice(queries)), rows(&output));
    let own = layout(device, "probe", &[entry(0, stage, read_storage()), entry(1, stage, write_storage())]);
    let group = bind(device, "probe", &own, &[input.binding(), output.binding()]);
    let placed = gpu_instancer(instancer, eye, 0);
    let uniforms = uploaded(SyncedBuffer::uniform(device, "probe"), bytemuck::bytes_of(&placed));
    let mut places = gpu_places(instancer).to_vec();
    places.resize(places.len().max(1), [0.0; 4]);
    let places = rows(bytemuck::cast_slice(&places));
    let of_copies = layout(device, "copies", &[entry(6, stage, uniform(false)), entry(7, stage, read_storage())]);
    let entries = [(6, &uniforms), (7, &places)]
        .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.binding() });
    let copies = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("copies"),
        layout: &of_copies,
        entries: &entries,
    });
    let text = assemble_plain("probe_copies.wgsl")?;
    let pipeline = compute_pipeline(device, "probe", text, entry_point, &[&own, &of_copies]);
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some(entry_point) });
    {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.set_bind_group(1, &copies, &[]);
        pass.dispatch_workgroups((queries.len() as u32).div_ceil(64), 1, 1);
    }
    queue.submit([encoder.finish()]);
    let words = read_words(gpu, output.buffer(), queries.len() * size_of::<CopyAnswer>() / 4)?;
    Ok(bytemuck::cast_slice(&words).to_vec())
}
