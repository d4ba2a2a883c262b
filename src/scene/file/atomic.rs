//! Scenes to disk and back. A save leaves the old file or the new one, whenever it is cut off.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use super::{FileError, parse, to_json};
use crate::scene::limits::{MAX_ATTACHMENT_BYTES, MAX_FILE_BYTES};
use crate::scene::{Scene, check};

/// Reads a scene file.
pub fn load(path: &Path) -> Result<Scene, FileError> {
    parse(&bytes_of(path, MAX_FILE_BYTES)?, path)
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
/// old contents stay beside it as a backup with a `~` behind the name. On failure the file is what it was.
///
/// A link is followed: the file that it leads to is written.
pub fn save(scene: &Scene, path: &Path) -> Result<(), FileError> {
    let json = to_json(scene).map_err(|e| FileError { file: path.display().to_string(), ..e })?;
    if json.len() as u64 > MAX_FILE_BYTES {
        return Err(FileError::new(path, format!("would be larger than {} MiB", MAX_FILE_BYTES >> 20)));
    }
    let again = parse(json.as_bytes(), path)?;
    if !is_same(scene, &again) {
        return Err(FileError::new(path, "would not read back as it is; nothing was written"));
    }
    replace(path, json.as_bytes(), &mut |_| Ok(()))
        .map_err(|(step, e)| FileError::new(path, format!("cannot be saved ({}): {}", step.label(), plain(&e))))
}

/// Removes the temporary files that savers of this file left when they were killed. Those of processes
/// that still run are left alone; where the system does not tell, those of the last day are.
pub fn remove_leftovers(path: &Path) {
    let Ok(target) = resolved(path) else { return };
    let (Some(folder), Some(prefix)) = (folder_of(&target), temporary_prefix(&target)) else { return };
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let process = name.to_str().and_then(|n| n.strip_prefix(&prefix)?.split('-').next()?.parse::<u32>().ok());
        if process.is_some_and(|id| is_gone(id).unwrap_or_else(|| is_old(&entry))) {
            // Nothing is lost where this fails: the next time tries again.
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// What a save does, in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Step {
    /// Follow links and look at the file that stands there.
    Look,
    /// Make the temporary file beside it.
    Create,
    /// Write the bytes.
    Write,
    /// Have them on the disk.
    Sync,
    /// Give the old contents a second name.
    Backup,
    /// Put the new in the place of the old.
    Rename,
    /// Have the names on the disk.
    SyncFolder,
}

impl Step {
    /// For messages.
    fn label(self) -> &'static str {
        match self {
            Self::Look => "looking at the file",
            Self::Create => "making a temporary file beside it",
            Self::Write => "writing the temporary file",
            Self::Sync => "flushing to the disk",
            Self::Backup => "keeping the old file as a backup",
            Self::Rename => "replacing the old file",
            Self::SyncFolder => "flushing the folder to the disk",
        }
    }
}

type Failure = (Step, io::Error);

/// Puts `bytes` in the place of a file. `before` is called before each step and can fail it: for tests.
fn replace(path: &Path, bytes: &[u8], before: &mut dyn FnMut(Step) -> io::Result<()>) -> Result<(), Failure> {
    let mut step = |step: Step, work: &mut dyn FnMut() -> io::Result<()>| {
        before(step).and_then(|()| work()).map_err(|e| (step, e))
    };
    let mut target = PathBuf::new();
    let mut old = None;
    step(Step::Look, &mut || {
        target = resolved(path)?;
        old = existing(&target)?;
        Ok(())
    })?;
    let temporary = Temporary::beside(&target).ok_or((Step::Look, io::ErrorKind::InvalidFilename.into()))?;
    let mut file = None;
    step(Step::Create, &mut || {
        file = Some(OpenOptions::new().write(true).create_new(true).open(&temporary.path)?);
        Ok(())
    })?;
    let Some(mut file) = file else { return Ok(()) };
    step(Step::Write, &mut || file.write_all(bytes))?;
    step(Step::Sync, &mut || {
        if let Some(metadata) = &old {
            file.set_permissions(metadata.permissions())?;
        }
        file.sync_all()
    })?;
    drop(file);
    if old.is_some() {
        step(Step::Backup, &mut || back_up(&target))?;
    }
    step(Step::Rename, &mut || fs::rename(&temporary.path, &target))?;
    step(Step::SyncFolder, &mut || sync_folder(&target))
}

/// The temporary file; removed when it goes out of scope, unless it has been renamed by then.
struct Temporary {
    path: PathBuf,
}

impl Temporary {
    fn beside(target: &Path) -> Option<Self> {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        let count = COUNT.fetch_add(1, Ordering::Relaxed);
        let name = format!("{}{}-{count}", temporary_prefix(target)?, std::process::id());
        Some(Self { path: folder_of(target)?.join(name) })
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.path);
    }
}

/// How the names of a file's temporaries begin: `.name.tmp-`, the name cut where it would get too long.
fn temporary_prefix(target: &Path) -> Option<String> {
    let name = target.file_name()?.to_string_lossy();
    let mut end = name.len().min(200);
    while !name.is_char_boundary(end) {
        end -= 1;
    }
    Some(format!(".{}.tmp-", &name[..end]))
}

fn folder_of(target: &Path) -> Option<&Path> {
    target.parent().map(|folder| if folder.as_os_str().is_empty() { Path::new(".") } else { folder })
}

/// The file that a chain of links leads to; it need not exist.
fn resolved(path: &Path) -> io::Result<PathBuf> {
    let mut at = path.to_path_buf();
    for _ in 0..32 {
        match fs::symlink_metadata(&at) {
            Ok(metadata) if metadata.is_symlink() => {
                let link = fs::read_link(&at)?;
                at = at.parent().unwrap_or(Path::new("")).join(link);
            }
            Ok(_) => return Ok(at),
            Err(e) if e.kind() == io::ErrorKind::NotFound => return Ok(at),
            Err(e) => return Err(e),
        }
    }
    Err(io::Error::other("its links lead in a circle"))
}

/// What stands there now; fails where that must not be replaced.
fn existing(target: &Path) -> io::Result<Option<fs::Metadata>> {
    match fs::metadata(target) {
        Ok(m) if m.is_dir() => Err(io::Error::other("it is a folder")),
        Ok(m) if !m.is_file() => Err(io::Error::other("it is not a file")),
        Ok(m) if m.permissions().readonly() => Err(io::Error::other("it is read-only")),
        Ok(m) => Ok(Some(m)),
        Err(e) if e.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(e) => Err(e),
    }
}

/// Gives the old contents the name of the backup, in one step, so that both names always lead to a whole file.
fn back_up(target: &Path) -> io::Result<()> {
    let mut backup = target.as_os_str().to_owned();
    backup.push("~");
    let temporary = Temporary::beside(target).ok_or(io::ErrorKind::InvalidFilename)?;
    // Not every file system has hard links.
    if fs::hard_link(target, &temporary.path).is_err() {
        fs::copy(target, &temporary.path)?;
    }
    fs::rename(&temporary.path, backup)
}

#[cfg(unix)]
fn sync_folder(target: &Path) -> io::Result<()> {
    File::open(folder_of(target).unwrap_or(Path::new(".")))?.sync_all()
}

/// Elsewhere folders cannot be opened, and renaming is the file system's to keep.
#[cfg(not(unix))]
fn sync_folder(_: &Path) -> io::Result<()> {
    Ok(())
}

/// Whether no process has this id any more; `None` where the system does not tell.
fn is_gone(process: u32) -> Option<bool> {
    let proc = Path::new("/proc");
    proc.join("self").exists().then(|| !proc.join(process.to_string()).exists())
}

/// No save takes a day.
fn is_old(entry: &fs::DirEntry) -> bool {
    let modified = entry.metadata().and_then(|m| m.modified()).ok();
    modified.and_then(|t| t.elapsed().ok()).is_some_and(|age| age > Duration::from_secs(24 * 60 * 60))
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

/// The message without the number that the system has for it.
fn plain(error: &io::Error) -> String {
    let text = error.to_string();
    match text.find(" (os error") {
        Some(end) => text[..end].to_owned(),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEPS: [Step; 7] =
        [Step::Look, Step::Create, Step::Write, Step::Sync, Step::Backup, Step::Rename, Step::SyncFolder];

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> =
            fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    #[test]
    fn whichever_step_fails_the_file_is_whole_and_nothing_is_left_over() {
        for broken in STEPS {
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join("scene.json");
            fs::write(&path, "old").unwrap();
            let mut seen = Vec::new();
            let result = replace(&path, b"new", &mut |step| {
                seen.push(step);
                if step == broken { Err(io::ErrorKind::StorageFull.into()) } else { Ok(()) }
            });
            let (step, error) = result.unwrap_err();
            assert_eq!((step, error.kind()), (broken, io::ErrorKind::StorageFull));
            assert_eq!(seen, STEPS[..seen.len()], "the steps come in order");
            // Only after the renaming does the new file stand there.
            let expected = if broken == Step::SyncFolder { "new" } else { "old" };
            assert_eq!(fs::read_to_string(&path).unwrap(), expected, "{broken:?}");
            let backed_up = matches!(broken, Step::Rename | Step::SyncFolder);
            let expected: &[&str] = if backed_up { &["scene.json", "scene.json~"] } else { &["scene.json"] };
            assert_eq!(names(folder.path()), expected, "{broken:?}");
        }
    }

    #[test]
    fn all_steps_are_taken_and_the_old_file_is_kept() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.json");
        for (text, backup) in [("one", None), ("two", Some("one")), ("three", Some("two"))] {
            let mut seen = Vec::new();
            replace(&path, text.as_bytes(), &mut |step| {
                seen.push(step);
                Ok(())
            })
            .unwrap();
            assert_eq!(seen.contains(&Step::Backup), backup.is_some());
            assert_eq!(fs::read_to_string(&path).unwrap(), text);
            assert_eq!(fs::read_to_string(folder.path().join("scene.json~")).ok().as_deref(), backup);
        }
        assert_eq!(names(folder.path()), ["scene.json", "scene.json~"]);
    }

    #[test]
    fn only_leftovers_of_processes_that_are_gone_are_removed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.json");
        let alive = format!(".scene.json.tmp-{}-7", std::process::id());
        // Process ids end far below this.
        for name in [".scene.json.tmp-4000000000-0", ".other.json.tmp-4000000000-0", ".scene.json.tmp-x", &alive] {
            fs::write(folder.path().join(name), "half").unwrap();
        }
        remove_leftovers(&path);
        let mut kept = vec![".other.json.tmp-4000000000-0".to_owned(), alive, ".scene.json.tmp-x".to_owned()];
        kept.sort();
        assert_eq!(names(folder.path()), kept);
    }
}
