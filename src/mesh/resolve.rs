//! Where bytes come from: files inside a folder, and data URIs. Nothing outside the folder is opened.

use std::fs::File;
use std::io::Read;
use std::path::{Component, Path, PathBuf};

use super::limits::MAX_FILE_BYTES;

/// The bytes that a glTF file names by `uri`; `folder` is the folder of the glTF file. The error is a
/// reason for people.
pub(super) fn read_uri(uri: &str, folder: Option<&Path>) -> Result<Vec<u8>, String> {
    if uri.get(..5).is_some_and(|scheme| scheme.eq_ignore_ascii_case("data:")) {
        return read_data_uri(&uri[5..]);
    }
    let Some(folder) = folder else {
        return Err("names another file, but this glTF stands in no folder".into());
    };
    let path = percent_decoded(uri)?;
    if path.contains([':', '?', '#']) {
        return Err(format!("“{}” is not a plain relative path", shortened(uri)));
    }
    read_file(&inside(folder, &path)?)
}

/// The whole file, unless it is too large or not a plain file. The error is a reason for people.
pub(super) fn read_file(path: &Path) -> Result<Vec<u8>, String> {
    let cannot = |e: std::io::Error| format!("cannot be read: {e}");
    let file = File::open(path).map_err(cannot)?;
    let metadata = file.metadata().map_err(cannot)?;
    if !metadata.is_file() {
        return Err("is not a file".into());
    }
    if metadata.len() > MAX_FILE_BYTES {
        return Err(format!("has {} bytes, more than {MAX_FILE_BYTES}", metadata.len()));
    }
    let mut bytes = Vec::with_capacity(metadata.len() as usize);
    // The file may grow while it is read: one byte more than allowed is enough to know.
    file.take(MAX_FILE_BYTES + 1).read_to_end(&mut bytes).map_err(cannot)?;
    if bytes.len() as u64 > MAX_FILE_BYTES {
        return Err(format!("has more than {MAX_FILE_BYTES} bytes"));
    }
    Ok(bytes)
}

/// The file that `relative` names, if it exists and lies in `folder`, links followed. The error is a
/// reason for people.
pub(super) fn inside(folder: &Path, relative: &str) -> Result<PathBuf, String> {
    let shown = shortened(relative);
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
    let cannot = |e: std::io::Error| format!("“{shown}” cannot be opened: {e}");
    let folder = folder.canonicalize().map_err(cannot)?;
    let file = folder.join(path).canonicalize().map_err(cannot)?;
    if !file.starts_with(&folder) {
        return Err(format!("“{shown}” leads out of the folder by a link"));
    }
    Ok(file)
}

/// What follows `data:`; only base64 is used in glTF files.
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

/// A URI's path with its `%41` written out.
fn percent_decoded(uri: &str) -> Result<String, String> {
    let wrong = || format!("“{}” is not a valid URI", shortened(uri));
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

/// A name short enough for a message.
fn shortened(text: &str) -> String {
    const LONGEST: usize = 80;
    if text.chars().count() <= LONGEST { text.into() } else { text.chars().take(LONGEST).chain(['…']).collect() }
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
        let reason = read_uri("%2e%2e/secret.bin", Some(&folder)).unwrap_err();
        assert!(reason.contains(".."), "{reason}");
    }
}
