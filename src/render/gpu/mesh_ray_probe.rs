//! Sends rays through the meshes of a scene on the GPU, for the test that compares them with the CPU's.

use std::sync::Arc;

use glam::DVec3;
use wgpu::{BindGroupLayout, ComputePipeline, ShaderStages};

use crate::gpu::Gpu;
use crate::gpu::readback::read_words;
use crate::renderer::RenderError;
use crate::resources::buffers::SyncedBuffer;
use crate::resources::layouts::{bind, compute_pipeline, entry, layout, read_storage, uniform, write_storage};
use crate::resources::mesh_rays::MeshRayBuffer;
use isolith_field::FlatScene;
use isolith_geometry::Ray;
use isolith_mesh::TriangleMesh;
use isolith_wgsl::assemble_plain;

/// Words of a result.
const WORDS: usize = 5;

/// Result of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProbedMeshHit {
    /// Distance from the ray's origin, the mesh, and its triangle.
    pub hit: Option<(f64, u32, u32)>,
    /// Whether the search for any triangle found one.
    pub is_blocked: bool,
    /// Visited nodes; `None` if there were too many.
    pub visits: Option<u32>,
}

/// The pipeline and its layouts.
#[derive(Debug)]
pub struct MeshRayProbe {
    none: BindGroupLayout,
    own: BindGroupLayout,
    rays: BindGroupLayout,
    pipeline: ComputePipeline,
}

impl MeshRayProbe {
    /// Builds the pipeline.
    ///
    /// # Errors
    /// A shader file is missing.
    pub fn new(gpu: &Gpu) -> Result<Self, RenderError> {
        let device = &gpu.device;
        let of = |label, first: u32, types: &[wgpu::BindingType]| {
            let entries: Vec<_> = (first..).zip(types).map(|(at, ty)| entry(at, ShaderStages::COMPUTE, *ty)).collect();
            layout(device, label, &entries)
        };
        let none = of("nothing", 0, &[]);
        let own = of("mesh ray probe", 0, &[uniform(false), read_storage(), write_storage()]);
        let rays = of("mesh rays", 3, &[read_storage()]);
        let groups = [&none, &none, &own, &rays];
        let text = assemble_plain("probe_mesh_rays.wgsl")?;
        let pipeline = compute_pipeline(device, "mesh ray probe", text, "probe_mesh_rays", &groups);
        Ok(Self { none, own, rays, pipeline })
    }

    /// The first hits of rays of the world between these distances. Queries are relative to `origin`.
    ///
    /// # Errors
    /// The device fails.
    pub fn rays(
        &self,
        gpu: &Gpu,
        (flat, meshes): (&FlatScene, &[Option<Arc<TriangleMesh>>]),
        origin: DVec3,
        rays: &[Ray],
        [near, far]: [f64; 2],
    ) -> Result<Vec<ProbedMeshHit>, RenderError> {
        let Gpu { device, queue, .. } = gpu;
        let mut buffer = MeshRayBuffer::new(device);
        buffer.set(gpu, flat, meshes, origin);
        let inputs: Vec<[f32; 4]> = rays
            .iter()
            .flat_map(|ray| {
                let word = |v: DVec3, w: f64| v.as_vec3().extend(w as f32).to_array();
                [word(ray.origin - origin, near), word(ray.direction, far)]
            })
            .collect();
        let mut settings = SyncedBuffer::uniform(device, "mesh ray probe");
        settings.set(device, queue, bytemuck::cast_slice(&[rays.len() as u32, 0, 0, 0]));
        let mut queries = SyncedBuffer::storage(device, "mesh ray probe");
        queries.set(device, queue, bytemuck::cast_slice(&inputs));
        let mut results = SyncedBuffer::read_back(device, "mesh ray probe");
        results.set(device, queue, bytemuck::cast_slice(&vec![0_u32; rays.len() * WORDS]));
        let none = bind(device, "nothing", &self.none, &[]);
        let own =
            bind(device, "mesh ray probe", &self.own, &[settings.binding(), queries.binding(), results.binding()]);
        let of_rays = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("mesh rays"),
            layout: &self.rays,
            entries: &[wgpu::BindGroupEntry { binding: 3, resource: buffer.binding() }],
        });
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(&self.pipeline);
            for (at, group) in (0..).zip([&none, &none, &own, &of_rays]) {
                pass.set_bind_group(at, group, &[]);
            }
            pass.dispatch_workgroups((rays.len() as u32).div_ceil(64), 1, 1);
        }
        queue.submit([encoder.finish()]);
        let words = read_words(gpu, results.buffer(), rays.len() * WORDS)?;
        let read = |&[t, mesh, triangle, blocked, visits]: &[u32; WORDS]| ProbedMeshHit {
            hit: (mesh != u32::MAX).then(|| (f32::from_bits(t).into(), mesh, triangle)),
            is_blocked: blocked == 1,
            visits: (visits != u32::MAX).then_some(visits),
        };
        Ok(words.as_chunks().0.iter().map(read).collect())
    }
}
