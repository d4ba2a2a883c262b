//! Loading and saving of scenes. An interrupted save leaves either the old file or the new one.

mod backup;
mod leftovers;
mod stamp;
mod target;
mod write_step;
mod writer;

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

use super::read::parse_by;
use super::watch::{BYTES_READ, PARSED};
use super::{FileError, parse, to_json};
use crate::limits::{MAX_ATTACHMENT_BYTES, MAX_FILE_BYTES};
use crate::{Scene, check};
pub use backup::{KEPT_BACKUPS, backup_path};
use isolith_jobs::Task;
pub use leftovers::{keep_records_in, random_name, remove_leftovers};
pub use stamp::Stamp;
pub use target::{create_private_folder, is_same_place};
use write_step::plain;
pub use write_step::{WriteError, WriteStep};
pub use writer::{check_writable, replace};

/// Reads a scene file.
pub fn load(path: &Path) -> Result<Scene, FileError> {
    load_stamped(path, &Task::new("Reading")).map(|(scene, _)| scene)
}

/// Reads a scene file as a part of a task. Returns the file's stamp too, to find out later whether the file has
/// changed. A canceled task ends with an error.
pub fn load_stamped(path: &Path, task: &Task) -> Result<(Scene, Stamp), FileError> {
    // Metadata first: a file that changes while it is read then counts as changed afterward.
    let metadata = fs::metadata(path);
    let bytes = bytes_of(path, MAX_FILE_BYTES)?;
    task.check().map_err(|canceled| FileError::new(path, canceled.to_string()))?;
    task.set_progress(BYTES_READ);
    let stamp = Stamp::of(&bytes, metadata.ok().as_ref());
    let scene = parse_by(&bytes, path, task)?;
    task.set_progress(PARSED);
    Ok((scene, stamp))
}

/// The bytes of a file to be embedded in the scene.
pub fn attachment(path: &Path) -> Result<Vec<u8>, FileError> {
    bytes_of(path, MAX_ATTACHMENT_BYTES as u64)
}

/// The contents of a file. The size is checked before the contents are read.
fn bytes_of(path: &Path, most: u64) -> Result<Vec<u8>, FileError> {
    let fail = |e: io::Error| FileError::new(path, format!("cannot be read: {}", plain(&e)));
    let metadata = fs::metadata(path).map_err(fail)?;
    if !metadata.is_file() {
        return Err(FileError::new(path, "is not a file"));
    }
    let mut bytes = Vec::new();
    if metadata.len() <= most {
        // Reads one byte more than allowed, to detect a file that has grown meanwhile.
        File::open(path).and_then(|f| f.take(most + 1).read_to_end(&mut bytes)).map_err(fail)?;
    }
    if metadata.len() > most || bytes.len() as u64 > most {
        return Err(FileError::new(path, format!("is larger than {} MiB", most >> 20)));
    }
    Ok(bytes)
}

/// Writes a scene file. It parses and compares the text before it touches the old file. The old contents stay beside
/// the file as backups: `name~`, and older ones as `name~2~`, `name~3~`. On failure the file is unchanged.
///
/// Links are followed: the write goes to the file that the link leads to.
pub fn save(scene: &Scene, path: &Path) -> Result<(), FileError> {
    save_stamped(scene, path).map(|_| ())
}

/// Like [`save`]; returns the stamp of the written file.
pub fn save_stamped(scene: &Scene, path: &Path) -> Result<Stamp, FileError> {
    let json = to_json(scene).map_err(|e| FileError { file: path.display().to_string(), ..e })?;
    if json.len() as u64 > MAX_FILE_BYTES {
        return Err(FileError::new(path, format!("would be larger than {} MiB", MAX_FILE_BYTES >> 20)));
    }
    let again = parse(json.as_bytes(), path)?;
    if !is_same(scene, &again) {
        return Err(FileError::new(path, "would not read back as it is; nothing was written"));
    }
    replace(path, json.as_bytes(), KEPT_BACKUPS)
        .map_err(|e| FileError::new(path, format!("cannot be saved ({}): {}", e.step.label(), plain(&e.error))))?;
    Ok(Stamp::of(json.as_bytes(), fs::metadata(path).ok().as_ref()))
}

/// Whether both are equal, except for rotations that writing normalizes.
fn is_same(scene: &Scene, again: &Scene) -> bool {
    let nodes = || scene.nodes().iter().zip(again.nodes());
    scene.environment == again.environment
        && scene.display == again.display
        && scene.next_id() == again.next_id()
        && scene.materials() == again.materials()
        && scene.nodes().len() == again.nodes().len()
        && nodes().all(|(a, b)| a == b || check::settled((**a).clone()) == **b)
}
