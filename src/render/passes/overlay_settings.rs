//! Settings of the overlay.

use isolith_scene::NodeId;

/// Marks to draw over the picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OverlaySettings {
    /// A grid on the ground.
    pub grid: bool,
    /// Nodes to outline.
    pub outline: Vec<NodeId>,
    /// Display size of a coarse picture. The pass enlarges the picture to this size first, so that lines are as thin as
    /// over a fine picture. `None` draws on the picture itself.
    pub shown_at: Option<[u32; 2]>,
}

impl OverlaySettings {
    /// Whether there is nothing to draw.
    pub fn is_empty(&self) -> bool {
        !self.grid && self.outline.is_empty()
    }

    /// Size of the enlarged picture, if a picture of this size is to be enlarged.
    pub(crate) fn enlarged(&self, size: [u32; 2]) -> Option<[u32; 2]> {
        self.shown_at.filter(|shown| *shown != size && !self.is_empty())
    }
}
