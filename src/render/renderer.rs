//! The renderer: takes a flat scene and a camera, delivers a picture, in dispatches that can be waited for.

mod choice;
mod frame;
mod measure;
mod picture;
mod pixel_counts;
mod record;
mod unfinished;
mod upload;

use std::sync::Arc;
use std::time::{Duration, Instant};

use thiserror::Error;

use super::passes::debug_view::DebugViewPass;
use super::passes::hiz::HizPass;
use super::passes::mesh::MeshPass;
use super::passes::overlay::{OverlayPass, OverlaySettings};
use super::passes::shade::ShadePass;
use crate::flat::debug_view::ViewMode;
use crate::flat::standpoint::Standpoints;
use crate::flat::{Cancel, FlatScene, ParamRow, TapeCache};
use crate::geometry::Camera;
use crate::mesh::TriangleMesh;
use crate::render::frame::cost_model::CostModel;
use crate::render::frame::plan::{EvaluationCost, FramePlan, TooLong, plan};
use crate::render::gpu::{Gpu, GpuError};
use crate::render::pipelines::cache::PipelineCache;
use crate::render::pipelines::strategy::EvalStrategy;
use crate::render::resources::buffers::{DataTexture, SyncedBuffer};
use crate::render::resources::layouts::{Layouts, PARAMS_FORMAT};
use crate::render::resources::tape_texture::TapeTexture;
use crate::render::resources::targets::{Target, Targets};
use crate::render::resources::uniforms::UNIFORM_STRIDE;
use crate::render::wgsl::{MAX_PIPELINE_ROWS, Options, ShaderError, SkipMode};
use crate::scene::NodeId;

use choice::Chosen;
pub use frame::Frame;
pub use measure::Counts;
pub use pixel_counts::{Distribution, PixelCounts, TraceCounts};
use unfinished::GoingOn;
use upload::{Groups, template_windows};

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
    /// What is to be done is more than one buffer of the device lists: most of it for this node.
    #[error("a picture of {0} by {1} pixels takes too many steps for this device, most of them for node {2}")]
    TooManyDispatches(u32, u32, NodeId),
    /// The caller asked to stop.
    #[error("canceled")]
    Canceled,
}

/// What a frame is expected to take that cannot be drawn yet.
const LONGEST: Duration = Duration::from_secs(1_000_000);

/// Which picture a frame makes: the editor keeps a coarse one for quick answers beside the full one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slot {
    /// The picture at full size.
    Full,
    /// The coarse picture.
    Preview,
}

/// Targets of a picture with the bind groups that lead to them; remade when its size changes or a
/// buffer or pipeline is replaced.
#[derive(Debug)]
struct SlotState {
    targets: Targets,
    /// What the picture is enlarged to where marks are drawn over it that it is too coarse for.
    enlarged: Option<Target>,
    groups: Option<Groups>,
}

/// Draws flat scenes.
#[derive(Debug)]
pub struct Renderer {
    gpu: Gpu,
    layouts: Layouts,
    pipelines: PipelineCache,
    strategy: EvalStrategy,
    hiz: HizPass,
    shade: ShadePass,
    mesh: MeshPass,
    overlay: OverlayPass,
    /// Built where somebody looks.
    debug_view: Option<DebugViewPass>,
    nodes: SyncedBuffer,
    /// For the windows of specialized pipelines.
    rows: SyncedBuffer,
    /// For those of pipelines for templates.
    template_rows: SyncedBuffer,
    /// The same numbers once more, for pipelines that walk.
    params: DataTexture,
    tapes: TapeTexture,
    tape_cache: TapeCache,
    cancel: Cancel,
    components: SyncedBuffer,
    materials: SyncedBuffer,
    view: SyncedBuffer,
    lights: SyncedBuffer,
    mesh_emissions: SyncedBuffer,
    dispatch_params: SyncedBuffer,
    subtiles: SyncedBuffer,
    subtile_counts: SyncedBuffer,
    rays: SyncedBuffer,
    ray_counts: SyncedBuffer,
    nothing: SyncedBuffer,
    march_counts: SyncedBuffer,
    /// Whether pipelines count.
    counting: bool,
    slots: [Option<SlotState>; 2],
    cost_model: CostModel,
}

/// Bytes of a pipeline's window on the rows of its component. As much room is kept behind the last row, so
/// that the window on the last component does not end outside the buffer.
pub(super) const PIPELINE_WINDOW: usize = MAX_PIPELINE_ROWS as usize * size_of::<ParamRow>();
/// Bytes of a subtile in a list.
const SUBTILE_BYTES: usize = 12;
/// Words of a list of subtiles, and of a list of what its rays leave: see `shaders/common/subtiles.wgsl`.
const SUBTILE_COUNTS: usize = 5;
const RAY_COUNTS: usize = 7;
/// Invocations in a workgroup of the cone pass.
const CONE_GROUP: u32 = 64;

impl Renderer {
    /// A renderer on `gpu`. Its interpreter knows no shape until a scene brings one.
    pub fn new(gpu: &Gpu) -> Result<Self, RenderError> {
        Self::with_options(gpu, Self::options(gpu))
    }

    /// What pipelines do on this device when nobody asks for something else.
    pub fn options(gpu: &Gpu) -> Options {
        let skip_mode = if gpu.is_software() { SkipMode::Selects } else { SkipMode::Branches };
        Options { skip_mode, ..Options::default() }
    }

    /// The same with pipelines of these options.
    pub fn with_options(gpu: &Gpu, options: Options) -> Result<Self, RenderError> {
        let device = &gpu.device;
        let layouts = Layouts::new(device);
        let storage = |label| SyncedBuffer::storage(device, label);
        let renderer = Self {
            pipelines: PipelineCache::new(gpu, &layouts, options)?,
            strategy: EvalStrategy::Auto,
            hiz: HizPass::new(device, &layouts)?,
            shade: ShadePass::new(device, &layouts)?,
            mesh: MeshPass::new(device, &layouts)?,
            overlay: OverlayPass::new(device, &layouts)?,
            debug_view: None,
            nodes: storage("nodes"),
            rows: SyncedBuffer::uniform(device, "rows"),
            template_rows: SyncedBuffer::uniform(device, "rows of templates"),
            params: DataTexture::new(device, "params", PARAMS_FORMAT),
            tapes: TapeTexture::new(device),
            tape_cache: TapeCache::default(),
            cancel: Cancel::default(),
            components: SyncedBuffer::uniform(device, "components"),
            materials: storage("materials"),
            view: SyncedBuffer::uniform(device, "view"),
            lights: storage("lights"),
            mesh_emissions: storage("mesh emissions"),
            dispatch_params: SyncedBuffer::uniform(device, "dispatch_params"),
            subtiles: storage("subtiles"),
            subtile_counts: SyncedBuffer::indirect(device, "subtile counts"),
            rays: storage("rays"),
            nothing: storage("nothing"),
            ray_counts: SyncedBuffer::indirect(device, "ray counts"),
            march_counts: SyncedBuffer::read_back(device, "march counts"),
            counting: options.counting,
            slots: [None, None],
            cost_model: CostModel::new(gpu.is_software()),
            layouts,
            gpu: gpu.clone(),
        };
        gpu.check()?;
        Ok(renderer)
    }

    /// Chooses how components are evaluated from now on.
    pub fn set_strategy(&mut self, strategy: EvalStrategy) {
        self.strategy = strategy;
    }

    /// What prepares a picture stops where this says so, with [`RenderError::Canceled`].
    pub fn set_cancel(&mut self, cancel: &Cancel) {
        self.cancel = cancel.clone();
        self.tape_cache.set_cancel(cancel);
    }

    fn check_cancel(&self) -> Result<(), RenderError> {
        if self.cancel.is_canceled() { Err(RenderError::Canceled) } else { Ok(()) }
    }

    /// How many pipelines are being built.
    pub fn pipelines_building(&self) -> usize {
        self.pipelines.building()
    }

    /// How many pipelines could not be built.
    pub fn pipelines_failed(&self) -> usize {
        self.pipelines.failed()
    }

    /// Whether pipelines or tapes are being made: pictures are right without them, and faster with them.
    pub fn is_preparing(&self) -> bool {
        self.pipelines.building() > 0 || self.tape_cache.building() > 0
    }

    /// The tapes.
    pub fn tape_cache(&mut self) -> &mut TapeCache {
        &mut self.tape_cache
    }

    /// The pipelines.
    pub fn pipelines(&mut self) -> &mut PipelineCache {
        &mut self.pipelines
    }

    /// The device.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Bytes of scene data uploaded so far.
    pub fn uploaded(&self) -> u64 {
        let buffers = [&self.nodes, &self.rows, &self.template_rows, &self.components, &self.materials]
            .map(SyncedBuffer::uploaded);
        buffers.iter().sum::<u64>() + self.params.uploaded() + self.tapes.uploaded()
    }

    /// How long a whole frame is expected to take. While tapes are being made it may be more than can be drawn at all.
    pub fn estimate(&mut self, flat: &FlatScene, camera: &Camera, size: [u32; 2]) -> Result<Duration, RenderError> {
        let Chosen { evaluations, .. } = self.choose(flat, camera)?;
        match self.plan(flat, camera, size, &evaluations) {
            Err(RenderError::TooManyDispatches(..)) if self.tape_cache.building() > 0 => Ok(LONGEST),
            plan => {
                Ok(Duration::from_secs_f64(self.cost_model.seconds_of_frame(plan?.cost()).min(LONGEST.as_secs_f64())))
            }
        }
    }

    /// The dispatches of a frame, no more than the device holds. A component of a thousand leaves that is walked without tapes on
    /// a driver that ends loops early makes it long.
    fn plan(
        &self,
        flat: &FlatScene,
        camera: &Camera,
        size: [u32; 2],
        evaluations: &[EvaluationCost],
    ) -> Result<FramePlan, RenderError> {
        let refused = |TooLong { component }| {
            RenderError::TooManyDispatches(size[0], size[1], flat.ids[flat.components[component].first as usize])
        };
        plan(flat, camera, size, evaluations, &self.cost_model, self.max_dispatches()).map_err(refused)
    }

    /// How many dispatches the device can be told of.
    fn max_dispatches(&self) -> usize {
        // Buffers grow by powers of two.
        let bytes = self.gpu.device.limits().max_buffer_size.checked_ilog2().map_or(0, |bits| 1_usize << bits);
        bytes / UNIFORM_STRIDE
    }

    /// Uploads what has changed and plans the dispatches. `meshes` stands beside `flat.meshes`.
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
        let Chosen { keys, choices, evaluations, trees } = self.choose(flat, camera)?;
        self.check_cancel()?;
        let plan = self.plan(flat, camera, size, &evaluations)?;
        self.check_cancel()?;
        self.gpu.check()?;
        if self.slots[slot as usize].as_ref().is_none_or(|s| s.targets.size != size) {
            let targets = Targets::new(&self.gpu.device, size);
            self.slots[slot as usize] = Some(SlotState { targets, enlarged: None, groups: None });
        }
        let standpoints = Standpoints::new(flat, camera, size);
        let (template_rows, templates) = template_windows(flat, &standpoints.params, &keys);
        let templates_are_new = self.template_rows.set(&self.gpu.device, &self.gpu.queue, &templates);
        if self.upload(flat, &standpoints, &trees, camera, size, &plan) || templates_are_new {
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
        self.mesh.prepare(&self.gpu.device, &self.gpu.queue, flat, meshes, camera, size);
        if let Some(state) = &mut self.slots[slot as usize] {
            let shown = overlay.enlarged(size);
            let kept = state.enlarged.take().filter(|target| shown == Some(target.size()));
            state.enlarged = kept.or_else(|| shown.map(|size| Target::shown(&self.gpu.device, size)));
        }
        if !overlay.is_empty() {
            self.overlay.prepare(&self.gpu.device, &self.gpu.queue, flat, &overlay, size, camera.position);
        }
        let mut frame = Frame {
            cost_model: self.cost_model,
            seconds: self.cost_model.seconds(plan.cost()),
            plan,
            keys,
            choices,
            next: 0,
            seconds_done: 0.0,
            measured: Some(Duration::ZERO),
            relaunches_at_once: 0,
            slot,
            overlay,
            view_mode: ViewMode::Shaded,
            going_on: GoingOn::default(),
            template_rows,
            rows: flat.components.iter().map(|c| c.params * size_of::<ParamRow>() as u32).collect(),
            origins: flat.components.iter().map(|c| flat.ids[c.first as usize]).collect(),
        };
        if slot == Slot::Preview {
            // It is to be there at once, and the full one comes after it.
            frame.end_as_planned();
        }
        Ok(frame)
    }

    /// Works on the frame until `budget` is used or the picture is complete; at least one batch of
    /// dispatches of about [`crate::render::frame::plan::DISPATCH_TARGET`]. Waits for the device, and updates the cost model.
    pub fn advance(&mut self, frame: &mut Frame, budget: Duration) -> Result<(), RenderError> {
        // What others have submitted before, the painting of a window above all, is none of this frame's time.
        self.gpu.wait()?;
        let start = Instant::now();
        if self.pipelines.collect() {
            self.pipelines.refresh(&frame.keys, &mut frame.choices);
        }
        loop {
            let (dispatches, cost, relaunches) = frame.next_batch(&self.cost_model);
            let submitted = Instant::now();
            frame.seconds_done += frame.cost_model.seconds(cost);
            self.submit(frame, dispatches.clone());
            self.gpu.wait()?;
            let elapsed = submitted.elapsed();
            // The first dispatch of a pipeline may include its compilation, and a later relaunch marches an unknown
            // few of its rays: neither says that the device is slow.
            let foreseen = relaunches == 0 || elapsed.as_secs_f64() < self.cost_model.seconds(cost);
            let is_typical = !frame.uses_fresh_pipelines(dispatches.clone());
            if is_typical && foreseen {
                self.cost_model.learn(cost, elapsed);
            }
            frame.measured = frame.measured.filter(|_| is_typical).map(|before| before + elapsed);
            frame.learn_relaunches(relaunches, elapsed);
            frame.next = dispatches.end;
            if frame.is_done() {
                self.go_on(frame)?;
            }
            if let (true, Some(elapsed)) = (frame.is_done(), frame.measured) {
                self.cost_model.learn_frame(frame.plan.cost(), elapsed);
            }
            if frame.is_done() || start.elapsed() >= budget {
                return Ok(());
            }
        }
    }

    /// The picture in a slot: complete once its frame is done, and another texture after a
    /// [`Renderer::begin`] of another size.
    pub fn picture(&self, slot: Slot) -> Option<(&wgpu::TextureView, [u32; 2])> {
        self.slots[slot as usize].as_ref().map(|s| {
            let shown = s.enlarged.as_ref().unwrap_or(&s.targets.color);
            (&shown.view, shown.size())
        })
    }

    fn slot(&self, slot: Slot) -> &SlotState {
        self.slots[slot as usize].as_ref().expect("begin makes the targets")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flat::{FlatNode, LEAF_ROWS, MESH_BIT, MODIFIER_ROWS, NO_LEAF};
    use crate::render::frame::plan::{SUBTILES, TILE};
    use crate::render::resources::buffers::DataTexture;
    use crate::render::wgsl::assemble_plain;

    /// The value of a constant in a shader.
    fn constant(file: &str, name: &str) -> u32 {
        let text = assemble_plain(file).unwrap_or_else(|error| panic!("{error}"));
        let start = format!("const {name}: u32 = ");
        let line =
            text.lines().find_map(|line| line.strip_prefix(&start)).unwrap_or_else(|| panic!("{file}: no {name}"));
        let digits = line.trim_end_matches(';').trim_end_matches('u');
        let number = digits.strip_prefix("0x").map_or_else(|| digits.parse(), |hex| u32::from_str_radix(hex, 16));
        number.unwrap_or_else(|error| panic!("{file}: {name}: {digits}: {error}"))
    }

    #[test]
    fn shaders_have_the_same_constants() {
        let counterparts = [
            ("common/subtiles.wgsl", "SUBTILE_COUNTS", SUBTILE_COUNTS as u32),
            ("common/subtiles.wgsl", "RAY_COUNTS", RAY_COUNTS as u32),
            ("common/subtiles.wgsl", "SUBTILE", TILE / SUBTILES),
            ("common/dispatch.wgsl", "TILE", TILE),
            ("common/depth.wgsl", "VISIBILITY_NONE", NO_LEAF),
            ("common/depth.wgsl", "MESH_BIT", MESH_BIT),
            ("common/scene.wgsl", "LEAF_ROWS", LEAF_ROWS as u32),
            ("common/scene.wgsl", "MODIFIER_ROWS", MODIFIER_ROWS as u32),
            ("common/scene.wgsl", "GROUP", FlatNode::GROUP),
            ("common/scene.wgsl", "RUN", FlatNode::RUN),
            ("common/scene.wgsl", "MODIFIER", FlatNode::MODIFIER),
            ("common/scene.wgsl", "LINE", DataTexture::LINE as u32),
            ("common/counts.wgsl", "COMPONENT_COUNTS", pixel_counts::COMPONENT_COUNTS as u32),
            ("common/counts.wgsl", "PIXEL_COUNTS", pixel_counts::PIXEL_COUNTS as u32),
        ];
        for (file, name, ours) in counterparts {
            assert_eq!(constant(file, name), ours, "{file}: {name}");
        }
    }

    #[test]
    fn subtiles_have_room() {
        let text = assemble_plain("trace.wgsl").unwrap_or_else(|error| panic!("{error}"));
        let module = naga::front::wgsl::parse_str(&text).unwrap_or_else(|error| panic!("{error}"));
        let (_, subtile) = module.types.iter().find(|(_, t)| t.name.as_deref() == Some("Subtile")).expect("a subtile");
        let naga::TypeInner::Struct { span, .. } = subtile.inner else { panic!("{subtile:?}") };
        assert_eq!(span as usize, SUBTILE_BYTES);
    }
}
