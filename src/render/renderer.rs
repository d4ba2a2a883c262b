//! The renderer: takes a flat scene and a camera, delivers a picture, in pieces that can be waited for.

mod choice;
mod frame;
mod measure;
mod picture;
mod pixel_counts;

use std::sync::Arc;
use std::time::{Duration, Instant};

use thiserror::Error;
use wgpu::BindGroup;

use super::buffers::{Mirror, TextureMirror};
use super::gpu::{Gpu, GpuError};
use super::kernel::{MAX_KERNEL_ROWS, Options, ShaderError, Skipping};
use super::kernels::{Kernels, Method};
use super::layouts::{Layouts, bind, window};
use super::passes::farthest::FarthestPass;
use super::passes::field::{FieldGroups, Lists};
use super::passes::inspect::InspectPass;
use super::passes::mesh::MeshPass;
use super::passes::overlay::{OverlayPass, OverlaySettings};
use super::passes::shade::{ShadePass, mesh_emissions};
use super::schedule::{DISPATCH_TARGET, Effort, Pace, Piece, Plan, Stage, TILE, plan};
use super::targets::Targets;
use super::uniforms::{GpuComponent, View, Work};
use crate::flat::inspect::Look;
use crate::flat::{CellTree, Component, FlatScene, Pruner, Row, gpu_lights};
use crate::geometry::Camera;
use crate::mesh::TriangleMesh;

use choice::Chosen;
pub use frame::Frame;
pub use measure::Counts;
pub use pixel_counts::{PixelCounts, Spread, Took};

/// Why there is no picture.
#[derive(Debug, Error)]
pub enum RenderError {
    /// The device.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// A shader could not be put together.
    #[error(transparent)]
    Shader(#[from] ShaderError),
    /// The picture is larger than the device allows.
    #[error("a picture of {0} by {1} pixels is not possible; the device's limit is {2} a side")]
    Size(u32, u32, u32),
    /// What each pixel takes cannot be counted in one buffer of the device.
    #[error("a picture of {0} by {1} pixels is too large to count what each of them takes")]
    Counts(u32, u32),
    /// The caller asked to stop.
    #[error("cancelled")]
    Cancelled,
}

/// The pieces of work as the device reads them, at offsets of [`WORK_STRIDE`].
fn work_bytes(plan: &Plan) -> Vec<u8> {
    let mut work = vec![0_u8; plan.pieces.len() * WORK_STRIDE];
    for (slot, piece) in work.chunks_exact_mut(WORK_STRIDE).zip(&plan.pieces) {
        slot[..size_of::<Work>()].copy_from_slice(bytemuck::bytes_of(&piece.work));
    }
    work
}

/// Which picture a frame makes: the editor keeps a coarse one for quick answers beside the full one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slot {
    /// The picture at full size.
    Full,
    /// The coarse picture.
    Preview,
}

/// Targets of a picture with the bind groups that lead to them; remade when its size changes or a
/// buffer or kernel is replaced.
#[derive(Debug)]
struct SlotState {
    targets: Targets,
    groups: Option<Groups>,
}

/// Draws flat scenes.
#[derive(Debug)]
pub struct Renderer {
    gpu: Gpu,
    layouts: Layouts,
    kernels: Kernels,
    method: Method,
    farthest: FarthestPass,
    shade: ShadePass,
    mesh: MeshPass,
    overlay: OverlayPass,
    /// Built where somebody looks.
    inspect: Option<InspectPass>,
    nodes: Mirror,
    numbers: TextureMirror,
    /// The same numbers once more, for the windows of specialised kernels.
    rows: Mirror,
    lists: TextureMirror,
    pruner: Pruner,
    components: Mirror,
    materials: Mirror,
    view: Mirror,
    lights: Mirror,
    mesh_emissions: Mirror,
    work: Mirror,
    tiles: Mirror,
    tile_counts: Mirror,
    rays: Mirror,
    ray_counts: Mirror,
    nothing: Mirror,
    march_counts: Mirror,
    /// Whether kernels count.
    counting: bool,
    slots: [Option<SlotState>; 2],
    pace: Pace,
}

#[derive(Debug)]
struct Groups {
    view: BindGroup,
    scene: BindGroup,
    work: BindGroup,
    lights: BindGroup,
    field: FieldGroups,
    farthest: BindGroup,
    shade: BindGroup,
}

/// Dynamic offsets of `Work` are multiples of this.
const WORK_STRIDE: usize = 256;
/// Bytes of a kernel's window on the rows of its component. As much room is kept behind the last row, so
/// that the window on the last component does not end outside the buffer.
pub(super) const KERNEL_WINDOW: usize = MAX_KERNEL_ROWS as usize * size_of::<Row>();
/// Of the texture of rows.
pub(super) const NUMBERS_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;
/// Of the texture of pruned lists.
pub(super) const LISTS_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rg32Uint;
/// Bytes of a tile in a list.
const TILE_BYTES: usize = 20;
/// Words for each list of tiles.
const COUNTS: usize = 4;
/// Invocations in a workgroup of the cone pass.
const CONE_GROUP: u32 = 64;

impl Renderer {
    /// A renderer on `gpu`. Its interpreter knows no shape until a scene brings one.
    pub fn new(gpu: &Gpu) -> Result<Self, RenderError> {
        Self::with_options(gpu, Self::options(gpu))
    }

    /// What kernels do on this device when nobody asks for something else.
    pub fn options(gpu: &Gpu) -> Options {
        let skipping = if gpu.is_software() { Skipping::Loops } else { Skipping::Branches };
        Options { skipping, ..Options::default() }
    }

    /// The same with kernels of these options.
    pub fn with_options(gpu: &Gpu, options: Options) -> Result<Self, RenderError> {
        let device = &gpu.device;
        let layouts = Layouts::new(device);
        let storage = |label| Mirror::storage(device, label);
        let renderer = Self {
            kernels: Kernels::new(gpu, &layouts, options)?,
            method: Method::Auto,
            farthest: FarthestPass::new(device, &layouts)?,
            shade: ShadePass::new(device, &layouts)?,
            mesh: MeshPass::new(device, &layouts)?,
            overlay: OverlayPass::new(device, &layouts)?,
            inspect: None,
            nodes: storage("nodes"),
            numbers: TextureMirror::new(device, "numbers", NUMBERS_FORMAT),
            rows: Mirror::uniform(device, "rows"),
            lists: TextureMirror::new(device, "lists", LISTS_FORMAT),
            pruner: Pruner::default(),
            components: storage("components"),
            materials: storage("materials"),
            view: Mirror::uniform(device, "view"),
            lights: storage("lights"),
            mesh_emissions: storage("mesh emissions"),
            work: Mirror::uniform(device, "work"),
            tiles: storage("tiles"),
            tile_counts: Mirror::indirect(device, "tile counts"),
            rays: storage("rays"),
            nothing: storage("nothing"),
            ray_counts: Mirror::indirect(device, "ray counts"),
            march_counts: Mirror::read_back(device, "march counts"),
            counting: options.counting,
            slots: [None, None],
            pace: Pace::new(gpu.is_software()),
            layouts,
            gpu: gpu.clone(),
        };
        gpu.check()?;
        Ok(renderer)
    }

    /// Chooses how components are evaluated from now on.
    pub fn set_method(&mut self, method: Method) {
        self.method = method;
    }

    /// How many kernels are being built.
    pub fn kernels_building(&self) -> usize {
        self.kernels.building()
    }

    /// How many kernels could not be built.
    pub fn kernels_failed(&self) -> usize {
        self.kernels.failed()
    }

    /// The kernels.
    pub fn kernels(&mut self) -> &mut Kernels {
        &mut self.kernels
    }

    /// The device.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Bytes of scene data uploaded so far.
    pub fn uploaded(&self) -> u64 {
        let buffers = [&self.nodes, &self.rows, &self.components, &self.materials].map(Mirror::uploaded);
        buffers.iter().sum::<u64>() + self.numbers.uploaded() + self.lists.uploaded()
    }

    /// How long a whole frame is expected to take.
    pub fn estimate(&mut self, flat: &FlatScene, camera: &Camera, size: [u32; 2]) -> Result<Duration, RenderError> {
        let Chosen { evaluations, .. } = self.choose(flat)?;
        let plan = plan(flat, camera, size, &evaluations, &self.pace);
        Ok(Duration::from_secs_f64(self.pace.seconds(plan.effort()).min(1e6)))
    }

    /// Uploads what has changed and lists the work. `meshes` stands beside `flat.meshes`.
    pub fn begin(
        &mut self,
        slot: Slot,
        flat: &FlatScene,
        meshes: &[Option<Arc<TriangleMesh>>],
        camera: &Camera,
        size: [u32; 2],
        overlay: OverlaySettings,
    ) -> Result<Frame, RenderError> {
        let limit = self.gpu.device.limits().max_texture_dimension_2d;
        if size[0] == 0 || size[1] == 0 || size[0] > limit || size[1] > limit {
            return Err(RenderError::Size(size[0], size[1], limit));
        }
        self.check_counts(flat.components.len(), size)?;
        let Chosen { keys, choices, evaluations, trees } = self.choose(flat)?;
        self.gpu.check()?;
        if self.slots[slot as usize].as_ref().is_none_or(|s| s.targets.size != size) {
            let targets = Targets::new(&self.gpu.device, size);
            self.slots[slot as usize] = Some(SlotState { targets, groups: None });
        }
        let plan = plan(flat, camera, size, &evaluations, &self.pace);
        if self.upload(flat, &trees, camera, size, &plan) {
            for state in self.slots.iter_mut().flatten() {
                state.groups = None;
            }
        }
        if self.slot(slot).groups.is_none() {
            let groups = self.bind_all(&self.slot(slot).targets);
            if let Some(state) = &mut self.slots[slot as usize] {
                state.groups = Some(groups);
            }
        }
        self.mesh.prepare(&self.gpu.device, &self.gpu.queue, flat, meshes, camera.position);
        if !overlay.is_empty() {
            self.overlay.prepare(&self.gpu.device, &self.gpu.queue, flat, &overlay, camera.position);
        }
        Ok(Frame {
            pace: self.pace,
            seconds: self.pace.seconds(plan.effort()),
            plan,
            keys,
            choices,
            next: 0,
            seconds_done: 0.0,
            slot,
            overlay,
            look: Look::Shaded,
            rows: flat.components.iter().map(|c| c.numbers * size_of::<Row>() as u32).collect(),
            origins: flat.components.iter().map(|c| flat.ids[c.first as usize]).collect(),
        })
    }

    /// Works on the frame until `budget` is used or the picture is complete; at least one batch of
    /// dispatches of about [`DISPATCH_TARGET`]. Waits for the device, and learns its pace.
    pub fn advance(&mut self, frame: &mut Frame, budget: Duration) -> Result<(), RenderError> {
        let start = Instant::now();
        if self.kernels.collect() {
            self.kernels.refresh(&frame.keys, &mut frame.choices);
        }
        loop {
            let first = frame.next;
            let mut effort = Effort::default();
            let mut end = first;
            while end < frame.plan.pieces.len() {
                let more = effort + frame.plan.pieces[end].effort;
                // How long a later round takes nobody can foresee: it stands alone.
                let alone = frame.plan.pieces[end].work.round > 0;
                if end > first && (alone || self.pace.seconds(more) > DISPATCH_TARGET.as_secs_f64()) {
                    break;
                }
                effort = more;
                end += 1;
            }
            let submitted = Instant::now();
            frame.seconds_done += frame.pace.seconds(effort);
            self.submit(frame, first..end);
            self.gpu.wait()?;
            // The first dispatch of a kernel may include its compilation, and a later round marches an unknown
            // few of its rays: neither says anything of the pace.
            if !frame.uses_fresh_kernel(first..end) && frame.plan.pieces[first].work.round == 0 {
                self.pace.learn(effort, submitted.elapsed());
            }
            frame.next = end;
            if frame.is_done() || start.elapsed() >= budget {
                return Ok(());
            }
        }
    }

    /// The picture in a slot: complete once its frame is done, and another texture after a
    /// [`Renderer::begin`] of another size.
    pub fn picture(&self, slot: Slot) -> Option<(&wgpu::TextureView, [u32; 2])> {
        self.slots[slot as usize].as_ref().map(|s| (&s.targets.color.view, s.targets.size))
    }

    fn slot(&self, slot: Slot) -> &SlotState {
        self.slots[slot as usize].as_ref().expect("begin makes the targets")
    }

    /// Returns whether a buffer was replaced.
    fn upload(
        &mut self,
        flat: &FlatScene,
        trees: &[Option<Arc<CellTree>>],
        camera: &Camera,
        size: [u32; 2],
        plan: &Plan,
    ) -> bool {
        let Gpu { device, queue, .. } = &self.gpu;
        let nothing = vec![[0_u32, 1, 1, 0]; plan.lists as usize];
        let mut lists: Vec<[u32; 2]> = Vec::new();
        let mut placed = |(component, tree): (&Component, &Option<Arc<CellTree>>)| {
            let gpu = GpuComponent::new(component, camera.position);
            let Some(tree) = tree else { return gpu };
            let at = lists.len() as u32;
            lists.extend_from_slice(&tree.words);
            gpu.with_grid(tree, at)
        };
        let components: Vec<_> = flat.components.iter().zip(trees).map(&mut placed).collect();
        let lights = gpu_lights(flat, camera);
        let view = View::new(camera, size, flat, lights.len() as u32);
        let uploads = [
            self.nodes.set(device, queue, bytemuck::cast_slice(&flat.nodes)),
            self.rows.set_with_room(device, queue, bytemuck::cast_slice(&flat.numbers), KERNEL_WINDOW),
            self.numbers.set(device, queue, bytemuck::cast_slice(&flat.numbers)),
            self.lists.set(device, queue, bytemuck::cast_slice(&lists)),
            self.components.set(device, queue, bytemuck::cast_slice(&components)),
            self.materials.set(device, queue, bytemuck::cast_slice(&flat.materials)),
            self.view.set(device, queue, bytemuck::bytes_of(&view)),
            self.lights.set(device, queue, bytemuck::cast_slice(&lights)),
            self.mesh_emissions.set(device, queue, bytemuck::cast_slice(&mesh_emissions(flat))),
            self.work.set(device, queue, &work_bytes(plan)),
            self.tiles.reserve(device, plan.tiles as usize * TILE_BYTES),
            self.rays.reserve(device, (plan.lists + plan.longest * TILE * TILE) as usize * 4),
            self.tile_counts.reset(device, queue, bytemuck::cast_slice(&nothing)),
            self.ray_counts.reset(device, queue, bytemuck::cast_slice(&nothing)),
        ];
        self.reset_counts(flat.components.len(), size) || uploads.contains(&true)
    }

    fn bind_all(&self, targets: &Targets) -> Groups {
        let device = &self.gpu.device;
        let scene = [
            self.nodes.binding(),
            self.numbers.binding(),
            self.components.binding(),
            self.materials.binding(),
            window(self.rows.buffer(), KERNEL_WINDOW),
            self.lists.binding(),
        ];
        let lists = Lists {
            tiles: self.tiles.buffer(),
            tile_counts: self.tile_counts.buffer(),
            rays: self.rays.buffer(),
            ray_counts: self.ray_counts.buffer(),
            nothing: self.nothing.buffer(),
            march_counts: self.march_counts.buffer(),
        };
        let work = window(self.work.buffer(), size_of::<Work>());
        Groups {
            view: bind(device, "view", &self.layouts.view, &[self.view.binding()]),
            scene: bind(device, "scene", &self.layouts.scene, &scene),
            work: bind(device, "work", &self.layouts.work, &[work]),
            lights: self.shade.bind_lights(device, [self.lights.binding(), self.mesh_emissions.binding()]),
            field: self.kernels.field().bind(device, targets, lists),
            farthest: self.farthest.bind(device, targets),
            shade: self.shade.bind(device, targets),
        }
    }

    fn submit(&self, frame: &Frame, range: std::ops::Range<usize>) {
        let SlotState { targets, groups } = self.slot(frame.slot);
        let groups = groups.as_ref().expect("begin binds");
        let descriptor = wgpu::CommandEncoderDescriptor { label: Some("frame") };
        let mut encoder = self.gpu.device.create_command_encoder(&descriptor);
        let pieces = &frame.plan.pieces;
        let mut at = range.start;
        while at < range.end {
            if pieces[at].stage == Stage::Mesh {
                // No ray is left over yet.
                encoder.clear_buffer(self.rays.buffer(), 0, Some(u64::from(frame.plan.lists.max(1)) * 4));
                self.clear_pixel_counts(&mut encoder, targets.size);
                self.mesh.record(&mut encoder, targets, &groups.view);
                at += 1;
                continue;
            }
            let end = (at..range.end).find(|i| pieces[*i].stage == Stage::Mesh).unwrap_or(range.end);
            self.record_compute(&mut encoder, groups, frame, at..end);
            at = end;
        }
        if range.end == pieces.len() {
            self.record_look(&mut encoder, frame);
            if !frame.overlay.is_empty() {
                self.overlay.record(&self.gpu.device, &mut encoder, targets, &groups.view);
            }
        }
        self.gpu.queue.submit([encoder.finish()]);
    }

    fn record_compute(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        groups: &Groups,
        frame: &Frame,
        range: std::ops::Range<usize>,
    ) {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_bind_group(0, &groups.view, &[]);
        for at in range {
            let piece = &frame.plan.pieces[at];
            pass.set_bind_group(3, &groups.work, &[(at * WORK_STRIDE) as u32]);
            match piece.stage {
                Stage::Farthest => {
                    pass.set_pipeline(self.farthest.pipeline());
                    pass.set_bind_group(1, self.farthest.scene(), &[]);
                    pass.set_bind_group(2, &groups.farthest, &[]);
                }
                Stage::Shade => {
                    pass.set_pipeline(self.shade.pipeline());
                    pass.set_bind_group(1, &groups.lights, &[]);
                    pass.set_bind_group(2, &groups.shade, &[]);
                }
                _ => {
                    self.record_field(&mut pass, groups, frame, piece);
                    continue;
                }
            }
            let [x, y] = piece.tiles();
            pass.dispatch_workgroups(x, y, 1);
        }
    }

    /// A pass over one component.
    fn record_field(&self, pass: &mut wgpu::ComputePass<'_>, groups: &Groups, frame: &Frame, piece: &Piece) {
        let component = piece.work.component as usize;
        let kernel = &frame.choices[component].kernel;
        let (pipeline, targets) = match piece.stage {
            Stage::Cone => (&kernel.cone, &groups.field.cone),
            Stage::Trace if piece.work.packed == 1 => (&kernel.trace, &groups.field.packed),
            Stage::Trace => (&kernel.trace, &groups.field.trace),
            Stage::Surface => (&kernel.surface, &groups.field.surface),
            Stage::Mesh | Stage::Farthest | Stage::Shade => unreachable!("the caller records these"),
        };
        pass.set_pipeline(pipeline);
        pass.set_bind_group(1, &groups.scene, &[frame.rows[component]]);
        pass.set_bind_group(2, targets, &[]);
        if piece.stage == Stage::Cone {
            let [x, y] = piece.tiles();
            pass.dispatch_workgroups((x * y).div_ceil(CONE_GROUP), 1, 1);
        } else {
            let counts = if piece.work.packed == 1 { &self.ray_counts } else { &self.tile_counts };
            pass.dispatch_workgroups_indirect(counts.buffer(), u64::from(piece.work.list) * 16);
        }
    }
}
