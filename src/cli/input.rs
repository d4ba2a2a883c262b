//! Scene files as the command line names them: `-` is standard input.

use std::io::Read;
use std::path::{Path, PathBuf};

use super::failure::Failure;
use crate::scene::limits::MAX_FILE_BYTES;
use crate::scene::{Scene, file};

/// The path that names standard input or standard output.
const STANDARD: &str = "-";

/// Whether the path names standard input or output.
pub fn is_standard(path: &Path) -> bool {
    path.as_os_str() == STANDARD
}

/// The name of the path in messages.
pub fn shown(path: &Path) -> PathBuf {
    if is_standard(path) { "standard input".into() } else { path.to_path_buf() }
}

/// Reads a scene.
pub fn read_scene(path: &Path) -> Result<Scene, Failure> {
    if !is_standard(path) {
        return file::load(path).map_err(Failure::Scene);
    }
    let mut bytes = Vec::new();
    let read = std::io::stdin().lock().take(MAX_FILE_BYTES + 1).read_to_end(&mut bytes);
    read.map_err(|error| Failure::Scene(file::FileError::new(&shown(path), error.to_string())))?;
    file::parse(&bytes, &shown(path)).map_err(Failure::Scene)
}

/// The base folder for the models of a scene: that of its file, or the current folder for standard input.
pub fn folder(path: &Path) -> Option<PathBuf> {
    if is_standard(path) { Some(PathBuf::from(".")) } else { path.parent().map(Path::to_path_buf) }
}

/// Refuses an argument that is neither a file nor looks like a path: otherwise a mistyped command would count as a
/// scene.
pub fn refuse_unknown_word(path: &Path) -> Result<(), Failure> {
    let is_word = path.components().count() == 1 && path.extension().is_none() && !path.exists();
    if is_word || is_standard(path) {
        let commands = "render, check, bench, pack, unpack, shader, schema, adapters";
        let word = path.display();
        return Err(Failure::Usage(format!("\"{word}\" is neither a file nor a command; the commands are {commands}")));
    }
    Ok(())
}
