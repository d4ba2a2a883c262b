//! The commands by name, without what they need and do.

use crate::navigation::Side;
use isolith_field::debug_view::ViewMode;
use isolith_scene::{Operator, ShapeKind};

/// Something that the artist can order. What it is called, where it stands and when it can be run is in the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    /// An empty scene with a light.
    New,
    /// Ask for a scene and open it.
    Open,
    /// Write the scene to its file.
    Save,
    /// Write the scene to another file.
    SaveAs,
    /// Read the scene's file again.
    Reload,
    /// Read the models of the scene again.
    ReloadModels,
    /// List what was not saved.
    Recover,
    /// Close the window.
    Quit,
    /// Take back the last change.
    Undo,
    /// Do again what was taken back.
    Redo,
    /// Change the active node's name in the tree.
    Rename,
    /// Copy the selection.
    Duplicate,
    /// Remove the selection.
    Delete,
    /// Put the selection into a group.
    Group,
    /// Take the children out of the selected groups.
    Ungroup,
    /// One place up among the siblings.
    MoveUp,
    /// One place down among the siblings.
    MoveDown,
    /// Join the selection by an operator.
    Join(Operator),
    /// Cut away, or join again.
    ToggleNegative,
    /// Select every node.
    SelectAll,
    /// Clear the selection.
    SelectNothing,
    /// Hide the selection, or show it again.
    ToggleVisible,
    /// Show everything that is hidden.
    ShowAll,
    /// Lock the selection, or unlock it.
    ToggleLock,
    /// Remove materials that nothing has.
    RemoveUnusedMaterials,
    /// Add an object of this shape.
    AddShape(ShapeKind),
    /// Add a group without children.
    AddGroup,
    /// Ask for a model and add it.
    AddMesh,
    /// Add parallel light.
    AddSun,
    /// Add light from a point into every direction.
    AddPointLight,
    /// Add light from a point into a cone.
    AddSpotLight,
    /// Add a camera that sees what the picture shows.
    AddCamera,
    /// Show all of the selection.
    FrameSelected,
    /// Show the whole scene.
    FrameAll,
    /// Take over the view of the scene's camera, or of the next one.
    LookThroughCamera,
    /// Look along an axis of the world.
    LookFrom(Side),
    /// Show or hide the ground grid.
    ToggleGrid,
    /// Show or hide what marks the selection.
    ToggleOutline,
    /// Open the palette.
    FindCommand,
    /// Open or close the log.
    ShowMessages,
    /// Have the picture show this.
    ShowLook(ViewMode),
}
