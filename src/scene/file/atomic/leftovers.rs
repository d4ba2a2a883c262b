//! Temporary files, and the proof whose they are.
//!
//! A temporary is made beside the file that it will become, so that renaming it is one step. For each one a record is
//! kept in a folder of this user: a locked file that holds the temporary's path. The lock dies with the process. So a
//! temporary is removed only if it stands in a record of ours that nobody holds any more; what else lies in the folders
//! of scenes is never touched, whatever it is called.

use std::fs::{self, File, OpenOptions};
use std::hash::{BuildHasher, RandomState};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::time::Duration;

use super::target::{create_private_folder, folder_of};

/// Longest path in a record, in bytes.
const MAX_RECORD: u64 = 1 << 16;
/// A record without contents belongs to a process that is just making it, unless it is older than this.
const IN_THE_MAKING: Duration = Duration::from_secs(60);

static RECORDS: OnceLock<PathBuf> = OnceLock::new();

/// Keeps records of temporaries in this folder, for the life of the program. Without, temporaries of a killed process
/// stay where they are. Only the first call counts.
pub fn keep_records_in(folder: &Path) {
    // It is made when the first record is.
    let _ = RECORDS.set(folder.to_path_buf());
}

/// Removes the temporaries of processes that have died. Nothing is lost where this fails: the next time tries again.
pub fn remove_leftovers() {
    let Some(entries) = RECORDS.get().and_then(|folder| fs::read_dir(folder).ok()) else { return };
    for entry in entries.flatten() {
        remove_leftover(&entry.path());
    }
}

fn remove_leftover(record: &Path) {
    // Not a link, nor a pipe that would block.
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

/// Whether this is a path as [`Temporary::beside`] makes them.
fn is_temporary(path: &Path) -> bool {
    let name = path.file_name().and_then(|name| name.to_str());
    let random = name.and_then(|name| name.strip_prefix(".isolith-")?.strip_suffix(".tmp"));
    path.is_absolute() && random.is_some_and(|r| r.len() == 32 && r.bytes().all(|b| b.is_ascii_hexdigit()))
}

/// A name that nobody can guess: 128 random bits from the system's source.
pub fn random_name() -> String {
    // Each of these is keyed by random numbers of the system.
    let bits = || RandomState::new().hash_one(std::process::id());
    format!("{:016x}{:016x}", bits(), bits())
}

/// A temporary file; removed when it goes out of scope, unless it has been renamed by then.
pub(super) struct Temporary {
    path: PathBuf,
    _record: Option<Record>,
}

impl Temporary {
    /// A name for one in the folder of `target`, short whatever the target's length. Nothing is made yet.
    pub fn beside(target: &Path) -> io::Result<Self> {
        let folder = folder_of(target).ok_or(io::ErrorKind::InvalidFilename)?;
        let path = folder.join(format!(".isolith-{}.tmp", random_name()));
        let record = Record::of(&path);
        Ok(Self { path, _record: record })
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Makes the file; fails where anything is there, a link as well. A private one is for its owner only until its
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

/// The record of a temporary; its file is locked as long as this lives.
struct Record {
    path: PathBuf,
    _locked: File,
}

impl Record {
    /// Where no record can be made, the temporary goes without: then it stays if the process is killed.
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
        // One that names a file which cannot be a temporary, one in the making, one that is no file.
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
