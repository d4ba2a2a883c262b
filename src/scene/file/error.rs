//! Errors in files: what is wrong, and where.

use std::fmt;
use std::path::Path;

use serde::Serialize;

use crate::NodeId;
use crate::check::Fault;

/// Why a file could not be read or written: which file, where in it, and the reason.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct FileError {
    /// Path of the file.
    pub file: String,
    /// Name and id of the node, if the error concerns one.
    pub node: Option<String>,
    /// Path of the value, such as `nodes[3].object.shape.radius`, if the error concerns one.
    pub field: Option<String>,
    /// The reason, in plain words.
    pub reason: String,
}

impl FileError {
    /// An error about the file as a whole.
    pub fn new(file: &Path, reason: impl Into<String>) -> Self {
        Self { file: file.display().to_string(), node: None, field: None, reason: reason.into() }
    }

    /// Adds the node.
    pub(super) fn of_node(mut self, name: &str, id: NodeId) -> Self {
        self.node = Some(format!("{} {id}", clipped(name, 60)).trim_start().to_owned());
        self
    }

    /// Adds the path of the value.
    pub(super) fn at(mut self, field: impl Into<String>) -> Self {
        self.field = Some(field.into());
        self
    }

    /// An error about a value below `outer` that failed a check.
    pub(super) fn from_fault(file: &Path, outer: &str, fault: Fault) -> Self {
        Self::new(file, fault.reason).at(format!("{outer}.{}", fault.field))
    }
}

/// Text from a file, prepared for a message: shortened, and without control characters.
pub(super) fn clipped(text: &str, most: usize) -> String {
    let mut out: String =
        text.chars().take(most).map(|c| if c.is_control() { char::REPLACEMENT_CHARACTER } else { c }).collect();
    if out.len() < text.len() && text.chars().nth(most).is_some() {
        out.push('…');
    }
    out
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: ", self.file)?;
        if let Some(node) = &self.node {
            write!(f, "{node}: ")?;
        }
        if let Some(field) = &self.field {
            write!(f, "{field}: ")?;
        }
        f.write_str(&self.reason)
    }
}

impl std::error::Error for FileError {}
