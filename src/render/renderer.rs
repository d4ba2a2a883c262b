//! The renderer: draws a flat scene as seen by a camera into a picture, in short dispatches.

mod choice;
mod error;
pub(super) mod evaluation;
mod frame;
mod going_on;
mod measure;
pub(super) mod mesh_materials;
mod pixel_counts;
mod prewarm;
pub(super) mod recorder;
pub(super) mod resources;
mod samples;
pub(super) mod scene;
mod shadows;
mod slot;
mod still;
pub(super) mod timings;
mod unfinished;

use std::ops::Range;
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::passes::{Passes, frame_pass::Building, overlay_settings::OverlaySettings};
use super::recipe::{Extent, Pass};
use crate::frame::cost_model::CostModel;
use crate::frame::light_tiles::{PixelLight, bytes_of_light_tiles};
use crate::frame::plan::{FramePlan, PlannedView, Room, TooMuch, TracedParts, plan};
use crate::gpu::Gpu;
use crate::gpu::readback::{read_buffers, read_color, read_words_at};
use crate::passes::shade_features::ShadeFeatures;
use crate::pipelines::cache::PipelineCache;
use crate::pipelines::strategy::EvalStrategy;
use crate::resources::layouts::Layouts;
use crate::resources::targets::copied_bytes;
use isolith_field::debug_view::{DepthRange, ViewMode};
use isolith_field::standpoint::Standpoints;
use isolith_field::{Cancel, FlatScene, GBuffer, GpuLight, TapeCache, Warning, gpu_lights};
use isolith_geometry::{Camera, SampleView};
use isolith_mesh::TriangleMesh;
use isolith_wgsl::{Options, SkipMode};

use choice::{Chosen, Evaluators, check};
pub use error::RenderError;
pub use frame::Frame;
pub use measure::Counts;
pub use pixel_counts::{Distribution, PixelCounts, TraceCounts};
use recorder::Recorder;
use resources::{FrameResources, SUBTILE_COUNTS, bytes_of_subtiles};
use scene::SceneResources;
use shadows::{SeenScene, ShadowWork};
pub use slot::Slot;
pub use still::{Film, SampleMoment, StillWatch};
pub use timings::PassTime;
use timings::PassTimings;

/// Estimated time of a frame that cannot be drawn yet.
const LONGEST: Duration = Duration::from_secs(1_000_000);

/// Draws flat scenes.
#[derive(Debug)]
pub struct Renderer {
    gpu: Gpu,
    scene: SceneResources,
    resources: FrameResources,
    passes: Passes,
    pipelines: PipelineCache,
    tape_cache: TapeCache,
    strategy: EvalStrategy,
    cost_model: CostModel,
    timings: PassTimings,
    cancel: Cancel,
    traced: TracedParts,
    /// See [`Renderer::set_sparse_light`].
    sparse_light: bool,
    /// See [`Renderer::set_late_shadows`].
    late_shadows: bool,
}

/// The plan of a picture, before any upload.
struct Prepared {
    chosen: Chosen,
    plan: FramePlan,
    lights: Vec<GpuLight>,
    shadows: Option<ShadowWork>,
}

impl Renderer {
    /// A renderer on `gpu`. Its interpreter knows no shapes until it gets a scene.
    pub fn new(gpu: &Gpu) -> Result<Self, RenderError> {
        Self::with_options(gpu, Self::options(gpu))
    }

    /// Default options of pipelines on this device.
    pub fn options(gpu: &Gpu) -> Options {
        let skip_mode = if gpu.is_software() { SkipMode::Selects } else { SkipMode::Branches };
        Options { skip_mode, ..Options::default() }
    }

    /// A renderer for view modes that show counts: its pipelines count. It evaluates components by tapes, so that a
    /// view mode compiles no specialized pipelines.
    pub fn counting(gpu: &Gpu) -> Result<Self, RenderError> {
        let mut renderer = Self::with_options(gpu, Options { counting: true, ..Self::options(gpu) })?;
        renderer.set_strategy(EvalStrategy::Tape);
        Ok(renderer)
    }

    /// A renderer whose pipelines have these options.
    pub fn with_options(gpu: &Gpu, options: Options) -> Result<Self, RenderError> {
        let device = &gpu.device;
        let layouts = Layouts::new(device);
        let pipelines = PipelineCache::new(gpu, &layouts, options)?;
        let building = Building { device, layouts: &layouts, field: pipelines.field() };
        let renderer = Self {
            passes: Passes::new(building)?,
            pipelines,
            scene: SceneResources::new(device, &layouts),
            resources: FrameResources::new(device, layouts, options.counting),
            tape_cache: TapeCache::default(),
            strategy: EvalStrategy::Auto,
            cost_model: CostModel::new(gpu.is_software()),
            timings: PassTimings::default(),
            cancel: Cancel::default(),
            traced: TracedParts::default(),
            sparse_light: false,
            late_shadows: false,
            gpu: gpu.clone(),
        };
        gpu.check()?;
        Ok(renderer)
    }

    /// Sets the strategy for the evaluation of components from now on.
    pub fn set_strategy(&mut self, strategy: EvalStrategy) {
        self.strategy = strategy;
    }

    /// Sets the token that stops the preparation of a picture with [`RenderError::Canceled`].
    pub fn set_cancel(&mut self, cancel: &Cancel) {
        self.cancel = cancel.clone();
        self.tape_cache.set_cancel(cancel);
    }

    /// Sets what is traced of scenes from now on.
    pub fn set_traced(&mut self, traced: TracedParts) {
        self.traced = traced;
    }

    /// Switches timings of the passes on or off. They cost time: each component then has its own passes on the device.
    pub fn set_timing(&mut self, is_on: bool) {
        self.timings = if is_on { PassTimings::new(&self.gpu) } else { PassTimings::default() };
    }

    /// Time of each pass of the recipe in the last frame begun; `None` if timings are off, or the device has no
    /// timestamps.
    pub fn timings(&self) -> Option<&[PassTime]> {
        self.timings.rows()
    }

    /// Number of pipelines that are being built.
    pub fn pipelines_building(&self) -> usize {
        self.pipelines.building()
    }

    /// Number of pipelines that failed to build.
    pub fn pipelines_failed(&self) -> usize {
        self.pipelines.failed()
    }

    /// Whether workers build pipelines or tapes. Pictures are correct without them, and faster with them.
    pub fn is_preparing(&self) -> bool {
        self.pipelines.building() > 0 || self.tape_cache.building() > 0
    }

    /// The cache of tapes.
    pub fn tape_cache(&mut self) -> &mut TapeCache {
        &mut self.tape_cache
    }

    /// The cache of pipelines.
    pub fn pipelines(&mut self) -> &mut PipelineCache {
        &mut self.pipelines
    }

    /// The device.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Bytes of scene data uploaded so far.
    pub fn uploaded(&self) -> u64 {
        self.scene.uploaded()
    }

    /// Expected time of a whole frame. While workers build tapes, it may exceed what can be drawn at all.
    pub fn estimate(&mut self, flat: &FlatScene, camera: &Camera, size: [u32; 2]) -> Result<Duration, RenderError> {
        match self.prepare(flat, &(*camera).into(), size) {
            Err(RenderError::TooManyDispatches(..)) if self.tape_cache.building() > 0 => Ok(LONGEST),
            prepared => {
                let seconds = self.cost_model.seconds_of_frame(prepared?.plan.cost());
                Ok(Duration::from_secs_f64(seconds.min(LONGEST.as_secs_f64())))
            }
        }
    }

    /// Chooses the evaluator of each component.
    fn choose(&mut self, flat: &FlatScene, camera: &Camera) -> Result<Chosen, RenderError> {
        let room = self.scene.most_words(&self.gpu.device);
        let Self { pipelines, tape_cache, strategy, cancel, .. } = self;
        Evaluators { pipelines, tape_cache, strategy: *strategy, room }.choose(flat, camera, cancel)
    }

    /// Chooses the evaluators and plans a frame within the capacity of the device. A frame becomes long if a component
    /// of a thousand leaves has no tapes and the driver ends loops early.
    fn prepare(&mut self, flat: &FlatScene, view: &SampleView, size: [u32; 2]) -> Result<Prepared, RenderError> {
        let chosen = self.choose(flat, &view.camera)?;
        let (room, limit) = Room::of(&self.gpu.device.limits());
        let node = |component: usize| flat.ids[flat.components[component].first as usize];
        let refused = |error| match error {
            TooMuch::Pieces { component } => RenderError::TooManyDispatches(size[0], size[1], node(component)),
            TooMuch::Subtiles { component, subtiles } => {
                RenderError::ListBytes { size, node: node(component), needed: bytes_of_subtiles(subtiles), limit }
            }
        };
        let lights = gpu_lights(flat, &view.camera, size);
        let casters = lights.iter().filter(|light| light.cast_shadows == 1).count();
        let shadows = ShadowWork::of(flat, &chosen, casters, size, limit);
        let shadows = shadows.map(|work| if self.sparse_light { work.sparse() } else { work });
        let shadows = shadows.filter(|work| self.shadows_are_ready(flat, work));
        let tiled = bytes_of_light_tiles(lights.len(), size, limit).is_some();
        let of_shadows = shadows.map_or(0.0, |shadows| shadows.per_pixel());
        let light = PixelLight { lights: lights.len(), tiled, shadows: of_shadows };
        let shown = PlannedView { view, size, traced: self.traced };
        let plan = plan(flat, shown, &chosen.evaluations, light, &self.cost_model, room).map_err(refused)?;
        check(&self.cancel)?;
        Ok(Prepared { chosen, plan, lights, shadows })
    }

    /// Uploads changed data and plans the dispatches. `meshes` is parallel to `flat.meshes`.
    pub fn begin(
        &mut self,
        slot: Slot,
        flat: &FlatScene,
        meshes: &[Option<Arc<TriangleMesh>>],
        camera: &Camera,
        size: [u32; 2],
        overlay: OverlaySettings,
    ) -> Result<Frame, RenderError> {
        self.begin_at(slot, flat, meshes, &(*camera).into(), size, overlay)
    }

    /// The same for one of several samples.
    fn begin_at(
        &mut self,
        slot: Slot,
        flat: &FlatScene,
        meshes: &[Option<Arc<TriangleMesh>>],
        view: &SampleView,
        size: [u32; 2],
        overlay: OverlaySettings,
    ) -> Result<Frame, RenderError> {
        let camera = &view.camera;
        let limits = self.gpu.device.limits();
        let limit = limits.max_texture_dimension_2d;
        if size[0] == 0 || size[1] == 0 || size[0] > limit || size[1] > limit {
            return Err(RenderError::Size(size[0], size[1], limit));
        }
        if !self.resources.counts.fit(flat.components.len(), size, limits.max_storage_buffer_binding_size) {
            return Err(RenderError::Counts(size[0], size[1]));
        }
        if !flat.instancers.is_empty() && copied_bytes(size) > limits.max_storage_buffer_binding_size {
            return Err(RenderError::Copies(size[0], size[1]));
        }
        let Prepared { chosen, plan, lights, shadows } = {
            let _span = tracing::debug_span!("plan", components = flat.components.len()).entered();
            self.prepare(flat, view, size)?
        };
        let _span = tracing::debug_span!("upload").entered();
        self.gpu.check()?;
        let (Gpu { device, queue, .. }, materials) = (&self.gpu, mesh_materials::MeshMaterials::new(flat, meshes));
        self.resources.resize(device, slot, size, &overlay, !flat.instancers.is_empty());
        let standpoints = Standpoints::new(flat, camera, size);
        let (scene_is_new, template_rows) =
            self.scene.upload(&self.gpu, flat, (camera.position, &standpoints), &chosen.trees, &chosen.keys);
        let parts = (&mut self.passes, &self.scene, &mut self.resources);
        let seen = SeenScene { flat, meshes, camera, size, standpoints: &standpoints };
        let shadows_are_new = shadows::upload(&self.gpu, parts, seen, (&chosen, shadows), self.pipelines.options())?;
        if self.resources.upload(&self.gpu, flat, (&lights, &materials), camera, size, &plan)
            || scene_is_new
            || shadows_are_new
        {
            self.resources.forget_groups();
        }
        self.passes.mesh.prepare(&self.gpu, flat, meshes, &materials.of_parts, camera, size)?;
        let shadowed = self.resources.shadows.used.is_on();
        let sparse = shadowed && self.resources.shadows.used.is_sparse();
        let tiled = self.resources.light_tiles().is_some();
        let features = ShadeFeatures { tiled, sparse, ..ShadeFeatures::new(flat, &lights, &materials.all, shadowed) };
        // Samples have shares for every pixel.
        for sparse in [sparse, false].into_iter().take(1 + usize::from(sparse)) {
            self.passes.shade.prepare(device, ShadeFeatures { sparse, ..features })?;
        }
        if !overlay.is_empty() {
            self.passes.overlay.prepare(device, queue, flat, &overlay, size, camera.position);
        }
        self.resources.bind(device, slot, &self.scene, |bound| self.passes.bind(device, bound));
        self.timings.begin();
        let mut frame = Frame::new(slot, flat, chosen, plan, self.cost_model, overlay);
        frame.template_rows = template_rows;
        frame.of_meshes = self.passes.mesh.warnings(flat);
        frame.shade_features = features;
        frame.shadowed_lights = shadows.map_or([0, 0], |shadows| shadows.lights());
        if slot == Slot::Preview {
            // A preview must be quick, and the full picture follows it.
            frame.end_as_planned();
        }
        Ok(frame)
    }

    /// Makes the frame end with this view mode. Colors of distances span `depth_range`. For view modes that show
    /// counts, use a renderer that counts: other renderers have no counts to show.
    pub fn debug_view(
        &mut self,
        frame: &mut Frame,
        view_mode: ViewMode,
        flat: &FlatScene,
        depth_range: &DepthRange,
    ) -> Result<(), RenderError> {
        assert!(self.resources.counts.is_on || !view_mode.counts(), "{} needs pipelines that count", view_mode.name());
        frame.view_mode = view_mode;
        if view_mode != ViewMode::Shaded {
            self.resources.show_first_surfaces(&self.gpu);
            let Gpu { device, queue, .. } = &self.gpu;
            self.passes.debug_view.prepare((device, queue), flat, view_mode, depth_range);
        }
        Ok(())
    }

    /// Works on the frame until `budget` is spent or the picture is complete, but for at least one batch of dispatches
    /// of about [`crate::frame::plan::DISPATCH_TARGET`]. Waits for the device, and updates the cost model.
    pub fn advance(&mut self, frame: &mut Frame, budget: Duration) -> Result<(), RenderError> {
        // Earlier submissions of others, above all the painting of the window, must not count as time of this frame.
        self.gpu.wait()?;
        let start = Instant::now();
        if self.pipelines.collect() {
            self.pipelines.refresh(&frame.keys, &mut frame.choices);
        }
        loop {
            let (dispatches, cost, relaunches) = frame.next_batch(&self.cost_model);
            let is_shadow = shadows::begin(&self.gpu, &mut self.resources, frame, dispatches.start);
            let submitted = Instant::now();
            frame.seconds_done += frame.cost_model.seconds(cost);
            self.submit(frame, dispatches.clone())?;
            self.gpu.wait()?;
            let elapsed = submitted.elapsed();
            // The first dispatch of a pipeline may include its compilation, and a later relaunch marches an unknown
            // number of remaining rays: neither shows that the device is slow.
            let foreseen = relaunches == 0 || elapsed.as_secs_f64() < self.cost_model.seconds(cost);
            let is_typical = !is_shadow && !frame.uses_fresh_pipelines(dispatches.clone());
            if is_typical && foreseen {
                self.cost_model.learn(cost, elapsed);
            }
            frame.measured = frame.measured.filter(|_| is_typical).map(|before| before + elapsed);
            frame.learn_relaunches(relaunches, elapsed);
            frame.next = dispatches.end;
            if is_shadow {
                shadows::go_on(&self.gpu, &self.resources, frame, dispatches.start)?;
            }
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

    /// Submits these dispatches in the order of the recipe. The last submission includes the passes over the finished
    /// picture.
    fn submit(&mut self, frame: &Frame, range: Range<usize>) -> Result<(), RenderError> {
        let dispatches = &frame.plan.dispatches;
        let mut at = range.start;
        loop {
            let mut recorder = Recorder::new(&self.gpu, frame, &self.resources, self.timings.stamps());
            while at < range.end && recorder.has_room() {
                let field_pass = dispatches[at].pass;
                let end = (at..range.end).find(|i| dispatches[*i].pass != field_pass).unwrap_or(range.end);
                self.passes.record(field_pass, &mut recorder, at..end);
                at = end;
            }
            if at == dispatches.len() {
                for field_pass in Pass::ALL.iter().filter(|field_pass| field_pass.extent() == Extent::Finished) {
                    self.passes.record(*field_pass, &mut recorder, at..at);
                }
            }
            let timed = recorder.submit();
            if !timed.is_empty() {
                self.timings.add(&self.gpu, &timed)?;
            }
            if at == range.end {
                return Ok(());
            }
        }
    }

    /// Continues the rays of a completed frame that have not ended.
    fn go_on(&mut self, frame: &mut Frame) -> Result<(), RenderError> {
        if !frame.may_go_on() {
            return Ok(());
        }
        let unfinished = self.count_unfinished(frame)?;
        let Some((planned, meant)) =
            unfinished::go_on(frame, unfinished, Room::of(&self.gpu.device.limits()).0.dispatches)
        else {
            return Ok(());
        };
        if self.resources.restart(&self.gpu, frame, planned, &|component| meant[component as usize]) {
            self.resources.forget_groups();
            let device = &self.gpu.device;
            self.resources.bind(device, frame.slot, &self.scene, |bound| self.passes.bind(device, bound));
        }
        Ok(())
    }

    fn count_unfinished(&self, frame: &Frame) -> Result<Vec<u32>, RenderError> {
        let counts = self.resources.counts.of_components(&self.gpu, frame.origins.len())?;
        Ok(counts.iter().zip(&frame.is_limited).map(|(counts, limited)| if *limited { 0 } else { counts[0] }).collect())
    }

    /// Warnings about components with rays that did not end within the step limit.
    pub fn unfinished_rays(&self, frame: &Frame) -> Result<Vec<Warning>, RenderError> {
        let of_rays = match frame.unfinished() {
            Some(counts) => frame.warnings(counts),
            None => frame.warnings(&self.count_unfinished(frame)?),
        };
        Ok([of_rays, frame.other_warnings(self.resources.shadows.left_out())].concat())
    }

    /// The picture in a slot: complete once its frame is done. [`Renderer::begin`] with another size replaces the
    /// texture.
    pub fn picture(&self, slot: Slot) -> Option<(&wgpu::TextureView, [u32; 2])> {
        self.resources.begun(slot).map(|state| (&state.shown().view, state.shown().size()))
    }

    /// Depth, normals and leaves of a finished frame, and its picture if it was shaded.
    pub fn read(&self, frame: &Frame) -> Result<GBuffer, RenderError> {
        Ok(read_buffers(&self.gpu, &self.resources.slot(frame.slot).targets)?)
    }

    /// The displayed picture of a slot, enlarged if [`OverlaySettings::shown_at`] asks for it.
    pub fn read_shown(&self, slot: Slot) -> Result<Vec<[u8; 4]>, RenderError> {
        Ok(read_color(&self.gpu, self.resources.slot(slot).shown())?)
    }

    /// The minimal work for the picture of a finished frame: every ray starts at its true depth and evaluates the field
    /// once to confirm it; normals and lighting follow as usual. For measurements only.
    pub fn begin_limit(&mut self, frame: &Frame) -> Frame {
        measure::begin_limit(&self.gpu, &mut self.resources, frame)
    }

    /// Resets the counters of a frame.
    pub fn forget_counts(&mut self, frame: &Frame) {
        measure::forget_counts(&self.gpu, &mut self.resources, frame);
    }

    /// The counters of a frame, if the pipelines count.
    pub fn counts(&self, frame: &Frame) -> Result<Counts, RenderError> {
        let words = self.resources.counts.of_components(&self.gpu, frame.origins.len())?;
        let lists = self.resources.subtile_counts.buffer();
        let lists = read_words_at(&self.gpu, lists, 0, frame.plan.lists as usize * SUBTILE_COUNTS)?;
        Ok(Counts::new(frame, &words, &lists))
    }

    /// Size of the buffer of counters, in bytes.
    pub fn counts_bytes(&self) -> u64 {
        self.resources.counts.buffer().size()
    }

    /// Counters of each pixel of the last frame drawn; empty if the pipelines do not count.
    pub fn pixel_counts(&self, frame: &Frame) -> Result<PixelCounts, RenderError> {
        Ok(self.resources.counts.of_pixels(&self.gpu, self.resources.slot(frame.slot).targets.size)?)
    }
}
