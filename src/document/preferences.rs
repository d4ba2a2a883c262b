//! What a user prefers, kept between runs. It is a convenience: failures here are ignored.

use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::state_folder;
use isolith_scene::file;

/// A larger file is not ours.
const MAX_BYTES: u64 = 1 << 20;
/// Most favorites.
pub const MAX_FAVORITES: usize = 64;

/// The values of the preferences. Unknown ones of a newer program are dropped.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct PreferenceValues {
    /// The name of the keymap; empty for the first.
    pub keymap: String,
    /// Whether the program starts without the welcome.
    pub skips_welcome: bool,
    /// The names of what is offered first for adding; `None` for the program's own choice.
    pub favorites: Option<Vec<String>>,
}

/// The preferences of a user.
#[derive(Clone, Debug, Default)]
pub struct Preferences {
    values: PreferenceValues,
    /// Their file; `None` keeps them in memory only.
    store: Option<PathBuf>,
}

impl Preferences {
    /// Those of this user, from the system's state folder.
    pub fn load() -> Self {
        state_folder().map_or_else(Self::default, |folder| Self::load_from(&folder.join("preferences.json")))
    }

    /// Those in this file; the usual ones if it is missing or invalid.
    pub fn load_from(store: &Path) -> Self {
        Self { values: read(store).unwrap_or_default(), store: Some(store.to_path_buf()) }
    }

    /// The values.
    pub fn values(&self) -> &PreferenceValues {
        &self.values
    }

    /// Changes them, over what other windows have written since, and writes them.
    pub fn change(&mut self, change: impl FnOnce(&mut PreferenceValues)) {
        if let Some(values) = self.store.as_deref().and_then(read) {
            self.values = values;
        }
        change(&mut self.values);
        let Some(store) = &self.store else { return };
        let Ok(json) = serde_json::to_string_pretty(&self.values) else { return };
        if let Some(folder) = store.parent() {
            let _ = file::create_private_folder(folder);
        }
        let _ = file::replace(store, (json + "\n").as_bytes(), 0);
    }
}

fn read(store: &Path) -> Option<PreferenceValues> {
    if fs::metadata(store).ok()?.len() > MAX_BYTES {
        return None;
    }
    let mut values: PreferenceValues = serde_json::from_slice(&fs::read(store).ok()?).ok()?;
    if let Some(favorites) = &mut values.favorites {
        favorites.truncate(MAX_FAVORITES);
    }
    Some(values)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn they_come_back_and_a_broken_file_does_no_harm() {
        let folder = tempfile::tempdir().unwrap();
        let store = folder.path().join("state").join("preferences.json");
        let mut preferences = Preferences::load_from(&store);
        assert_eq!(*preferences.values(), PreferenceValues::default());
        preferences.change(|values| values.keymap = "Industry".into());
        // Another window changes something else.
        Preferences::load_from(&store).change(|values| values.favorites = Some(vec!["Box".into()]));
        preferences.change(|_| {});
        let again = Preferences::load_from(&store);
        assert_eq!((&*again.values().keymap, again.values().favorites.as_ref().unwrap().len()), ("Industry", 1));
        std::fs::write(&store, "{").unwrap();
        assert_eq!(*Preferences::load_from(&store).values(), PreferenceValues::default());
    }
}
