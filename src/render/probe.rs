//! The field at given points, computed by the GPU: what the agreement tests compare with the CPU twin.

use glam::DVec3;
use wgpu::ShaderStages;

use super::buffers::Mirror;
use super::gpu::Gpu;
use super::layouts::{Layouts, bind, compute_pipeline, entry, layout, read_storage, uniform, write_storage};
use super::readback::read_words;
use super::renderer::RenderError;
use super::shader::{Features, source};
use crate::flat::{Component, FlatScene};

/// The field of `component` at `points` (relative to its origin), by the interpreter of the passes.
pub fn field(gpu: &Gpu, flat: &FlatScene, component: &Component, points: &[DVec3]) -> Result<Vec<f32>, RenderError> {
    let Gpu { device, queue, .. } = gpu;
    let stage = ShaderStages::COMPUTE;
    let layouts = Layouts::new(device);
    let own = layout(device, "probe", &[entry(0, stage, uniform(false))]);
    let data = layout(device, "probe data", &[entry(0, stage, read_storage()), entry(1, stage, write_storage())]);
    let text = source("probe.wgsl", &Features::of(flat))?;
    let pipeline = compute_pipeline(device, "probe", text, "probe_field", &[&own, &layouts.scene, &data]);
    let uploaded = |bytes: &[u8]| {
        let mut mirror = Mirror::read_back(device, "probe");
        mirror.set(device, queue, bytes);
        mirror
    };
    let mut settings = Mirror::uniform(device, "probe");
    let numbers = [component.first, component.first + component.count, points.len() as u32, 0];
    settings.set(device, queue, bytemuck::cast_slice(&numbers));
    let scene = [
        uploaded(bytemuck::cast_slice(&flat.nodes)),
        uploaded(bytemuck::cast_slice(&flat.numbers)),
        uploaded(&[]),
        uploaded(bytemuck::cast_slice(&flat.materials)),
    ];
    let positions: Vec<[f32; 4]> = points.iter().map(|p| [p.x as f32, p.y as f32, p.z as f32, 0.0]).collect();
    let (positions, values) = (uploaded(bytemuck::cast_slice(&positions)), uploaded(&vec![0; points.len() * 4]));
    let groups = [
        bind(device, "probe", &own, &[settings.binding()]),
        bind(device, "scene", &layouts.scene, &scene.each_ref().map(Mirror::binding)),
        bind(device, "probe data", &data, &[positions.binding(), values.binding()]),
    ];
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(&pipeline);
        for (i, group) in groups.iter().enumerate() {
            pass.set_bind_group(i as u32, group, &[]);
        }
        pass.dispatch_workgroups((points.len() as u32).div_ceil(64), 1, 1);
    }
    queue.submit([encoder.finish()]);
    Ok(read_words(gpu, values.buffer(), points.len())?.into_iter().map(f32::from_bits).collect())
}
