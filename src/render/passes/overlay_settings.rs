//! Settings of the overlay.

use isolith_scene::NodeId;

/// The plane of the grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GridPlane {
    /// The axis across it: 1 for the ground.
    pub axis: usize,
    /// Side of a fine cell, in meters; ten of them make a coarse one. `None` chooses it by the height of the eye.
    pub cell: Option<f64>,
    /// Whether it fades with distance. One that does not is for views from very far.
    pub fades: bool,
}

impl Default for GridPlane {
    fn default() -> Self {
        Self { axis: 1, cell: None, fades: true }
    }
}

/// Marks to draw over the picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OverlaySettings {
    /// A grid.
    pub grid: bool,
    /// Where the grid is.
    pub plane: GridPlane,
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
