//! Which pose of a model is meant: its file, and a clip at a time.

use std::hash::{Hash, Hasher};

/// A model in a pose.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelPose {
    /// The file, relative to the scene's folder, with forward slashes.
    pub path: String,
    /// `None` for the rest pose.
    pub clip: Option<ClipTime>,
}

/// An animation clip of a file at a time.
#[derive(Clone, Debug, PartialEq)]
pub struct ClipTime {
    /// Its name; or its number, if no clip has such a name.
    pub name: String,
    /// In seconds; finite. Beyond its ends the clip repeats.
    pub time: f64,
}

// The time is finite.
impl Eq for ModelPose {}

impl Hash for ModelPose {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.path.hash(state);
        if let Some(clip) = &self.clip {
            clip.name.hash(state);
            // Equal numbers have equal bits, but for the two zeros.
            (clip.time + 0.0).to_bits().hash(state);
        }
    }
}

impl From<&str> for ModelPose {
    fn from(path: &str) -> Self {
        Self { path: path.to_owned(), clip: None }
    }
}

impl From<&String> for ModelPose {
    fn from(path: &String) -> Self {
        path.as_str().into()
    }
}

impl From<&Self> for ModelPose {
    fn from(pose: &Self) -> Self {
        pose.clone()
    }
}
