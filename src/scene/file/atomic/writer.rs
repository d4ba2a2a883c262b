//! The only way in which this program writes a file: write beside it, sync, rename, sync the folder. A reader sees the
//! old file or the new one, even if the write is interrupted.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::backup;
use super::leftovers::Temporary;
use super::target::{existing, folder_of, keep_owner_and_mode, resolved, sync_folder};
use super::write_step::{Calls, WriteError, WriteStep};

/// Replaces the contents of a file with `bytes`, and keeps this many generations of earlier contents.
///
/// Links are followed: the write goes to the file that the link leads to. The file keeps its mode, and its owner if the
/// system allows it.
pub fn replace(path: &Path, bytes: &[u8], backups: usize) -> Result<(), WriteError> {
    replace_by(&mut Calls { before: &mut |_| Ok(()) }, path, bytes, backups)
}

/// Fails as the first steps of [`replace`] would. To be called before work whose result could not be written.
pub fn check_writable(path: &Path) -> Result<(), WriteError> {
    let calls = &mut Calls { before: &mut |_| Ok(()) };
    let (target, _) = look(calls, path)?;
    let temporary = calls.call(WriteStep::Create, || Temporary::beside(&target))?;
    calls.call(WriteStep::Create, || temporary.create(true)).map(|_| ())
}

fn look(calls: &mut Calls<'_>, path: &Path) -> Result<(PathBuf, Option<fs::Metadata>), WriteError> {
    let target = calls.call(WriteStep::Resolve, || resolved(path))?;
    let old = calls.call(WriteStep::Resolve, || existing(&target))?;
    calls.call(WriteStep::Resolve, || match (target.file_name(), folder_of(&target)) {
        (Some(_), Some(_)) => Ok(()),
        _ => Err(io::ErrorKind::InvalidFilename.into()),
    })?;
    Ok((target, old))
}

fn replace_by(calls: &mut Calls<'_>, path: &Path, bytes: &[u8], backups: usize) -> Result<(), WriteError> {
    let (target, old) = look(calls, path)?;
    let temporary = calls.call(WriteStep::Create, || Temporary::beside(&target))?;
    let mut file = calls.call(WriteStep::Create, || temporary.create(old.is_some()))?;
    calls.call(WriteStep::Write, || file.write_all(bytes))?;
    if let Some(old) = &old {
        calls.call(WriteStep::Mode, || keep_owner_and_mode(&file, old))?;
    }
    calls.call(WriteStep::Sync, || file.sync_all())?;
    drop(file);
    // Saving identical contents again must not push older contents out.
    let is_same = |old: &fs::Metadata| old.len() == bytes.len() as u64 && fs::read(&target).is_ok_and(|b| b == bytes);
    if backups > 0 && old.as_ref().is_some_and(|old| !is_same(old)) {
        backup::keep(calls, &target, backups)?;
    }
    calls.call(WriteStep::Rename, || fs::rename(temporary.path(), &target))?;
    calls.call(WriteStep::SyncFolder, || sync_folder(&target))
}

#[cfg(test)]
mod tests {
    use std::io::ErrorKind;

    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> =
            fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    fn text(folder: &Path, name: &str) -> Option<String> {
        fs::read_to_string(folder.join(name)).ok()
    }

    /// Saves over three generations while the call of this number fails with this error. Returns the step that failed,
    /// and whether the save failed.
    fn with_one_failure(number: usize, kind: ErrorKind) -> Option<(WriteStep, bool)> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.json");
        for text in ["first", "second", "third", "old"] {
            replace(&path, text.as_bytes(), 3).unwrap();
        }
        let (mut count, mut failed) = (0, None);
        let mut before = |step| {
            count += 1;
            if count - 1 == number {
                failed = Some(step);
                return Err(kind.into());
            }
            Ok(())
        };
        let result = replace_by(&mut Calls { before: &mut before }, &path, b"new", 3);
        let step = failed?;
        let shown = text(folder.path(), "scene.json").unwrap();
        match &result {
            Ok(()) => assert_eq!(shown, "new", "{step:?}"),
            Err(error) => {
                assert_eq!((error.step, error.error.kind()), (step, kind));
                assert!(error.to_string().len() > 20, "{error}");
                // Only the rename puts the new file there.
                assert_eq!(shown, if step == WriteStep::SyncFolder { "new" } else { "old" }, "call {number}: {step:?}");
            }
        }
        // After any failure: no partial file, no leftovers, and only the oldest contents may be gone.
        assert_eq!(names(folder.path()), ["scene.json", "scene.json~", "scene.json~2~", "scene.json~3~"]);
        let all: Vec<_> = names(folder.path()).iter().map(|name| text(folder.path(), name).unwrap()).collect();
        for kept in ["old", "third", "second"] {
            assert!(all.iter().any(|text| text == kept), "call {number}: {step:?}: {kept} is not in {all:?}");
        }
        assert!(all.iter().all(|text| ["new", "old", "third", "second", "first"].contains(&text.as_str())), "{all:?}");
        Some((step, result.is_err()))
    }

    #[test]
    fn whichever_call_fails_nothing_is_lost_and_nothing_is_left_over() {
        let mut fatal = Vec::new();
        for kind in [ErrorKind::StorageFull, ErrorKind::PermissionDenied, ErrorKind::ReadOnlyFilesystem] {
            let failures: Vec<_> = (0..).map_while(|number| with_one_failure(number, kind)).collect();
            assert!(failures.len() >= 18, "only {} calls", failures.len());
            // Failing calls that do not fail the save: a hard link, which is then copied.
            assert_eq!(failures.iter().filter(|(step, failed)| *step == WriteStep::Backup && !failed).count(), 3);
            fatal = failures.iter().filter(|(_, failed)| *failed).map(|(step, _)| *step).collect();
        }
        fatal.dedup();
        use WriteStep::{Backup, Create, Mode, Rename, Resolve, Sync, SyncFolder, Write};
        assert_eq!(fatal, [Resolve, Create, Write, Mode, Sync, Backup, Rename, SyncFolder], "the steps come in order");
    }

    #[test]
    fn three_generations_are_kept_and_the_same_again_is_none() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.json");
        for text in ["1", "2", "2", "3", "4", "5", "5", "5"] {
            replace(&path, text.as_bytes(), 3).unwrap();
        }
        let kept = ["scene.json", "scene.json~", "scene.json~2~", "scene.json~3~"];
        assert_eq!(kept.map(|name| text(folder.path(), name).unwrap()), ["5", "4", "3", "2"]);
        assert_eq!(names(folder.path()), kept);
        // Pictures have no backups.
        replace(&folder.path().join("x.png"), b"1", 0).unwrap();
        replace(&folder.path().join("x.png"), b"2", 0).unwrap();
        assert_eq!(names(folder.path()).len(), 5);
    }

    #[test]
    fn saves_that_fail_again_and_again_push_no_backup_out() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.json");
        ["1", "2", "3", "4"].iter().for_each(|text| replace(&path, text.as_bytes(), 3).unwrap());
        for _ in 0..5 {
            let mut before = |step| if step == WriteStep::Rename { Err(ErrorKind::StorageFull.into()) } else { Ok(()) };
            replace_by(&mut Calls { before: &mut before }, &path, b"new", 3).unwrap_err();
        }
        let kept = ["scene.json", "scene.json~", "scene.json~2~", "scene.json~3~"];
        assert_eq!(kept.map(|name| text(folder.path(), name).unwrap()), ["4", "4", "3", "2"]);
    }

    #[test]
    fn names_as_long_as_the_system_allows_are_written() {
        let folder = tempfile::tempdir().unwrap();
        for length in [245, 254, 255] {
            let path = folder.path().join("n".repeat(length));
            for text in ["1", "2", "3"] {
                replace(&path, text.as_bytes(), 3).unwrap();
                assert_eq!(fs::read_to_string(&path).unwrap(), text);
            }
            assert_eq!(fs::read_to_string(backup::backup_path(&path, 2)).unwrap(), "1");
        }
        assert_eq!(names(folder.path()).len(), 9);
    }

    #[cfg(unix)]
    #[test]
    fn a_temporary_is_never_more_readable_than_the_file() {
        use std::os::unix::fs::PermissionsExt;
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o7777;
        for wanted in [0o600, 0o640, 0o644, 0o755, 0o200] {
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join("secret.json");
            fs::write(&path, "old").unwrap();
            fs::set_permissions(&path, fs::Permissions::from_mode(wanted)).unwrap();
            let mut looser = Vec::new();
            let mut before = |_| {
                for entry in fs::read_dir(folder.path()).unwrap() {
                    let mode = mode(&entry.unwrap().path());
                    // The owner's bits are exempt: an owner can grant them to himself anyway.
                    if mode & 0o077 & !wanted != 0 {
                        looser.push(mode);
                    }
                }
                Ok(())
            };
            replace_by(&mut Calls { before: &mut before }, &path, b"new", 3).unwrap();
            assert!(looser.is_empty(), "{wanted:o}: {looser:?}");
            assert_eq!(mode(&path), wanted);
        }
    }

    /// Only root can give files away; for other users the test shows that the failure does no harm.
    #[cfg(unix)]
    #[test]
    fn owner_and_group_stay_where_the_system_allows_it() {
        use std::os::unix::fs::{MetadataExt, PermissionsExt, chown};
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("theirs.json");
        fs::write(&path, "old").unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o660)).unwrap();
        let given_away = chown(&path, Some(4_321), Some(1_234)).is_ok();
        let before = fs::metadata(&path).unwrap();
        assert_eq!(given_away, (before.uid(), before.gid()) == (4_321, 1_234));
        replace(&path, b"new", 3).unwrap();
        let now = fs::metadata(&path).unwrap();
        assert_eq!((now.uid(), now.gid(), now.mode()), (before.uid(), before.gid(), before.mode()));
    }
}
