//! Saving in three steps, so that the middle one can run on another thread: what is to be written, writing it, and the
//! document's knowledge that it is written. Edits made meanwhile stay changes.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::{Document, OverwriteRisk};
use isolith_scene::Scene;
use isolith_scene::file::{self, FileError, Stamp};

/// A document as it is to be saved to a path.
#[derive(Clone, Debug)]
pub struct SaveOrder {
    scene: Arc<Scene>,
    mark: u64,
    path: PathBuf,
    /// The document's file, and how that was when it was read or saved last.
    own: Option<(PathBuf, Option<Stamp>)>,
}

/// A scene that was written.
#[derive(Clone, Debug)]
pub struct Saved {
    path: PathBuf,
    stamp: Stamp,
    mark: u64,
}

impl SaveOrder {
    /// Where it is to be written.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// What writing it would replace.
    pub fn would_replace(&self) -> OverwriteRisk {
        let path = &self.path;
        let own = self.own.as_ref().filter(|(own, _)| own == path || file::is_same_place(own, path));
        let Some((_, stamp)) = own else {
            return if path.exists() { OverwriteRisk::OtherFile } else { OverwriteRisk::Nothing };
        };
        match stamp {
            Some(stamp) if !stamp.is_outdated(path) => OverwriteRisk::Nothing,
            // Recovered, and nobody knows any more what its file was.
            None if !path.exists() => OverwriteRisk::Nothing,
            _ => OverwriteRisk::ChangedByOthers,
        }
    }

    /// Writes it. On failure the file is what it was.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(self) -> Result<Saved, FileError> {
        let stamp = file::save_stamped(&self.scene, &self.path)?;
        Ok(Saved { path: self.path, stamp, mark: self.mark })
    }
}

impl Document {
    /// The document as it is now, to be saved to a path.
    pub fn save_order(&self, path: &Path) -> SaveOrder {
        let own = self.path.clone().map(|own| (own, self.stamp));
        SaveOrder { scene: self.snapshot(), mark: self.state.mark, path: path.to_path_buf(), own }
    }

    /// The document's file is the one that was written from then on; what was changed since the order is a change.
    pub fn take_saved(&mut self, saved: Saved) {
        let Saved { path, stamp, mark } = saved;
        (self.path, self.stamp, self.saved) = (Some(path), Some(stamp), Some(mark));
    }
}
