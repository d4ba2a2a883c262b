//! Rays that have not ended within the steps of a plan: the renderer traces them again with more steps, and reports
//! those that still do not end.

use super::frame::Frame;
use crate::frame::cost_model::Cost;
use crate::frame::plan::{Dispatch, LONGER};
use isolith_field::Warning;
use isolith_scene::NodeId;

impl Frame {
    /// The dispatches of the plan, before any ray continued.
    pub(super) fn planned(&self) -> &[Dispatch] {
        &self.plan.dispatches[..self.going_on.planned.unwrap_or(self.plan.dispatches.len())]
    }
}

/// Makes a completed frame trace the components with unfinished rays again, with more steps. `unfinished` holds their
/// number for each component. This costs only time: hits stay, and only nearer ones are added. Returns where the new
/// dispatches begin and which components they trace, if there are any.
pub(super) fn go_on(frame: &mut Frame, unfinished: Vec<u32>, max_dispatches: usize) -> Option<(usize, Vec<bool>)> {
    let times = *LONGER.get(frame.going_on.times)?;
    let meant: Vec<bool> = unfinished.iter().map(|count| *count > 0).collect();
    if meant.contains(&true) {
        let planned = *frame.going_on.planned.get_or_insert(frame.plan.dispatches.len());
        frame.plan.dispatches.truncate(planned);
        let again = frame.plan.again(|component| meant[component as usize], times);
        frame.next = planned;
        if planned + again.len() <= max_dispatches {
            let cost = again.iter().fold(Cost::default(), |sum, dispatch| sum + dispatch.cost);
            frame.seconds += frame.cost_model.seconds(cost);
            frame.plan.dispatches.extend(again);
            frame.going_on.times += 1;
            frame.measured = None;
            return Some((planned, meant));
        }
    }
    frame.end_as_planned();
    frame.going_on.unfinished = Some(unfinished);
    None
}

impl Frame {
    /// Whether its unfinished rays may continue.
    pub(super) fn may_go_on(&self) -> bool {
        self.going_on.times < LONGER.len()
    }

    /// Number of unfinished rays of each component, if it was read back.
    pub(super) fn unfinished(&self) -> Option<&Vec<u32>> {
        self.going_on.unfinished.as_ref()
    }

    /// Warnings about the components with unfinished rays.
    pub(super) fn warnings(&self, counts: &[u32]) -> Vec<Warning> {
        let unfinished = counts.iter().zip(&self.origins).filter(|(count, _)| **count > 0);
        let warning = |(count, id): (&u32, &NodeId)| Warning {
            node: *id,
            name: String::new(),
            reason: format!("{count} rays did not come to an end within the steps allowed; they show what lies behind"),
        };
        unfinished.map(warning).collect()
    }
}
