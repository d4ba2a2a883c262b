//! The names of the commands, without their conditions and effects.

use crate::arrangement::{BoundsEdge, CopiedPart, OriginPlace};
use crate::keymap::Keymap;
use crate::navigation::Side;
use crate::pass_step::PassStep;
use crate::transforms::kinds::{Orientation, PivotPoint, Tool, TransformKind};
use isolith_field::Shading;
use isolith_field::debug_view::ViewMode;
use isolith_scene::{InstancerPreset, Operator, ShapeKind};

/// A command of the artist. The table holds its label, menu and condition.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    /// Start an empty scene with a light.
    New,
    /// Ask for a scene and open it.
    Open,
    /// Save the scene to its file.
    Save,
    /// Save the scene to another file.
    SaveAs,
    /// Reload the scene from its file.
    Reload,
    /// Reload the models of the scene.
    ReloadModels,
    /// Store the files of the models in the scene.
    PackFiles,
    /// Write the files of the models beside the scene.
    UnpackFiles,
    /// List recoverable work.
    Recover,
    /// Open the render dialog.
    Render,
    /// Close the window.
    Quit,
    /// Undo the last change.
    Undo,
    /// Redo the last undone change.
    Redo,
    /// Toggle the list of undo steps.
    ShowHistory,
    /// Copy the selection to the clipboard.
    Copy,
    /// Copy the selection to the clipboard and delete it.
    Cut,
    /// Add what the clipboard holds.
    Paste,
    /// Give the selection a part of the copied node.
    PastePart(CopiedPart),
    /// Align the selection with the active node, along an axis.
    Align(usize, BoundsEdge),
    /// Make the gaps between the selected nodes equal, along an axis.
    Distribute(usize),
    /// Move the origin of the selected groups.
    MoveOrigin(OriginPlace),
    /// Duplicate the selection along the last move.
    DuplicateAlong,
    /// Rename the active node in the outliner.
    Rename,
    /// Duplicate the selection.
    Duplicate,
    /// Duplicate the selection so that objects share shape and material with their copies.
    DuplicateLinked,
    /// Take the selection out of its sets of linked objects.
    Unlink,
    /// Select what is linked with the selection.
    SelectLinked,
    /// Delete the selection.
    Delete,
    /// Group the selection.
    Group,
    /// Ungroup the selected groups.
    Ungroup,
    /// Move one place up among the siblings.
    MoveUp,
    /// Move one place down among the siblings.
    MoveDown,
    /// Combine the selection by an operator.
    Join(Operator),
    /// Make the selection the types of an instancer.
    InstanceSelection,
    /// Give the selected instancers other seeds.
    RerollSeeds,
    /// Give the selected instancers, or a new one of the selection, ready-made settings.
    ApplyPreset(InstancerPreset),
    /// Switch the selection between subtracted and added.
    ToggleSubtract,
    /// Switch the selection between intersected and added.
    ToggleIntersect,
    /// Select every node.
    SelectAll,
    /// Clear the selection.
    SelectNothing,
    /// Select the groups that hold the selection.
    SelectParents,
    /// Select the children of the selected groups.
    SelectChildren,
    /// Select what is of the same kind.
    SelectSimilar,
    /// Make fields of the selected models.
    MeshToField,
    /// Make triangles of the selected fields of models.
    FieldToMesh,
    /// Select what has the same material.
    SelectSameMaterial,
    /// Select by a line that the next drag draws.
    SelectByLasso,
    /// Select by a box that the next drag draws.
    SelectByBox,
    /// Show the selection alone, or everything again.
    Isolate,
    /// Move the selection down onto what is below it.
    DropOnSurface,
    /// Hide or show the selection.
    ToggleVisible,
    /// Show all hidden nodes.
    ShowAll,
    /// Lock or unlock the selection.
    ToggleLock,
    /// Give the selection copies of materials that others use, too.
    MakeMaterialUnique,
    /// Remove unused materials.
    RemoveUnusedMaterials,
    /// Open the palette of what can be added, at the pointer.
    AddAtPointer,
    /// Add an object of this shape.
    AddShape(ShapeKind),
    /// Add an empty group.
    AddGroup,
    /// Add an instancer without types.
    AddInstancer,
    /// Ask for a model and add it.
    AddMesh,
    /// Add a sun.
    AddSun,
    /// Add a point light.
    AddPointLight,
    /// Add a spot light.
    AddSpotLight,
    /// Add a light that is a rectangle.
    AddAreaLight,
    /// Add a camera with the current view.
    AddCamera,
    /// Set keys of position, rotation and scale.
    KeyTransform,
    /// Play the timeline, or pause.
    Play,
    /// Frame the selection.
    FrameSelected,
    /// Frame the whole scene.
    FrameAll,
    /// Look through the scene's camera, or through the next one.
    LookThroughCamera,
    /// Move the camera that one looks through with the view.
    LockCamera,
    /// Toggle the safe areas in the frame of a camera.
    ToggleSafeAreas,
    /// Show this many viewports: 1, 2 or 4.
    SplitView(usize),
    /// Keep the view in this bookmark.
    SetBookmark(usize),
    /// Show the view of this bookmark.
    ShowBookmark(usize),
    /// Look along a world axis.
    LookFrom(Side),
    /// Switch between a perspective and an orthographic view.
    ToggleOrthographic,
    /// Toggle the grid.
    ToggleGrid,
    /// Toggle the outline of the selection.
    ToggleOutline,
    /// Open the preferences.
    Preferences,
    /// Open the page of help about what is under the pointer.
    ShowHelp,
    /// List the keys.
    ShowKeys,
    /// Show the latest changes of the program.
    ShowNews,
    /// Begin the tour.
    StartTour,
    /// Open the welcome.
    ShowWelcome,
    /// Open the command palette.
    FindCommand,
    /// Open the field doctor.
    ExamineScene,
    /// Toggle the log.
    ShowMessages,
    /// Put all panels back into their usual places.
    ResetLayout,
    /// Move, rotate or scale the selection with the pointer, until a click or Enter.
    Transform(TransformKind),
    /// Switch to this tool.
    UseTool(Tool),
    /// Switch to these axes.
    UseOrientation(Orientation),
    /// Switch to this pivot.
    UsePivot(PivotPoint),
    /// Let drags snap without Ctrl, or only with it.
    ToggleSnap,
    /// Let lengths snap to the step of this index, or to one that suits the view.
    SnapLengths(Option<usize>),
    /// Let angles snap to the step of this index.
    SnapAngles(usize),
    /// Switch to this keymap.
    UseKeymap(Keymap),
    /// Switch to this shading.
    ShowShading(Shading),
    /// Switch to the next shading.
    CycleShading,
    /// Switch to this view for debugging, or back.
    ShowView(ViewMode),
    /// Show the picture after another pass over the parts of the scene.
    ShowPass(PassStep),
    /// Accumulate this many samples per pixel.
    Samples(u32),
}
