//! The renderer: takes a flat scene and a camera, delivers a picture, in pieces that can be waited for.

use std::sync::Arc;
use std::time::{Duration, Instant};

use thiserror::Error;
use wgpu::BindGroup;

use super::buffers::Mirror;
use super::gpu::{Gpu, GpuError};
use super::layouts::{Layouts, bind};
use super::passes::mesh::MeshPass;
use super::passes::overlay::{OverlayPass, OverlaySettings};
use super::passes::shade::ShadePass;
use super::passes::surface::SurfacePass;
use super::passes::trace::TracePass;
use super::readback::{read_buffers, read_words};
use super::schedule::{DISPATCH_TARGET, Pace, Piece, Stage, plan};
use super::shader::{Features, ShaderError};
use super::targets::Targets;
use super::uniforms::{GpuComponent, View, Work};
use crate::flat::{Buffers, FlatScene, Warning, gpu_lights};
use crate::geometry::Camera;
use crate::mesh::TriangleMesh;

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
    /// The caller asked to stop.
    #[error("cancelled")]
    Cancelled,
}

/// A frame under way.
#[derive(Debug)]
pub struct Frame {
    pieces: Vec<Piece>,
    next: usize,
    effort_done: f64,
    effort: f64,
    slot: Slot,
    overlay: OverlaySettings,
    origins: Vec<crate::scene::NodeId>,
}

impl Frame {
    /// Share that is done, from 0 to 1.
    pub fn progress(&self) -> f32 {
        if self.is_done() { 1.0 } else { (self.effort_done / self.effort.max(1e-9)) as f32 }
    }

    /// Whether the picture is complete.
    pub fn is_done(&self) -> bool {
        self.next == self.pieces.len()
    }
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
    features: Features,
    trace: TracePass,
    surface: SurfacePass,
    shade: ShadePass,
    mesh: MeshPass,
    overlay: OverlayPass,
    nodes: Mirror,
    numbers: Mirror,
    components: Mirror,
    materials: Mirror,
    view: Mirror,
    lights: Mirror,
    work: Mirror,
    unfinished: Mirror,
    slots: [Option<SlotState>; 2],
    pace: Pace,
    kernels_built: u32,
}

#[derive(Debug)]
struct Groups {
    view: BindGroup,
    scene: BindGroup,
    work: BindGroup,
    lights: BindGroup,
    trace: BindGroup,
    surface: BindGroup,
    shade: BindGroup,
}

/// Dynamic offsets of `Work` are multiples of this.
const WORK_STRIDE: usize = 256;

impl Renderer {
    /// A renderer on `gpu`. Its kernels know no shape until a scene brings one.
    pub fn new(gpu: &Gpu) -> Result<Self, RenderError> {
        let device = &gpu.device;
        let layouts = Layouts::new(device);
        let features = Features { shapes: [].into(), stack: 1 };
        let storage = |label| Mirror::storage(device, label);
        let renderer = Self {
            trace: TracePass::new(device, &layouts, &features)?,
            surface: SurfacePass::new(device, &layouts, &features)?,
            shade: ShadePass::new(device, &layouts)?,
            mesh: MeshPass::new(device, &layouts)?,
            overlay: OverlayPass::new(device, &layouts)?,
            nodes: storage("nodes"),
            numbers: storage("numbers"),
            components: storage("components"),
            materials: storage("materials"),
            view: Mirror::uniform(device, "view"),
            lights: storage("lights"),
            work: Mirror::uniform(device, "work"),
            unfinished: Mirror::read_back(device, "unfinished"),
            slots: [None, None],
            pace: Pace::new(gpu.is_software()),
            kernels_built: 0,
            layouts,
            features,
            gpu: gpu.clone(),
        };
        gpu.check()?;
        Ok(renderer)
    }

    /// The device.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// How often kernels had to be built because a scene used more than they knew.
    pub fn kernels_built(&self) -> u32 {
        self.kernels_built
    }

    /// Bytes of scene data uploaded so far.
    pub fn uploaded(&self) -> u64 {
        [&self.nodes, &self.numbers, &self.components, &self.materials].map(Mirror::uploaded).iter().sum()
    }

    /// How long a whole frame is expected to take.
    pub fn estimate(&self, flat: &FlatScene, camera: &Camera, size: [u32; 2]) -> Duration {
        self.pace.time_for(plan(flat, camera, size, &self.pace).iter().map(|p| p.effort).sum())
    }

    /// The picture of a whole scene. `progress` is told the share that is done, between dispatches, and
    /// answers whether to go on.
    pub fn render(
        &mut self,
        flat: &FlatScene,
        meshes: &[Option<Arc<TriangleMesh>>],
        camera: &Camera,
        size: [u32; 2],
        progress: &mut dyn FnMut(f32) -> bool,
    ) -> Result<(Buffers, Vec<Warning>), RenderError> {
        let mut frame = self.begin(Slot::Full, flat, meshes, camera, size, OverlaySettings::default())?;
        while !frame.is_done() {
            if !progress(frame.progress()) {
                return Err(RenderError::Cancelled);
            }
            self.advance(&mut frame, Duration::ZERO)?;
        }
        progress(1.0);
        let buffers = read_buffers(&self.gpu, &self.slot(Slot::Full).targets)?;
        Ok((buffers, self.unfinished_rays(&frame, flat)?))
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
        self.learn_features(flat)?;
        if self.slots[slot as usize].as_ref().is_none_or(|s| s.targets.size != size) {
            let targets = Targets::new(&self.gpu.device, size);
            self.slots[slot as usize] = Some(SlotState { targets, groups: None });
        }
        let pieces = plan(flat, camera, size, &self.pace);
        if self.upload(flat, camera, size, &pieces) {
            self.forget_groups();
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
        let effort = pieces.iter().map(|p| p.effort).sum();
        let origins = flat.components.iter().map(|c| flat.ids[c.first as usize]).collect();
        Ok(Frame { pieces, next: 0, effort_done: 0.0, effort, slot, overlay, origins })
    }

    /// Works on the frame until `budget` is used or the picture is complete; at least one batch of
    /// dispatches of about [`DISPATCH_TARGET`]. Waits for the device, and learns its pace.
    pub fn advance(&mut self, frame: &mut Frame, budget: Duration) -> Result<(), RenderError> {
        let start = Instant::now();
        loop {
            let first = frame.next;
            let most = self.pace.effort_in(DISPATCH_TARGET);
            let mut effort = 0.0;
            let mut end = first;
            while end < frame.pieces.len() && (end == first || effort + frame.pieces[end].effort <= most) {
                effort += frame.pieces[end].effort;
                end += 1;
            }
            let submitted = Instant::now();
            self.submit(frame, first..end);
            self.gpu.wait()?;
            self.pace.learn(effort, submitted.elapsed());
            frame.next = end;
            frame.effort_done += effort;
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

    /// Which components had rays that did not come to an end within the steps allowed.
    pub fn unfinished_rays(&self, frame: &Frame, flat: &FlatScene) -> Result<Vec<Warning>, RenderError> {
        let counts = read_words(&self.gpu, self.unfinished.buffer(), flat.components.len())?;
        let warnings = counts.iter().zip(&frame.origins).filter(|(count, _)| **count > 0).map(|(count, id)| Warning {
            node: *id,
            name: String::new(),
            reason: format!("{count} rays did not come to an end within the steps allowed; they show what lies behind"),
        });
        Ok(warnings.collect())
    }

    fn learn_features(&mut self, flat: &FlatScene) -> Result<(), RenderError> {
        let wanted = Features::of(flat);
        if !self.features.covers(&wanted) {
            // Only ever more: going back and forth between scenes builds nothing twice.
            let features = self.features.union(&wanted);
            self.trace = TracePass::new(&self.gpu.device, &self.layouts, &features)?;
            self.surface = SurfacePass::new(&self.gpu.device, &self.layouts, &features)?;
            self.gpu.check()?;
            self.features = features;
            self.kernels_built += 1;
            self.forget_groups();
        }
        Ok(())
    }

    fn slot(&self, slot: Slot) -> &SlotState {
        self.slots[slot as usize].as_ref().expect("begin makes the targets")
    }

    fn forget_groups(&mut self) {
        for state in self.slots.iter_mut().flatten() {
            state.groups = None;
        }
    }

    /// Returns whether a buffer was replaced.
    fn upload(&mut self, flat: &FlatScene, camera: &Camera, size: [u32; 2], pieces: &[Piece]) -> bool {
        let Gpu { device, queue, .. } = &self.gpu;
        let components: Vec<_> = flat.components.iter().map(|c| GpuComponent::new(c, camera.position)).collect();
        let lights = gpu_lights(flat, camera);
        let view = View::new(camera, size, flat, lights.len() as u32);
        let mut work = vec![0_u8; pieces.len() * WORK_STRIDE];
        for (slot, piece) in work.chunks_exact_mut(WORK_STRIDE).zip(pieces) {
            slot[..size_of::<Work>()].copy_from_slice(bytemuck::bytes_of(&piece.work));
        }
        let uploads = [
            self.nodes.set(device, queue, bytemuck::cast_slice(&flat.nodes)),
            self.numbers.set(device, queue, bytemuck::cast_slice(&flat.numbers)),
            self.components.set(device, queue, bytemuck::cast_slice(&components)),
            self.materials.set(device, queue, bytemuck::cast_slice(&flat.materials)),
            self.view.set(device, queue, bytemuck::bytes_of(&view)),
            self.lights.set(device, queue, bytemuck::cast_slice(&lights)),
            self.work.set(device, queue, &work),
            self.unfinished.clear(device, queue, flat.components.len() * 4),
        ];
        uploads.contains(&true)
    }

    fn bind_all(&self, targets: &Targets) -> Groups {
        let device = &self.gpu.device;
        let scene = [&self.nodes, &self.numbers, &self.components, &self.materials].map(Mirror::binding);
        let work = wgpu::BindingResource::Buffer(wgpu::BufferBinding {
            buffer: self.work.buffer(),
            offset: 0,
            size: std::num::NonZeroU64::new(size_of::<Work>() as u64),
        });
        Groups {
            view: bind(device, "view", &self.layouts.view, &[self.view.binding()]),
            scene: bind(device, "scene", &self.layouts.scene, &scene),
            work: bind(device, "work", &self.layouts.work, &[work]),
            lights: self.shade.bind_lights(device, self.lights.binding()),
            trace: self.trace.bind(device, targets, self.unfinished.buffer()),
            surface: self.surface.bind(device, targets),
            shade: self.shade.bind(device, targets),
        }
    }

    fn submit(&self, frame: &Frame, range: std::ops::Range<usize>) {
        let SlotState { targets, groups } = self.slot(frame.slot);
        let groups = groups.as_ref().expect("begin binds");
        let descriptor = wgpu::CommandEncoderDescriptor { label: Some("frame") };
        let mut encoder = self.gpu.device.create_command_encoder(&descriptor);
        let mut at = range.start;
        while at < range.end {
            if frame.pieces[at].stage == Stage::Mesh {
                self.mesh.record(&mut encoder, targets, &groups.view);
                at += 1;
                continue;
            }
            let end = (at..range.end).find(|i| frame.pieces[*i].stage == Stage::Mesh).unwrap_or(range.end);
            self.record_compute(&mut encoder, groups, &frame.pieces[at..end], at);
            at = end;
        }
        if range.end == frame.pieces.len() && !frame.overlay.is_empty() {
            self.overlay.record(&self.gpu.device, &mut encoder, targets, &groups.view);
        }
        self.gpu.queue.submit([encoder.finish()]);
    }

    fn record_compute(&self, encoder: &mut wgpu::CommandEncoder, groups: &Groups, pieces: &[Piece], first: usize) {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_bind_group(0, &groups.view, &[]);
        let mut stage = None;
        for (i, piece) in pieces.iter().enumerate() {
            if stage != Some(piece.stage) {
                stage = Some(piece.stage);
                let (pipeline, data, targets) = match piece.stage {
                    Stage::Trace => (self.trace.pipeline(), &groups.scene, &groups.trace),
                    Stage::Surface => (self.surface.pipeline(), &groups.scene, &groups.surface),
                    Stage::Shade => (self.shade.pipeline(), &groups.lights, &groups.shade),
                    Stage::Mesh => unreachable!("the caller records it as a render pass"),
                };
                pass.set_pipeline(pipeline);
                pass.set_bind_group(1, data, &[]);
                pass.set_bind_group(2, targets, &[]);
            }
            pass.set_bind_group(3, &groups.work, &[((first + i) * WORK_STRIDE) as u32]);
            let [x, y] = piece.tiles();
            pass.dispatch_workgroups(x, y, 1);
        }
    }
}
