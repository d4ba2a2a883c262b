//! A picture under way: what is still to be done, by which pipelines.

use std::time::Duration;

use super::choice::Chosen;
use super::going_on::GoingOn;
use super::slot::Slot;
use crate::frame::cost_model::{Cost, CostModel};
use crate::frame::plan::{DISPATCH_TARGET, Dispatch, FramePlan, LONGER};
use crate::passes::overlay_settings::OverlaySettings;
use crate::pipelines::cache::{EvalMode, PipelineChoice};
use crate::pipelines::field::FieldPipelines;
use crate::pipelines::key::PipelineKey;
use crate::recipe::Pass;
use isolith_field::debug_view::ViewMode;
use isolith_field::{FlatScene, ParamRow};

/// A frame under way.
#[derive(Clone, Debug)]
pub struct Frame {
    pub(crate) plan: FramePlan,
    pub(super) keys: Vec<Option<PipelineKey>>,
    pub(super) choices: Vec<PipelineChoice>,
    pub(super) next: usize,
    /// The cost model at the beginning: what is learned on the way must not move the bar.
    pub(super) cost_model: CostModel,
    pub(super) seconds_done: f64,
    /// What its dispatches have taken; `None` where that says nothing about others.
    pub(super) measured: Option<Duration>,
    /// So many later relaunches may be submitted together with others; where it is 0 each stands alone.
    pub(super) relaunches_at_once: u32,
    pub(super) seconds: f64,
    pub(super) slot: Slot,
    pub(crate) overlay: OverlaySettings,
    pub(crate) view_mode: ViewMode,
    /// How its rays go on.
    pub(super) going_on: GoingOn,
    pub(super) rows: Vec<u32>,
    /// Where pipelines for templates find theirs; beside components with such a key.
    pub(super) template_rows: Vec<Option<u32>>,
    pub(super) origins: Vec<isolith_scene::NodeId>,
}

/// See [`Frame::relaunches_at_once`]; more would save nothing.
const MAX_RELAUNCHES_AT_ONCE: u32 = 64;

impl Frame {
    /// What is to be done for a picture in `slot`.
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
            going_on: GoingOn::default(),
            template_rows: Vec::new(),
            rows: flat.components.iter().map(|c| c.params * size_of::<ParamRow>() as u32).collect(),
            origins: flat.components.iter().map(|c| flat.ids[c.first as usize]).collect(),
        }
    }

    /// Share that is done, from 0 to 1.
    pub fn progress(&self) -> f32 {
        if self.is_done() { 1.0 } else { (self.seconds_done / self.seconds.max(1e-9)) as f32 }
    }

    /// Where the rows of a component's pipeline begin among those of templates, in bytes; `None` for all other pipelines.
    pub(super) fn template_window(&self, component: usize) -> Option<u32> {
        self.template_rows[component].filter(|_| self.choices[component].mode == EvalMode::StraightLine)
    }

    /// The dispatches to submit next, what they cost, and how many of them are later relaunches. How long those take nobody
    /// can foresee: mostly nothing is left for them, but what is left may take long.
    pub(super) fn next_batch(&self, cost_model: &CostModel) -> (std::ops::Range<usize>, Cost, u32) {
        let (mut cost, mut relaunches, mut end) = (Cost::default(), 0, self.next);
        for dispatch in &self.plan.dispatches[self.next..] {
            let more = cost + dispatch.cost;
            let more_relaunches = relaunches + u32::from(dispatch.params.relaunch > 0);
            let fits =
                more_relaunches <= self.relaunches_at_once && cost_model.seconds(more) <= DISPATCH_TARGET.as_secs_f64();
            if end > self.next && !fits {
                break;
            }
            (cost, relaunches, end) = (more, more_relaunches, end + 1);
        }
        (self.next..end, cost, relaunches)
    }

    /// Learns from how long a batch took how many later relaunches the next one may hold.
    pub(super) fn learn_relaunches(&mut self, relaunches: u32, elapsed: Duration) {
        if elapsed > DISPATCH_TARGET {
            self.relaunches_at_once = 0;
        } else if relaunches >= self.relaunches_at_once {
            self.relaunches_at_once = (2 * self.relaunches_at_once).clamp(1, MAX_RELAUNCHES_AT_ONCE);
        }
    }

    /// Whether a pipeline is dispatched for the first time among these dispatches.
    pub(super) fn uses_fresh_pipelines(&self, dispatches: std::ops::Range<usize>) -> bool {
        let field = |p: &&Dispatch| FieldPipelines::STAGES.contains(&p.pass);
        let pipelines = self.plan.dispatches[dispatches]
            .iter()
            .filter(field)
            .map(|p| (p, &self.choices[p.params.component as usize]));
        // All of them, not only up to the first fresh one: each is marked.
        pipelines.fold(false, |fresh, (dispatch, choice)| choice.pipelines.first_use(dispatch.pass as usize) | fresh)
    }

    /// Leaves out everything but light and overlay: for a picture of the same scene from the same place
    /// that is complete in its slot already.
    pub fn skip_to_shading(&mut self) {
        let shading = self.plan.dispatches.iter().position(|p| p.pass == Pass::Shade);
        self.next = shading.unwrap_or(self.plan.dispatches.len());
        self.measured = None;
    }

    /// Leaves out light and overlay: depth, normals and materials are all that is wanted.
    pub fn skip_shading(&mut self) {
        self.plan.dispatches.retain(|dispatch| dispatch.pass != Pass::Shade);
        self.overlay = OverlaySettings::default();
    }

    /// Leaves the rays that have not ended as they are, unasked.
    pub(super) fn end_as_planned(&mut self) {
        self.going_on.times = LONGER.len();
    }

    /// Whether the picture is complete.
    pub fn is_done(&self) -> bool {
        self.next == self.plan.dispatches.len()
    }
}
