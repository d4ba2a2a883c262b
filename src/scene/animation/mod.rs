//! Animation: parameters of a scene whose values change with time.
//!
//! A [`Track`] holds the keys of one parameter, named by its [`ParamPath`]. The scene at a moment is a scene like any
//! other, see [`Scene::at`]. The scene itself keeps its resting values.
//!
//! | file | holds |
//! |---|---|
//! | `timeline` | which part of time is played |
//! | `track` | the keys of a parameter |
//! | `tracks` | all tracks of a scene |
//! | `of_scene` | the check of tracks |
//! | `curve` | the value between two keys |
//! | `evaluate` | the scene at a moment |
//! | `keep` | tracks that follow what an edit does to their parameters |

mod curve;
mod evaluate;
mod keep;
mod of_scene;
#[cfg(test)]
mod tests;
mod timeline;
mod track;
mod tracks;

pub use keep::MovedParts;
pub use timeline::Timeline;
pub use track::{KeyInterpolation, Keyframe, SAME_TIME, Track};
pub use tracks::Animation;
pub(crate) use tracks::doubled;
