//! Backups: older contents of a file, kept beside it.

use std::ffi::OsString;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::leftovers::Temporary;
use super::stamp::hash;
use super::target::is_one_file;
use super::write_step::{Calls, WriteError, WriteStep};

/// Number of backups kept of a scene.
pub const KEPT_BACKUPS: usize = 3;
/// Longest name of a file on the file systems in use, in bytes.
const MAX_NAME_BYTES: usize = 255;

/// The name of the backup of a generation; 1 is the latest: `name~`, `name~2~`, `name~3~`. A name that would get too
/// long is cut and gets a hash of the whole name as its end.
pub fn backup_path(target: &Path, generation: usize) -> PathBuf {
    let suffix = if generation == 1 { "~".to_owned() } else { format!("~{generation}~") };
    let name = target.file_name().unwrap_or_default();
    let mut backup = OsString::from(name);
    if name.len() + suffix.len() > MAX_NAME_BYTES {
        let whole = hash(name.as_encoded_bytes());
        let name = name.to_string_lossy();
        let mut end = MAX_NAME_BYTES - 17 - suffix.len();
        while !name.is_char_boundary(end) {
            end -= 1;
        }
        backup = format!("{}-{whole:016x}", &name[..end]).into();
    }
    backup.push(suffix);
    target.with_file_name(backup)
}

/// Rotates the backups: the target becomes the first, the first the second and so on. At every moment each name leads
/// to a complete file, or to none where there was none.
pub(super) fn keep(calls: &mut Calls<'_>, target: &Path, generations: usize) -> Result<(), WriteError> {
    let metadata = |path: &Path| fs::symlink_metadata(path).ok();
    if let (Some(now), Some(kept)) = (metadata(target), metadata(&backup_path(target, 1)))
        && is_one_file(&now, &kept)
    {
        // An earlier save did this step and failed afterward.
        return Ok(());
    }
    for generation in (0..generations).rev() {
        let from = if generation == 0 { target.to_path_buf() } else { backup_path(target, generation) };
        if metadata(&from).is_some() {
            rename_copy(calls, &from, &backup_path(target, generation + 1))?;
        }
    }
    Ok(())
}

/// Gives a file an additional name in one step, replacing any file of that name.
fn rename_copy(calls: &mut Calls<'_>, from: &Path, to: &Path) -> Result<(), WriteError> {
    let temporary = calls.call(WriteStep::Backup, || Temporary::beside(to))?;
    // Not every file system has hard links.
    if calls.call(WriteStep::Backup, || fs::hard_link(from, temporary.path())).is_err() {
        calls.call(WriteStep::Backup, || copy(from, &temporary))?;
    }
    calls.call(WriteStep::Backup, || fs::rename(temporary.path(), to))
}

fn copy(from: &Path, to: &Temporary) -> io::Result<()> {
    let mut source = fs::File::open(from)?;
    let mut file = to.create(true)?;
    io::copy(&mut source, &mut file)?;
    super::target::keep_owner_and_mode(&file, &source.metadata()?)?;
    file.sync_all()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_backups_are_never_too_long_and_differ() {
        let name = |length: usize| PathBuf::from("folder").join("é".repeat(length / 2) + &"x".repeat(length % 2));
        assert_eq!(backup_path(Path::new("a/scene.json"), 1), Path::new("a/scene.json~"));
        assert_eq!(backup_path(Path::new("a/scene.json"), 3), Path::new("a/scene.json~3~"));
        for length in [200, 251, 252, 253, 254, 255] {
            let backups = [1, 2, 3].map(|generation| backup_path(&name(length), generation));
            for backup in &backups {
                assert!(backup.file_name().unwrap().len() <= MAX_NAME_BYTES, "{length}");
                assert_eq!(backup.parent(), Some(Path::new("folder")));
            }
            assert!(backups[0] != backups[1] && backups[1] != backups[2]);
        }
        let [a, b] = ["a", "b"].map(|end| PathBuf::from("n".repeat(254) + end));
        assert_ne!(backup_path(&a, 1), backup_path(&b, 1));
    }
}
