//! What the device is given for a frame, and the bind groups that lead to it.

use std::sync::Arc;

use wgpu::BindGroup;

use super::unfinished::{NO_RAYS, NO_SUBTILES};
use super::{PIPELINE_WINDOW, Renderer, SUBTILE_BYTES};
use crate::flat::standpoint::{Standpoint, Standpoints};
use crate::flat::{CellTree, Component, FlatScene, ParamRow, ROW_ALIGNMENT, gpu_lights};
use crate::geometry::Camera;
use crate::render::frame::plan::{FramePlan, TILE};
use crate::render::gpu::Gpu;
use crate::render::passes::field::{FieldBuffers, FieldGroups};
use crate::render::passes::shade::mesh_emissions;
use crate::render::pipelines::key::PipelineKey;
use crate::render::resources::layouts::{bind, window};
use crate::render::resources::targets::Targets;
use crate::render::resources::uniforms::{DispatchParams, GpuComponent, GpuView, strided};
use crate::render::wgsl::{MAX_PIPELINE_ROWS, template_rows};

#[derive(Debug)]
pub(super) struct Groups {
    pub(super) view: BindGroup,
    pub(super) scene: BindGroup,
    /// The same with the rows of templates.
    pub(super) templates: BindGroup,
    pub(super) dispatch_params: BindGroup,
    pub(super) lights: BindGroup,
    pub(super) field: FieldGroups,
    pub(super) hiz: BindGroup,
    pub(super) shade: BindGroup,
}

/// The rows of components whose pipelines are for templates, and where those of each begin, in bytes. As much room as a window
/// takes is behind the last.
pub(super) fn template_windows(
    flat: &FlatScene,
    params: &[ParamRow],
    keys: &[Option<PipelineKey>],
) -> (Vec<Option<u32>>, Vec<u8>) {
    let mut rows: Vec<ParamRow> = Vec::new();
    let window = |(component, key): (&Component, &Option<PipelineKey>)| {
        key.and_then(|key| key.template)?;
        rows.resize(rows.len().next_multiple_of(ROW_ALIGNMENT), [0.0; 4]);
        let first = rows.len();
        template_rows(flat, params, component, &mut rows);
        Some((first * size_of::<ParamRow>()) as u32)
    };
    let windows = flat.components.iter().zip(keys).map(window).collect();
    rows.resize(rows.len() + MAX_PIPELINE_ROWS as usize, [0.0; 4]);
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
        plan: &FramePlan,
    ) -> bool {
        let Gpu { device, queue, .. } = &self.gpu;
        // See `shaders/common/subtiles.wgsl`.
        let no_subtiles = vec![NO_SUBTILES; plan.lists as usize];
        let no_rays = vec![NO_RAYS; plan.lists as usize];
        let mut is_new = self.tapes.hold(device, queue, trees);
        let placed = |((component, at), tree): ((&Component, &Standpoint), &Option<Arc<CellTree>>)| {
            let gpu = GpuComponent::new(component, at);
            let place = tree.as_ref().and_then(|tree| Some((tree, self.tapes.place(tree)?)));
            place.map_or(gpu, |(tree, tapes)| gpu.with_grid(tree, tapes, at))
        };
        let components = strided(flat.components.iter().zip(&standpoints.all).zip(trees).map(placed));
        let params: &[u8] = bytemuck::cast_slice(&standpoints.params);
        let (rows_are_new, changed) =
            self.rows.set_with_room(device, queue, params, PIPELINE_WINDOW, size_of::<ParamRow>());
        let texture_is_new = self.params.reserve(device, params.len());
        if let Some(range) = if texture_is_new { Some(0..params.len()) } else { changed } {
            self.params.write(queue, range.start, &params[range]);
        }
        is_new |= rows_are_new || texture_is_new;
        let lights = gpu_lights(flat, camera);
        let view = GpuView::new(camera, size, flat, lights.len() as u32);
        let uploads = [
            self.nodes.set(device, queue, bytemuck::cast_slice(&flat.nodes)),
            self.components.set(device, queue, &components),
            self.materials.set(device, queue, bytemuck::cast_slice(&flat.materials)),
            self.view.set(device, queue, bytemuck::bytes_of(&view)),
            self.lights.set(device, queue, bytemuck::cast_slice(&lights)),
            self.mesh_emissions.set(device, queue, bytemuck::cast_slice(&mesh_emissions(flat))),
            self.dispatch_params.set(device, queue, &strided(plan.dispatches.iter().map(|dispatch| dispatch.params))),
            self.subtiles.reserve(device, 2 * plan.subtiles as usize * SUBTILE_BYTES),
            self.rays.reserve(device, (plan.lists + plan.longest * TILE * TILE) as usize * 4),
            self.subtile_counts.reset(device, queue, bytemuck::cast_slice(&no_subtiles)),
            self.ray_counts.reset(device, queue, bytemuck::cast_slice(&no_rays)),
        ];
        self.reset_counts(flat.components.len(), size) || is_new || uploads.contains(&true)
    }

    pub(super) fn bind_all(&self, targets: &Targets) -> Groups {
        let device = &self.gpu.device;
        let [scene, templates] = [&self.rows, &self.template_rows].map(|rows| {
            let resources = [
                self.nodes.binding(),
                self.params.binding(),
                window(self.components.buffer(), size_of::<GpuComponent>()),
                self.materials.binding(),
                window(rows.buffer(), PIPELINE_WINDOW),
                self.tapes.binding(),
            ];
            bind(device, "scene", &self.layouts.scene, &resources)
        });
        let lists = FieldBuffers {
            subtiles: self.subtiles.buffer(),
            subtile_counts: self.subtile_counts.buffer(),
            rays: self.rays.buffer(),
            ray_counts: self.ray_counts.buffer(),
            nothing: self.nothing.buffer(),
            march_counts: self.march_counts.buffer(),
        };
        let dispatch_params = window(self.dispatch_params.buffer(), size_of::<DispatchParams>());
        Groups {
            view: bind(device, "view", &self.layouts.view, &[self.view.binding()]),
            scene,
            templates,
            dispatch_params: bind(device, "dispatch_params", &self.layouts.dispatch_params, &[dispatch_params]),
            lights: self.shade.bind_lights(device, [self.lights.binding(), self.mesh_emissions.binding()]),
            field: self.pipelines.field().bind(device, targets, lists),
            hiz: self.hiz.bind(device, targets),
            shade: self.shade.bind(device, targets),
        }
    }
}
