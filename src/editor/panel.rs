//! What a panel is: a part of the window that shows the editor's state and changes it, wherever the shell puts it.

use egui::Ui;

use super::state::EditorState;

/// Where a panel stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PanelPlace {
    /// A bar at the top.
    Top,
    /// A bar at the bottom.
    Bottom,
    /// At the left, so wide at first and at least, in points.
    Left(f32, f32),
    /// At the right, so wide at first and at least, in points.
    Right(f32, f32),
    /// What the others leave. Only one can stand there.
    Center,
}

/// See the module.
pub trait Panel {
    /// Tells it from the others, also in what the window remembers.
    fn id(&self) -> &'static str;

    /// What it is called.
    fn title(&self) -> &'static str;

    /// Where it stands unless the shell says otherwise.
    fn place(&self) -> PanelPlace;

    /// Shows it.
    fn ui(&mut self, state: &mut EditorState, ui: &mut Ui);

    /// Another document is shown from now on.
    fn forget(&mut self) {}
}
