//! The state of a file when it was read or written, to find out whether somebody else has changed it since.

use std::fs;
use std::path::Path;
use std::time::SystemTime;

use serde::{Deserialize, Serialize};

use super::bytes_of;
use crate::limits::MAX_FILE_BYTES;

/// Length, modification time and a hash of the contents.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Stamp {
    bytes: u64,
    modified: Option<SystemTime>,
    hash: u64,
}

impl Stamp {
    /// The stamp of these contents.
    pub fn of(contents: &[u8], metadata: Option<&fs::Metadata>) -> Self {
        let modified = metadata.and_then(|m| m.modified().ok());
        Self { bytes: contents.len() as u64, modified, hash: hash(contents) }
    }

    /// Whether the file has other contents now. The time alone proves nothing: copying and syncing change it, and two
    /// saves within its resolution have the same time. A file that is missing or unreadable does not count as changed.
    pub fn is_outdated(&self, path: &Path) -> bool {
        match fs::metadata(path) {
            Ok(now) if now.is_file() && now.len() != self.bytes => true,
            Ok(now) if now.is_file() => bytes_of(path, MAX_FILE_BYTES).is_ok_and(|bytes| hash(&bytes) != self.hash),
            _ => false,
        }
    }

    /// Like [`Self::is_outdated`], but cheap enough for frequent calls: it does not read a file whose time is
    /// unchanged.
    pub fn seems_outdated(&self, path: &Path) -> bool {
        let unchanged = |now: &fs::Metadata| now.len() == self.bytes && now.modified().ok() == self.modified;
        fs::metadata(path).is_ok_and(|now| !unchanged(&now)) && self.is_outdated(path)
    }
}

/// FNV-1a: the same in every version of the program, because files store stamps.
pub(super) fn hash(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contents_count_and_times_do_not() {
        assert_eq!(hash(b"foobar"), 0x8594_4171_f739_67e8, "the published value of FNV-1a");
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.json");
        fs::write(&path, "abc").unwrap();
        let stamp = Stamp::of(b"abc", fs::metadata(&path).ok().as_ref());
        assert!(!stamp.is_outdated(&path) && !stamp.seems_outdated(&path));
        let later = SystemTime::now() + std::time::Duration::from_secs(100);
        fs::File::options().write(true).open(&path).unwrap().set_modified(later).unwrap();
        assert!(!stamp.is_outdated(&path) && !stamp.seems_outdated(&path), "only the time is another");
        fs::write(&path, "abd").unwrap();
        assert!(stamp.is_outdated(&path) && stamp.seems_outdated(&path), "the same length");
        fs::File::options().write(true).open(&path).unwrap().set_modified(stamp.modified.unwrap()).unwrap();
        assert!(stamp.is_outdated(&path), "the same length and time");
        fs::write(&path, "abcd").unwrap();
        assert!(stamp.is_outdated(&path) && stamp.seems_outdated(&path));
        fs::remove_file(&path).unwrap();
        assert!(!stamp.is_outdated(&path) && !stamp.seems_outdated(&path), "nothing is there to be lost");
    }
}
