//! Commands on the selection.

use egui::{Key, Modifiers};
use egui_material_icons::MaterialIcon;
use egui_material_icons::icons::{
    ICON_ANIMATION, ICON_ARROW_DOWNWARD, ICON_ARROW_UPWARD, ICON_CALL_SPLIT, ICON_CASINO, ICON_CHANGE_HISTORY,
    ICON_CONTENT_COPY, ICON_DELETE, ICON_EDIT, ICON_FOLDER, ICON_FOLDER_OFF, ICON_FORMAT_PAINT, ICON_GRID_ON,
    ICON_HISTORY, ICON_JOIN, ICON_JOIN_FULL, ICON_JOIN_INNER, ICON_JOIN_LEFT, ICON_KEY,
    ICON_KEYBOARD_DOUBLE_ARROW_DOWN, ICON_LASSO_SELECT, ICON_LINK, ICON_LINK_OFF, ICON_LOCK, ICON_PLUMBING, ICON_REDO,
    ICON_REMOVE_CIRCLE, ICON_SELECT, ICON_SELECT_ALL, ICON_STYLUS, ICON_UNDO, ICON_VERTICAL_ALIGN_BOTTOM,
    ICON_VERTICAL_ALIGN_TOP, ICON_VIEW_IN_AR, ICON_VISIBILITY, ICON_VISIBILITY_LOCK, ICON_VISIBILITY_OFF,
};

use super::arrange;
use super::command::Command;
use super::info::{CommandInfo, Icon, Menu};
use crate::instancer_edits::{can_instance, can_take_preset};
use crate::mesh_conversion;
use crate::seeds;
use crate::selection::linked_in_selection;
use crate::state::EditorState;
use isolith_scene::{InstancerPreset, Operator};

const NONE: Modifiers = Modifiers::NONE;
const CTRL: Modifiers = Modifiers::COMMAND;
const SHIFT_CTRL: Modifiers = Modifiers::COMMAND.plus(Modifiers::SHIFT);

pub(super) fn commands() -> Vec<CommandInfo> {
    let mut all = history();
    all.extend(arrange::clipboard());
    all.extend(structure());
    all.extend(instancers());
    all.extend(roles());
    all.extend(extended_operators());
    let keys = "Sets keys of position, rotation and scale of the selection at the moment that is shown";
    all.push(on_selection(Command::KeyTransform, ICON_KEY, "Insert key", keys).key(NONE, Key::K).group());
    all.extend(arrange::commands());
    all.extend(showing());
    all.extend(selecting());
    all
}

fn row(command: Command, icon: MaterialIcon, label: &str, help: &str) -> CommandInfo {
    CommandInfo::new(Menu::Edit, command, Icon::from(icon), label, help)
}

fn any(state: &EditorState) -> bool {
    !state.session.document.selection().is_empty()
}

/// A command that needs a selection.
fn on_selection(command: Command, icon: MaterialIcon, label: &str, help: &str) -> CommandInfo {
    row(command, icon, label, help).when(any)
}

fn join(operator: Operator, icon: MaterialIcon, label: &str, help: &str) -> CommandInfo {
    on_selection(Command::Join(operator), icon, label, help).within(Menu::Combine)
}

fn history() -> Vec<CommandInfo> {
    vec![
        row(Command::Undo, ICON_UNDO, "Undo", "Takes back the last change")
            .key(CTRL, Key::Z)
            .when(|state| state.session.document.undo_label().is_some()),
        row(Command::Redo, ICON_REDO, "Redo", "Does again what was taken back")
            .key(SHIFT_CTRL, Key::Z)
            .key(CTRL, Key::Y)
            .when(|state| state.session.document.redo_label().is_some()),
        row(Command::ShowHistory, ICON_HISTORY, "History", "The list of all steps of undo; a click goes to one")
            .key(Modifiers::ALT, Key::Z)
            .switch(|state, _| state.show_history),
    ]
}

fn structure() -> Vec<CommandInfo> {
    let along = "A copy of the selection, moved, turned or scaled as was done last; again for a row or a ring";
    let linked = "A copy whose objects share shape and material with their originals: an edit of one changes all";
    let up = "One place up among its siblings; the order of operands matters";
    vec![
        on_selection(Command::Rename, ICON_EDIT, "Rename", "Changes the name in the outliner")
            .key(NONE, Key::F2)
            .group(),
        on_selection(Command::Duplicate, ICON_CONTENT_COPY, "Duplicate", "A copy of the selection, right behind it")
            .key(Modifiers::SHIFT, Key::D)
            .key(CTRL, Key::D),
        on_selection(Command::DuplicateLinked, ICON_LINK, "Duplicate linked", linked).key(Modifiers::ALT, Key::D),
        on_selection(Command::DuplicateAlong, ICON_CONTENT_COPY, "Duplicate along the last move", along)
            .key(Modifiers::SHIFT, Key::R)
            .when(|state| any(state) && state.view.last_motion.is_some()),
        on_selection(
            Command::Delete,
            ICON_DELETE,
            "Delete",
            "Removes the selection; over the timeline, its selected keys",
        )
        .key(NONE, Key::X)
        .key(NONE, Key::Delete)
        .when(|state| any(state) || state.playback.deletes_keys()),
        on_selection(Command::Group, ICON_FOLDER, "Group", "Puts the selection into a group").key(CTRL, Key::G).group(),
        on_selection(Command::Ungroup, ICON_FOLDER_OFF, "Ungroup", "Takes the children out of the selected groups")
            .key(SHIFT_CTRL, Key::G),
        on_selection(Command::MoveUp, ICON_ARROW_UPWARD, "Move up", up)
            .key(Modifiers::ALT, Key::ArrowUp)
            .within(Menu::Arrange),
        on_selection(Command::MoveDown, ICON_ARROW_DOWNWARD, "Move down", "One place down among its siblings")
            .key(Modifiers::ALT, Key::ArrowDown)
            .within(Menu::Arrange),
    ]
}

fn instancers() -> Vec<CommandInfo> {
    let types = "Makes the selected objects and groups the types of a new instancer";
    let seeds = "Other seeds for all selected instancers whose seed is not locked";
    let mut all = vec![
        row(Command::InstanceSelection, ICON_GRID_ON, "Instancer from selection", types)
            .when(|state| can_instance(&state.session))
            .within(Menu::Convert),
        row(Command::RerollSeeds, ICON_CASINO, "Re-roll seeds", seeds)
            .when(|state| {
                let document = &state.session.document;
                seeds::unlocked(document.scene(), document.selection()).next().is_some()
            })
            .within(Menu::Convert),
    ];
    all.push(
        row(
            Command::MeshToField,
            ICON_VIEW_IN_AR,
            "Convert to field",
            "Makes the selected meshes solids that blend and cut",
        )
        .when(|state| mesh_conversion::can_become_field(&state.session))
        .within(Menu::Convert)
        .group(),
    );
    all.push(
        row(
            Command::FieldToMesh,
            ICON_CHANGE_HISTORY,
            "Convert to mesh",
            "Draws the selected mesh fields as triangles again",
        )
        .when(|state| mesh_conversion::can_become_mesh(&state.session))
        .within(Menu::Convert),
    );
    all.extend(InstancerPreset::ALL.map(|preset| {
        let label = format!("Instancer preset: {}", preset.label().to_lowercase());
        CommandInfo::new(Menu::Presets, Command::ApplyPreset(preset), Icon::from(ICON_GRID_ON), label, preset.help())
            .when(|state| can_take_preset(&state.session))
    }));
    all
}

fn roles() -> Vec<CommandInfo> {
    let subtract = "Cut away from what stands before it, or added again";
    let intersect = "Keep of what stands before it only what is inside of it, or add it again";
    vec![
        join(Operator::Union, ICON_JOIN_FULL, "Union", "Joins the selection: what is in any of it")
            .key(NONE, Key::U)
            .group(),
        join(Operator::Intersection, ICON_JOIN_INNER, "Intersect", "Keeps what is in all of the selection")
            .key(NONE, Key::I),
        join(Operator::Difference, ICON_JOIN_LEFT, "Subtract", "Cuts all later ones out of the first of the selection")
            .key(NONE, Key::D),
        on_selection(Command::ToggleSubtract, ICON_REMOVE_CIRCLE, "Toggle subtract", subtract)
            .key(NONE, Key::N)
            .within(Menu::Combine)
            .group(),
        on_selection(Command::ToggleIntersect, ICON_JOIN_INNER, "Toggle intersect", intersect).within(Menu::Combine),
    ]
}

/// Operators without a shortcut; the command palette finds them.
fn extended_operators() -> Vec<CommandInfo> {
    let [exclude, pipe, groove] = [
        "Keeps what is in one of the selection but not in the next",
        "A tube along the curve where the surfaces of the selection meet",
        "Cuts a groove along the surfaces of all later ones",
    ];
    vec![
        join(Operator::Xor, ICON_JOIN, "Exclude (XOR)", exclude).group(),
        join(Operator::Pipe, ICON_PLUMBING, "Pipe", pipe),
        join(Operator::Groove, ICON_VERTICAL_ALIGN_BOTTOM, "Groove", groove),
        join(
            Operator::Tongue,
            ICON_VERTICAL_ALIGN_TOP,
            "Tongue",
            "Raises a tongue along the surfaces of all later ones",
        ),
        join(Operator::Engrave, ICON_STYLUS, "Engrave", "Cuts a V along the surfaces of all later ones"),
        join(Operator::Morph, ICON_ANIMATION, "Morph", "A shape between those of the selection"),
        join(
            Operator::Paint,
            ICON_FORMAT_PAINT,
            "Color projection",
            "The first of the selection in the colors of the others",
        ),
    ]
}

fn showing() -> Vec<CommandInfo> {
    let nothing = "Clears the selection and shows the scene's settings";
    let unused = "Removes materials that nothing uses";
    let alone = "Hides everything else but lights and cameras; once more shows it again";
    let drop = "Moves the selection down until it touches what is below it, or the ground";
    let unlink = "Takes the selection out of its sets of linked objects";
    let unique = "Copies of materials that others use, too, for the selection alone";
    vec![
        row(Command::SelectAll, ICON_SELECT_ALL, "Select all", "Selects every node that is not locked")
            .key(CTRL, Key::A)
            .group(),
        CommandInfo::new(Menu::Edit, Command::SelectNothing, None, "Deselect all", nothing)
            .key(NONE, Key::Escape)
            .when(|state| any(state) || state.materials.current.is_some()),
        CommandInfo::new(Menu::Edit, Command::Isolate, Icon::from(ICON_VISIBILITY_LOCK), "Isolate", alone)
            .key(NONE, Key::Slash)
            .when(|state| any(state) || !state.view.isolated.is_empty()),
        on_selection(Command::DropOnSurface, ICON_KEYBOARD_DOUBLE_ARROW_DOWN, "Drop on surface", drop)
            .key(NONE, Key::End),
        on_selection(
            Command::ToggleVisible,
            ICON_VISIBILITY_OFF,
            "Toggle visible",
            "Hides the selection, or shows it again",
        )
        .key(NONE, Key::H),
        row(Command::ShowAll, ICON_VISIBILITY, "Show all", "Shows everything that is hidden")
            .key(Modifiers::ALT, Key::H),
        on_selection(Command::ToggleLock, ICON_LOCK, "Toggle lock", "Locked nodes are not picked in the viewport")
            .key(NONE, Key::L),
        on_selection(Command::Unlink, ICON_LINK_OFF, "Unlink", unlink)
            .when(|state| !linked_in_selection(&state.session).is_empty())
            .within(Menu::Sharing),
        on_selection(Command::MakeMaterialUnique, ICON_CALL_SPLIT, "Make material unique", unique)
            .within(Menu::Sharing),
        CommandInfo::new(Menu::Sharing, Command::RemoveUnusedMaterials, None, "Remove unused materials", unused),
    ]
}

/// The submenu of ways to select.
fn selecting() -> Vec<CommandInfo> {
    let similar = "Selects all with the shape, operator or kind of light of the active node";
    vec![
        on_selection(
            Command::SelectParents,
            ICON_ARROW_UPWARD,
            "Select parent",
            "Selects the groups that hold the selection",
        )
        .key(NONE, Key::OpenBracket)
        .within(Menu::Select),
        on_selection(
            Command::SelectChildren,
            ICON_ARROW_DOWNWARD,
            "Select children",
            "Selects what the selected groups hold",
        )
        .key(NONE, Key::CloseBracket)
        .within(Menu::Select),
        on_selection(Command::SelectSimilar, ICON_SELECT_ALL, "Select similar", similar)
            .key(Modifiers::SHIFT, Key::G)
            .within(Menu::Select),
        on_selection(
            Command::SelectSameMaterial,
            ICON_SELECT_ALL,
            "Select same material",
            "Selects all with the material of the active node",
        )
        .within(Menu::Select),
        on_selection(
            Command::SelectLinked,
            ICON_LINK,
            "Select linked",
            "Selects what shares its shape with the selection",
        )
        .when(|state| !linked_in_selection(&state.session).is_empty())
        .within(Menu::Select),
        row(
            Command::SelectByBox,
            ICON_SELECT,
            "Select by a box",
            "The next drag in the viewport selects what is in its box",
        )
        .key(NONE, Key::B)
        .within(Menu::Select),
        row(
            Command::SelectByLasso,
            ICON_LASSO_SELECT,
            "Select by a lasso",
            "The next drag in the viewport draws a line around what is selected",
        )
        .key(Modifiers::SHIFT, Key::B)
        .within(Menu::Select),
    ]
}
