//! The keymaps: which keys run the commands.

use egui::{Context, Id, KeyboardShortcut};

/// A set of keys.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Keymap {
    /// G R S transform at once.
    #[default]
    Blender,
    /// Q W E R choose a tool.
    Industry,
}

impl Keymap {
    /// Every keymap.
    pub const ALL: [Self; 2] = [Self::Blender, Self::Industry];

    /// Display name; also its name in the preferences.
    pub fn label(self) -> &'static str {
        match self {
            Self::Blender => "Blender",
            Self::Industry => "Industry",
        }
    }

    /// The help text.
    pub fn help(self) -> &'static str {
        match self {
            Self::Blender => "G, R and S move, rotate and scale at once",
            Self::Industry => "Q, W, E and R choose the tool to select, move, rotate or scale",
        }
    }

    /// The keymap of this name; the first if there is none.
    pub fn named(name: &str) -> Self {
        Self::ALL.into_iter().find(|keymap| keymap.label() == name).unwrap_or_default()
    }

    /// The keymap in use, for the labels of menus.
    pub fn of(ctx: &Context) -> Self {
        ctx.data(|data| data.get_temp(Id::unique("keymap"))).unwrap_or_default()
    }

    /// Puts it to use. Call once a frame, before all panels.
    pub fn install(self, ctx: &Context) {
        ctx.data_mut(|data| data.insert_temp(Id::unique("keymap"), self));
    }
}

/// The shortcut as menus show it: signs rather than the names of their keys.
pub fn shown(ctx: &Context, shortcut: &KeyboardShortcut) -> String {
    const SIGNS: [(&str, &str); 4] = [("OpenBracket", "["), ("CloseBracket", "]"), ("Slash", "/"), ("Period", ".")];
    let text = ctx.format_shortcut(shortcut);
    SIGNS.iter().fold(text, |text, (name, sign)| text.replace(name, sign))
}
