//! Copies of meshes as the pass `mesh` draws them: all copies of a part in one draw.

use glam::DVec3;

use super::mesh_instance::{CopyInstance, PlacedInstance};
use crate::gpu::Gpu;
use crate::resources::buffers::SyncedBuffer;
use isolith_field::copies::{MeshCopy, mesh_copies_in_view};
use isolith_field::standpoint::ray_origin_depth;
use isolith_field::{FlatScene, Warning};
use isolith_geometry::{Aabb, Camera};
use isolith_mesh::TriangleMesh;

/// The copies of all meshes in view.
#[derive(Debug)]
pub struct DrawnCopies {
    buffer: SyncedBuffer,
    rows: Vec<CopyInstance>,
    cut: Vec<Cut>,
}

/// A mesh of which copies are left out.
#[derive(Clone, Copy, Debug)]
struct Cut {
    /// Its index in the scene.
    mesh: usize,
    /// Copies that are drawn.
    count: usize,
    /// The depth up to which they are.
    depth: f64,
}

impl DrawnCopies {
    /// None.
    pub fn new(device: &wgpu::Device) -> Self {
        Self { buffer: SyncedBuffer::vertex(device, "mesh copies"), rows: Vec::new(), cut: Vec::new() }
    }

    /// Forgets those of the last frame.
    pub fn clear(&mut self) {
        self.rows.clear();
        self.cut.clear();
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Finds the copies of a mesh that are in view. Returns what they share, and their range; `None` if there are none.
    pub fn add(
        &mut self,
        flat: &FlatScene,
        (index, mesh): (usize, &TriangleMesh),
        camera: &Camera,
        size: [u32; 2],
    ) -> Option<(PlacedInstance, [u32; 2])> {
        let placed = &flat.meshes[index];
        let aspect = f64::from(size[0]) / f64::from(size[1]);
        let found = mesh_copies_in_view(flat, placed, &mesh.bounds, camera, aspect);
        self.cut.extend(found.cut.map(|depth| Cut { mesh: index, count: found.all.len(), depth }));
        let of_copy = |copy: &MeshCopy| mesh.bounds.transformed(&copy.world_from_mesh);
        let seen = found.all.iter().fold(Aabb::EMPTY, |all, copy| all.union(&of_copy(copy)));
        let first = found.all.first()?;
        let depth = ray_origin_depth(&seen.translated(-camera.position), camera, size);
        let eye = camera.position + camera.rotation * DVec3::NEG_Z * depth;
        let from = self.rows.len() as u32;
        self.rows.extend(found.all.iter().map(|copy| CopyInstance::new(&copy.world_from_mesh, eye)));
        let shared = PlacedInstance::of_copies(flat, placed, index, &first.world_from_mesh, (camera, depth));
        Some((shared, [from, self.rows.len() as u32]))
    }

    /// Uploads them.
    pub fn upload(&mut self, Gpu { device, queue, .. }: &Gpu) {
        self.buffer.set(device, queue, bytemuck::cast_slice(&self.rows));
    }

    /// The buffer, a [`CopyInstance`] for each copy.
    pub fn buffer(&self) -> &wgpu::Buffer {
        self.buffer.buffer()
    }

    /// Warnings about meshes of which only the nearest copies are drawn.
    pub fn warnings(&self, flat: &FlatScene) -> Vec<Warning> {
        let told = |Cut { mesh, count, depth }: &Cut| {
            let placed = &flat.meshes[*mesh];
            let reason = format!(
                "is copied as triangles, of which only the nearest are drawn: {count} copies up to {depth:.0} m; \
                 convert it to a field to see all"
            );
            Warning { node: placed.id, name: placed.model.path.clone(), reason }
        };
        self.cut.iter().map(told).collect()
    }
}
