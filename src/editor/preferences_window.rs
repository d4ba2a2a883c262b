//! The state of the window of the preferences. `preferences_view` shows it.

use super::key_editor::KeyEditor;

/// A page of the window.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
pub enum Page {
    /// Theme, scale, units and samples.
    #[default]
    General,
    /// All keys.
    Keys,
}

impl Page {
    /// Every page.
    pub const ALL: [Self; 2] = [Self::General, Self::Keys];

    /// Display name.
    pub fn label(self) -> &'static str {
        match self {
            Self::General => "General",
            Self::Keys => "Keymap",
        }
    }
}

/// State of the window while it is open.
#[derive(Default)]
pub struct PreferencesWindow {
    open: bool,
    /// The page in front.
    pub page: Page,
    /// The list of keys.
    pub keys: KeyEditor,
}

impl PreferencesWindow {
    /// Opens it.
    pub fn open(&mut self) {
        self.open = true;
    }

    /// Closes it. The page stays for the next time.
    pub fn close(&mut self) {
        (self.open, self.keys) = (false, KeyEditor::default());
    }

    /// Whether it is open.
    pub fn is_open(&self) -> bool {
        self.open
    }
}
