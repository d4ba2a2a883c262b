//! Bricks kept as files: in a folder beside the scene, each named by the key of what it was made of. A file that is not
//! what it should be is as good as none, and a folder that cannot be written leaves the bricks in memory.

use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use isolith_bricks::{BRICK_TEXELS, Bricks, CODEC_MAGIC, ContentKey, MAX_BRICK_TEXELS, from_bytes, to_bytes};
use isolith_scene::file;

/// The folder beside the scene.
pub const CACHE_FOLDER: &str = ".isolith-cache";
/// The ending of the files.
const ENDING: &str = "bricks";
/// Most bytes of all files together; the ones used longest ago go first.
const MAX_CACHE_BYTES: u64 = 2 << 30;
/// Most bytes of one file: texels and as many of looks, and the little around them.
const MAX_BRICK_FILE_BYTES: u64 = 64 * MAX_BRICK_TEXELS as u64 + BRICK_TEXELS as u64;

/// The cache of the scenes in a folder.
#[derive(Clone, Debug)]
pub(super) struct BrickCache {
    /// The folder of the scene; there is no cache without one.
    folder: Option<PathBuf>,
    most_bytes: u64,
    write: fn(&Path, &[u8]) -> Result<(), String>,
}

impl BrickCache {
    pub fn new(folder: Option<&Path>) -> Self {
        let write = |path: &Path, bytes: &[u8]| file::replace(path, bytes, 0).map_err(|error| error.to_string());
        Self { folder: folder.map(|folder| folder.join(CACHE_FOLDER)), most_bytes: MAX_CACHE_BYTES, write }
    }

    /// The bricks of these contents; `None` if they are in no file. The error says what is wrong with the file.
    pub fn load(&self, key: ContentKey) -> Result<Option<Bricks>, String> {
        let Some(path) = self.path(key) else { return Ok(None) };
        let Ok(metadata) = fs::metadata(&path) else { return Ok(None) };
        if !metadata.is_file() || metadata.len() > MAX_BRICK_FILE_BYTES {
            return Err("is no file, or too large".into());
        }
        let mut bytes = Vec::new();
        let read = File::open(&path).and_then(|file| file.take(MAX_BRICK_FILE_BYTES).read_to_end(&mut bytes));
        read.map_err(|error| format!("cannot be read: {error}"))?;
        let bricks = from_bytes(&bytes, key).map_err(|error| error.to_string())?;
        // For the order in which files go; those of others may stay as they are.
        let _ = File::options().append(true).open(&path).and_then(|file| file.set_modified(SystemTime::now()));
        Ok(Some(bricks))
    }

    /// Writes the bricks of these contents. The error is a reason for the user.
    pub fn store(&self, key: ContentKey, bricks: &Bricks) -> Result<(), String> {
        let (Some(folder), Some(path)) = (&self.folder, self.path(key)) else { return Ok(()) };
        if !folder.is_dir() {
            fs::create_dir(folder).map_err(|error| error.to_string())?;
        }
        (self.write)(&path, &to_bytes(bricks, key))?;
        self.trim(folder, &path);
        Ok(())
    }

    fn path(&self, key: ContentKey) -> Option<PathBuf> {
        self.folder.as_ref().map(|folder| folder.join(format!("{key}.{ENDING}")))
    }

    /// Removes the oldest files beyond the budget, but for the newest. Only files that this program wrote.
    fn trim(&self, folder: &Path, newest: &Path) {
        let Ok(entries) = fs::read_dir(folder) else { return };
        let own = entries.flatten().filter_map(|entry| {
            let (path, metadata) = (entry.path(), entry.metadata().ok()?);
            let is_own = metadata.is_file() && path.extension()? == ENDING && path != newest && is_of_bricks(&path);
            is_own.then(|| (metadata.modified().unwrap_or(SystemTime::UNIX_EPOCH), metadata.len(), path))
        });
        let mut files: Vec<_> = own.collect();
        files.sort();
        let newest = fs::metadata(newest).map_or(0, |metadata| metadata.len());
        let mut bytes: u64 = newest + files.iter().map(|(_, bytes, _)| bytes).sum::<u64>();
        for (_, size, path) in files {
            if bytes <= self.most_bytes {
                return;
            }
            if fs::remove_file(path).is_ok() {
                bytes -= size;
            }
        }
    }
}

fn is_of_bricks(path: &Path) -> bool {
    let mut start = [0; CODEC_MAGIC.len()];
    File::open(path).and_then(|mut file| file.read_exact(&mut start)).is_ok() && start == CODEC_MAGIC
}

#[cfg(test)]
mod tests {
    use super::*;
    use isolith_bricks::placeholder;

    fn key(n: u64) -> ContentKey {
        ContentKey([n, 7])
    }

    fn cache(folder: &Path) -> BrickCache {
        BrickCache::new(Some(folder))
    }

    fn file_of(folder: &Path, n: u64) -> PathBuf {
        cache(folder).path(key(n)).unwrap()
    }

    #[test]
    fn what_was_stored_is_loaded_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let cache = cache(folder.path());
        assert_eq!(cache.load(key(1)), Ok(None));
        cache.store(key(1), placeholder().finest()).unwrap();
        assert!(cache.load(key(1)).unwrap().unwrap() == *placeholder().finest());
        assert_eq!(cache.load(key(2)), Ok(None));
        // Without a folder there is no cache, which is no problem.
        let none = BrickCache::new(None);
        assert_eq!((none.store(key(1), placeholder().finest()), none.load(key(1))), (Ok(()), Ok(None)));
        // The file of other contents under this name.
        fs::copy(file_of(folder.path(), 1), file_of(folder.path(), 2)).unwrap();
        assert!(cache.load(key(2)).unwrap_err().contains("other contents"));
    }

    #[test]
    fn files_that_are_cut_changed_or_foreign_are_never_bricks() {
        let folder = tempfile::tempdir().unwrap();
        let cache = cache(folder.path());
        cache.store(key(1), placeholder().finest()).unwrap();
        let path = file_of(folder.path(), 1);
        let good = fs::read(&path).unwrap();
        let refused = |bytes: &[u8], what: &str| {
            fs::write(&path, bytes).unwrap();
            let reason = cache.load(key(1)).expect_err(what);
            assert!(!reason.is_empty());
            reason
        };
        for length in (0..good.len()).step_by(4_096).chain([1, 8, 11, 12, 100, good.len() - 1]) {
            refused(&good[..length], "it is cut");
        }
        let mut seed = 1_u64;
        for _ in 0..200 {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let bit = (seed >> 20) as usize % (8 * good.len());
            let mut bytes = good.clone();
            bytes[bit / 8] ^= 1 << (bit % 8);
            refused(&bytes, "a bit is flipped");
        }
        let mut other = good.clone();
        other[8] = 99;
        assert!(refused(&other, "of another version").contains("version 99"));
        assert!(refused(b"a text", "foreign").contains("not a file of bricks"));
        assert!(refused(&[good.clone(), vec![0; 16]].concat(), "longer").contains("bytes instead of"));
        // It is written anew.
        cache.store(key(1), placeholder().finest()).unwrap();
        assert!(cache.load(key(1)).unwrap().is_some());
    }

    #[test]
    fn a_folder_that_cannot_be_written_is_a_reason_and_no_more() {
        let folder = tempfile::tempdir().unwrap();
        let full = BrickCache { write: |_, _| Err("no space left".into()), ..cache(folder.path()) };
        assert_eq!(full.store(key(1), placeholder().finest()), Err("no space left".into()));
        assert_eq!(full.load(key(1)), Ok(None));
        // A file stands where the folder should.
        let blocked = tempfile::tempdir().unwrap();
        fs::write(blocked.path().join(CACHE_FOLDER), "mine").unwrap();
        assert!(cache(blocked.path()).store(key(1), placeholder().finest()).is_err());
        assert_eq!(cache(blocked.path()).load(key(1)), Ok(None));
        assert_eq!(fs::read(blocked.path().join(CACHE_FOLDER)).unwrap(), b"mine");
        let gone = cache(&folder.path().join("gone"));
        assert!(gone.store(key(1), placeholder().finest()).is_err());
    }

    #[test]
    fn the_oldest_files_go_and_others_stay() {
        let folder = tempfile::tempdir().unwrap();
        let size = to_bytes(placeholder().finest(), key(0)).len() as u64;
        let cache = BrickCache { most_bytes: 3 * size, ..cache(folder.path()) };
        fs::create_dir(folder.path().join(CACHE_FOLDER)).unwrap();
        let foreign = folder.path().join(CACHE_FOLDER).join("mine.bricks");
        fs::write(&foreign, vec![1; 100]).unwrap();
        for n in 0..5 {
            cache.store(key(n), placeholder().finest()).unwrap();
            let old = SystemTime::UNIX_EPOCH + std::time::Duration::from_secs(1_000 + n);
            File::options().append(true).open(file_of(folder.path(), n)).unwrap().set_modified(old).unwrap();
            if n == 2 {
                // Used again: the newest now.
                assert!(cache.load(key(0)).unwrap().is_some());
            }
        }
        let kept: Vec<u64> = (0..5).filter(|n| file_of(folder.path(), *n).exists()).collect();
        assert_eq!((kept, foreign.exists()), (vec![0, 3, 4], true));
    }
}
