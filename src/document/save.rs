//! Saving in three steps, so that the middle one can run on another thread: make an order, write it, and tell the
//! document that it is written. Edits made meanwhile stay unsaved changes.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::{Document, OverwriteRisk};
use isolith_scene::Scene;
use isolith_scene::file::{self, FileError, Stamp};

/// An order to save a document to a path.
#[derive(Clone, Debug)]
pub struct SaveOrder {
    scene: Arc<Scene>,
    mark: u64,
    path: PathBuf,
    /// The document's file, and its stamp when it was read or saved last.
    own: Option<(PathBuf, Option<Stamp>)>,
}

/// The result of writing an order.
#[derive(Clone, Debug)]
pub struct Saved {
    path: PathBuf,
    stamp: Stamp,
    mark: u64,
}

impl SaveOrder {
    /// The target path.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The file that writing would overwrite.
    pub fn would_replace(&self) -> OverwriteRisk {
        let path = &self.path;
        let own = self.own.as_ref().filter(|(own, _)| own == path || file::is_same_place(own, path));
        let Some((_, stamp)) = own else {
            return if path.exists() { OverwriteRisk::OtherFile } else { OverwriteRisk::Nothing };
        };
        match stamp {
            Some(stamp) if !stamp.is_outdated(path) => OverwriteRisk::Nothing,
            // A recovered document: the state of its file at that time is unknown.
            None if !path.exists() => OverwriteRisk::Nothing,
            _ => OverwriteRisk::ChangedByOthers,
        }
    }

    /// Writes the file. On failure it is unchanged.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(self) -> Result<Saved, FileError> {
        let stamp = file::save_stamped(&self.scene, &self.path)?;
        Ok(Saved { path: self.path, stamp, mark: self.mark })
    }
}

impl Document {
    /// An order to save the document in its current state to a path.
    pub fn save_order(&self, path: &Path) -> SaveOrder {
        let own = self.path.clone().map(|own| (own, self.stamp));
        SaveOrder { scene: Arc::clone(self.resting()), mark: self.state.mark, path: path.to_path_buf(), own }
    }

    /// Makes the written file the document's file; edits made since the order stay unsaved changes.
    pub fn take_saved(&mut self, saved: Saved) {
        let Saved { path, stamp, mark } = saved;
        (self.path, self.stamp, self.saved) = (Some(path), Some(stamp), Some(mark));
    }
}
