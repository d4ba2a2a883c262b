//! The list of recent files, kept between runs. It is a convenience: failures here are ignored.

use std::fs;
use std::path::{Path, PathBuf};

use super::state_folder;
use isolith_scene::file;

/// Most files in the list.
pub const MAX_RECENT: usize = 12;
/// A larger file is not our list.
const MAX_BYTES: u64 = 1 << 20;

/// The files opened or saved recently, latest first.
#[derive(Clone, Debug, Default)]
pub struct RecentFiles {
    paths: Vec<PathBuf>,
    /// The file of the list; `None` keeps the list in memory only.
    store: Option<PathBuf>,
}

impl RecentFiles {
    /// The list of this user, from the system's state folder.
    pub fn load() -> Self {
        state_folder().map_or_else(Self::default, |folder| Self::load_from(&folder.join("recent.json")))
    }

    /// The list in this file; empty if it is missing or invalid.
    pub fn load_from(store: &Path) -> Self {
        let paths = read(store).unwrap_or_default();
        Self { paths, store: Some(store.to_path_buf()) }
    }

    /// The files, latest first. Some may no longer exist.
    pub fn paths(&self) -> &[PathBuf] {
        &self.paths
    }

    /// Moves a file to the front, and writes the list.
    pub fn add(&mut self, path: &Path) {
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
        self.follow_others();
        self.paths.retain(|p| *p != path);
        self.paths.insert(0, path);
        self.paths.truncate(MAX_RECENT);
        self.write();
    }

    /// Removes a file, such as a missing one, and writes the list.
    pub fn remove(&mut self, path: &Path) {
        self.follow_others();
        self.paths.retain(|p| p != path);
        self.write();
    }

    /// Clears the list, and writes it.
    pub fn clear(&mut self) {
        self.paths.clear();
        self.write();
    }

    /// Merges entries that other windows have added since. Paths that only this window can keep stay, at the end.
    fn follow_others(&mut self) {
        let Some(paths) = self.store.as_deref().and_then(read) else { return };
        let unwritten = std::mem::replace(&mut self.paths, paths).into_iter().filter(|path| path.to_str().is_none());
        self.paths.extend(unwritten);
    }

    fn write(&self) {
        let Some(store) = &self.store else { return };
        // JSON cannot hold paths that are not Unicode; they are kept for this run only.
        let texts: Vec<&str> = self.paths.iter().filter_map(|p| p.to_str()).collect();
        let Ok(json) = serde_json::to_string_pretty(&texts) else { return };
        if let Some(folder) = store.parent() {
            let _ = file::create_private_folder(folder);
        }
        let _ = file::replace(store, (json + "\n").as_bytes(), 0);
    }
}

fn read(store: &Path) -> Option<Vec<PathBuf>> {
    if fs::metadata(store).ok()?.len() > MAX_BYTES {
        return None;
    }
    let mut paths: Vec<PathBuf> = serde_json::from_slice(&fs::read(store).ok()?).ok()?;
    paths.retain(|p| p.is_absolute());
    paths.truncate(MAX_RECENT);
    Some(paths)
}
