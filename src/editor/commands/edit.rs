//! Commands on the selection.

use egui::{Context, Key, Modifiers};
use egui_material_icons::MaterialIcon;
use egui_material_icons::icons::{
    ICON_ANIMATION, ICON_ARROW_DOWNWARD, ICON_ARROW_UPWARD, ICON_CONTENT_COPY, ICON_DELETE, ICON_EDIT, ICON_FOLDER,
    ICON_FOLDER_OFF, ICON_FORMAT_PAINT, ICON_JOIN, ICON_JOIN_FULL, ICON_JOIN_INNER, ICON_JOIN_LEFT, ICON_LOCK,
    ICON_PLUMBING, ICON_REDO, ICON_REMOVE_CIRCLE, ICON_SELECT_ALL, ICON_STYLUS, ICON_UNDO, ICON_VERTICAL_ALIGN_BOTTOM,
    ICON_VERTICAL_ALIGN_TOP, ICON_VISIBILITY, ICON_VISIBILITY_OFF,
};

use super::{Command, Icon, Menu};
use crate::document::Edit;
use crate::editor::{Editor, selection};
use crate::scene::Operator;

const CTRL: Modifiers = Modifiers::COMMAND;

fn any(editor: &Editor) -> bool {
    !editor.session.document.selection().is_empty()
}

pub(super) fn commands() -> Vec<Command> {
    let mut all = history();
    all.extend(structure());
    all.extend(roles());
    all.extend(extended_operators());
    all.extend(showing());
    all
}

fn new(icon: MaterialIcon, name: &str, help: &str, run: fn(&mut Editor, &Context)) -> Command {
    Command::new(Menu::Edit, Icon::from(icon), name, help, run).when(any)
}

fn history() -> Vec<Command> {
    let shift_ctrl = CTRL.plus(Modifiers::SHIFT);
    vec![
        Command::new(Menu::Edit, Icon::from(ICON_UNDO), "Undo", "Takes back the last change", |e, _| {
            e.session.document.undo();
        })
        .key(CTRL, Key::Z)
        .when(|e| e.session.document.undo_label().is_some()),
        Command::new(Menu::Edit, Icon::from(ICON_REDO), "Redo", "Does again what was taken back", |e, _| {
            e.session.document.redo();
        })
        .key(shift_ctrl, Key::Z)
        .key(CTRL, Key::Y)
        .when(|e| e.session.document.redo_label().is_some()),
    ]
}

fn structure() -> Vec<Command> {
    vec![
        new(ICON_EDIT, "Rename", "Changes the name in the outliner", |e, _| e.rename_active())
            .key(Modifiers::NONE, Key::F2)
            .group(),
        new(ICON_CONTENT_COPY, "Duplicate", "A copy of the selection, right behind it", |e, _| {
            selection::duplicate(&mut e.session);
        })
        .key(Modifiers::SHIFT, Key::D)
        .key(CTRL, Key::D),
        new(ICON_DELETE, "Delete", "Removes the selection", |e, _| selection::delete(&mut e.session))
            .key(Modifiers::NONE, Key::X)
            .key(Modifiers::NONE, Key::Delete),
        new(ICON_FOLDER, "Group", "Puts the selection into a group", |e, _| {
            selection::join(&mut e.session, Operator::Union, true);
        })
        .key(CTRL, Key::G)
        .group(),
        new(ICON_FOLDER_OFF, "Ungroup", "Takes the children out of the selected groups", |e, _| {
            selection::ungroup(&mut e.session);
        })
        .key(CTRL.plus(Modifiers::SHIFT), Key::G),
        new(ICON_ARROW_UPWARD, "Move up", "One place up among its siblings; the order of operands matters", |e, _| {
            selection::shift(&mut e.session, -1);
        })
        .key(Modifiers::ALT, Key::ArrowUp),
        new(ICON_ARROW_DOWNWARD, "Move down", "One place down among its siblings", |e, _| {
            selection::shift(&mut e.session, 1);
        })
        .key(Modifiers::ALT, Key::ArrowDown),
    ]
}

fn roles() -> Vec<Command> {
    vec![
        new(ICON_JOIN_FULL, "Union", "Joins the selection: what is in any of it", |e, _| {
            selection::join(&mut e.session, Operator::Union, false);
        })
        .key(Modifiers::NONE, Key::U)
        .group(),
        new(ICON_JOIN_INNER, "Intersect", "Keeps what is in all of the selection", |e, _| {
            selection::join(&mut e.session, Operator::Intersection, false);
        })
        .key(Modifiers::NONE, Key::I),
        new(ICON_JOIN_LEFT, "Subtract", "Cuts all later ones out of the first of the selection", |e, _| {
            selection::join(&mut e.session, Operator::Difference, false);
        })
        .key(Modifiers::NONE, Key::D),
        new(ICON_REMOVE_CIRCLE, "Toggle subtract", "Cut away from what stands before it, or joined again", |e, _| {
            selection::toggle_negative(&mut e.session);
        })
        .key(Modifiers::NONE, Key::N),
    ]
}

/// Operators without a key; the command palette finds them.
fn extended_operators() -> Vec<Command> {
    vec![
        new(ICON_JOIN, "Exclude (XOR)", "Keeps what is in one of the selection but not in the next", |e, _| {
            selection::join(&mut e.session, Operator::Xor, false);
        })
        .group(),
        new(ICON_PLUMBING, "Pipe", "A tube along the curve where the surfaces of the selection meet", |e, _| {
            selection::join(&mut e.session, Operator::Pipe, false);
        }),
        new(ICON_VERTICAL_ALIGN_BOTTOM, "Groove", "Cuts a groove along the surfaces of all later ones", |e, _| {
            selection::join(&mut e.session, Operator::Groove, false);
        }),
        new(ICON_VERTICAL_ALIGN_TOP, "Ridge", "Raises a ridge along the surfaces of all later ones", |e, _| {
            selection::join(&mut e.session, Operator::Tongue, false);
        }),
        new(ICON_STYLUS, "Engrave", "Cuts a V along the surfaces of all later ones", |e, _| {
            selection::join(&mut e.session, Operator::Engrave, false);
        }),
        new(ICON_ANIMATION, "Morph", "A shape between those of the selection", |e, _| {
            selection::join(&mut e.session, Operator::Morph, false);
        }),
        new(ICON_FORMAT_PAINT, "Color projection", "The first of the selection in the colors of the others", |e, _| {
            selection::join(&mut e.session, Operator::Paint, false);
        }),
    ]
}

fn showing() -> Vec<Command> {
    vec![
        Command::new(
            Menu::Edit,
            Icon::from(ICON_SELECT_ALL),
            "Select all",
            "Selects every node that is not locked",
            |e, _| {
                selection::select_all(&mut e.session);
            },
        )
        .key(CTRL, Key::A)
        .group(),
        Command::new(
            Menu::Edit,
            None,
            "Deselect all",
            "Clears the selection and shows the scene's settings",
            |e, _| {
                e.session.document.select(Vec::new());
            },
        )
        .key(Modifiers::NONE, Key::Escape)
        .when(any),
        Command::new(
            Menu::Edit,
            Icon::from(ICON_VISIBILITY_OFF),
            "Toggle visible",
            "Hides the selection, or shows it again",
            |e, _| {
                selection::toggle_visible(&mut e.session);
            },
        )
        .key(Modifiers::NONE, Key::H)
        .when(any),
        Command::new(Menu::Edit, Icon::from(ICON_VISIBILITY), "Show all", "Shows everything that is hidden", |e, _| {
            selection::show_all(&mut e.session);
        })
        .key(Modifiers::ALT, Key::H),
        Command::new(
            Menu::Edit,
            Icon::from(ICON_LOCK),
            "Toggle lock",
            "Locked nodes are not picked in the viewport",
            |e, _| {
                selection::toggle_locked(&mut e.session);
            },
        )
        .key(Modifiers::NONE, Key::L)
        .when(any),
        Command::new(Menu::Edit, None, "Remove unused materials", "Removes materials that nothing uses", |e, _| {
            let unused = selection::unused_materials(e.session.document.scene());
            e.session.together(|session| {
                for id in unused {
                    session.apply(Edit::RemoveMaterial(id));
                }
            });
        }),
    ]
}
