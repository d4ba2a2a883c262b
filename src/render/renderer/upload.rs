//! What the device is given for a frame, and the bind groups that lead to it.

use std::sync::Arc;

use wgpu::BindGroup;

use super::unfinished::{NO_QUADS, NO_RAYS};
use super::{KERNEL_WINDOW, QUAD_BYTES, Renderer};
use crate::flat::{CellTree, Component, FlatScene, ROW_ALIGNMENT, Row, gpu_lights};
use crate::geometry::Camera;
use crate::render::gpu::Gpu;
use crate::render::kernel::{MAX_KERNEL_ROWS, form_rows};
use crate::render::keys::Key;
use crate::render::layouts::{bind, window};
use crate::render::passes::field::{FieldGroups, Lists};
use crate::render::passes::shade::mesh_emissions;
use crate::render::schedule::{Plan, TILE};
use crate::render::standpoint::{Standpoint, Standpoints};
use crate::render::targets::Targets;
use crate::render::uniforms::{GpuComponent, View, Work, strided};

#[derive(Debug)]
pub(super) struct Groups {
    pub(super) view: BindGroup,
    pub(super) scene: BindGroup,
    /// The same with the rows of forms.
    pub(super) forms: BindGroup,
    pub(super) work: BindGroup,
    pub(super) lights: BindGroup,
    pub(super) field: FieldGroups,
    pub(super) farthest: BindGroup,
    pub(super) shade: BindGroup,
}

/// The rows of components whose kernels are for forms, and where those of each begin, in bytes. As much room as a window
/// takes is behind the last.
pub(super) fn form_windows(flat: &FlatScene, numbers: &[Row], keys: &[Option<Key>]) -> (Vec<Option<u32>>, Vec<u8>) {
    let mut rows: Vec<Row> = Vec::new();
    let window = |(component, key): (&Component, &Option<Key>)| {
        key.and_then(|key| key.form)?;
        rows.resize(rows.len().next_multiple_of(ROW_ALIGNMENT), [0.0; 4]);
        let first = rows.len();
        form_rows(flat, numbers, component, &mut rows);
        Some((first * size_of::<Row>()) as u32)
    };
    let windows = flat.components.iter().zip(keys).map(window).collect();
    rows.resize(rows.len() + MAX_KERNEL_ROWS as usize, [0.0; 4]);
    (windows, bytemuck::cast_slice(&rows).to_vec())
}

impl Renderer {
    /// Returns whether a buffer was replaced.
    pub(super) fn upload(
        &mut self,
        flat: &FlatScene,
        standpoints: &Standpoints<'_>,
        trees: &[Option<Arc<CellTree>>],
        camera: &Camera,
        size: [u32; 2],
        plan: &Plan,
    ) -> bool {
        let Gpu { device, queue, .. } = &self.gpu;
        // See `shaders/common/quads.wgsl`.
        let no_quads = vec![NO_QUADS; plan.lists as usize];
        let no_rays = vec![NO_RAYS; plan.lists as usize];
        let mut is_new = self.lists.hold(device, queue, trees);
        let placed = |((component, at), tree): ((&Component, &Standpoint), &Option<Arc<CellTree>>)| {
            let gpu = GpuComponent::new(component, at);
            let place = tree.as_ref().and_then(|tree| Some((tree, self.lists.place(tree)?)));
            place.map_or(gpu, |(tree, lists)| gpu.with_grid(tree, lists, at))
        };
        let components = strided(flat.components.iter().zip(&standpoints.all).zip(trees).map(placed));
        let numbers: &[u8] = bytemuck::cast_slice(&standpoints.numbers);
        let (rows_are_new, changed) = self.rows.set_with_room(device, queue, numbers, KERNEL_WINDOW, size_of::<Row>());
        let texture_is_new = self.numbers.reserve(device, numbers.len());
        if let Some(range) = if texture_is_new { Some(0..numbers.len()) } else { changed } {
            self.numbers.write(queue, range.start, &numbers[range]);
        }
        is_new |= rows_are_new || texture_is_new;
        let lights = gpu_lights(flat, camera);
        let view = View::new(camera, size, flat, lights.len() as u32);
        let uploads = [
            self.nodes.set(device, queue, bytemuck::cast_slice(&flat.nodes)),
            self.components.set(device, queue, &components),
            self.materials.set(device, queue, bytemuck::cast_slice(&flat.materials)),
            self.view.set(device, queue, bytemuck::bytes_of(&view)),
            self.lights.set(device, queue, bytemuck::cast_slice(&lights)),
            self.mesh_emissions.set(device, queue, bytemuck::cast_slice(&mesh_emissions(flat))),
            self.work.set(device, queue, &strided(plan.pieces.iter().map(|piece| piece.work))),
            self.quads.reserve(device, 2 * plan.quads as usize * QUAD_BYTES),
            self.rays.reserve(device, (plan.lists + plan.longest * TILE * TILE) as usize * 4),
            self.quad_counts.reset(device, queue, bytemuck::cast_slice(&no_quads)),
            self.ray_counts.reset(device, queue, bytemuck::cast_slice(&no_rays)),
        ];
        self.reset_counts(flat.components.len(), size) || is_new || uploads.contains(&true)
    }

    pub(super) fn bind_all(&self, targets: &Targets) -> Groups {
        let device = &self.gpu.device;
        let [scene, forms] = [&self.rows, &self.form_rows].map(|rows| {
            let resources = [
                self.nodes.binding(),
                self.numbers.binding(),
                window(self.components.buffer(), size_of::<GpuComponent>()),
                self.materials.binding(),
                window(rows.buffer(), KERNEL_WINDOW),
                self.lists.binding(),
            ];
            bind(device, "scene", &self.layouts.scene, &resources)
        });
        let lists = Lists {
            quads: self.quads.buffer(),
            quad_counts: self.quad_counts.buffer(),
            rays: self.rays.buffer(),
            ray_counts: self.ray_counts.buffer(),
            nothing: self.nothing.buffer(),
            march_counts: self.march_counts.buffer(),
        };
        let work = window(self.work.buffer(), size_of::<Work>());
        Groups {
            view: bind(device, "view", &self.layouts.view, &[self.view.binding()]),
            scene,
            forms,
            work: bind(device, "work", &self.layouts.work, &[work]),
            lights: self.shade.bind_lights(device, [self.lights.binding(), self.mesh_emissions.binding()]),
            field: self.kernels.field().bind(device, targets, lists),
            farthest: self.farthest.bind(device, targets),
            shade: self.shade.bind(device, targets),
        }
    }
}
