//! What is to be drawn over the picture.

use isolith_scene::NodeId;

/// What is drawn over the picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OverlaySettings {
    /// A grid on the ground.
    pub grid: bool,
    /// An outline around these nodes.
    pub outline: Vec<NodeId>,
    /// The size in which a coarse picture is shown: it is enlarged to it first, so that lines are as thin as over a fine
    /// one. `None` draws on the picture as it is.
    pub shown_at: Option<[u32; 2]>,
}

impl OverlaySettings {
    /// Whether there is nothing to draw.
    pub fn is_empty(&self) -> bool {
        !self.grid && self.outline.is_empty()
    }

    /// The size of what is drawn on where a picture of this size is enlarged for it.
    pub(crate) fn enlarged(&self, size: [u32; 2]) -> Option<[u32; 2]> {
        self.shown_at.filter(|shown| *shown != size && !self.is_empty())
    }
}
