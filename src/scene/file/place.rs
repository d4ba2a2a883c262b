//! Where in a text reading failed: line and column, and the node around it.

use std::path::Path;

use serde::de::{Deserializer, Error as _, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde_json::Value;
use serde_path_to_error::{Path as FieldPath, Segment};

use super::FileError;
use crate::scene::NodeId;

/// Line and column, counted from 1, of what follows these bytes.
pub(super) fn line_and_column(before: &[u8]) -> (usize, usize) {
    let line = before.iter().filter(|b| **b == b'\n').count() + 1;
    let start = before.iter().rposition(|b| *b == b'\n').map_or(0, |i| i + 1);
    (line, String::from_utf8_lossy(&before[start..]).chars().count() + 1)
}

/// An error of the JSON reader, in our words: with the field where the path is known, with the node where
/// the path leads through one.
pub(super) fn json_error(text: &str, file: &Path, path: Option<&FieldPath>, error: &serde_json::Error) -> FileError {
    let whole = error.to_string();
    let place = format!(" at line {} column {}", error.line(), error.column());
    let reason = whole.strip_suffix(&place).unwrap_or(&whole);
    let mut out = if error.line() > 0 {
        FileError::new(file, format!("line {}, column {}: {reason}", error.line(), error.column()))
    } else {
        FileError::new(file, reason)
    };
    let Some(path) = path.filter(|p| p.iter().next().is_some()) else { return out };
    let shown = path.to_string();
    if shown != "." {
        out = out.at(shown);
    }
    if let Some(node) = node_index(path).and_then(|i| node_at(text, i)) {
        if let Some(id) = node.id {
            out = out.of_node(&node.name.chars().take(60).collect::<String>(), NodeId(id));
        }
    }
    out
}

fn node_index(path: &FieldPath) -> Option<usize> {
    let mut segments = path.iter();
    match (segments.next(), segments.next()) {
        (Some(Segment::Map { key }), Some(Segment::Seq { index })) if key == "nodes" => Some(*index),
        _ => None,
    }
}

/// What could be read of a node before the text went wrong.
#[derive(Default)]
struct Found {
    id: Option<u64>,
    name: String,
}

/// Name and id of the node at `index`, read without keeping anything else.
fn node_at(text: &str, index: usize) -> Option<Found> {
    let mut found = Found::default();
    // An error is expected here: the text is broken, or we stop early.
    let _ = serde_json::Deserializer::from_str(text).deserialize_map(Top { index, found: &mut found });
    Some(found)
}

struct Top<'a> {
    index: usize,
    found: &'a mut Found,
}

impl<'de> Visitor<'de> for Top<'_> {
    type Value = ();

    fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("a scene")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        while let Some(key) = map.next_key::<String>()? {
            if key == "nodes" {
                return map.next_value_seed(List { index: self.index, found: self.found });
            }
            map.next_value::<IgnoredAny>()?;
        }
        Ok(())
    }
}

struct List<'a> {
    index: usize,
    found: &'a mut Found,
}

impl<'de> serde::de::DeserializeSeed<'de> for List<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_seq(self)
    }
}

impl<'de> Visitor<'de> for List<'_> {
    type Value = ();

    fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("a list of nodes")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<(), A::Error> {
        for _ in 0..self.index {
            seq.next_element::<IgnoredAny>()?;
        }
        seq.next_element_seed(Entry { found: self.found })?;
        Err(A::Error::custom("found"))
    }
}

struct Entry<'a> {
    found: &'a mut Found,
}

impl<'de> serde::de::DeserializeSeed<'de> for Entry<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_map(self)
    }
}

impl<'de> Visitor<'de> for Entry<'_> {
    type Value = ();

    fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("a node")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        while let Some(key) = map.next_key::<String>()? {
            match key.as_str() {
                "id" => self.found.id = map.next_value::<Value>()?.as_u64(),
                "name" => self.found.name = map.next_value::<Value>()?.as_str().unwrap_or_default().to_owned(),
                _ => drop(map.next_value::<IgnoredAny>()?),
            }
        }
        Ok(())
    }
}
