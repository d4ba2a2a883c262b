//! Limits of flattening. The budget counts everything before flattening makes it, so no scene exceeds a limit,
//! however it is built.

use super::arrays::{MAX_FLAT_NODES, MAX_FLAT_ROWS, MAX_FLAT_STEPS};
use super::error::FlattenError;
pub use isolith_jobs::Cancel;
use isolith_scene::{Node, NodeId};

/// Shapes and modifiers, each copy counted; entries of groups come on top.
pub(super) const ENTRIES: &str = "the number of shapes and modifiers, copies included";
/// See [`MAX_FLAT_ROWS`].
pub(super) const ROWS: &str = "the number of rows of points, letters and images, copies included";
/// See [`isolith_bricks::MAX_BRICK_TEXELS`].
pub(super) const TEXELS: &str = "the number of texels of all models that are fields (a lower resolution takes fewer)";
/// See [`MAX_FLAT_STEPS`].
pub(super) const STEPS: &str = "the number of steps that flattening takes, copies included";
/// See [`super::MAX_FLAT_LEVELS`].
pub(super) const LEVELS: &str = "the nesting of groups and modifiers";
/// See [`super::MAX_FLAT_BYTES`].
pub(super) const BYTES: &str = "the number of bytes that the scene takes on the device";
/// See [`super::MAX_LIGHTS`].
pub(super) const LIGHTS: &str = "the number of lights";
/// See [`super::MAX_STACK`].
pub(super) const STACK: &str = "the nesting of groups that cannot be simplified";

/// How much of a limit a scene uses.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Usage {
    /// The limited quantity.
    pub name: &'static str,
    /// The amount used.
    pub used: usize,
    /// The largest accepted amount.
    pub limit: usize,
    /// The node that contributes most, if there is one.
    pub node: Option<NodeId>,
}

/// The limit of each kind.
#[derive(Clone, Copy, Debug)]
pub(super) struct FlattenLimits {
    pub entries: usize,
    pub rows: usize,
    pub steps: usize,
}

impl Default for FlattenLimits {
    fn default() -> Self {
        Self { entries: MAX_FLAT_NODES, rows: MAX_FLAT_ROWS, steps: MAX_FLAT_STEPS }
    }
}

/// The amounts taken so far, and the first limit that was hit.
pub(super) struct Budget {
    pub limits: FlattenLimits,
    used: FlattenLimits,
    cancel: Cancel,
    /// The first limit that was hit.
    pub problem: Option<FlattenError>,
}

impl Budget {
    pub fn new(limits: FlattenLimits, cancel: &Cancel) -> Self {
        Self { limits, used: FlattenLimits { entries: 0, rows: 0, steps: 0 }, cancel: cancel.clone(), problem: None }
    }

    /// Whether to go on: no limit was hit, and flattening is not canceled.
    pub fn is_open(&self) -> bool {
        self.problem.is_none() && !self.cancel.is_canceled()
    }

    /// Steps so far.
    pub fn steps(&self) -> usize {
        self.used.steps
    }

    /// Takes `count` entries for the node; false if flattening must stop.
    pub fn take_entries(&mut self, node: &Node, count: usize) -> bool {
        self.used.entries = self.used.entries.saturating_add(count);
        self.hold(node, ENTRIES, self.used.entries, self.limits.entries)
    }

    /// The same for payload rows.
    pub fn take_rows(&mut self, node: &Node, count: usize) -> bool {
        self.used.rows = self.used.rows.saturating_add(count);
        self.hold(node, ROWS, self.used.rows, self.limits.rows)
    }

    /// The same for steps, which stand for time: none takes longer than a microsecond or two.
    pub fn take_steps(&mut self, node: &Node, count: usize) -> bool {
        self.used.steps = self.used.steps.saturating_add(count);
        self.hold(node, STEPS, self.used.steps, self.limits.steps)
    }

    /// Checks the value against its limit; false if flattening must stop.
    pub fn hold(&mut self, node: &Node, what: &'static str, value: usize, limit: usize) -> bool {
        if value > limit {
            self.hit(node, what, value, limit);
        }
        self.is_open()
    }

    /// Records a limit that was hit, if it is the first.
    pub fn hit(&mut self, node: &Node, what: &'static str, value: usize, limit: usize) {
        self.problem.get_or_insert_with(|| FlattenError::new(node, what, value, limit));
    }
}
