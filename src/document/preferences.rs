//! What a user prefers, kept between runs. It is a convenience: a failure to write is ignored, and a damaged file is
//! set aside and replaced.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::layout::PanelLayout;
use super::state_folder;
use isolith_scene::file;

/// A larger file is not ours.
const MAX_BYTES: u64 = 1 << 20;
/// Most favorites.
pub const MAX_FAVORITES: usize = 64;
/// Most commands with keys of their own, and most keys of one.
pub const MAX_CHANGED_KEYS: usize = 1_000;
/// Least and greatest scale of the user interface.
pub const SCALES: [f32; 2] = [0.6, 3.0];

/// The keys of commands that differ from the keymap's: names of commands, and their keys as text.
pub type ChangedKeys = BTreeMap<String, Vec<String>>;

/// The values of the preferences. Unknown ones of a newer program are dropped.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct PreferenceValues {
    /// The name of the keymap; empty for the first.
    pub keymap: String,
    /// The keys that differ from it, by the name of the keymap.
    pub keys: BTreeMap<String, ChangedKeys>,
    /// Whether the program starts without the welcome.
    pub skips_welcome: bool,
    /// The names of what is offered first for adding; `None` for the program's own choice.
    pub favorites: Option<Vec<String>>,
    /// The places of the panels; `None` for the usual ones.
    pub layout: Option<PanelLayout>,
    /// The name of the theme; empty for the first.
    pub theme: String,
    /// Scale of the user interface; 1 is the usual one.
    pub scale: f32,
    /// The unit in which lengths are shown; empty for meters.
    pub unit: String,
    /// Samples per pixel of a new viewport; `None` for the program's own choice.
    pub samples: Option<u32>,
    /// Most MiB that the bricks of models take; `None` for as many as there may be.
    pub brick_mebibytes: Option<u32>,
    /// Whether drags snap unless Ctrl is held.
    pub snaps: bool,
    /// The step of lengths to which they snap, in meters; `None` for one that suits the view.
    pub snap_length: Option<f64>,
    /// The step of angles in degrees; `None` for the usual one.
    pub snap_angle: Option<f64>,
}

impl Default for PreferenceValues {
    fn default() -> Self {
        Self {
            keymap: String::new(),
            keys: BTreeMap::new(),
            skips_welcome: false,
            favorites: None,
            layout: None,
            theme: String::new(),
            scale: 1.0,
            unit: String::new(),
            samples: None,
            brick_mebibytes: None,
            snaps: false,
            snap_length: None,
            snap_angle: None,
        }
    }
}

impl PreferenceValues {
    /// Brings every value within its limits.
    fn limit(&mut self) {
        if let Some(favorites) = &mut self.favorites {
            favorites.truncate(MAX_FAVORITES);
        }
        self.keys.values_mut().for_each(limit_keys);
        self.layout = self.layout.take().filter(PanelLayout::is_sound);
        let is_step = |step: &f64| step.is_finite() && *step > 0.0;
        self.snap_length = self.snap_length.filter(is_step);
        self.snap_angle = self.snap_angle.filter(is_step);
        self.scale = if self.scale.is_finite() { self.scale.clamp(SCALES[0], SCALES[1]) } else { 1.0 };
    }
}

fn limit_keys(keys: &mut ChangedKeys) {
    while keys.len() > MAX_CHANGED_KEYS {
        keys.pop_last();
    }
    keys.values_mut().for_each(|keys| keys.truncate(MAX_CHANGED_KEYS));
}

/// The preferences of a user.
#[derive(Clone, Debug, Default)]
pub struct Preferences {
    values: PreferenceValues,
    /// Their file; `None` keeps them in memory only.
    store: Option<PathBuf>,
    /// What was wrong with the file.
    problem: Option<String>,
}

impl Preferences {
    /// Those of this user, from the system's state folder.
    pub fn load() -> Self {
        state_folder().map_or_else(Self::default, |folder| Self::load_from(&folder.join("preferences.json")))
    }

    /// Those in this file; the usual ones if it is missing. A file that cannot be understood is set aside as
    /// `NAME.broken`, and [`Preferences::take_problem`] tells so.
    pub fn load_from(store: &Path) -> Self {
        let (values, problem) = match read(store) {
            Ok(values) => (values.unwrap_or_default(), None),
            Err(reason) => (PreferenceValues::default(), Some(set_aside(store, &reason))),
        };
        Self { values, store: Some(store.to_path_buf()), problem }
    }

    /// The values.
    pub fn values(&self) -> &PreferenceValues {
        &self.values
    }

    /// What was wrong with the file, once.
    pub fn take_problem(&mut self) -> Option<String> {
        self.problem.take()
    }

    /// Changes them, over what other windows have written since, and writes them.
    pub fn change(&mut self, change: impl FnOnce(&mut PreferenceValues)) {
        if let Some(Ok(Some(values))) = self.store.as_deref().map(read) {
            self.values = values;
        }
        change(&mut self.values);
        self.values.limit();
        let Some(store) = &self.store else { return };
        let Ok(json) = serde_json::to_string_pretty(&self.values) else { return };
        if let Some(folder) = store.parent() {
            let _ = file::create_private_folder(folder);
        }
        let _ = file::replace(store, (json + "\n").as_bytes(), 0);
    }
}

/// The values in a file; `None` if there is none.
fn read(store: &Path) -> Result<Option<PreferenceValues>, String> {
    let Ok(about) = fs::metadata(store) else { return Ok(None) };
    if about.len() > MAX_BYTES {
        return Err("it is too large".into());
    }
    let bytes = fs::read(store).map_err(|error| error.to_string())?;
    let mut values: PreferenceValues = serde_json::from_slice(&bytes).map_err(|error| error.to_string())?;
    values.limit();
    Ok(Some(values))
}

/// Moves a damaged file out of the way; returns what to tell.
fn set_aside(store: &Path, reason: &str) -> String {
    let mut broken = store.as_os_str().to_owned();
    broken.push(".broken");
    let broken = PathBuf::from(broken);
    match fs::rename(store, &broken) {
        Ok(()) => format!(
            "The preferences could not be read: {reason}. They are the usual ones again; the file is kept as {}.",
            broken.display()
        ),
        Err(error) => format!("The preferences could not be read: {reason}. They are the usual ones; {error}."),
    }
}

/// A keymap in a file of its own.
#[derive(Debug, Serialize, Deserialize)]
struct KeymapFile {
    /// The keymap from which it differs.
    keymap: String,
    keys: ChangedKeys,
}

/// Writes the keys that differ from a keymap to a file.
pub fn export_keys(path: &Path, keymap: &str, keys: &ChangedKeys) -> Result<(), String> {
    let content = KeymapFile { keymap: keymap.to_owned(), keys: keys.clone() };
    let json = serde_json::to_string_pretty(&content).map_err(|error| error.to_string())?;
    file::replace(path, (json + "\n").as_bytes(), 0).map(drop).map_err(|error| error.to_string())
}

/// Reads what [`export_keys`] has written: the name of a keymap and the keys that differ from it.
pub fn import_keys(path: &Path) -> Result<(String, ChangedKeys), String> {
    if fs::metadata(path).map_err(|error| error.to_string())?.len() > MAX_BYTES {
        return Err("it is too large for a keymap".into());
    }
    let bytes = fs::read(path).map_err(|error| error.to_string())?;
    let KeymapFile { keymap, mut keys } = serde_json::from_slice(&bytes).map_err(|error| error.to_string())?;
    limit_keys(&mut keys);
    Ok((keymap, keys))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn they_come_back_over_what_other_windows_have_written() {
        let folder = tempfile::tempdir().unwrap();
        let store = folder.path().join("state").join("preferences.json");
        let mut preferences = Preferences::load_from(&store);
        assert_eq!(*preferences.values(), PreferenceValues::default());
        assert!(preferences.take_problem().is_none(), "a missing file is no problem");
        preferences.change(|values| values.keymap = "Industry".into());
        // Another window changes something else.
        Preferences::load_from(&store).change(|values| values.favorites = Some(vec!["Box".into()]));
        preferences.change(|_| {});
        let again = Preferences::load_from(&store);
        assert_eq!((&*again.values().keymap, again.values().favorites.as_ref().unwrap().len()), ("Industry", 1));
    }

    #[test]
    fn a_damaged_file_is_told_and_kept_beside_the_new_one() {
        let folder = tempfile::tempdir().unwrap();
        let store = folder.path().join("preferences.json");
        for damaged in ["{", r#"{ "scale": "large" }"#, "7"] {
            fs::write(&store, damaged).unwrap();
            let mut preferences = Preferences::load_from(&store);
            assert_eq!(*preferences.values(), PreferenceValues::default());
            assert!(preferences.take_problem().expect("told").contains("preferences.json.broken"));
            assert!(preferences.take_problem().is_none(), "once");
            assert_eq!(fs::read_to_string(folder.path().join("preferences.json.broken")).unwrap(), damaged);
            preferences.change(|values| values.theme = "Light".into());
            assert_eq!(Preferences::load_from(&store).values().theme, "Light");
        }
    }

    #[test]
    fn values_stay_within_their_limits() {
        let folder = tempfile::tempdir().unwrap();
        let store = folder.path().join("preferences.json");
        fs::write(&store, r#"{ "scale": 900.0, "newer": 1 }"#).unwrap();
        assert_eq!(Preferences::load_from(&store).values().scale, SCALES[1]);
    }

    #[test]
    fn keys_are_exported_and_imported() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("keys.json");
        let keys = ChangedKeys::from([("Save".to_owned(), vec!["Ctrl+K".to_owned()]), ("Grid".to_owned(), vec![])]);
        export_keys(&path, "Blender", &keys).unwrap();
        assert_eq!(import_keys(&path).unwrap(), ("Blender".to_owned(), keys));
        fs::write(&path, "{}").unwrap();
        assert!(import_keys(&path).is_err());
        assert!(import_keys(&folder.path().join("missing")).is_err());
    }
}
