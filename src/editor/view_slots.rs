//! What belongs to each viewport while another one is the active one.

use egui::Rect;

use super::navigation::{Navigation, Side};
use super::view_state::{Picture, Through, ViewState};
use isolith_field::Shading;
use isolith_field::debug_view::ViewMode;

/// The number of viewports: the main one and those beside it.
pub const VIEWS: usize = 4;
/// The panels of the viewports beside the main one: id, title, and the side from which they look at first.
pub const SIDES: [(&str, &str, Side); VIEWS - 1] =
    [("view-2", "View 2", Side::Front), ("view-3", "View 3", Side::Right), ("view-4", "View 4", Side::Top)];

/// What belongs to one viewport.
pub struct ViewSlot {
    /// The camera.
    pub navigation: Navigation,
    /// The camera of the scene that one looks through.
    pub through: Option<Through>,
    /// The shading.
    pub shading: Shading,
    /// The view mode.
    pub view_mode: ViewMode,
    /// Its rectangle, in points.
    pub rect: Rect,
    /// Its size in pixels.
    pub size_px: [u32; 2],
    /// Its picture.
    pub picture: Picture,
    /// Whether it was not shown in this document.
    pub is_new: bool,
}

impl Default for ViewSlot {
    fn default() -> Self {
        Self {
            navigation: Navigation::default(),
            through: None,
            shading: Shading::default(),
            view_mode: ViewMode::Shaded,
            rect: Rect::NOTHING,
            size_px: [1, 1],
            picture: Picture::default(),
            is_new: true,
        }
    }
}

impl ViewSlot {
    /// Exchanges it with the view and the picture of the editor.
    pub fn swap(&mut self, view: &mut ViewState, shown: &mut Picture) {
        use std::mem::swap;
        swap(&mut self.navigation, &mut view.navigation);
        swap(&mut self.through, &mut view.through);
        swap(&mut self.shading, &mut view.shading);
        swap(&mut self.view_mode, &mut view.view_mode);
        swap(&mut self.rect, &mut view.rect);
        swap(&mut self.size_px, &mut view.size_px);
        swap(&mut self.picture, shown);
    }
}

/// The viewports.
#[derive(Default)]
pub struct SideViews {
    /// The one whose view is the editor's.
    pub active: usize,
    /// The views of the others.
    pub slots: [ViewSlot; VIEWS],
    /// Which were shown in this frame.
    pub shown: [bool; VIEWS],
}

impl SideViews {
    /// The room of all viewports that wait, none for a single one.
    pub fn room(&self) -> Option<Rect> {
        let shown = self.slots.iter().enumerate().filter(|(index, _)| self.shown[*index] && *index != self.active);
        shown.map(|(_, slot)| slot.rect).reduce(Rect::union)
    }

    /// Whether more than the main viewport is shown.
    pub fn is_split(&self) -> bool {
        self.shown.iter().filter(|shown| **shown).count() > 1
    }
}
