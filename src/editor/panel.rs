//! The trait of panels: a part of the window that shows and changes the editor's state, independent of the layout.

use egui::Ui;

use super::state::EditorState;

/// The place of a panel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PanelPlace {
    /// A bar at the top.
    Top,
    /// A bar at the bottom.
    Bottom,
    /// Above the bar at the bottom, over the whole width, with default height in points.
    Lower(f32),
    /// At the left, with default and minimum width in points.
    Left(f32, f32),
    /// At the left, below the panel there, with default height in points.
    BelowLeft(f32),
    /// At the right, with default and minimum width in points.
    Right(f32, f32),
    /// Beside the center, closed until it is asked for, with default width in points.
    Beside(f32),
    /// The area that the other panels leave. Only one panel can take it.
    Center,
}

/// A part of the window that shows and changes the editor's state.
pub trait Panel {
    /// Unique id, which the window's saved layout uses, too.
    fn id(&self) -> &'static str;

    /// Its title.
    fn title(&self) -> &'static str;

    /// Its default place.
    fn place(&self) -> PanelPlace;

    /// The height to which it shrinks while it has little to show, in points; `None` while it has more. Only for
    /// [`PanelPlace::Lower`].
    fn slim_height(&self, _: &EditorState) -> Option<f32> {
        None
    }

    /// Shows the panel.
    fn ui(&mut self, state: &mut EditorState, ui: &mut Ui);

    /// Drops all state of the previous document.
    fn forget(&mut self) {}
}
