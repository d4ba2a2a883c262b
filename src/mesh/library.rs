//! Every mesh of a scene, loaded once.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::resolve::{inside, read_file};
use super::{MeshError, TriangleMesh, parse};
use crate::guard::guarded;

/// The meshes that a scene names, by their paths relative to the scene's folder. Failures are kept
/// too, so that a broken file is read once and not once per frame.
#[derive(Debug, Default)]
pub struct MeshLibrary {
    folder: Option<PathBuf>,
    loaded: HashMap<String, Result<Arc<TriangleMesh>, Arc<MeshError>>>,
}

impl MeshLibrary {
    /// A library for scenes in `folder`; without one (a scene that was never saved) nothing is found.
    pub fn new(folder: Option<PathBuf>) -> Self {
        Self { folder, loaded: HashMap::new() }
    }

    /// The folder that paths are relative to.
    pub fn folder(&self) -> Option<&Path> {
        self.folder.as_deref()
    }

    /// Moves to another folder, and forgets everything where it is another one.
    pub fn set_folder(&mut self, folder: Option<PathBuf>) {
        if self.folder != folder {
            *self = Self::new(folder);
        }
    }

    /// Forgets everything, so that changed files are read again.
    pub fn forget(&mut self) {
        self.loaded.clear();
    }

    /// The mesh in the file of this name, from memory if it was asked for before. The path must stay
    /// inside the folder; the error names it as the scene does.
    pub fn get(&mut self, path: &str) -> Result<Arc<TriangleMesh>, Arc<MeshError>> {
        if let Some(known) = self.loaded.get(path) {
            return known.clone();
        }
        let broken = |reason| Err(MeshError { file: path.to_owned(), place: String::new(), reason });
        let result = guarded(|| self.read(path)).unwrap_or_else(broken).map(Arc::new).map_err(Arc::new);
        self.loaded.insert(path.to_owned(), result.clone());
        result
    }

    fn read(&self, path: &str) -> Result<TriangleMesh, MeshError> {
        let refuse = |reason: String| MeshError { file: path.to_owned(), place: String::new(), reason };
        let Some(folder) = &self.folder else {
            return Err(refuse("the scene has no folder to look in until it is saved".into()));
        };
        let file = inside(folder, path).map_err(refuse)?;
        let bytes = read_file(&file).map_err(refuse)?;
        // What the glTF names must lie beside it or below, as for any glTF.
        parse(&bytes, Path::new(path), file.parent())
    }
}
