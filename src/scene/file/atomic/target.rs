//! The file that a path leads to, and its metadata.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

/// Longest chain of links, as on Linux.
const MAX_LINKS: usize = 40;

/// Whether writing to both paths would write one file: by another spelling, through links, or through a linked folder.
/// Neither needs to exist.
pub fn is_same_place(a: &Path, b: &Path) -> bool {
    match (place(a), place(b)) {
        (Some(a), Some(b)) => a == b,
        _ => false,
    }
}

/// Creates a folder with its parents; new ones are accessible to this user only.
pub fn create_private_folder(path: &Path) -> io::Result<()> {
    let mut builder = fs::DirBuilder::new();
    builder.recursive(true);
    #[cfg(unix)]
    std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
    builder.create(path)
}

/// The real folder of the file that a path leads to, and the file's name.
fn place(path: &Path) -> Option<(PathBuf, OsString)> {
    let target = resolved(path).ok()?;
    let folder = fs::canonicalize(folder_of(&target)?).ok()?;
    let name = target.file_name()?;
    // On these systems, names that differ in case only are the same.
    let folded = cfg!(any(windows, target_os = "macos")).then(|| OsString::from(name.to_string_lossy().to_lowercase()));
    Some((folder, folded.unwrap_or_else(|| name.to_os_string())))
}

/// The folder that a file stands in.
pub(super) fn folder_of(target: &Path) -> Option<&Path> {
    target.parent().map(|folder| if folder.as_os_str().is_empty() { Path::new(".") } else { folder })
}

/// The file that a chain of links leads to; it need not exist.
pub(super) fn resolved(path: &Path) -> io::Result<PathBuf> {
    let mut at = path.to_path_buf();
    for _ in 0..MAX_LINKS {
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

/// The metadata of the file that stands there now; fails if it must not be replaced.
pub(super) fn existing(target: &Path) -> io::Result<Option<fs::Metadata>> {
    match fs::metadata(target) {
        Ok(m) if m.is_dir() => Err(io::Error::other("it is a folder")),
        Ok(m) if !m.is_file() => Err(io::Error::other("it is not a file")),
        Ok(m) if m.permissions().readonly() => Err(io::Error::other("it is read-only")),
        Ok(m) => Ok(Some(m)),
        Err(e) if e.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(e) => Err(e),
    }
}

/// Gives the new file the mode of the old one, and its owner and group if the system allows it. If not, the mode is
/// reduced so that nobody can do more with the new file than with the old one.
#[cfg(unix)]
pub(super) fn keep_owner_and_mode(file: &File, old: &fs::Metadata) -> io::Result<()> {
    use std::os::unix::fs::{MetadataExt, PermissionsExt, fchown};
    let now = file.metadata()?;
    let mut mode = old.permissions().mode() & 0o7777;
    if (now.uid(), now.gid()) != (old.uid(), old.gid()) {
        let both = fchown(file, Some(old.uid()), Some(old.gid())).is_ok();
        let group = both || now.gid() == old.gid() || fchown(file, None, Some(old.gid())).is_ok();
        if !both && now.uid() != old.uid() {
            mode &= 0o777;
        }
        if !group {
            mode = cut_for_another_group(mode);
        }
    }
    match file.set_permissions(fs::Permissions::from_mode(mode)) {
        // The file system has no modes.
        Err(e) if matches!(e.kind(), io::ErrorKind::PermissionDenied | io::ErrorKind::Unsupported) => Ok(()),
        result => result,
    }
}

/// On other systems a new file gets the rights of its folder, and a read-only file is not replaced.
#[cfg(not(unix))]
pub(super) fn keep_owner_and_mode(_: &File, _: &fs::Metadata) -> io::Result<()> {
    Ok(())
}

/// The mode for a file that could not keep its group: another group gets the rights that the old group and others had
/// in common.
#[cfg(unix)]
fn cut_for_another_group(mode: u32) -> u32 {
    let others = (mode & 0o007) << 3;
    (mode & 0o707) | (mode & 0o070 & others)
}

/// Whether both are one file under two names.
#[cfg(unix)]
pub(super) fn is_one_file(a: &fs::Metadata, b: &fs::Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    (a.dev(), a.ino()) == (b.dev(), b.ino())
}

/// Unknown on other systems.
#[cfg(not(unix))]
pub(super) fn is_one_file(_: &fs::Metadata, _: &fs::Metadata) -> bool {
    false
}

/// Syncs the names in the folder of a file to the disk.
#[cfg(unix)]
pub(super) fn sync_folder(target: &Path) -> io::Result<()> {
    File::open(folder_of(target).unwrap_or(Path::new(".")))?.sync_all()
}

/// On other systems folders cannot be opened, and the file system is responsible for the rename.
#[cfg(not(unix))]
pub(super) fn sync_folder(_: &Path) -> io::Result<()> {
    Ok(())
}

#[cfg(unix)]
#[cfg(test)]
mod tests {
    use super::*;
    use std::os::unix::fs::symlink;

    #[test]
    fn another_group_may_do_no_more_than_anybody() {
        for (mode, cut) in [(0o640, 0o600), (0o644, 0o644), (0o664, 0o644), (0o750, 0o700), (0o606, 0o606)] {
            assert_eq!(cut_for_another_group(mode), cut, "{mode:o}");
        }
    }

    #[test]
    fn one_place_has_many_spellings() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("deep")).unwrap();
        symlink(folder.path(), at("deep/up")).unwrap();
        symlink("x.png", at("link.png")).unwrap();
        symlink("link.png", at("chain.png")).unwrap();
        symlink("there.png", at("dangling.png")).unwrap();
        let same = ["./x.png", "deep/../x.png", "deep/up/x.png", "link.png", "chain.png"];
        for name in same {
            assert!(is_same_place(&at("x.png"), &at(name)), "{name}");
        }
        fs::write(at("x.png"), "").unwrap();
        for name in same {
            assert!(is_same_place(&at("x.png"), &at(name)), "{name}");
        }
        assert!(is_same_place(&at("there.png"), &at("deep/up/dangling.png")));
        for name in ["y.png", "deep/x.png", "dangling.png", "no/x.png"] {
            assert!(!is_same_place(&at("x.png"), &at(name)), "{name}");
        }
    }
}
