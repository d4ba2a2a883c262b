//! Reads bytes from files inside a folder and from data URIs. Opens nothing outside the folder.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::Read;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;
use std::time::SystemTime;

use super::error::name;
use super::limits::MAX_FILE_BYTES;

/// A file's stamp: properties that change when the file is written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct MeshFileStamp {
    path: PathBuf,
    /// Modification time and length; `None` if there was no file.
    state: Option<(Option<SystemTime>, u64)>,
}

impl MeshFileStamp {
    /// The current stamp of the file.
    pub fn of(path: &Path) -> Self {
        let state = path.metadata().ok().map(|metadata| (metadata.modified().ok(), metadata.len()));
        Self { path: path.to_path_buf(), state }
    }

    /// The current stamp of the same file.
    pub fn again(&self) -> Self {
        Self::of(&self.path)
    }
}

/// The bytes of files that travel within a scene, by their paths relative to its folder.
pub type ModelFileTable = BTreeMap<String, Arc<[u8]>>;

/// Where a glTF file stands.
#[derive(Clone, Copy, Debug)]
enum GltfPlace<'a> {
    /// It cannot name other files.
    Nowhere,
    Folder(&'a Path),
    /// Among these files, in this folder of theirs.
    Table(&'a ModelFileTable, &'a str),
}

/// Reads the files that a glTF names, and records which were requested, whether they exist or not.
#[derive(Debug)]
pub(super) struct Reader<'a> {
    place: GltfPlace<'a>,
    files: RefCell<Vec<MeshFileStamp>>,
    /// The files that were read, by the paths that the glTF names.
    named: RefCell<ModelFileTable>,
    /// Whether to keep those.
    keeps: bool,
}

impl<'a> Reader<'a> {
    /// A reader for a glTF file in this folder; without one it cannot name other files.
    pub fn new(folder: Option<&'a Path>) -> Self {
        Self::at(folder.map_or(GltfPlace::Nowhere, GltfPlace::Folder))
    }

    /// A reader for the glTF file at `path` in a table.
    pub fn of_table(table: &'a ModelFileTable, path: &'a str) -> Self {
        Self::at(GltfPlace::Table(table, path.rsplit_once('/').map_or("", |(folder, _)| folder)))
    }

    /// A reader that keeps what it has read.
    pub fn keeping(folder: &'a Path) -> Self {
        Self { keeps: true, ..Self::new(Some(folder)) }
    }

    fn at(place: GltfPlace<'a>) -> Self {
        Self { place, files: RefCell::default(), named: RefCell::default(), keeps: false }
    }

    /// The files that were read, by the paths that the glTF names.
    pub fn into_named(self) -> ModelFileTable {
        self.named.into_inner()
    }

    /// The requested files.
    pub fn into_files(self) -> Vec<MeshFileStamp> {
        self.files.into_inner()
    }

    /// The bytes that a glTF file names by `uri`. The error is a reason for the user.
    pub fn uri(&self, uri: &str) -> Result<Vec<u8>, String> {
        if uri.get(..5).is_some_and(|scheme| scheme.eq_ignore_ascii_case("data:")) {
            return read_data_uri(&uri[5..]);
        }
        // These have a meaning in URIs, unless they are percent-encoded (`%23`).
        if uri.contains([':', '?', '#']) {
            return Err(format!("“{}” is not a plain relative path", name(uri)));
        }
        let path = percent_decoded(uri)?;
        let folder = match self.place {
            GltfPlace::Nowhere => return Err("names another file, but this glTF stands in no folder".into()),
            GltfPlace::Folder(folder) => folder,
            GltfPlace::Table(table, folder) => {
                let path = plain(&path)?;
                let path = if folder.is_empty() { path } else { format!("{folder}/{path}") };
                let packed = table.get(&path).map(|bytes| bytes.to_vec());
                return packed.ok_or_else(|| format!("“{}” is not among the packed files", name(&path)));
            }
        };
        let file = inside(folder, &path);
        // Stamped before reading, so that a change during the read is noticed later.
        let stamp = file
            .as_ref()
            .map_or_else(|_| MeshFileStamp { path: folder.join(&path), state: None }, |file| MeshFileStamp::of(file));
        self.files.borrow_mut().push(stamp);
        let bytes = read_file(&file?)?;
        if self.keeps {
            self.named.borrow_mut().insert(plain(&path)?, bytes.as_slice().into());
        }
        Ok(bytes)
    }
}

/// A relative path without `.` that does not leave its folder.
fn plain(path: &str) -> Result<String, String> {
    let parts: Vec<&str> = path.split('/').filter(|part| !part.is_empty() && *part != ".").collect();
    if parts.contains(&"..") {
        return Err(format!("“{}” leaves the folder by “..”", name(path)));
    }
    Ok(parts.join("/"))
}

/// The whole file. Refuses files that are too large or not regular. The error is a reason for the user.
pub(super) fn read_file(path: &Path) -> Result<Vec<u8>, String> {
    let cannot = |e: std::io::Error| format!("cannot be read: {e}");
    let check = |metadata: std::fs::Metadata| {
        if !metadata.is_file() {
            return Err("is not a file".to_owned());
        }
        match metadata.len() {
            length if length > MAX_FILE_BYTES => Err(format!("has {length} bytes, more than {MAX_FILE_BYTES}")),
            length => Ok(length),
        }
    };
    // Checked before opening: opening a pipe may block forever, and opening a device may have side effects.
    check(path.metadata().map_err(cannot)?)?;
    let file = File::open(path).map_err(cannot)?;
    let length = check(file.metadata().map_err(cannot)?)?;
    let mut bytes = Vec::with_capacity(length as usize);
    // The file may grow while it is read: one byte more than allowed proves it.
    file.take(MAX_FILE_BYTES + 1).read_to_end(&mut bytes).map_err(cannot)?;
    if bytes.len() as u64 > MAX_FILE_BYTES {
        return Err(format!("has more than {MAX_FILE_BYTES} bytes"));
    }
    Ok(bytes)
}

/// The file that `relative` names, if it exists and lies in `folder`, links followed. The error is a reason for the
/// user.
pub(super) fn inside(folder: &Path, relative: &str) -> Result<PathBuf, String> {
    let shown = name(relative);
    if relative.is_empty() {
        return Err("names no file".into());
    }
    if relative.contains(['\\', '\0']) {
        return Err(format!("“{shown}” must use forward slashes"));
    }
    let path = Path::new(relative);
    for component in path.components() {
        match component {
            Component::Normal(_) | Component::CurDir => {}
            Component::ParentDir => return Err(format!("“{shown}” leaves the folder by “..”")),
            Component::RootDir | Component::Prefix(_) => return Err(format!("“{shown}” is not a relative path")),
        }
    }
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let cannot = |e: std::io::Error| match e.kind() {
        std::io::ErrorKind::NotFound => format!("“{shown}” is not there"),
        _ => format!("“{shown}” cannot be opened: {e}"),
    };
    let folder = folder.canonicalize().map_err(cannot)?;
    let file = folder.join(path).canonicalize().map_err(cannot)?;
    if !file.starts_with(&folder) {
        return Err(format!("“{shown}” leads out of the folder by a link"));
    }
    Ok(file)
}

/// The bytes of a data URI, given the part after `data:`; glTF files use base64 only.
fn read_data_uri(rest: &str) -> Result<Vec<u8>, String> {
    let Some((header, body)) = rest.split_once(',') else {
        return Err("is a data URI without a comma".into());
    };
    if !header.to_ascii_lowercase().ends_with(";base64") {
        return Err("is a data URI that is not base64".into());
    }
    base64_decoded(body.as_bytes())
}

/// Base64 with the standard alphabet (RFC 4648, section 4); padding may be left out.
fn base64_decoded(text: &[u8]) -> Result<Vec<u8>, String> {
    let end = text.iter().rposition(|c| *c != b'=').map_or(0, |i| i + 1);
    if text.len() - end > 2 || end % 4 == 1 {
        return Err("is base64 of a wrong length".into());
    }
    if (end as u64) / 4 * 3 > MAX_FILE_BYTES {
        return Err(format!("has more than {MAX_FILE_BYTES} bytes"));
    }
    let mut out = Vec::with_capacity(end / 4 * 3 + 2);
    for (i, chunk) in text[..end].chunks(4).enumerate() {
        let mut bits = 0_u32;
        for (j, c) in chunk.iter().enumerate() {
            let digit = match c {
                b'A'..=b'Z' => c - b'A',
                b'a'..=b'z' => c - b'a' + 26,
                b'0'..=b'9' => c - b'0' + 52,
                b'+' => 62,
                b'/' => 63,
                _ => return Err(format!("is not base64 at character {}", i * 4 + j)),
            };
            bits |= u32::from(digit) << (18 - 6 * j);
        }
        out.extend_from_slice(&bits.to_be_bytes()[1..chunk.len()]);
    }
    Ok(out)
}

/// Decodes the percent-encoding (`%41`) of a URI's path.
fn percent_decoded(uri: &str) -> Result<String, String> {
    let wrong = || format!("“{}” is not a valid URI", name(uri));
    let mut out = Vec::with_capacity(uri.len());
    let mut bytes = uri.bytes();
    while let Some(b) = bytes.next() {
        if b != b'%' {
            out.push(b);
            continue;
        }
        let mut digit = || bytes.next().and_then(|c| char::from(c).to_digit(16)).ok_or_else(wrong);
        out.push((digit()? * 16 + digit()?) as u8);
    }
    String::from_utf8(out).map_err(|_| wrong())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_of_every_length() {
        let cases =
            [("", ""), ("Zg==", "f"), ("Zm8=", "fo"), ("Zm9v", "foo"), ("Zm9vYg", "foob"), ("Zm9vYmFy", "foobar")];
        for (text, plain) in cases {
            assert_eq!(base64_decoded(text.as_bytes()).unwrap(), plain.as_bytes());
        }
        for wrong in ["Z", "Zm9v=a==", "Zm9vY", "Z===", "Zm 9", "Zm9v\n"] {
            assert!(base64_decoded(wrong.as_bytes()).is_err(), "{wrong:?}");
        }
    }

    #[test]
    fn escapes_in_uris_are_written_out_before_they_are_judged() {
        assert_eq!(percent_decoded("a%20b").unwrap(), "a b");
        assert!(percent_decoded("a%2").is_err() && percent_decoded("%ff").is_err());
        let folder = std::env::temp_dir();
        let reason = Reader::new(Some(&folder)).uri("%2e%2e/secret.bin").unwrap_err();
        assert!(reason.contains(".."), "{reason}");
    }
}
