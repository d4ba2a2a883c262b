//! Scenes to disk and back. A save leaves the old file or the new one, whenever it is cut off.

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

/// Reads a scene file as a part of a task, and returns with it how the file was, to find out later whether it has changed.
/// One that is canceled ends with an error.
pub fn load_stamped(path: &Path, task: &Task) -> Result<(Scene, Stamp), FileError> {
    // Looked at first: a file that is changed while it is read counts as changed afterward.
    let metadata = fs::metadata(path);
    let bytes = bytes_of(path, MAX_FILE_BYTES)?;
    task.check().map_err(|canceled| FileError::new(path, canceled.to_string()))?;
    task.set_progress(BYTES_READ);
    let stamp = Stamp::of(&bytes, metadata.ok().as_ref());
    let scene = parse_by(&bytes, path, task)?;
    task.set_progress(PARSED);
    Ok((scene, stamp))
}

/// The bytes of a file that a shape is to keep.
pub fn attachment(path: &Path) -> Result<Vec<u8>, FileError> {
    bytes_of(path, MAX_ATTACHMENT_BYTES as u64)
}

/// The contents of a file. Its size is checked before they are read.
fn bytes_of(path: &Path, most: u64) -> Result<Vec<u8>, FileError> {
    let fail = |e: io::Error| FileError::new(path, format!("cannot be read: {}", plain(&e)));
    let metadata = fs::metadata(path).map_err(fail)?;
    if !metadata.is_file() {
        return Err(FileError::new(path, "is not a file"));
    }
    let mut bytes = Vec::new();
    if metadata.len() <= most {
        // One byte more than allowed tells of a file that has grown meanwhile.
        File::open(path).and_then(|f| f.take(most + 1).read_to_end(&mut bytes)).map_err(fail)?;
    }
    if metadata.len() > most || bytes.len() as u64 > most {
        return Err(FileError::new(path, format!("is larger than {} MiB", most >> 20)));
    }
    Ok(bytes)
}

/// Writes a scene file. What is written is read again and compared before the old file is touched; the
/// old contents stay beside it as backups: `name~`, and older ones as `name~2~`, `name~3~`. On failure the
/// file is what it was.
///
/// A link is followed: the file that it leads to is written.
pub fn save(scene: &Scene, path: &Path) -> Result<(), FileError> {
    save_stamped(scene, path).map(|_| ())
}

/// The same; returns how the file is now.
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

/// Equal, but for rotations that writing settles.
fn is_same(scene: &Scene, again: &Scene) -> bool {
    let nodes = || scene.nodes().iter().zip(again.nodes());
    scene.environment == again.environment
        && scene.next_id() == again.next_id()
        && scene.materials() == again.materials()
        && scene.nodes().len() == again.nodes().len()
        && nodes().all(|(a, b)| a == b || check::settled((**a).clone()) == **b)
}
