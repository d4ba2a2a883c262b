//! A picture under way: what is still to be done, by which kernels.

use super::Slot;
use crate::flat::inspect::Look;
use crate::render::kernels::Choice;
use crate::render::passes::overlay::OverlaySettings;
use crate::render::schedule::{Pace, Piece, Plan, Stage};

/// A frame under way.
#[derive(Clone, Debug)]
pub struct Frame {
    pub(super) plan: Plan,
    pub(super) keys: Vec<Option<u128>>,
    pub(super) choices: Vec<Choice>,
    pub(super) next: usize,
    /// The pace at the beginning: the pace that is learnt on the way must not move the bar.
    pub(super) pace: Pace,
    pub(super) seconds_done: f64,
    pub(super) seconds: f64,
    pub(super) slot: Slot,
    pub(super) overlay: OverlaySettings,
    pub(super) look: Look,
    pub(super) rows: Vec<u32>,
    pub(super) origins: Vec<crate::scene::NodeId>,
}

impl Frame {
    /// Share that is done, from 0 to 1.
    pub fn progress(&self) -> f32 {
        if self.is_done() { 1.0 } else { (self.seconds_done / self.seconds.max(1e-9)) as f32 }
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
    }

    /// Leaves out light and overlay: depth, normals and materials are all that is wanted.
    pub fn skip_shading(&mut self) {
        self.plan.pieces.retain(|piece| piece.stage != Stage::Shade);
        self.overlay = OverlaySettings::default();
    }

    /// Whether the picture is complete.
    pub fn is_done(&self) -> bool {
        self.next == self.plan.pieces.len()
    }
}
