//! The panel of a viewport beside the main one: the same viewport with a view of its own.

use egui::Ui;

use super::panel::{Panel, PanelPlace};
use super::state::EditorState;
use super::view_slots::SIDES;
use super::viewport::Viewport;

/// A viewport beside the main one.
pub struct SideViewport {
    /// Its place in the list of these.
    index: usize,
    viewport: Viewport,
}

impl SideViewport {
    /// The viewport of this place in the list.
    pub fn new(index: usize) -> Self {
        Self { index, viewport: Viewport::of(index + 1) }
    }
}

impl Panel for SideViewport {
    fn id(&self) -> &'static str {
        SIDES[self.index].0
    }

    fn title(&self) -> &'static str {
        SIDES[self.index].1
    }

    fn place(&self) -> PanelPlace {
        PanelPlace::Beside(420.0)
    }

    fn ui(&mut self, state: &mut EditorState, ui: &mut Ui) {
        self.viewport.ui(state, ui);
    }
}
