//! The folder of one unsaved document.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use serde::{Deserialize, Serialize};

use super::Thumbnail;
use crate::Document;
use isolith_scene::file::{self, FileError, Stamp};
use isolith_scene::{Scene, limits};

/// The lock file; its holder owns the folder.
const LOCK: &str = "lock";
const ABOUT: &str = "about.json";
const SNAPSHOT: &str = "scene.json";
const PICTURE: &str = "picture.png";
/// Older snapshots kept beside the latest, in case a scene crashes the program each time it is opened.
const OLDER_SNAPSHOTS: usize = 2;
/// Attempts to create a folder that another window keeps removing.
const TRIES: usize = 4;
/// Greatest size of a description or picture, in bytes.
const MAX_SMALL_FILE: u64 = 1 << 20;

/// The description of a document, without its scene. Constant until the document is saved.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub(super) struct About {
    /// The file that the document was read from or saved to last.
    path: Option<PathBuf>,
    /// The stamp of that file.
    stamp: Option<Stamp>,
    /// The document's display name.
    name: String,
}

impl About {
    pub fn of(document: &Document) -> Self {
        // JSON cannot hold a path that is not Unicode: such a document is recovered without a file.
        let path = document.path().filter(|path| path.to_str().is_some());
        let path = path.map(|path| std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf()));
        let name = document.title().trim_end_matches(" *").to_owned();
        Self { stamp: path.is_some().then(|| document.stamp()).flatten(), path, name }
    }
}

/// The scene of the latest readable snapshot, with the error of a later one; or the error if none is readable.
pub type ReadSnapshot = Result<(Scene, Option<FileError>), FileError>;

/// A folder that this process owns.
#[derive(Debug)]
pub(super) struct Place {
    folder: PathBuf,
    /// Held while this process owns the folder.
    lock: File,
}

impl Place {
    /// Creates a folder for a document.
    pub fn new(root: &Path, about: &About) -> io::Result<Self> {
        // Another window that scans the folders can interfere: it takes this one for that of a process that died before
        // its first snapshot, and removes it.
        let is_taken = |error: &io::Error| matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::NotFound);
        for _ in 0..TRIES {
            match Self::make(root, about) {
                Err(error) if is_taken(&error) => {}
                made => return made,
            }
        }
        Self::make(root, about)
    }

    fn make(root: &Path, about: &About) -> io::Result<Self> {
        file::create_private_folder(root)?;
        let folder = root.join(file::random_name());
        file::create_private_folder(&folder)?;
        let lock = OpenOptions::new().write(true).create_new(true).open(folder.join(LOCK))?;
        lock.try_lock().map_err(io::Error::from)?;
        let place = Self { folder, lock };
        let text = serde_json::to_vec(about).map_err(io::Error::other)?;
        place.write(ABOUT, &text, 0)?;
        Ok(place)
    }

    pub fn write_snapshot(&self, scene: &Scene) -> io::Result<()> {
        let json = file::to_json(scene).map_err(|error| io::Error::other(error.to_string()))?;
        self.write(SNAPSHOT, json.as_bytes(), OLDER_SNAPSHOTS)
    }

    pub fn write_picture(&self, picture: &Thumbnail) -> io::Result<()> {
        picture.to_png().map_or(Ok(()), |bytes| self.write(PICTURE, &bytes, 0))
    }

    fn write(&self, name: &str, bytes: &[u8], older: usize) -> io::Result<()> {
        let path = self.folder.join(name);
        file::replace(&path, bytes, older)
            .map_err(|e| io::Error::new(e.error.kind(), format!("{}: {e}", path.display())))
    }

    /// Removes the folder with its contents. The lock goes last, so that no other window takes a part of it.
    pub fn remove(self) -> io::Result<()> {
        let entries = match fs::read_dir(&self.folder) {
            // Another process has removed it.
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
            entries => entries?,
        };
        for entry in entries {
            let path = entry?.path();
            if path != self.folder.join(LOCK) {
                fs::remove_file(path)?;
            }
        }
        let Self { folder, lock } = self;
        fs::remove_file(folder.join(LOCK))?;
        // Some systems keep a folder while one of its files is open.
        drop(lock);
        fs::remove_dir(&folder)
    }
}

/// A document whose process died before it was saved. No other window is offered it while this value lives.
#[derive(Debug)]
pub struct Lost {
    place: Place,
    about: About,
    changed: SystemTime,
    picture: Option<Thumbnail>,
}

impl Lost {
    /// The unique name of its folder.
    pub fn id(&self) -> String {
        self.place.folder.file_name().unwrap_or_default().to_string_lossy().into_owned()
    }

    /// The document's display name.
    pub fn name(&self) -> &str {
        if self.about.name.is_empty() { "Untitled" } else { &self.about.name }
    }

    /// The document's file.
    pub fn path(&self) -> Option<PathBuf> {
        self.about.path.clone()
    }

    /// The time of its last snapshot.
    pub fn changed(&self) -> SystemTime {
        self.changed
    }

    /// Its picture.
    pub fn picture(&self) -> Option<&Thumbnail> {
        self.picture.as_ref()
    }

    pub(super) fn stamp(&self) -> Option<Stamp> {
        self.about.stamp
    }

    pub(super) fn into_place(self) -> Place {
        self.place
    }

    /// Reads the latest readable snapshot; returns the error of a later one with it.
    pub fn read(&self) -> ReadSnapshot {
        let mut problem = None;
        for path in snapshots(&self.place.folder) {
            match file::load(&path) {
                Ok(scene) => return Ok((scene, problem)),
                Err(error) => problem = problem.or(Some(error)),
            }
        }
        Err(problem.unwrap_or_else(|| FileError::new(&self.place.folder, "holds no scene")))
    }
}

/// The snapshots in a folder, latest first.
fn snapshots(folder: &Path) -> impl Iterator<Item = PathBuf> {
    let latest = folder.join(SNAPSHOT);
    let older = (1..=OLDER_SNAPSHOTS).map({
        let latest = latest.clone();
        move |generation| file::backup_path(&latest, generation)
    });
    std::iter::once(latest).chain(older).filter(|path| path.is_file())
}

/// Claims every folder below `root` whose owner has died, latest first.
pub(super) fn claim_all(root: &Path) -> Vec<Lost> {
    let Ok(entries) = fs::read_dir(root) else { return Vec::new() };
    let mut found: Vec<Lost> = entries.flatten().filter_map(|entry| claim(&entry.path())).collect();
    found.sort_by_key(|lost| std::cmp::Reverse(lost.changed));
    found
}

fn claim(folder: &Path) -> Option<Lost> {
    if !fs::symlink_metadata(folder).is_ok_and(|m| m.is_dir()) {
        return None;
    }
    let lock = match OpenOptions::new().write(true).open(folder.join(LOCK)) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            // Removes the folder only if it is empty.
            let _ = fs::remove_dir(folder);
            return None;
        }
        lock => lock.ok()?,
    };
    lock.try_lock().ok()?;
    let place = Place { folder: folder.to_path_buf(), lock };
    let latest = snapshots(folder).next();
    let about: About = small_file(folder, ABOUT).and_then(|b| serde_json::from_slice(&b).ok()).unwrap_or_default();
    let is_saved = |latest: &Path| about.path.as_deref().is_some_and(|path| is_same_file(latest, path));
    let Some(latest) = latest.filter(|latest| !is_saved(latest)) else {
        // Its owner died before the first snapshot, or between saving and removing the folder.
        let _ = place.remove();
        return None;
    };
    let changed = fs::metadata(latest).and_then(|m| m.modified()).unwrap_or(SystemTime::UNIX_EPOCH);
    let picture = small_file(folder, PICTURE).and_then(|bytes| Thumbnail::from_png(&bytes));
    Some(Lost { place, about, changed, picture })
}

/// Whether both files have the same contents, so that nothing is lost.
fn is_same_file(snapshot: &Path, saved: &Path) -> bool {
    let length = |path: &Path| fs::metadata(path).ok().filter(|m| m.is_file()).map(|m| m.len());
    let both = (length(snapshot), length(saved));
    matches!(both, (Some(a), Some(b)) if a == b && a <= limits::MAX_FILE_BYTES)
        && matches!((fs::read(snapshot), fs::read(saved)), (Ok(a), Ok(b)) if a == b)
}

fn small_file(folder: &Path, name: &str) -> Option<Vec<u8>> {
    let path = folder.join(name);
    let mut bytes = Vec::new();
    if !fs::symlink_metadata(&path).ok()?.is_file() {
        return None;
    }
    File::open(path).ok()?.take(MAX_SMALL_FILE).read_to_end(&mut bytes).ok()?;
    Some(bytes)
}
