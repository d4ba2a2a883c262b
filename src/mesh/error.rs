//! Why a mesh file was refused, and how messages show text from files.

use std::path::Path;

use serde::Serialize;
use thiserror::Error;

/// A mesh file that cannot be used: which file, where in it, and why.
#[derive(Clone, Debug, PartialEq, Eq, Error, Serialize)]
#[error("{file}: {}{reason}", if place.is_empty() { String::new() } else { format!("{place}: ") })]
pub struct MeshError {
    /// The glTF file, or the path as the scene names it.
    pub file: String,
    /// Where in the file, like `meshes[0].primitives[1].indices`; empty for the file as a whole.
    pub place: String,
    /// The reason, for the user.
    pub reason: String,
}

impl MeshError {
    /// An error whose parts may be text from files; it sanitizes them for display.
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

    /// Adds the file's name.
    pub fn of(self, file: &Path) -> MeshError {
        MeshError::new(&file.display().to_string(), &self.place, &self.reason)
    }

    /// The refusal as a warning, if the rest of the file can be used without the refused part.
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

/// A name from a file, shortened for a message.
pub(super) fn name(text: &str) -> String {
    shown(text, LONGEST_NAME)
}

/// Sanitizes text that may come from a file for terminals and windows: replaces control characters and characters that
/// reverse the text direction by their codes, and truncates long text.
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

/// Marks, embeddings, overrides and isolates of the bidirectional algorithm, and line separators.
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
