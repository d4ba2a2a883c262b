//! Files that shapes and modifiers embed: images and fonts. The scene holds their bytes, so that it stays complete when
//! it moves to another machine.

use std::fmt;
use std::sync::Arc;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::decode_budget;
use super::limits::{MAX_ATTACHMENT_BYTES, MAX_NAME};
use isolith_font::Face;
use isolith_guard::guarded;

/// The decoded contents of an attachment.
pub trait Content: Sized + Send + Sync + 'static {
    /// The required file type, as messages name it.
    const WHAT: &'static str;
    /// The default that a shape uses without a file, as messages name it.
    const WITHOUT: &'static str;
    /// The accepted file name extensions.
    const ENDINGS: &'static [&'static str];
    /// Decodes a file's bytes. The error says why they cannot be decoded.
    fn read(bytes: &[u8]) -> Result<Self, String>;
}

/// A file with its decoded contents, or none. Clones share both.
pub struct Attachment<T>(Option<Arc<Held<T>>>);

struct Held<T> {
    name: String,
    bytes: Vec<u8>,
    content: T,
}

/// The serialized form of an attachment.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a file in braces")]
struct Written {
    /// The file's name, for messages.
    name: String,
    /// The file's bytes in base 64.
    base64: String,
}

impl<T> Default for Attachment<T> {
    fn default() -> Self {
        Self::NONE
    }
}

impl<T> Attachment<T> {
    /// No file.
    pub const NONE: Self = Self(None);

    /// The decoded contents.
    pub fn content(&self) -> Option<&T> {
        self.0.as_deref().map(|held| &held.content)
    }

    /// The file's name.
    pub fn name(&self) -> Option<&str> {
        self.0.as_deref().map(|held| &*held.name)
    }

    /// The file itself; empty without one.
    pub fn bytes(&self) -> &[u8] {
        self.0.as_deref().map_or(&[], |held| &held.bytes)
    }

    /// The size of the file in bytes; 0 without a file.
    pub fn size(&self) -> usize {
        self.0.as_deref().map_or(0, |held| held.bytes.len())
    }
}

impl<T: Content> Attachment<T> {
    /// Decodes a file of this name from these bytes. The error says why the file cannot be used.
    pub fn new(name: &str, bytes: Vec<u8>) -> Result<Self, String> {
        let name = cleaned(name);
        if bytes.len() > MAX_ATTACHMENT_BYTES {
            return Err(format!("{name:?} must be {} of at most {} MiB", T::WHAT, MAX_ATTACHMENT_BYTES >> 20));
        }
        if let Some(known) = decode_budget::known::<Held<T>>(|held| held.name == name && held.bytes == bytes) {
            return Ok(Self(Some(known)));
        }
        let refused = |reason: String| format!("{name:?} must be {}: {reason}", T::WHAT);
        // Decoders of foreign formats have bugs: a panic in one counts as a broken file.
        let content = guarded(|| T::read(&bytes)).flatten().map_err(refused)?;
        let held = Arc::new(Held { name, bytes, content });
        decode_budget::remember(&held);
        Ok(Self(Some(held)))
    }

    /// Whether both share one file, or neither has one.
    pub fn is_same(&self, other: &Self) -> bool {
        match (&self.0, &other.0) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (a, b) => a.is_none() && b.is_none(),
        }
    }
}

/// A file name as the scene stores it and messages show it.
pub(super) fn cleaned(name: &str) -> String {
    name.chars().filter(|c| !c.is_control()).take(MAX_NAME).collect()
}

impl<T> Clone for Attachment<T> {
    fn clone(&self) -> Self {
        Self(self.0.clone())
    }
}

impl<T> PartialEq for Attachment<T> {
    fn eq(&self, other: &Self) -> bool {
        match (&self.0, &other.0) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b) || (a.name == b.name && a.bytes == b.bytes),
            (a, b) => a.is_none() && b.is_none(),
        }
    }
}

impl<T> fmt::Debug for Attachment<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Attachment({:?})", self.name())
    }
}

impl<T> Serialize for Attachment<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let written = |held: &Held<T>| Written { name: held.name.clone(), base64: STANDARD.encode(&held.bytes) };
        self.0.as_deref().map(written).serialize(serializer)
    }
}

impl<'de, T: Content> Deserialize<'de> for Attachment<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let Some(Written { name, base64 }) = Option::deserialize(deserializer)? else { return Ok(Self::NONE) };
        let bytes = STANDARD
            .decode(base64)
            .map_err(|e| D::Error::custom(format!("{:?} is not base 64: {e}", cleaned(&name))))?;
        Self::new(&name, bytes).map_err(D::Error::custom)
    }
}

impl<T> JsonSchema for Attachment<T> {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Attachment".into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        Option::<Written>::json_schema(generator)
    }
}

impl Content for Face {
    const WHAT: &'static str = "a TrueType or OpenType font";
    const WITHOUT: &'static str = "The editor's font";
    const ENDINGS: &'static [&'static str] = &["ttf", "otf", "ttc", "otc"];

    fn read(bytes: &[u8]) -> Result<Self, String> {
        Self::new(bytes.to_vec())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn font() -> Vec<u8> {
        epaint_default_fonts::HACK_REGULAR.to_vec()
    }

    #[test]
    fn a_file_is_written_whole_and_read_again() {
        let file = Attachment::<Face>::new("Hack\u{7}.ttf", font()).unwrap();
        assert_eq!(file.name(), Some("Hack.ttf"));
        let text = serde_json::to_string(&file).unwrap();
        let again: Attachment<Face> = serde_json::from_str(&text).unwrap();
        assert_eq!(again, file);
        assert!(again.content().is_some());
        assert_ne!(again, Attachment::NONE);
        assert_eq!(serde_json::from_str::<Attachment<Face>>("null").unwrap(), Attachment::NONE);
    }
}
