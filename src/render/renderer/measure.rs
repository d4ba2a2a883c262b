//! Measurements of a finished frame: its counters, and the minimal work for its picture.

use super::frame::Frame;
use super::pixel_counts::COMPONENT_COUNTS;
use super::resources::{FrameResources, SUBTILE_COUNTS};
use crate::frame::plan::Dispatch;
use crate::gpu::Gpu;
use crate::passes::overlay_settings::OverlaySettings;
use crate::recipe::Pass;
use crate::resources::uniforms::DispatchParams;

/// Results of pipelines that count.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Evaluations of fields by rays.
    pub steps: u64,
    /// Started rays: one for each component that a ray meets.
    pub rays: u64,
    /// Evaluations of fields by cones.
    pub cone_steps: u64,
    /// Subtiles that the cones keep, over all components.
    pub subtiles: u64,
    /// Evaluations by rays and cones, for each component.
    pub of_components: Vec<u64>,
    /// Tape cells that rays and cones looked up, for each component.
    pub cells: Vec<u64>,
    /// Tape entries that they read, for each component.
    pub entries: Vec<u64>,
}

/// Prepares [`limit`].
pub(super) fn begin_limit(gpu: &Gpu, resources: &mut FrameResources, frame: &Frame) -> Frame {
    let limit = limit(frame);
    resources.set_work(gpu, &limit.plan.dispatches);
    let targets = &resources.slot(frame.slot).targets;
    let descriptor = wgpu::CommandEncoderDescriptor { label: Some("depths of the limit") };
    let mut encoder = gpu.device.create_command_encoder(&descriptor);
    let [from, to] = [&targets.depth, &targets.march].map(|target| target.texture.as_image_copy());
    encoder.copy_texture_to_texture(from, to, targets.depth.texture.size());
    gpu.queue.submit([encoder.finish()]);
    limit
}

/// Resets the counters of a frame.
pub(super) fn forget_counts(gpu: &Gpu, resources: &mut FrameResources, frame: &Frame) {
    let size = resources.slot(frame.slot).targets.size;
    resources.counts.reset(gpu, frame.origins.len(), size);
    let descriptor = wgpu::CommandEncoderDescriptor { label: Some("forget counts") };
    let mut encoder = gpu.device.create_command_encoder(&descriptor);
    resources.counts.clear_pixels(&mut encoder, size);
    gpu.queue.submit([encoder.finish()]);
}

/// The minimal work for the picture of a finished frame: every ray starts at its true depth and evaluates the field
/// once to confirm it; normals and lighting follow as usual. For measurements only.
fn limit(frame: &Frame) -> Frame {
    let confirm = |dispatch: &Dispatch| {
        let dispatch_params =
            DispatchParams { relaunch: 1, last_relaunch: 1, max_steps: 1, compacted: 0, ..dispatch.params };
        match dispatch.pass {
            Pass::Trace if dispatch.params.relaunch == 0 => Some(Dispatch { params: dispatch_params, ..*dispatch }),
            Pass::Surface | Pass::Shade => Some(*dispatch),
            _ => None,
        }
    };
    let mut plan = frame.plan.clone();
    plan.dispatches = frame.planned().iter().filter_map(confirm).collect();
    let seconds = frame.cost_model.seconds(plan.cost());
    let overlay = OverlaySettings::default();
    let mut limit = Frame { plan, next: 0, seconds_done: 0.0, seconds, measured: None, overlay, ..frame.clone() };
    limit.end_as_planned();
    limit
}

impl Counts {
    /// The counters of a frame: `words` of each component, and the counts of its subtile lists.
    pub(super) fn new(frame: &Frame, words: &[[u32; COMPONENT_COUNTS]], lists: &[u32]) -> Self {
        let sum = |i: usize| lists.chunks_exact(SUBTILE_COUNTS).map(|c| u64::from(c[i])).sum();
        let of_each = |i: usize| words.iter().map(|c| u64::from(c[i])).collect::<Vec<_>>();
        let mut of_components = of_each(1);
        for dispatch in frame.planned().iter().filter(|dispatch| dispatch.pass == Pass::Cone) {
            of_components[dispatch.params.component as usize] +=
                u64::from(lists[dispatch.params.list as usize * SUBTILE_COUNTS + 3]);
        }
        Self {
            steps: of_each(1).iter().sum(),
            rays: of_each(2).iter().sum(),
            cone_steps: sum(3),
            subtiles: sum(4),
            of_components,
            cells: of_each(3),
            entries: of_each(4),
        }
    }
}
