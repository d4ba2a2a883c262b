//! The table of all commands: label, keys, menu and condition of each. It feeds menus, toolbar, shortcuts and palette.

use std::sync::LazyLock;

use super::command::Command;
use super::info::CommandInfo;
use super::{add, edit, file, help, tools, view};
use crate::state::EditorState;

static TABLE: LazyLock<Vec<CommandInfo>> = LazyLock::new(|| {
    let menus =
        [file::commands(), edit::commands(), tools::commands(), add::commands(), view::commands(), help::commands()];
    menus.into_iter().flatten().collect()
});

impl Command {
    /// All commands, in menu order.
    pub fn all() -> impl Iterator<Item = Self> {
        TABLE.iter().map(|info| info.command)
    }

    /// The row of this command.
    pub fn info(self) -> &'static CommandInfo {
        TABLE.iter().find(|info| info.command == self).expect("every command that is named stands in the table")
    }

    /// Whether it is enabled now.
    pub fn is_enabled(self, state: &EditorState) -> bool {
        (self.info().is_enabled)(state)
    }

    /// Whether its switch is on.
    pub fn is_on(self, state: &EditorState) -> Option<bool> {
        self.info().is_on.map(|is_on| is_on(state, self))
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;
    use crate::keymap::Keymap;
    use isolith_field::Shading;
    use isolith_field::debug_view::ViewMode;
    use isolith_scene::{Operator, ShapeKind};

    #[test]
    fn labels_and_keys_are_unique_and_everything_is_explained() {
        let mut labels = HashSet::new();
        let mut keys = HashSet::new();
        for command in Command::all() {
            let info = command.info();
            assert_eq!(info.command, command, "twice");
            assert!(labels.insert(&info.label), "{} twice", info.label);
            assert!(!info.help.is_empty(), "{}", info.label);
            for keymap in Keymap::ALL {
                for key in info.keys(keymap) {
                    assert!(keys.insert((keymap, *key)), "{}: {key:?} twice in {keymap:?}", info.label);
                }
            }
        }
    }

    #[test]
    fn every_shape_operator_shading_and_view_has_a_command() {
        let all: Vec<_> = Command::all().collect();
        assert!(ShapeKind::ALL.iter().all(|kind| all.contains(&Command::AddShape(*kind))));
        assert!(Operator::ALL.iter().all(|operator| all.contains(&Command::Join(*operator))));
        assert!(Shading::ALL.into_iter().all(|shading| all.contains(&Command::ShowShading(shading))));
        let mut views = ViewMode::ALL.into_iter().filter(|view_mode| *view_mode != ViewMode::Shaded);
        assert!(views.all(|view_mode| all.contains(&Command::ShowView(view_mode))));
    }
}
