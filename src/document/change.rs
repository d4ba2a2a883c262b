//! The effect of an edit.

use isolith_scene::NodeId;

/// The effect of an edit.
pub(super) struct Change {
    /// Whether the scene differs from before.
    pub changed: bool,
    /// The new nodes.
    pub added: Vec<NodeId>,
}

impl Change {
    pub(super) const NONE: Self = Self { changed: false, added: Vec::new() };
    pub(super) const VALUE: Self = Self { changed: true, added: Vec::new() };
}
