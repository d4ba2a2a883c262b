//! A picture under way: what is still to be done, by which kernels.

use std::time::Duration;

use super::Slot;
use super::unfinished::GoingOn;
use crate::flat::inspect::Look;
use crate::render::kernels::{Choice, Walk};
use crate::render::keys::Key;
use crate::render::pace::{Effort, Pace};
use crate::render::passes::overlay::OverlaySettings;
use crate::render::schedule::{DISPATCH_TARGET, LONGER, Piece, Plan, Stage};

/// A frame under way.
#[derive(Clone, Debug)]
pub struct Frame {
    pub(super) plan: Plan,
    pub(super) keys: Vec<Option<Key>>,
    pub(super) choices: Vec<Choice>,
    pub(super) next: usize,
    /// The pace at the beginning: the pace that is learnt on the way must not move the bar.
    pub(super) pace: Pace,
    pub(super) seconds_done: f64,
    /// What its dispatches have taken; `None` where that says nothing about others.
    pub(super) measured: Option<Duration>,
    /// So many later rounds may be submitted together with others; where it is 0 each stands alone.
    pub(super) rounds_at_once: u32,
    pub(super) seconds: f64,
    pub(super) slot: Slot,
    pub(super) overlay: OverlaySettings,
    pub(super) look: Look,
    /// How its rays go on.
    pub(super) going_on: GoingOn,
    pub(super) rows: Vec<u32>,
    /// Where kernels for forms find theirs; beside components with such a key.
    pub(super) form_rows: Vec<Option<u32>>,
    pub(super) origins: Vec<crate::scene::NodeId>,
}

/// See [`Frame::rounds_at_once`]; more would save nothing.
const MOST_ROUNDS_AT_ONCE: u32 = 64;

impl Frame {
    /// Share that is done, from 0 to 1.
    pub fn progress(&self) -> f32 {
        if self.is_done() { 1.0 } else { (self.seconds_done / self.seconds.max(1e-9)) as f32 }
    }

    /// Where the rows of a component's kernel begin among those of forms, in bytes; `None` for all other kernels.
    pub(super) fn form_window(&self, component: usize) -> Option<u32> {
        self.form_rows[component].filter(|_| self.choices[component].walk == Walk::Straight)
    }

    /// The pieces to submit next, what effort they are, and how many of them are later rounds. How long those take nobody
    /// can foresee: mostly nothing is left for them, but what is left may take long.
    pub(super) fn next_batch(&self, pace: &Pace) -> (std::ops::Range<usize>, Effort, u32) {
        let (mut effort, mut rounds, mut end) = (Effort::default(), 0, self.next);
        for piece in &self.plan.pieces[self.next..] {
            let more = effort + piece.effort;
            let more_rounds = rounds + u32::from(piece.work.round > 0);
            let fits = more_rounds <= self.rounds_at_once && pace.seconds(more) <= DISPATCH_TARGET.as_secs_f64();
            if end > self.next && !fits {
                break;
            }
            (effort, rounds, end) = (more, more_rounds, end + 1);
        }
        (self.next..end, effort, rounds)
    }

    /// Learns from how long a batch took how many later rounds the next one may hold.
    pub(super) fn learn_rounds(&mut self, rounds: u32, took: Duration) {
        if took > DISPATCH_TARGET {
            self.rounds_at_once = 0;
        } else if rounds >= self.rounds_at_once {
            self.rounds_at_once = (2 * self.rounds_at_once).clamp(1, MOST_ROUNDS_AT_ONCE);
        }
    }

    /// Whether a kernel is dispatched for the first time among these pieces.
    pub(super) fn uses_fresh_kernel(&self, pieces: std::ops::Range<usize>) -> bool {
        let field = |p: &&Piece| matches!(p.stage, Stage::Cone | Stage::Trace | Stage::Surface);
        let kernels =
            self.plan.pieces[pieces].iter().filter(field).map(|p| (p, &self.choices[p.work.component as usize]));
        // All of them, not only up to the first fresh one: each is marked.
        kernels.fold(false, |fresh, (piece, choice)| choice.kernel.first_use(piece.stage as usize) | fresh)
    }

    /// Leaves out everything but light and overlay: for a picture of the same scene from the same place
    /// that is complete in its slot already.
    pub fn skip_to_shading(&mut self) {
        let shading = self.plan.pieces.iter().position(|p| p.stage == Stage::Shade);
        self.next = shading.unwrap_or(self.plan.pieces.len());
        self.measured = None;
    }

    /// Leaves out light and overlay: depth, normals and materials are all that is wanted.
    pub fn skip_shading(&mut self) {
        self.plan.pieces.retain(|piece| piece.stage != Stage::Shade);
        self.overlay = OverlaySettings::default();
    }

    /// Leaves the rays that have not ended as they are, unasked.
    pub(super) fn end_as_planned(&mut self) {
        self.going_on.times = LONGER.len();
    }

    /// Whether the picture is complete.
    pub fn is_done(&self) -> bool {
        self.next == self.plan.pieces.len()
    }
}
