//! The place in a text where reading failed: line and column, and the node around it.

use std::path::Path;

use serde::de::{Deserializer, Error as _, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Value};
use serde_path_to_error::{Path as FieldPath, Segment};

use super::error::{FileError, clipped};
use crate::NodeId;
use crate::attachment::cleaned;

/// Line and column, counted from 1, of the position after these bytes.
pub(super) fn line_and_column(before: &[u8]) -> (usize, usize) {
    let line = before.iter().filter(|b| **b == b'\n').count() + 1;
    let start = before.iter().rposition(|b| *b == b'\n').map_or(0, |i| i + 1);
    (line, String::from_utf8_lossy(&before[start..]).chars().count() + 1)
}

/// Translates an error of the JSON reader: adds the field if the path is known, and the node if the path leads through
/// one.
pub(super) fn json_error(text: &str, file: &Path, path: Option<&FieldPath>, error: &serde_json::Error) -> FileError {
    let whole = error.to_string();
    let place = format!(" at line {} column {}", error.line(), error.column());
    let reason = whole.strip_suffix(&place).unwrap_or(&whole);
    let reason = if error.is_eof() { "the file ends before it is complete" } else { reason };
    let plain = clipped(reason, 400)
        .replace("expected f64", "expected a number")
        .replace("expected u64", "expected a whole number from 0")
        .replace("expected struct ", "expected in braces: ")
        .replace("expected internally tagged enum ", "expected in braces: ");
    let mut out = if error.line() > 0 {
        FileError::new(file, format!("line {}, column {}: {plain}", error.line(), error.column()))
    } else {
        FileError::new(file, plain)
    };
    let mut field = path.map(shown).unwrap_or_default();
    if let Some((path, index)) = path.and_then(|p| Some((p, node_index(p)?))) {
        let node = node_at(text, index);
        let name = node.get("name").and_then(Value::as_str).unwrap_or_default();
        match node.get("id").and_then(Value::as_u64) {
            Some(id) => out = out.of_node(name, NodeId(id)),
            None if !name.is_empty() => out.node = Some(clipped(name, 60)),
            None => {}
        }
        field += &offender(&node, path, reason);
    }
    if let Some(name) = named(reason).filter(|name| field.rsplit('.').next() != Some(name)) {
        field = format!("{field}.{}", clipped(name, 60)).trim_start_matches('.').to_owned();
    }
    if field.is_empty() { out } else { out.at(field) }
}

/// A path for messages, as far as it is known.
fn shown(path: &FieldPath) -> String {
    let mut out = String::new();
    for segment in path.iter() {
        match segment {
            Segment::Seq { index } => out += &format!("[{index}]"),
            Segment::Map { key } if out.is_empty() => out += &clipped(key, 60),
            Segment::Map { key } => out += &format!(".{}", clipped(key, 60)),
            _ => break,
        }
    }
    out
}

/// The field that serde's message names.
fn named(reason: &str) -> Option<&str> {
    let heads = ["missing field `", "unknown field `", "duplicate field `"];
    heads.iter().find_map(|head| reason.strip_prefix(head)?.split('`').next())
}

fn node_index(path: &FieldPath) -> Option<usize> {
    let mut segments = path.iter();
    match (segments.next(), segments.next()) {
        (Some(Segment::Map { key }), Some(Segment::Seq { index })) if key == "nodes" => Some(*index),
        _ => None,
    }
}

/// The remaining path to a value of the wrong type. Serde buffers an enum with an inner `type` as a whole before it
/// parses it, and the path ends there. Empty if the value cannot be identified.
fn offender(node: &Value, path: &FieldPath, reason: &str) -> String {
    let mut at = node;
    for segment in path.iter().skip(2) {
        let next = match segment {
            Segment::Map { key } => at.get(key.as_str()),
            Segment::Seq { index } => at.get(*index),
            _ => None,
        };
        let Some(next) = next else { return String::new() };
        at = next;
    }
    // The JSON reader bounds the depth. The last entry is next, so the search finds the first value in the file first.
    let mut open = vec![(String::new(), at)];
    while let Some((way, value)) = open.pop() {
        if !way.is_empty() && is_blamed(value, reason) {
            return way;
        }
        match value {
            Value::Array(list) => {
                open.extend(list.iter().enumerate().rev().map(|(i, v)| (format!("{way}[{i}]"), v)));
            }
            Value::Object(map) => {
                open.extend(map.iter().rev().filter(|(k, _)| *k != "type").map(|(k, v)| (format!("{way}.{k}"), v)));
            }
            _ => {}
        }
    }
    String::new()
}

/// Whether serde's message blames this value.
fn is_blamed(value: &Value, reason: &str) -> bool {
    let variant = reason.strip_prefix("unknown variant `").and_then(|rest| rest.split('`').next());
    let found = match value {
        Value::String(v) if variant == Some(v) => return true,
        Value::Null => "null".to_owned(),
        Value::Bool(v) => format!("boolean `{v}`"),
        Value::Number(v) if v.is_f64() => return false,
        Value::Number(v) => format!("integer `{v}`"),
        Value::String(v) => format!("string {v:?}"),
        Value::Array(v) if reason.starts_with(&format!("invalid length {}, ", v.len())) => return true,
        Value::Array(_) => "sequence".to_owned(),
        Value::Object(map) if is_blamed_file(map, reason) => return true,
        Value::Object(_) => "map".to_owned(),
    };
    reason.strip_prefix("invalid type: ").and_then(|r| r.strip_prefix(&found)).is_some_and(|r| r.starts_with(", "))
}

/// Whether serde's message blames this attachment: it cannot be used, or its fields are wrong.
fn is_blamed_file(map: &Map<String, Value>, reason: &str) -> bool {
    let field = |name: &str| map.get(name).and_then(Value::as_str);
    match (field("name"), field("base64"), named(reason)) {
        (Some(name), Some(_), None) => reason.starts_with(&format!("{:?} ", cleaned(name))),
        (None, Some(_), Some("name")) | (Some(_), None, Some("base64")) => reason.starts_with("missing field"),
        (Some(_), Some(_), Some(unknown)) => reason.starts_with("unknown field") && map.contains_key(unknown),
        _ => false,
    }
}

/// The readable part of the node at `index`, up to the error. Keeps nothing else.
fn node_at(text: &str, index: usize) -> Value {
    let mut found = Map::new();
    // An error is expected: the text is broken, or reading stops early.
    let _ = serde_json::Deserializer::from_str(text).deserialize_map(Top { index, found: &mut found });
    Value::Object(found)
}

struct Top<'a> {
    index: usize,
    found: &'a mut Map<String, Value>,
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
    found: &'a mut Map<String, Value>,
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
    found: &'a mut Map<String, Value>,
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
            let value = map.next_value()?;
            self.found.insert(key, value);
        }
        Ok(())
    }
}
