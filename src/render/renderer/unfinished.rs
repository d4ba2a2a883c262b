//! Rays that have not come to an end within the steps of a plan: traced again with more, and reported where that does not do.

use super::frame::Frame;
use crate::frame::cost_model::Cost;
use crate::frame::plan::{Dispatch, LONGER};
use isolith_field::Warning;
use isolith_scene::NodeId;

impl Frame {
    /// The dispatches that were planned before any ray went on.
    pub(super) fn planned(&self) -> &[Dispatch] {
        &self.plan.dispatches[..self.going_on.planned.unwrap_or(self.plan.dispatches.len())]
    }
}

/// Has a frame that is done, with so many rays without an end for each component, trace the components with such rays again
/// with more steps. Nothing is lost by that but time: what was found stays, and only what is nearer is added. Where there is
/// something to do again, which components that are meant, and where their dispatches begin.
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
    /// Whether its rays may go on that have not ended.
    pub(super) fn may_go_on(&self) -> bool {
        self.going_on.times < LONGER.len()
    }

    /// Rays without an end by component, where that was asked already.
    pub(super) fn unfinished(&self) -> Option<&Vec<u32>> {
        self.going_on.unfinished.as_ref()
    }

    /// The components with rays that did not come to an end.
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
