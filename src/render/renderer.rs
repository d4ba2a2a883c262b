//! The renderer: takes a flat scene and a camera, delivers a picture, in pieces that can be waited for.

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

use super::buffers::{Mirror, RowTexture};
use super::gpu::{Gpu, GpuError};
use super::kernel::{MAX_KERNEL_ROWS, Options, ShaderError, Skipping};
use super::kernels::{Kernels, Method};
use super::layouts::{Layouts, NUMBERS_FORMAT};
use super::list_texture::ListTexture;
use super::pace::Pace;
use super::passes::farthest::FarthestPass;
use super::passes::inspect::InspectPass;
use super::passes::mesh::MeshPass;
use super::passes::overlay::{OverlayPass, OverlaySettings};
use super::passes::shade::ShadePass;
use super::schedule::{Evaluation, Plan, TooLong, plan};
use super::standpoint::Standpoints;
use super::targets::{Target, Targets};
use super::uniforms::UNIFORM_STRIDE;
use crate::flat::inspect::Look;
use crate::flat::{Cancel, FlatScene, Pruner, Row};
use crate::geometry::Camera;
use crate::mesh::TriangleMesh;
use crate::scene::NodeId;

use choice::Chosen;
pub use frame::Frame;
pub use measure::Counts;
pub use pixel_counts::{PixelCounts, Spread, Took};
use unfinished::GoingOn;
use upload::{Groups, form_windows};

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
    Work(u32, u32, NodeId),
    /// The caller asked to stop.
    #[error("cancelled")]
    Cancelled,
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
/// buffer or kernel is replaced.
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
    kernels: Kernels,
    method: Method,
    farthest: FarthestPass,
    shade: ShadePass,
    mesh: MeshPass,
    overlay: OverlayPass,
    /// Built where somebody looks.
    inspect: Option<InspectPass>,
    nodes: Mirror,
    /// For the windows of specialised kernels.
    rows: Mirror,
    /// For those of kernels for forms.
    form_rows: Mirror,
    /// The same numbers once more, for kernels that walk.
    numbers: RowTexture,
    lists: ListTexture,
    pruner: Pruner,
    cancel: Cancel,
    components: Mirror,
    materials: Mirror,
    view: Mirror,
    lights: Mirror,
    mesh_emissions: Mirror,
    work: Mirror,
    quads: Mirror,
    quad_counts: Mirror,
    rays: Mirror,
    ray_counts: Mirror,
    nothing: Mirror,
    march_counts: Mirror,
    /// Whether kernels count.
    counting: bool,
    slots: [Option<SlotState>; 2],
    pace: Pace,
}

/// Bytes of a kernel's window on the rows of its component. As much room is kept behind the last row, so
/// that the window on the last component does not end outside the buffer.
pub(super) const KERNEL_WINDOW: usize = MAX_KERNEL_ROWS as usize * size_of::<Row>();
/// Bytes of a quad in a list.
const QUAD_BYTES: usize = 12;
/// Words of a list of quads, and of a list of what its rays leave: see `shaders/common/quads.wgsl`.
const QUAD_COUNTS: usize = 5;
const RAY_COUNTS: usize = 7;
/// Invocations in a workgroup of the cone pass.
const CONE_GROUP: u32 = 64;

impl Renderer {
    /// A renderer on `gpu`. Its interpreter knows no shape until a scene brings one.
    pub fn new(gpu: &Gpu) -> Result<Self, RenderError> {
        Self::with_options(gpu, Self::options(gpu))
    }

    /// What kernels do on this device when nobody asks for something else.
    pub fn options(gpu: &Gpu) -> Options {
        let skipping = if gpu.is_software() { Skipping::Selects } else { Skipping::Branches };
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
            rows: Mirror::uniform(device, "rows"),
            form_rows: Mirror::uniform(device, "rows of forms"),
            numbers: RowTexture::new(device, "numbers", NUMBERS_FORMAT),
            lists: ListTexture::new(device),
            pruner: Pruner::default(),
            cancel: Cancel::default(),
            components: Mirror::uniform(device, "components"),
            materials: storage("materials"),
            view: Mirror::uniform(device, "view"),
            lights: storage("lights"),
            mesh_emissions: storage("mesh emissions"),
            work: Mirror::uniform(device, "work"),
            quads: storage("quads"),
            quad_counts: Mirror::indirect(device, "quad counts"),
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

    /// What prepares a picture stops where this says so, with [`RenderError::Cancelled`].
    pub fn set_cancel(&mut self, cancel: &Cancel) {
        self.cancel = cancel.clone();
        self.pruner.set_cancel(cancel);
    }

    fn check_cancel(&self) -> Result<(), RenderError> {
        if self.cancel.is_cancelled() { Err(RenderError::Cancelled) } else { Ok(()) }
    }

    /// How many kernels are being built.
    pub fn kernels_building(&self) -> usize {
        self.kernels.building()
    }

    /// How many kernels could not be built.
    pub fn kernels_failed(&self) -> usize {
        self.kernels.failed()
    }

    /// Whether kernels or pruned lists are being made: pictures are right without them, and faster with them.
    pub fn is_preparing(&self) -> bool {
        self.kernels.building() > 0 || self.pruner.building() > 0
    }

    /// The pruned lists.
    pub fn pruner(&mut self) -> &mut Pruner {
        &mut self.pruner
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
        let buffers =
            [&self.nodes, &self.rows, &self.form_rows, &self.components, &self.materials].map(Mirror::uploaded);
        buffers.iter().sum::<u64>() + self.numbers.uploaded() + self.lists.uploaded()
    }

    /// How long a whole frame is expected to take. While lists are being made it may be more than can be drawn at all.
    pub fn estimate(&mut self, flat: &FlatScene, camera: &Camera, size: [u32; 2]) -> Result<Duration, RenderError> {
        let Chosen { evaluations, .. } = self.choose(flat, camera)?;
        match self.plan(flat, camera, size, &evaluations) {
            Err(RenderError::Work(..)) if self.pruner.building() > 0 => Ok(LONGEST),
            plan => Ok(Duration::from_secs_f64(self.pace.seconds_of_frame(plan?.effort()).min(LONGEST.as_secs_f64()))),
        }
    }

    /// The work of a frame, no more than the device holds. A component of a thousand leaves that is walked without lists on
    /// a driver that ends loops early makes it long.
    fn plan(
        &self,
        flat: &FlatScene,
        camera: &Camera,
        size: [u32; 2],
        evaluations: &[Evaluation],
    ) -> Result<Plan, RenderError> {
        let refused = |TooLong { component }| {
            RenderError::Work(size[0], size[1], flat.ids[flat.components[component].first as usize])
        };
        plan(flat, camera, size, evaluations, &self.pace, self.most_pieces()).map_err(refused)
    }

    /// How many pieces of work the device can be told of.
    fn most_pieces(&self) -> usize {
        // Buffers grow by powers of two.
        let bytes = self.gpu.device.limits().max_buffer_size.checked_ilog2().map_or(0, |bits| 1_usize << bits);
        bytes / UNIFORM_STRIDE
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
        let (form_rows, forms) = form_windows(flat, &standpoints.numbers, &keys);
        let forms_are_new = self.form_rows.set(&self.gpu.device, &self.gpu.queue, &forms);
        if self.upload(flat, &standpoints, &trees, camera, size, &plan) || forms_are_new {
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
            pace: self.pace,
            seconds: self.pace.seconds(plan.effort()),
            plan,
            keys,
            choices,
            next: 0,
            seconds_done: 0.0,
            measured: Some(Duration::ZERO),
            rounds_at_once: 0,
            slot,
            overlay,
            look: Look::Shaded,
            going_on: GoingOn::default(),
            form_rows,
            rows: flat.components.iter().map(|c| c.numbers * size_of::<Row>() as u32).collect(),
            origins: flat.components.iter().map(|c| flat.ids[c.first as usize]).collect(),
        };
        if slot == Slot::Preview {
            // It is to be there at once, and the full one comes after it.
            frame.end_as_planned();
        }
        Ok(frame)
    }

    /// Works on the frame until `budget` is used or the picture is complete; at least one batch of
    /// dispatches of about [`super::schedule::DISPATCH_TARGET`]. Waits for the device, and learns its pace.
    pub fn advance(&mut self, frame: &mut Frame, budget: Duration) -> Result<(), RenderError> {
        // What others have submitted before, the painting of a window above all, is none of this frame's time.
        self.gpu.wait()?;
        let start = Instant::now();
        if self.kernels.collect() {
            self.kernels.refresh(&frame.keys, &mut frame.choices);
        }
        loop {
            let (pieces, effort, rounds) = frame.next_batch(&self.pace);
            let submitted = Instant::now();
            frame.seconds_done += frame.pace.seconds(effort);
            self.submit(frame, pieces.clone());
            self.gpu.wait()?;
            let took = submitted.elapsed();
            // The first dispatch of a kernel may include its compilation, and a later round marches an unknown
            // few of its rays: neither says that the pace is slow.
            let foreseen = rounds == 0 || took.as_secs_f64() < self.pace.seconds(effort);
            let is_typical = !frame.uses_fresh_kernel(pieces.clone());
            if is_typical && foreseen {
                self.pace.learn(effort, took);
            }
            frame.measured = frame.measured.filter(|_| is_typical).map(|before| before + took);
            frame.learn_rounds(rounds, took);
            frame.next = pieces.end;
            if frame.is_done() {
                self.go_on(frame)?;
            }
            if let (true, Some(took)) = (frame.is_done(), frame.measured) {
                self.pace.learn_frame(frame.plan.effort(), took);
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
    use crate::render::buffers::RowTexture;
    use crate::render::kernel::plain_source;
    use crate::render::schedule::{QUADS, TILE};

    /// The value of a constant in a shader.
    fn constant(file: &str, name: &str) -> u32 {
        let text = plain_source(file).unwrap_or_else(|error| panic!("{error}"));
        let start = format!("const {name}: u32 = ");
        let line =
            text.lines().find_map(|line| line.strip_prefix(&start)).unwrap_or_else(|| panic!("{file}: no {name}"));
        let digits = line.trim_end_matches(';').trim_end_matches('u');
        let number = digits.strip_prefix("0x").map_or_else(|| digits.parse(), |hex| u32::from_str_radix(hex, 16));
        number.unwrap_or_else(|error| panic!("{file}: {name}: {digits}: {error}"))
    }

    #[test]
    fn shaders_have_the_same_constants() {
        let twins = [
            ("common/quads.wgsl", "QUAD_COUNTS", QUAD_COUNTS as u32),
            ("common/quads.wgsl", "RAY_COUNTS", RAY_COUNTS as u32),
            ("common/quads.wgsl", "QUAD", TILE / QUADS),
            ("common/work.wgsl", "TILE", TILE),
            ("common/depth.wgsl", "NO_OWNER", NO_LEAF),
            ("common/depth.wgsl", "MESH_BIT", MESH_BIT),
            ("common/scene.wgsl", "LEAF_ROWS", LEAF_ROWS as u32),
            ("common/scene.wgsl", "MODIFIER_ROWS", MODIFIER_ROWS as u32),
            ("common/scene.wgsl", "GROUP", FlatNode::GROUP),
            ("common/scene.wgsl", "RUN", FlatNode::RUN),
            ("common/scene.wgsl", "MODIFIER", FlatNode::MODIFIER),
            ("common/scene.wgsl", "LINE", RowTexture::LINE as u32),
            ("common/counts.wgsl", "COMPONENT_COUNTS", pixel_counts::COMPONENT_COUNTS as u32),
            ("common/counts.wgsl", "PIXEL_COUNTS", pixel_counts::PIXEL_COUNTS as u32),
        ];
        for (file, name, ours) in twins {
            assert_eq!(constant(file, name), ours, "{file}: {name}");
        }
    }

    #[test]
    fn quads_have_room() {
        let text = plain_source("trace.wgsl").unwrap_or_else(|error| panic!("{error}"));
        let module = naga::front::wgsl::parse_str(&text).unwrap_or_else(|error| panic!("{error}"));
        let (_, quad) = module.types.iter().find(|(_, t)| t.name.as_deref() == Some("Quad")).expect("a quad");
        let naga::TypeInner::Struct { span, .. } = quad.inner else { panic!("{quad:?}") };
        assert_eq!(span as usize, QUAD_BYTES);
    }
}
