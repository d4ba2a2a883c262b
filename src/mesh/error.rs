//! Why a mesh file was refused.

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

/// A refusal before the file's name is known: place and reason.
#[derive(Debug)]
pub(super) struct Refusal {
    place: String,
    reason: String,
}

impl Refusal {
    /// A refusal of the thing at `place`.
    pub fn at(place: impl Into<String>, reason: impl Into<String>) -> Self {
        Self { place: place.into(), reason: reason.into() }
    }

    /// With the file's name.
    pub fn of(self, file: &Path) -> MeshError {
        MeshError { file: file.display().to_string(), place: self.place, reason: self.reason }
    }
}
