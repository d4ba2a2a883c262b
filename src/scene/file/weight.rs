//! Counts the values in a text before it is parsed. Serde buffers an entry with an inner `type` as a whole, and a list
//! of a million numbers then takes twenty times the size of its text.

use serde::Deserialize;

use crate::limits::MAX_ENTRY_VALUES;

/// An entry of a file with too many values.
#[derive(Debug)]
pub(super) struct TooMuch {
    /// Offset in the text at which the entry exceeds the limit, in bytes.
    pub at: usize,
    /// Path of the entry in the file.
    pub field: String,
    /// Its name and id, as far as the text contains them.
    pub name: String,
    pub id: Option<u64>,
}

/// Searches for an entry with more than [`MAX_ENTRY_VALUES`] values: a node, a material, a track,
/// or any other entry at the top.
/// Returns the number of nodes.
pub(super) fn weigh(text: &str) -> Result<usize, TooMuch> {
    let bytes = text.as_bytes();
    let mut depth = 0_usize;
    let (mut key, mut is_key_next) = ("", false);
    // In a list of entries: the index of the current entry, and its start.
    let (mut index, mut start) = (0, 0);
    let (mut values, mut nodes) = (0, 0);
    let mut i = 0;
    while i < bytes.len() {
        let in_list = depth > 1 && matches!(key, "nodes" | "materials" | "tracks");
        match bytes[i] {
            b'"' => {
                let end = string_end(bytes, i + 1);
                if depth == 1 && is_key_next {
                    key = text.get(i + 1..end).unwrap_or_default();
                    (is_key_next, index, start, values) = (false, 0, i, 0);
                }
                i = end;
            }
            b'{' | b'[' => {
                if depth == 2 && in_list {
                    (start, values) = (i, 0);
                    nodes += usize::from(key == "nodes");
                }
                depth += 1;
                values += 1;
                is_key_next |= depth == 1;
            }
            b'}' | b']' => depth = depth.saturating_sub(1),
            b',' if depth == 1 => is_key_next = true,
            b',' if depth == 2 && in_list => {
                index += 1;
                (start, values) = (i, 0);
            }
            b',' => values += 1,
            _ => {}
        }
        if values > MAX_ENTRY_VALUES {
            let field = if in_list { format!("{key}[{index}]") } else { key.to_owned() };
            let (name, id) = if in_list { named(&text[start..]) } else { Default::default() };
            return Err(TooMuch { at: i, field, name, id });
        }
        i += 1;
    }
    Ok(nodes)
}

/// The end of the string whose first letter is at `from`: its closing quote, or the end of the text.
fn string_end(bytes: &[u8], from: usize) -> usize {
    let mut i = from;
    loop {
        let Some(found) = bytes[i.min(bytes.len())..].iter().position(|b| matches!(b, b'"' | b'\\')) else {
            return bytes.len();
        };
        i += found;
        if bytes[i] == b'"' {
            return i;
        }
        // An escaped quote does not end the string.
        i += 2;
    }
}

/// The name and the id of the entry at the start of a text; skips the rest of the entry.
fn named(text: &str) -> (String, Option<u64>) {
    #[derive(Default, Deserialize)]
    #[serde(default)]
    struct Entry {
        id: Option<serde_json::Number>,
        name: String,
    }
    let entry = Entry::deserialize(&mut serde_json::Deserializer::from_str(text)).unwrap_or_default();
    (entry.name, entry.id.and_then(|id| id.as_u64()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_are_weighed_one_by_one() {
        let list = |count: usize| format!("[{}]", vec!["0"; count].join(","));
        let scene = |nodes: &str| format!(r#"{{"isolith": 1, "nodes": [{nodes}]}}"#);
        let small = format!(r#"{{"id": 1, "x": {}}}"#, list(MAX_ENTRY_VALUES / 2));
        assert!(weigh(&scene(&[small.as_str(); 9].join(","))).is_ok());
        let large = format!(r#"{{"id": 2, "name": "a, \"b\" [", "x": {}}}"#, list(MAX_ENTRY_VALUES));
        let found = weigh(&scene(&[&*small, &*large].join(","))).unwrap_err();
        assert_eq!((&*found.field, &*found.name, found.id), ("nodes[1]", "a, \"b\" [", Some(2)));
        let found = weigh(&format!(r#"{{"isolith": {}}}"#, list(2 * MAX_ENTRY_VALUES))).unwrap_err();
        assert_eq!(found.field, "isolith");
        // Commas inside strings do not count as separators.
        assert!(weigh(&scene(&format!(r#"{{"name": "{}"}}"#, "[,".repeat(MAX_ENTRY_VALUES)))).is_ok());
        for broken in ["", "]", "{\"", "{\"a\\", "[[[[", "}}}}{\"nodes\":[,"] {
            assert!(weigh(broken).is_ok(), "{broken}");
        }
    }
}
