//! A frame in progress: its remaining dispatches and their pipelines.

use std::time::Duration;

use super::choice::Chosen;
use super::going_on::GoingOn;
use super::slot::Slot;
use crate::frame::cost_model::{Cost, CostModel};
use crate::frame::plan::{DISPATCH_TARGET, Dispatch, FramePlan, LONGER};
use crate::passes::overlay_settings::OverlaySettings;
use crate::passes::shade_features::ShadeFeatures;
use crate::pipelines::cache::{EvalMode, PipelineChoice};
use crate::pipelines::field::FieldPipelines;
use crate::pipelines::key::PipelineKey;
use crate::recipe::Pass;
use isolith_field::debug_view::ViewMode;
use isolith_field::{FlatScene, ParamRow};
use isolith_scene::ViewTransform;

/// Which sample a frame renders.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sampling {
    /// Counted from 0.
    pub index: u32,
    /// Whether the background is without color and coverage.
    pub is_transparent: bool,
}

/// A frame in progress.
#[derive(Clone, Debug)]
pub struct Frame {
    pub(crate) plan: FramePlan,
    pub(super) keys: Vec<Option<PipelineKey>>,
    pub(crate) choices: Vec<PipelineChoice>,
    pub(super) next: usize,
    /// The cost model at the start: later learning must not move the progress bar.
    pub(super) cost_model: CostModel,
    pub(super) seconds_done: f64,
    /// Time of its dispatches so far; `None` if it says nothing about other frames.
    pub(super) measured: Option<Duration>,
    /// Number of later relaunches that one batch may hold; with 0 each forms a batch of its own.
    pub(super) relaunches_at_once: u32,
    pub(super) seconds: f64,
    pub(super) slot: Slot,
    pub(crate) overlay: OverlaySettings,
    pub(crate) view_mode: ViewMode,
    pub(crate) view_transform: ViewTransform,
    /// What pass `shade` needs.
    pub(crate) shade_features: ShadeFeatures,
    /// The sample that it renders; `None` for a picture of a single sample.
    pub(crate) sampling: Option<Sampling>,
    /// State of the rays that continue beyond the plan.
    pub(super) going_on: GoingOn,
    pub(super) rows: Vec<u32>,
    /// Offset of the template rows of each component with such a pipeline; parallel to the components.
    pub(super) template_rows: Vec<Option<u32>>,
    /// Warnings about meshes of which copies are left out.
    pub(super) of_meshes: Vec<isolith_field::Warning>,
    pub(super) origins: Vec<isolith_scene::NodeId>,
    /// Of each component whether its settings limit the steps of a ray.
    pub(super) is_limited: Vec<bool>,
    /// Of each component the instancer that it is a type of.
    pub(super) instancers: Vec<Option<u32>>,
    /// Dispatches of the current part of the pass `shadow` so far.
    pub(super) shadow_relaunches: u32,
    /// Pixels whose shadows were given up.
    pub(super) unfinished_shadows: u32,
    /// Evaluations of fields for shadows and occlusion, if the pipelines count.
    pub(super) shadow_evaluations: u64,
    /// Numbers of lights with and without shadows.
    pub(super) shadowed_lights: [usize; 2],
}

/// Limit of [`Frame::relaunches_at_once`]; more would save nothing.
const MAX_RELAUNCHES_AT_ONCE: u32 = 64;

impl Frame {
    /// A frame for the picture in `slot`.
    pub(super) fn new(
        slot: Slot,
        flat: &FlatScene,
        Chosen { keys, choices, .. }: Chosen,
        plan: FramePlan,
        cost_model: CostModel,
        overlay: OverlaySettings,
    ) -> Self {
        Self {
            cost_model,
            seconds: cost_model.seconds(plan.cost()),
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
            view_transform: flat.display.view_transform,
            shade_features: ShadeFeatures::default(),
            sampling: None,
            going_on: GoingOn::default(),
            template_rows: Vec::new(),
            of_meshes: Vec::new(),
            rows: flat.components.iter().map(|c| c.params * size_of::<ParamRow>() as u32).collect(),
            origins: flat.components.iter().map(|c| flat.ids[c.first as usize]).collect(),
            is_limited: flat.components.iter().map(isolith_field::Component::has_most_steps).collect(),
            instancers: flat.components.iter().map(|c| c.instanced.map(|of| of.instancer)).collect(),
            shadow_relaunches: 0,
            unfinished_shadows: 0,
            shadow_evaluations: 0,
            shadowed_lights: [0, 0],
        }
    }

    /// Fraction that is done, from 0 to 1.
    pub fn progress(&self) -> f32 {
        if self.is_done() { 1.0 } else { (self.seconds_done / self.seconds.max(1e-9)).min(1.0) as f32 }
    }

    /// Whether the component of a dispatch is a type of an instancer.
    pub(crate) fn is_of_copies(&self, dispatch: &Dispatch) -> bool {
        self.instancers[dispatch.params.component as usize].is_some()
    }

    /// Offset of a component's rows among the template rows, in bytes; `None` if its pipeline is not for a template.
    pub(super) fn template_window(&self, component: usize) -> Option<u32> {
        self.template_rows[component].filter(|_| self.choices[component].mode == EvalMode::StraightLine)
    }

    /// The next dispatches to submit, their cost, and the number of later relaunches among them. The time of those is
    /// unpredictable: usually no rays are left for them, but the rays that are left may take long.
    pub(super) fn next_batch(&self, cost_model: &CostModel) -> (std::ops::Range<usize>, Cost, u32) {
        let (mut cost, mut relaunches, mut end) = (Cost::default(), 0, self.next);
        for dispatch in &self.plan.dispatches[self.next..] {
            let more = cost + dispatch.cost;
            let more_relaunches = relaunches + u32::from(dispatch.params.relaunch > 0);
            let fits =
                more_relaunches <= self.relaunches_at_once && cost_model.seconds(more) <= DISPATCH_TARGET.as_secs_f64();
            // What follows a dispatch of this pass depends on its result.
            let is_alone = dispatch.pass == Pass::Shadow;
            if end > self.next && (!fits || is_alone) {
                break;
            }
            (cost, relaunches, end) = (more, more_relaunches, end + 1);
            if is_alone {
                break;
            }
        }
        (self.next..end, cost, relaunches)
    }

    /// Adapts the number of later relaunches in the next batch to the time of the last one.
    pub(super) fn learn_relaunches(&mut self, relaunches: u32, elapsed: Duration) {
        if elapsed > DISPATCH_TARGET {
            self.relaunches_at_once = 0;
        } else if relaunches >= self.relaunches_at_once {
            self.relaunches_at_once = (2 * self.relaunches_at_once).clamp(1, MAX_RELAUNCHES_AT_ONCE);
        }
    }

    /// Whether one of these dispatches is the first use of a pipeline.
    pub(super) fn uses_fresh_pipelines(&self, dispatches: std::ops::Range<usize>) -> bool {
        let field = |p: &&Dispatch| FieldPipelines::STAGES.contains(&p.pass);
        let pipelines = self.plan.dispatches[dispatches]
            .iter()
            .filter(field)
            .map(|p| (p, &self.choices[p.params.component as usize]));
        // `fold` visits all of them, not only up to the first fresh one, because `first_use` marks each.
        pipelines.fold(false, |fresh, (dispatch, choice)| choice.pipelines.first_use(dispatch.pass as usize) | fresh)
    }

    /// Skips all passes but shadows, lighting and overlay, for a picture of the same scene from the same place that is already
    /// complete in its slot.
    pub fn skip_to_shading(&mut self) {
        let shading = self.plan.dispatches.iter().position(|dispatch| dispatch.pass.is_of_light());
        self.next = shading.unwrap_or(self.plan.dispatches.len());
        self.measured = None;
    }

    /// Skips lighting and overlay, if only depth, normals and materials are needed.
    pub fn skip_shading(&mut self) {
        self.plan.dispatches.retain(|dispatch| !dispatch.pass.is_of_light());
        self.overlay = OverlaySettings::default();
    }

    /// Ends the frame as planned, without checking for rays that have not ended.
    pub(super) fn end_as_planned(&mut self) {
        self.going_on.times = LONGER.len();
    }

    /// Number of accumulated samples in the picture; 0 if the frame does not accumulate. While a sample is in progress,
    /// the picture still shows those before it.
    pub fn samples(&self) -> u32 {
        self.sampling.map_or(0, |sampling| sampling.index + u32::from(self.is_done()))
    }

    /// Whether it shows light, not a view mode for debugging.
    pub fn is_lit(&self) -> bool {
        self.view_mode == ViewMode::Shaded
    }

    /// Whether the picture is complete.
    pub fn is_done(&self) -> bool {
        self.next == self.plan.dispatches.len()
    }
}
