//! Reflects light and mixes materials on the GPU, for the tests that compare it with the CPU.

use bytemuck::{Pod, Zeroable};
use wgpu::ShaderStages;

use crate::gpu::Gpu;
use crate::gpu::readback::read_words;
use crate::renderer::RenderError;
use crate::resources::buffers::SyncedBuffer;
use crate::resources::layouts::{compute_pipeline, entry, layout, read_storage, write_storage};
use isolith_field::FlatMaterial;
use isolith_field::mixture::MIXED;
use isolith_wgsl::{Evaluator, OpSet, Options, assemble};

/// A material, seen from a direction and lit from one.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct BrdfQuery {
    /// The material.
    pub material: FlatMaterial,
    /// Unit normal.
    pub normal: [f32; 3],
    /// Unused.
    pub padding_0: f32,
    /// Unit direction to the eye.
    pub to_eye: [f32; 3],
    /// Unused.
    pub padding_1: f32,
    /// Unit direction to the light.
    pub to_light: [f32; 3],
    /// Unused.
    pub padding_2: f32,
}

/// What the shader finds.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct BrdfAnswer {
    /// `brdf_direct`.
    pub direct: [f32; 3],
    /// The shares of the environment.
    pub coat: f32,
    /// Diffuse.
    pub diffuse: [f32; 3],
    /// Roughness of the coat.
    pub coat_roughness: f32,
    /// Specular.
    pub specular: [f32; 3],
    /// Its roughness.
    pub roughness: f32,
}

/// The light that materials reflect. Without `layers`, by the source for scenes of Blinn-Phong materials.
///
/// # Errors
/// The device fails.
pub fn reflected(gpu: &Gpu, queries: &[BrdfQuery], layers: bool) -> Result<Vec<BrdfAnswer>, RenderError> {
    let probe = Probe { entry: "probe_brdf", first: 0, layers };
    let words = probe.run(gpu, bytemuck::cast_slice(queries), &[], queries.len(), size_of::<BrdfAnswer>())?;
    Ok(bytemuck::cast_slice(&words).to_vec())
}

/// The materials of mixtures in their encoding.
///
/// # Errors
/// The device fails.
pub fn mixed(
    gpu: &Gpu,
    materials: &[FlatMaterial],
    mixtures: &[[u32; MIXED]],
) -> Result<Vec<FlatMaterial>, RenderError> {
    let probe = Probe { entry: "probe_mixture", first: 3, layers: true };
    let (mixtures, count) = (bytemuck::cast_slice(mixtures), mixtures.len());
    let words = probe.run(gpu, mixtures, bytemuck::cast_slice(materials), count, size_of::<FlatMaterial>())?;
    Ok(bytemuck::cast_slice(&words).to_vec())
}

/// An entry point whose input has the binding `first`, and whose output has the next one.
struct Probe {
    entry: &'static str,
    first: u32,
    layers: bool,
}

impl Probe {
    fn run(
        &self,
        gpu: &Gpu,
        input: &[u8],
        materials: &[u8],
        count: usize,
        size: usize,
    ) -> Result<Vec<u32>, RenderError> {
        let Gpu { device, queue, .. } = gpu;
        let stage = ShaderStages::COMPUTE;
        let mut entries = vec![entry(self.first, stage, read_storage()), entry(self.first + 1, stage, write_storage())];
        let uploaded = |bytes: &[u8]| {
            let mut buffer = SyncedBuffer::rows(device, "probe");
            buffer.set_with_room(device, queue, bytes, 0, 4);
            buffer
        };
        // The last workgroup may write past the end.
        let output = vec![0; count.next_multiple_of(64) * size];
        let buffers = [uploaded(input), uploaded(&output), uploaded(materials)];
        let mut bound = vec![(self.first, &buffers[0]), (self.first + 1, &buffers[1])];
        if !materials.is_empty() {
            entries.push(entry(2, stage, read_storage()));
            bound.push((2, &buffers[2]));
        }
        let own = layout(device, "probe", &entries);
        let options = Options { layers: self.layers, ..Options::default() };
        let text = assemble("probe_brdf.wgsl", &Evaluator::Interpreter(OpSet::none()), options)?;
        let pipeline = compute_pipeline(device, "probe", text, self.entry, &[&own]);
        let entries: Vec<_> = bound
            .iter()
            .map(|(binding, buffer)| wgpu::BindGroupEntry { binding: *binding, resource: buffer.binding() })
            .collect();
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("probe"),
            layout: &own,
            entries: &entries,
        });
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some(self.entry) });
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.dispatch_workgroups((count as u32).div_ceil(64), 1, 1);
        }
        queue.submit([encoder.finish()]);
        Ok(read_words(gpu, buffers[1].buffer(), count * size / 4)?)
    }
}
