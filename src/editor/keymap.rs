//! The keymaps: which keys run the commands, and what the user has changed in them.

use std::collections::HashMap;
use std::sync::Arc;

use egui::{Context, Id, Key, KeyboardShortcut, Modifiers};

use isolith_document::ChangedKeys;

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
}

/// The keys in use: a keymap, and what the user has changed in it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct KeyBindings {
    keymap: Keymap,
    changed: HashMap<String, Vec<KeyboardShortcut>>,
}

impl KeyBindings {
    /// The keys of a keymap with these changes. Keys that this program does not know are left out.
    pub fn new(keymap: Keymap, changed: Option<&ChangedKeys>) -> Self {
        let parsed = |keys: &Vec<String>| keys.iter().filter_map(|key| parse(key)).collect();
        let changed = changed.into_iter().flatten().map(|(name, keys)| (name.clone(), parsed(keys))).collect();
        Self { keymap, changed }
    }

    /// Those in use, for the labels of menus.
    pub fn of(ctx: &Context) -> Arc<Self> {
        ctx.data(|data| data.get_temp(Id::unique("keymap"))).unwrap_or_default()
    }

    /// Puts them to use. Call once a frame, before all panels.
    pub fn install(self: &Arc<Self>, ctx: &Context) {
        ctx.data_mut(|data| data.insert_temp(Id::unique("keymap"), Arc::clone(self)));
    }

    /// The keymap that they begin with.
    pub fn keymap(&self) -> Keymap {
        self.keymap
    }

    /// The keys of the command of this name, which by itself has others.
    pub fn keys<'a>(&'a self, name: &str, usual: &'a [KeyboardShortcut]) -> &'a [KeyboardShortcut] {
        self.changed.get(name).map_or(usual, Vec::as_slice)
    }

    /// Whether the user has changed the keys of this command.
    pub fn is_changed(&self, name: &str) -> bool {
        self.changed.contains_key(name)
    }
}

/// The names of modifiers in a file.
const MODIFIERS: [(&str, Modifiers); 3] =
    [("Ctrl", Modifiers::COMMAND), ("Shift", Modifiers::SHIFT), ("Alt", Modifiers::ALT)];

/// A shortcut as text, the same on all systems.
pub fn written(shortcut: &KeyboardShortcut) -> String {
    let held = MODIFIERS.into_iter().filter(|(_, modifiers)| shortcut.modifiers.contains(*modifiers));
    let names = held.map(|(name, _)| name).chain([shortcut.logical_key.name()]);
    names.collect::<Vec<_>>().join("+")
}

/// The shortcut of a text; `None` if it is none.
pub fn parse(text: &str) -> Option<KeyboardShortcut> {
    let (held, key) = text.rsplit_once('+').unwrap_or(("", text));
    let mut modifiers = Modifiers::NONE;
    for name in held.split('+').filter(|name| !name.is_empty()) {
        modifiers |= MODIFIERS.into_iter().find(|(known, _)| *known == name)?.1;
    }
    Some(KeyboardShortcut::new(modifiers, Key::from_name(key)?))
}

/// The shortcut of a key press.
pub fn pressed(modifiers: Modifiers, key: Key) -> KeyboardShortcut {
    let held = |is_held, modifiers| if is_held { modifiers } else { Modifiers::NONE };
    let modifiers = held(modifiers.command || modifiers.ctrl, Modifiers::COMMAND)
        | held(modifiers.shift, Modifiers::SHIFT)
        | held(modifiers.alt, Modifiers::ALT);
    KeyboardShortcut::new(modifiers, key)
}

/// The shortcut as menus show it: signs rather than the names of their keys.
pub fn shown(ctx: &Context, shortcut: &KeyboardShortcut) -> String {
    const SIGNS: [(&str, &str); 4] = [("OpenBracket", "["), ("CloseBracket", "]"), ("Slash", "/"), ("Period", ".")];
    let text = ctx.format_shortcut(shortcut);
    SIGNS.iter().fold(text, |text, (name, sign)| text.replace(name, sign))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shortcuts_are_written_and_read() {
        for (modifiers, key, text) in [
            (Modifiers::NONE, Key::G, "G"),
            (Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::S, "Ctrl+Shift+S"),
            (Modifiers::ALT, Key::ArrowUp, "Alt+Up"),
            (Modifiers::NONE, Key::Slash, "Slash"),
        ] {
            let shortcut = KeyboardShortcut::new(modifiers, key);
            assert_eq!(written(&shortcut), text);
            assert_eq!(parse(text), Some(shortcut));
        }
        for wrong in ["", "Ctrl+", "Hyper+A", "Ctrl+Nothing"] {
            assert_eq!(parse(wrong), None, "{wrong}");
        }
        let ctrl = Modifiers { ctrl: true, command: true, ..Modifiers::NONE };
        assert_eq!(written(&pressed(ctrl, Key::K)), "Ctrl+K");
    }

    #[test]
    fn changed_keys_replace_the_usual_ones() {
        let usual = [KeyboardShortcut::new(Modifiers::NONE, Key::G)];
        let changed = ChangedKeys::from([
            ("Move".to_owned(), vec!["M".to_owned(), "what".to_owned()]),
            ("Grid".to_owned(), Vec::new()),
        ]);
        let bindings = KeyBindings::new(Keymap::Blender, Some(&changed));
        assert_eq!(bindings.keys("Move", &usual), [KeyboardShortcut::new(Modifiers::NONE, Key::M)]);
        assert_eq!(bindings.keys("Grid", &usual), []);
        assert_eq!(bindings.keys("Save", &usual), usual);
    }
}
