//! Pass `overlay`: grid and selection outline over the finished picture. It runs only if the editor asks for it.

use std::ops::Range;

use bytemuck::{Pod, Zeroable};
use glam::{DVec3, UVec2};
use wgpu::{BindGroup, BindGroupLayout, ShaderStages};

use super::frame_pass::{Building, FramePass};
use super::overlay_settings::{GridPlane, OverlaySettings};
use crate::frame::plan::FramePlan;
use crate::recipe::Pass;
use crate::renderer::recorder::Recorder;
use crate::renderer::resources::Bound;
use crate::resources::buffers::SyncedBuffer;
use crate::resources::layouts::*;
use isolith_field::FlatScene;
use isolith_scene::NodeId;
use isolith_wgsl::{ShaderError, assemble_plain};

/// Parameters of the shader.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Overlay {
    /// Position of the eye, turned so that the grid lies across y; x and z are modulo one coarse cell.
    pub eye: [f32; 3],
    /// Side of a fine cell, in meters.
    pub cell: f32,
    /// Position of the X axis in the reduced grid.
    pub axis_x: f32,
    /// Position of the Z axis in the reduced grid.
    pub axis_z: f32,
    /// Number of selection bits before those of the meshes.
    pub leaf_count: u32,
    /// Size of the target in pixels: the width, plus the height times 65 536.
    pub size: u32,
    /// The axis across the grid.
    pub axis: u32,
    /// Distance over which the grid loses half of its strength, in meters.
    pub reach: f32,
    /// Share of the depth by which the grid must be nearer than a surface.
    pub bias: f32,
    /// Alignment.
    pub padding: f32,
}

/// Fine cells over which the grid loses half of its strength.
const REACH_CELLS: f32 = 60.0;

/// Largest distance of the outline from a selected pixel, in pixels: the ring in the shader.
const REACH: u32 = 2;

/// The pass.
#[derive(Debug)]
pub struct OverlayPass {
    grid: wgpu::RenderPipeline,
    outline: wgpu::RenderPipeline,
    coarse_outline: wgpu::RenderPipeline,
    enlarge: wgpu::RenderPipeline,
    draws_grid: bool,
    outlined: Outlined,
    own: BindGroupLayout,
    targets: BindGroupLayout,
    picture: BindGroupLayout,
    uniform: SyncedBuffer,
    selected: SyncedBuffer,
    own_group: Option<BindGroup>,
}

impl FramePass for OverlayPass {
    fn new(Building { device, layouts, .. }: Building<'_>) -> Result<Self, ShaderError> {
        let stage = ShaderStages::FRAGMENT;
        let own = layout(device, "overlay", &[entry(0, stage, uniform(false)), entry(1, stage, read_storage())]);
        let targets = layout(
            device,
            "overlay targets",
            &[entry(0, stage, read_texture(false)), entry(1, stage, read_texture(true))],
        );
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(Pass::Overlay.label()),
            source: wgpu::ShaderSource::Wgsl(assemble_plain(Pass::Overlay.file())?.into()),
        });
        let picture = layout(device, "overlay picture", &[entry(0, stage, read_texture(false))]);
        let over = pipeline_layout(device, "overlay", &[&layouts.view, &own, &targets]);
        let blend = Some(wgpu::BlendState::ALPHA_BLENDING);
        let [grid, outline, coarse_outline] =
            ["overlay_grid_fragment", "overlay_outline_fragment", "overlay_coarse_outline_fragment"]
                .map(|entry_point| screen_pipeline(device, &module, entry_point, &over, blend));
        let whole = pipeline_layout(device, "overlay enlarge", &[&layouts.view, &own, &targets, &picture]);
        let enlarge = screen_pipeline(device, &module, "overlay_enlarge_fragment", &whole, None);
        let uniform = SyncedBuffer::uniform(device, "overlay");
        let selected = SyncedBuffer::storage(device, "selected");
        Ok(Self {
            grid,
            outline,
            coarse_outline,
            enlarge,
            draws_grid: false,
            outlined: Outlined::default(),
            own,
            targets,
            picture,
            uniform,
            selected,
            own_group: None,
        })
    }

    fn bind(&self, device: &wgpu::Device, bound: &Bound<'_>) -> Vec<BindGroup> {
        let inputs = [bound.targets.depth.binding(), bound.targets.leaf.binding()];
        let picture = [bound.targets.color.binding()];
        vec![
            bind(device, "overlay targets", &self.targets, &inputs),
            bind(device, "overlay picture", &self.picture, &picture),
        ]
    }

    fn record(&self, recorder: &mut Recorder<'_>, _: Range<usize>) {
        let Some(own) = self.own_group.as_ref().filter(|_| !recorder.frame.overlay.is_empty()) else { return };
        let ([view, inputs], [_, picture]) = (recorder.groups(0), recorder.groups(1));
        let (targets, enlarged, plan) = (recorder.targets, recorder.enlarged, &recorder.frame.plan);
        // Later samples have hits beside the pixels' centers: marks keep to the first.
        let later = recorder.frame.sampling.filter(|sampling| sampling.index > 0);
        let kept = later.and(recorder.accumulation).map(|accumulation| {
            let inputs = [accumulation.depth.binding(), accumulation.leaf.binding()];
            bind(&recorder.gpu.device, "overlay of samples", &self.targets, &inputs)
        });
        let inputs = kept.as_ref().unwrap_or(inputs);
        let (encoder, stamps) = recorder.drawing();
        let stamps = stamps.map(|stamps| stamps.of_drawing());
        let color = &enlarged.unwrap_or(&targets.color).view;
        let mut pass = screen_pass(encoder, Pass::Overlay.label(), color, stamps);
        pass.set_bind_group(0, view, &[]);
        pass.set_bind_group(1, own, &[]);
        pass.set_bind_group(2, inputs, &[]);
        if enlarged.is_some() {
            pass.set_bind_group(3, picture, &[]);
            pass.set_pipeline(&self.enlarge);
            pass.draw(0..3, 0..1);
        }
        if self.draws_grid {
            pass.set_pipeline(&self.grid);
            pass.draw(0..3, 0..1);
        }
        if let Some([low, high]) = self.outlined.around(plan, targets.size.into()) {
            let (low, high) = match enlarged {
                None => (low, high),
                Some(target) => larger(low, high, targets.size.into(), target.size().into()),
            };
            pass.set_scissor_rect(low.x, low.y, high.x - low.x, high.y - low.y);
            pass.set_pipeline(if enlarged.is_some() { &self.coarse_outline } else { &self.outline });
            pass.draw(0..3, 0..1);
        }
    }
}

impl OverlayPass {
    /// Uploads the parameters for a picture of `size` pixels, seen from `eye`.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        flat: &FlatScene,
        settings: &OverlaySettings,
        size: [u32; 2],
        eye: DVec3,
    ) {
        self.draws_grid = settings.grid;
        // The cell size follows the eye's height in powers of ten.
        let GridPlane { axis, cell, fades } = settings.plane;
        let eye = turned(eye, axis);
        let cell = cell.unwrap_or_else(|| 10.0_f64.powf(eye.y.abs().max(1e-3).log10().floor()) * 0.1);
        let period = cell * 100.0;
        let reduced = DVec3::new(eye.x.rem_euclid(period), eye.y, eye.z.rem_euclid(period));
        let [width, height] = settings.enlarged(size).unwrap_or(size);
        let overlay = Overlay {
            eye: reduced.as_vec3().to_array(),
            cell: cell as f32,
            axis_x: (reduced.z - eye.z) as f32,
            axis_z: (reduced.x - eye.x) as f32,
            leaf_count: flat.nodes.len() as u32,
            size: width | height << 16,
            axis: axis as u32,
            reach: if fades { cell as f32 * REACH_CELLS } else { f32::MAX },
            // From very far, a share of the depth is large beside the scene.
            bias: if fades { 1e-4 } else { 1e-6 },
            padding: 0.0,
        };
        let changed = self.uniform.set(device, queue, bytemuck::bytes_of(&overlay));
        let bits = selected_bits(flat, &settings.outline);
        self.outlined = if settings.outline.is_empty() { Outlined::default() } else { Outlined::of(flat, &bits) };
        let changed = self.selected.set(device, queue, bytemuck::cast_slice(&bits)) || changed;
        if changed || self.own_group.is_none() {
            let resources = [self.uniform.binding(), self.selected.binding()];
            self.own_group = Some(bind(device, "overlay", &self.own, &resources));
        }
    }
}

/// The vector with the axis across the grid in the place of y, as the shader turns it.
fn turned(v: DVec3, axis: usize) -> DVec3 {
    match axis {
        0 => DVec3::new(v.y, v.x, v.z),
        2 => DVec3::new(v.x, v.z, v.y),
        _ => v,
    }
}

/// Scales a rectangle of a picture of `from` pixels to a picture of `to` pixels.
fn larger(low: UVec2, high: UVec2, from: UVec2, to: UVec2) -> (UVec2, UVec2) {
    let scale = to.as_dvec2() / from.as_dvec2();
    let high = (high.as_dvec2() * scale).ceil().as_uvec2();
    ((low.as_dvec2() * scale).floor().as_uvec2().min(to - 1), high.min(to))
}

/// The objects that may have an outline.
#[derive(Debug, Default)]
struct Outlined {
    /// Components with a selected leaf, ascending.
    components: Vec<u32>,
    /// Whether a mesh is selected.
    meshes: bool,
}

impl Outlined {
    fn of(flat: &FlatScene, bits: &[u32]) -> Self {
        let is_selected = |i: u32| bits[i as usize / 32] >> (i % 32) & 1 == 1;
        let leaves = flat.nodes.len() as u32;
        let components = (0..).zip(&flat.components);
        let selected = components.filter(|(_, c)| (c.first..c.first + c.count).any(is_selected));
        Self {
            components: selected.map(|(index, _)| index).collect(),
            meshes: (leaves..leaves + flat.meshes.len() as u32).any(is_selected),
        }
    }

    /// Bounding rectangle of the pixels that the outline may cover: upper left pixel, first pixel outside.
    fn around(&self, plan: &FramePlan, size: UVec2) -> Option<[UVec2; 2]> {
        if self.meshes {
            return Some([UVec2::ZERO, size]);
        }
        let [low, high] = plan.around(|component| self.components.binary_search(&component).is_ok())?;
        Some([low.saturating_sub(UVec2::splat(REACH)), (high + REACH).min(size)])
    }
}

/// One bit for each entry of the subtree-extent array, then one for each mesh.
fn selected_bits(flat: &FlatScene, outline: &[NodeId]) -> Vec<u32> {
    let selected: std::collections::HashSet<NodeId> = outline.iter().copied().collect();
    let ids = flat.ids.iter().chain(flat.meshes.iter().map(|m| &m.id));
    let mut bits = vec![0_u32; (flat.nodes.len() + flat.meshes.len()).div_ceil(32).max(1)];
    if !selected.is_empty() {
        for (i, _) in ids.enumerate().filter(|(_, id)| selected.contains(id)) {
            bits[i / 32] |= 1 << (i % 32);
        }
    }
    bits
}
