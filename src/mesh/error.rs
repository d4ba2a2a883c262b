//! Why a mesh file was refused, and how what stands in files is shown.

use std::path::Path;

use serde::Serialize;
use thiserror::Error;

/// A mesh file that cannot be used: which, where in it, and why.
#[derive(Clone, Debug, PartialEq, Eq, Error, Serialize)]
#[error("{file}: {}{reason}", if place.is_empty() { String::new() } else { format!("{place}: ") })]
pub struct MeshError {
    /// The glTF file, or the path as the scene names it.
    pub file: String,
    /// Where in the file, like `meshes[0].primitives[1].indices`; empty for the file as a whole.
    pub place: String,
    /// What is the matter, for people.
    pub reason: String,
}

impl MeshError {
    /// An error whose parts may be text from files: they are made fit to be shown.
    pub(super) fn new(file: &str, place: &str, reason: &str) -> Self {
        Self { file: shown(file, LONGEST_PATH), place: shown(place, LONGEST_TEXT), reason: shown(reason, LONGEST_TEXT) }
    }
}

/// A refusal before the file's name is known: place and reason.
#[derive(Debug)]
pub(super) struct LoadRefusal {
    place: String,
    reason: String,
}

impl LoadRefusal {
    /// A refusal of the thing at `place`.
    pub fn at(place: impl Into<String>, reason: impl Into<String>) -> Self {
        Self { place: place.into(), reason: reason.into() }
    }

    /// With the file's name.
    pub fn of(self, file: &Path) -> MeshError {
        MeshError::new(&file.display().to_string(), &self.place, &self.reason)
    }

    /// As the text of a warning, where the rest of the file can be used without.
    pub fn into_warning(self) -> String {
        format!("{}: {}", self.place, self.reason)
    }
}

/// Most characters of a path in a message: more than any path that a system opens.
const LONGEST_PATH: usize = 4096;
/// Most characters of a reason in a message.
pub(super) const LONGEST_TEXT: usize = 400;
/// Most characters of one name within a message.
const LONGEST_NAME: usize = 80;

/// A name out of a file, short enough to stand in a message.
pub(super) fn name(text: &str) -> String {
    shown(text, LONGEST_NAME)
}

/// Text that may come from a file, fit for terminals and windows: characters that control either, or turn the order
/// of others round, are written as their codes, and what is too long is cut.
pub(super) fn shown(text: &str, longest: usize) -> String {
    let mut out = String::with_capacity(text.len().min(longest));
    for (i, c) in text.chars().enumerate() {
        if i == longest {
            out.push('…');
            break;
        }
        if c.is_control() || changes_direction(c) { out.extend(c.escape_unicode()) } else { out.push(c) }
    }
    out
}

/// Marks, embeddings, overrides and isolates of the bidirectional algorithm, and the separators of lines.
fn changes_direction(c: char) -> bool {
    matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_controls_a_terminal_is_written_as_its_code() {
        assert_eq!(shown("\u{1b}]0;x\u{7}", 80), "\\u{1b}]0;x\\u{7}");
        assert_eq!(shown("\u{9b}31m a\nb", 80), "\\u{9b}31m a\\u{a}b");
        assert_eq!(shown("txt\u{202e}fdp", 80), "txt\\u{202e}fdp");
        assert_eq!(shown("größe 木 é", 80), "größe 木 é");
        assert_eq!(shown("abcd", 3), "abc…");
        assert_eq!(shown("abc", 3), "abc");
    }
}
