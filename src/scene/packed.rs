//! Files that travel within a scene: its models, with the buffers and images that these name. Images and fonts of shapes,
//! materials and the environment are always within.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::attachment::cleaned;
use super::check::mesh_path;
use super::limits::{MAX_PACKED_BYTES, MAX_PACKED_FILES};

/// The endings that packed files may have: models, their buffers and their images. So unpacking a scene of somebody else
/// writes nothing that a system runs or reads as its settings.
pub const PACKED_ENDINGS: [&str; 10] = ["gltf", "glb", "bin", "buf", "dat", "png", "jpg", "jpeg", "webp", "ktx2"];

/// The bytes of files, by their paths relative to the scene's folder.
type FileTable = BTreeMap<String, Arc<[u8]>>;

/// Packed files, by their paths relative to the scene's folder. Clones share them.
#[derive(Clone, Default)]
pub struct PackedFiles(Arc<FileTable>);

impl PackedFiles {
    /// Packs these. The error names the file that cannot be packed, and says why.
    pub fn new(files: impl IntoIterator<Item = (String, Arc<[u8]>)>) -> Result<Self, String> {
        let (mut table, mut total) = (FileTable::new(), 0);
        for (name, bytes) in files {
            let refused = |reason: String| Err(format!("{:?} {reason}", cleaned(&name)));
            if let Err(reason) = check_name(&name) {
                return refused(reason);
            }
            total += bytes.len();
            if total > MAX_PACKED_BYTES {
                return refused(format!("makes the packed files larger than {} MiB", MAX_PACKED_BYTES >> 20));
            }
            if table.len() == MAX_PACKED_FILES {
                return refused(format!("is more than the {MAX_PACKED_FILES} files that can be packed"));
            }
            if table.contains_key(&name) {
                return refused("is packed twice".into());
            }
            table.insert(name, bytes);
        }
        Ok(Self(Arc::new(table)))
    }

    /// The files, by their paths.
    pub fn table(&self) -> &Arc<FileTable> {
        &self.0
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The bytes of all of them together.
    pub fn size(&self) -> usize {
        self.0.values().map(|bytes| bytes.len()).sum()
    }
}

/// Checks a path: below the scene's folder, not hidden, with one of the endings.
fn check_name(name: &str) -> Result<(), String> {
    mesh_path(name)?;
    if name.split('/').any(|part| part.starts_with('.') || part.ends_with(['.', ' '])) {
        return Err("must not name a hidden file or folder".into());
    }
    let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending).to_ascii_lowercase();
    if PACKED_ENDINGS.contains(&&*ending) {
        return Ok(());
    }
    Err(format!("must end in one of {}", PACKED_ENDINGS.join(", ")))
}

impl PartialEq for PackedFiles {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0) || self.0 == other.0
    }
}

impl fmt::Debug for PackedFiles {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.0.keys()).finish()
    }
}

/// The serialized form of a packed file.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a file in braces")]
struct WrittenFile {
    /// Its path relative to the scene's folder, with forward slashes.
    path: String,
    /// Its bytes in base 64.
    base64: String,
}

impl Serialize for PackedFiles {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let written =
            |(path, bytes): (&String, &Arc<[u8]>)| WrittenFile { path: path.clone(), base64: STANDARD.encode(bytes) };
        serializer.collect_seq(self.0.iter().map(written))
    }
}

impl<'de> Deserialize<'de> for PackedFiles {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        // The reader of scenes bounds the values of the list before.
        let written: Vec<WrittenFile> = Vec::deserialize(deserializer)?;
        let read = |WrittenFile { path, base64 }: WrittenFile| match STANDARD.decode(base64) {
            Ok(bytes) => Ok((path, Arc::from(bytes))),
            Err(e) => Err(D::Error::custom(format!("{:?} is not base 64: {e}", cleaned(&path)))),
        };
        let files: Vec<(String, Arc<[u8]>)> = written.into_iter().map(read).collect::<Result<_, _>>()?;
        Self::new(files).map_err(D::Error::custom)
    }
}

impl JsonSchema for PackedFiles {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "PackedFiles".into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        Vec::<WrittenFile>::json_schema(generator)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bytes(count: usize) -> Arc<[u8]> {
        vec![7; count].into()
    }

    #[test]
    fn a_pack_is_written_whole_and_read_again() {
        let files = [("models/a.glb".to_owned(), bytes(5)), ("models/b.bin".to_owned(), bytes(0))];
        let files = PackedFiles::new(files).unwrap();
        let again: PackedFiles = serde_json::from_str(&serde_json::to_string(&files).unwrap()).unwrap();
        assert_eq!((again.size(), again.table().len()), (5, 2));
        assert_eq!(again, files);
    }

    #[test]
    fn hostile_packs_are_refused_by_name() {
        for (name, reason) in [
            ("../up.glb", "straight"),
            ("/etc/x.glb", "relative"),
            ("C:/x.glb", "relative"),
            ("a\\b.glb", "slashes"),
            ("", "name a file"),
            (".config/autostart/x.bin", "hidden"),
            ("a/.x.glb", "hidden"),
            ("run.sh", "must end in"),
            ("x.desktop", "must end in"),
            ("glb", "must end in"),
        ] {
            let error = PackedFiles::new([(name.to_owned(), bytes(1))]).unwrap_err();
            assert!(error.contains(reason) && error.starts_with(&format!("{name:?}")), "{name}: {error}");
            let json = format!(r#"[{{"path": {}, "base64": ""}}]"#, serde_json::to_string(name).unwrap());
            let error = serde_json::from_str::<PackedFiles>(&json).unwrap_err().to_string();
            assert!(error.contains(reason), "{error}");
        }
        let twice = [("a.glb".to_owned(), bytes(1)), ("a.glb".to_owned(), bytes(1))];
        assert!(PackedFiles::new(twice).unwrap_err().contains("twice"));
        let large = PackedFiles::new([("a.glb".to_owned(), bytes(MAX_PACKED_BYTES + 1))]).unwrap_err();
        assert!(large.contains("a.glb") && large.contains("64 MiB"), "{large}");
        let many = (0..=MAX_PACKED_FILES).map(|i| (format!("{i}.glb"), bytes(0)));
        assert!(PackedFiles::new(many).unwrap_err().contains("1000 files"));
    }
}
