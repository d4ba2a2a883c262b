//! Temporary files, and the proof of their ownership.
//!
//! A temporary stands beside the file that it will become, so that the rename is one step. Each temporary has a record
//! in a folder of this user: a locked file that holds the temporary's path. The lock dies with the process. So a
//! temporary is removed only if one of our records names it and nobody holds that record's lock. Other files in the
//! folders of scenes are never touched, whatever their names.

use std::fs::{self, File, OpenOptions};
use std::hash::{BuildHasher, RandomState};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::time::Duration;

use super::target::{create_private_folder, folder_of};

/// Longest path in a record, in bytes.
const MAX_RECORD: u64 = 1 << 16;
/// An empty record belongs to a process that is creating it, unless the record is older than this.
const IN_THE_MAKING: Duration = Duration::from_secs(60);

static RECORDS: OnceLock<PathBuf> = OnceLock::new();

/// Sets the folder for records of temporaries, for the life of the program. Without it, temporaries of a killed process
/// stay where they are. Only the first call counts.
pub fn keep_records_in(folder: &Path) {
    // The first record creates the folder.
    let _ = RECORDS.set(folder.to_path_buf());
}

/// Removes the temporaries of processes that have died. A failure loses nothing: the next call tries again.
pub fn remove_leftovers() {
    let Some(entries) = RECORDS.get().and_then(|folder| fs::read_dir(folder).ok()) else { return };
    for entry in entries.flatten() {
        remove_leftover(&entry.path());
    }
}

fn remove_leftover(record: &Path) {
    // Skips links, and pipes, which would block.
    if !fs::symlink_metadata(record).is_ok_and(|m| m.is_file()) {
        return;
    }
    let Ok(mut file) = OpenOptions::new().read(true).write(true).open(record) else { return };
    if file.try_lock().is_err() {
        return;
    }
    let mut text = String::new();
    if Read::by_ref(&mut file).take(MAX_RECORD).read_to_string(&mut text).is_err() {
        return;
    }
    if text.is_empty() {
        let age = file.metadata().and_then(|m| m.modified()).ok().and_then(|t| t.elapsed().ok());
        if age.is_none_or(|age| age < IN_THE_MAKING) {
            return;
        }
    }
    let temporary = Path::new(&text);
    if is_temporary(temporary) && fs::symlink_metadata(temporary).is_ok_and(|m| m.is_file()) {
        match fs::remove_file(temporary) {
            Err(e) if e.kind() != io::ErrorKind::NotFound => return,
            _ => {}
        }
    }
    let _ = fs::remove_file(record);
}

/// Whether the path has the form that [`Temporary::beside`] gives it.
fn is_temporary(path: &Path) -> bool {
    let name = path.file_name().and_then(|name| name.to_str());
    let random = name.and_then(|name| name.strip_prefix(".isolith-")?.strip_suffix(".tmp"));
    path.is_absolute() && random.is_some_and(|r| r.len() == 32 && r.bytes().all(|b| b.is_ascii_hexdigit()))
}

/// An unguessable name: 128 random bits from the system's source.
pub fn random_name() -> String {
    // The system seeds each of these with random numbers.
    let bits = || RandomState::new().hash_one(std::process::id());
    format!("{:016x}{:016x}", bits(), bits())
}

/// A temporary file. Dropping it removes the file unless it has been renamed.
pub(super) struct Temporary {
    path: PathBuf,
    _record: Option<Record>,
}

impl Temporary {
    /// A short name for a temporary in the folder of `target`, whatever the target's length. Creates nothing yet.
    pub fn beside(target: &Path) -> io::Result<Self> {
        let folder = folder_of(target).ok_or(io::ErrorKind::InvalidFilename)?;
        let path = folder.join(format!(".isolith-{}.tmp", random_name()));
        let record = Record::of(&path);
        Ok(Self { path, _record: record })
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Creates the file; fails if anything stands there, even a link. Only the owner may access a private one until its
    /// mode is set.
    pub fn create(&self, private: bool) -> io::Result<File> {
        let mut options = OpenOptions::new();
        options.write(true).create_new(true);
        #[cfg(unix)]
        if private {
            std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
        }
        #[cfg(not(unix))]
        let _ = private;
        options.open(&self.path)
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.path);
    }
}

/// The record of a temporary; its file stays locked for the lifetime of this value.
struct Record {
    path: PathBuf,
    _locked: File,
}

impl Record {
    /// A temporary whose record cannot be created goes without one: it then stays if the process is killed.
    fn of(temporary: &Path) -> Option<Self> {
        let folder = RECORDS.get()?;
        let text = std::path::absolute(temporary).ok()?;
        let text = text.to_str()?;
        create_private_folder(folder).ok()?;
        let path = folder.join(random_name());
        let mut file = OpenOptions::new().write(true).create_new(true).open(&path).ok()?;
        let kept = file.try_lock().is_ok() && file.write_all(text.as_bytes()).is_ok();
        let record = Self { path, _locked: file };
        kept.then_some(record)
    }
}

impl Drop for Record {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.path);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_a_record_of_the_dead_names_is_removed() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let names = ["a", "b", "c"].map(|c| format!(".isolith-{}.tmp", c.repeat(32)));
        let [dead, alive, unnamed] = names.each_ref().map(|name| at(name));
        let files = [&dead, &alive, &unnamed, &at("scene.json"), &at(".scene.json.tmp-4000000000-0")];
        files.iter().for_each(|path| fs::write(path, "half").unwrap());
        let record = |name: &str, of: &Path| {
            fs::write(at(name), of.to_str().unwrap()).unwrap();
            at(name)
        };
        let (first, second) = (record("first", &dead), record("second", &alive));
        let owner = File::open(&second).unwrap();
        owner.lock().unwrap();
        // A record that names a file which cannot be a temporary, a record being created, a record that is not a file.
        let third = record("third", &at("scene.json"));
        fs::write(at("fourth"), "").unwrap();
        for path in [&first, &second, &third, &at("fourth"), folder.path()] {
            remove_leftover(path);
        }
        let there = |paths: &[&Path]| paths.iter().map(|p| p.exists()).collect::<Vec<_>>();
        assert_eq!(there(&[&dead, &first, &third]), [false; 3]);
        assert_eq!(there(&[&alive, &unnamed, &second, &at("fourth"), &at("scene.json")]), [true; 5]);
        assert!(at(".scene.json.tmp-4000000000-0").exists());
        drop(owner);
        remove_leftover(&second);
        assert_eq!(there(&[&alive, &second]), [false; 2]);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_in_place_of_a_temporary_is_neither_written_through_nor_removed() {
        let folder = tempfile::tempdir().unwrap();
        let precious = folder.path().join("precious");
        fs::write(&precious, "keep me").unwrap();
        let temporary = Temporary::beside(&folder.path().join("x.png")).unwrap();
        std::os::unix::fs::symlink("precious", temporary.path()).unwrap();
        assert_eq!(temporary.create(false).unwrap_err().kind(), io::ErrorKind::AlreadyExists);
        let record = folder.path().join("record");
        fs::write(&record, temporary.path().to_str().unwrap()).unwrap();
        remove_leftover(&record);
        assert!(fs::symlink_metadata(temporary.path()).unwrap().is_symlink());
        drop(temporary);
        assert_eq!(fs::read_to_string(&precious).unwrap(), "keep me");
    }

    #[test]
    fn names_are_short_and_never_the_same() {
        let mut names: Vec<_> = (0..1_000).map(|_| random_name()).collect();
        names.sort();
        names.dedup();
        assert_eq!(names.len(), 1_000);
        assert!(names.iter().all(|name| name.len() == 32));
    }
}
