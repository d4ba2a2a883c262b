//! Input of `shaders/scene/mesh_rays.wgsl`: the placed meshes, their hierarchies and their triangles, in one buffer. Only
//! passes that follow rays through meshes make it.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use glam::{DAffine3, DVec3};

use crate::gpu::Gpu;
use crate::resources::buffers::SyncedBuffer;
use isolith_field::{FlatMesh, FlatScene};
use isolith_geometry::Aabb;
use isolith_mesh::TriangleMesh;

/// A placed mesh in the layout of the shader.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct RayMesh {
    /// First row of the matrix from the query's space to that of the triangles.
    pub local_x: [f32; 4],
    /// Second row.
    pub local_y: [f32; 4],
    /// Third row.
    pub local_z: [f32; 4],
    /// Its first node, counted in words of four numbers.
    pub nodes: u32,
    /// Its first triangle, counted in the same words.
    pub triangles: u32,
    /// Its number in the scene.
    pub index: u32,
    /// Unused.
    pub padding_0: u32,
}

/// Most nodes that an invocation visits, in all its rays together.
pub const MAX_MESH_VISITS: u32 = 12_000;
/// The number of the entry that ends the list.
const NO_MESH: u32 = u32::MAX;
/// Bytes of a word, and words of a placed mesh, of a triangle and of a node.
const WORD: u64 = 16;
const MESH_WORDS: usize = 4;
const TRIANGLE_WORDS: usize = 3;
const NODE_WORDS: usize = 2;

/// The buffer.
#[derive(Debug)]
pub struct MeshRayBuffer {
    words: SyncedBuffer,
    /// The list of placed meshes, as it stands at the beginning of the buffer.
    placed: Vec<RayMesh>,
    /// Room for entries of the list.
    room: usize,
    /// The meshes whose triangles are held, each with its first node and its first triangle.
    held: Vec<(Arc<TriangleMesh>, [u32; 2])>,
    left_out: Vec<usize>,
}

impl MeshRayBuffer {
    /// A buffer without meshes.
    pub fn new(device: &wgpu::Device) -> Self {
        let words = SyncedBuffer::storage(device, "meshes of rays");
        Self { words, placed: Vec::new(), room: 0, held: Vec::new(), left_out: Vec::new() }
    }

    /// Uploads changed data. `meshes` is parallel to `flat.meshes`; `origin` is that of the queries. Returns whether
    /// bind groups must be rebuilt. Builds the hierarchy of a mesh on its first use.
    pub fn set(&mut self, gpu: &Gpu, flat: &FlatScene, meshes: &[Option<Arc<TriangleMesh>>], origin: DVec3) -> bool {
        // Copies of meshes stop no rays.
        let stops = |(placed, mesh): (&FlatMesh, &Option<Arc<TriangleMesh>>)| {
            mesh.clone().filter(|_| placed.instanced.is_none())
        };
        let meshes: Vec<_> = flat.meshes.iter().zip(meshes).map(stops).collect();
        let meshes = &meshes[..];
        let is_replaced = self.hold(gpu, meshes);
        let mut placed = Vec::new();
        self.left_out.clear();
        for (index, (placement, mesh)) in flat.meshes.iter().zip(meshes).enumerate() {
            let Some(mesh) = mesh else { continue };
            let Some((_, [nodes, triangles])) = self.held.iter().find(|(held, _)| Arc::ptr_eq(held, mesh)) else {
                self.left_out.push(index);
                continue;
            };
            let local_from_world = placement.world_from_local.inverse();
            // A mesh without extent in some direction has no inverse, and stops no ray.
            if local_from_world.is_finite() {
                placed.push(RayMesh::new(mesh, &local_from_world, origin, [*nodes, *triangles, index as u32]));
            }
        }
        placed.push(RayMesh { index: NO_MESH, ..RayMesh::zeroed() });
        if self.placed != placed {
            gpu.queue.write_buffer(self.words.buffer(), 0, bytemuck::cast_slice(&placed));
            self.placed = placed;
        }
        is_replaced
    }

    /// The meshes, by their numbers in the scene, that the device has no room for: they stop no rays.
    pub fn left_out(&self) -> &[usize] {
        &self.left_out
    }

    /// The binding.
    pub fn binding(&self) -> wgpu::BindingResource<'_> {
        self.words.binding()
    }

    /// Holds the triangles of exactly these meshes, as far as they fit. Returns whether the buffer was replaced.
    fn hold(&mut self, gpu: &Gpu, meshes: &[Option<Arc<TriangleMesh>>]) -> bool {
        let mut wanted: Vec<&Arc<TriangleMesh>> = Vec::new();
        for mesh in meshes.iter().flatten() {
            if !wanted.iter().any(|other| Arc::ptr_eq(other, mesh)) {
                wanted.push(mesh);
            }
        }
        let limits = gpu.device.limits();
        let bytes = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
        // Buffers grow by powers of two.
        let room = bytes.checked_ilog2().map_or(0, |bits| ((1_u64 << bits) / WORD) as usize);
        let entries = (meshes.len() + 1).next_power_of_two();
        let mut used = entries * MESH_WORDS;
        wanted.retain(|mesh| {
            let words = words_of(mesh);
            let fits = used + words <= room;
            used += if fits { words } else { 0 };
            fits
        });
        let is_held = self.room == entries
            && wanted.len() == self.held.len()
            && wanted.iter().zip(&self.held).all(|(mesh, (held, _))| Arc::ptr_eq(mesh, held));
        if is_held {
            return false;
        }
        let mut words = vec![[0; 4]; entries * MESH_WORDS];
        words.reserve(used - words.len());
        self.held = wanted.into_iter().map(|mesh| (mesh.clone(), write_words(mesh, &mut words))).collect();
        (self.room, self.placed) = (entries, Vec::new());
        let is_replaced = self.words.reserve(&gpu.device, words.len() * WORD as usize);
        gpu.queue.write_buffer(self.words.buffer(), 0, bytemuck::cast_slice(&words));
        is_replaced
    }
}

impl RayMesh {
    fn new(
        mesh: &TriangleMesh,
        local_from_world: &DAffine3,
        origin: DVec3,
        [nodes, triangles, index]: [u32; 3],
    ) -> Self {
        let m = local_from_world.matrix3;
        let translation = local_from_world.transform_point3(origin) - mesh.bounds.center();
        let row = |i: usize| {
            let r = m.row(i);
            [r.x as f32, r.y as f32, r.z as f32, translation[i] as f32]
        };
        Self { local_x: row(0), local_y: row(1), local_z: row(2), nodes, triangles, index, padding_0: 0 }
    }
}

/// Words that a mesh takes.
fn words_of(mesh: &TriangleMesh) -> usize {
    mesh.triangle_count() * TRIANGLE_WORDS + mesh.bvh().nodes.len() * NODE_WORDS
}

/// Appends nodes and triangles, relative to the center of the mesh; returns where they begin.
fn write_words(mesh: &TriangleMesh, words: &mut Vec<[u32; 4]>) -> [u32; 2] {
    let (bvh, center) = (mesh.bvh(), mesh.bounds.center());
    let nodes = words.len() as u32;
    for node in &bvh.nodes {
        let Aabb { min, max } = node.bounds.translated(-center);
        // Rounding must never cut a triangle off.
        let slack = min.abs().max(max.abs()).max_element() * 4.0 * f64::from(f32::EPSILON);
        words.push(word(min - slack, node.first));
        words.push(word(max + slack, node.count));
    }
    let triangles = words.len() as u32;
    for &triangle in &bvh.triangles {
        let [a, b, c] = mesh.corners(triangle);
        words.push(word(a - center, triangle));
        words.push(word(b - a, u32::from(!mesh.part(triangle).surface.is_blended)));
        words.push(word(c - a, 0));
    }
    [nodes, triangles]
}

/// Three numbers, and a fourth word.
fn word(v: DVec3, last: u32) -> [u32; 4] {
    let [x, y, z] = v.as_vec3().to_array().map(f32::to_bits);
    [x, y, z, last]
}
