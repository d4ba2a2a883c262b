//! Animation: parameters of a scene whose values change with time.
//!
//! A [`Track`] holds the keys of one parameter, named by its [`ParamPath`]. The scene at a moment is a scene like any
//! other, see [`Scene::at`]. The scene itself keeps its resting values.
//!
//! | file | holds |
//! |---|---|
//! | `curve` | the value between two keys |
//! | `evaluate` | the scene at a moment |
//! | `keep` | tracks that follow what an edit does to their parameters |

mod curve;
mod evaluate;
mod keep;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use keep::MovedParts;

use super::check::{self, Fault};
use super::limits::{FRAMES_PER_SECOND, KEY_TIME, MAX_KEYS, MAX_TRACK_KEYS, MAX_TRACKS, NO_LIMITS};
use super::params::param_struct;
use super::{ParamOwner, ParamPath, ParamValue, Scene, SceneError};

/// Two keys of a track nearer than this are the same key for edits, in seconds: frames are counted in numbers that
/// have no exact form.
pub const SAME_TIME: f64 = 1e-6;

param_struct! {
    /// The part of time that the timeline plays, and how finely it counts.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(deny_unknown_fields, default)]
    pub struct Timeline {
        /// Frames per second of playback and of rendered pictures.
        frames_per_second: f64 = 24.0, FRAMES_PER_SECOND;
        /// The first moment that is played.
        start: f64 = 0.0, KEY_TIME;
        /// The last moment that is played.
        end: f64 = 10.0, KEY_TIME;
        /// Whether playback starts again at its end.
        is_looping: bool = true, NO_LIMITS.labeled("Loop");
    }
}

impl Timeline {
    /// The moment of a frame. Frame 0 is at 0 seconds.
    pub fn time_of(&self, frame: f64) -> f64 {
        frame / self.frames_per_second
    }

    /// The frame of a moment, with its fraction.
    pub fn frame_at(&self, time: f64) -> f64 {
        time * self.frames_per_second
    }

    /// The moment of the nearest whole frame.
    pub fn snapped(&self, time: f64) -> f64 {
        self.time_of(self.frame_at(time).round())
    }

    /// Checks every value.
    pub fn check(&self) -> Result<(), Fault> {
        check::values(self)?;
        match self.start < self.end {
            true => Ok(()),
            false => {
                let reason = format!("must be more than the start of {}, not {}", self.start, self.end);
                Err(Fault { field: "end".into(), reason })
            }
        }
    }
}

/// How a value changes from a key to the next one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum KeyInterpolation {
    /// Along a curve through the keys that never passes them.
    #[default]
    Smooth,
    /// At a constant rate.
    Linear,
    /// Not until the next key.
    Hold,
}

impl KeyInterpolation {
    /// Every interpolation, in the order of the user interface.
    pub const ALL: [Self; 3] = [Self::Smooth, Self::Linear, Self::Hold];

    /// Display name.
    pub fn label(self) -> &'static str {
        match self {
            Self::Smooth => "Smooth",
            Self::Linear => "Linear",
            Self::Hold => "Hold",
        }
    }

    /// The help text.
    pub fn help(self) -> &'static str {
        match self {
            Self::Smooth => "A curve through the keys that never passes them; it stands still at its ends",
            Self::Linear => "At a constant rate",
            Self::Hold => "The value stays until the next key",
        }
    }
}

/// The value of a parameter at a moment.
#[derive(Clone, Debug, PartialEq)]
pub struct Keyframe {
    /// The moment, in seconds.
    pub time: f64,
    /// The value.
    pub value: ParamValue,
    /// How it changes from here to the next key.
    pub interpolation: KeyInterpolation,
}

/// The keys of a parameter. Before the first one the parameter has the value of the first, after the last one that of
/// the last.
#[derive(Clone, Debug, PartialEq)]
pub struct Track {
    /// The parameter, or one of its elements.
    pub path: ParamPath,
    /// Its keys; each is later than the one before. Not empty in a scene.
    pub keys: Vec<Keyframe>,
}

impl Track {
    /// The index of the key at this moment.
    pub fn key_at(&self, time: f64) -> Option<usize> {
        self.keys.iter().position(|key| (key.time - time).abs() < SAME_TIME)
    }

    /// The value at `time` seconds; `None` without keys.
    pub fn value_at(&self, time: f64) -> Option<ParamValue> {
        (!self.keys.is_empty()).then(|| curve::value(&self.keys, time))
    }

    /// Sets a key. It replaces the one at its moment.
    pub fn set(&mut self, key: Keyframe) {
        match self.key_at(key.time) {
            Some(at) => self.keys[at] = key,
            None => {
                let at = self.keys.partition_point(|other| other.time < key.time);
                self.keys.insert(at, key);
            }
        }
    }

    /// Sets the value at a moment. A new key interpolates as the one before it does.
    pub fn set_value(&mut self, time: f64, value: ParamValue) {
        if let Some(at) = self.key_at(time) {
            self.keys[at].value = value;
            return;
        }
        let before = self.keys.partition_point(|other| other.time < time).saturating_sub(1);
        let interpolation = self.keys.get(before).map_or_else(KeyInterpolation::default, |key| key.interpolation);
        self.set(Keyframe { time, value, interpolation });
    }

    /// Checks the track as one of this scene: its parameter, and the order, types and limits of its keys.
    pub fn check(&self, scene: &Scene) -> Result<(), Fault> {
        let fault = |field: &str, reason: String| Err(Fault { field: field.to_owned(), reason });
        let (param, now) = match (self.path.param(scene), self.path.get(scene)) {
            (Ok(param), Ok(now)) => (param, now),
            (Err(error), _) | (_, Err(error)) => return fault("path", error.to_string()),
        };
        if !param.animatable {
            return fault("path", format!("{} cannot change with time", self.path));
        }
        if self.keys.is_empty() || self.keys.len() > MAX_TRACK_KEYS {
            return fault("keys", format!("must be 1 to {MAX_TRACK_KEYS} keys, not {}", self.keys.len()));
        }
        for (i, key) in self.keys.iter().enumerate() {
            let (time, value) = (format!("keys[{i}].time"), format!("keys[{i}].value"));
            if !KEY_TIME.accept(key.time) {
                let [least, most] = KEY_TIME.hard;
                return fault(&time, format!("must be {least} to {most} s, not {}", key.time));
            }
            if i > 0 && self.keys[i - 1].time >= key.time {
                let before = self.keys[i - 1].time;
                return fault(&time, format!("must be later than the key before, at {before} s, not {} s", key.time));
            }
            if std::mem::discriminant(&key.value) != std::mem::discriminant(&now) {
                return fault(&value, format!("must be a value like {now}, not {}", key.value));
            }
            check::value(param, &key.value).map_err(|fault| Fault { field: value.clone(), ..fault })?;
        }
        Ok(())
    }
}

/// The timeline and the tracks of a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Animation {
    /// What is played.
    pub timeline: Timeline,
    /// Sorted by path, one for each, so that those of one owner stand together.
    tracks: Vec<Arc<Track>>,
}

impl Animation {
    /// All tracks, sorted by path.
    pub fn tracks(&self) -> &[Arc<Track>] {
        &self.tracks
    }

    /// Whether nothing is animated.
    pub fn is_empty(&self) -> bool {
        self.tracks.is_empty()
    }

    /// The track with exactly this path.
    pub fn track(&self, path: &ParamPath) -> Option<&Arc<Track>> {
        self.place(path).ok().map(|at| &self.tracks[at])
    }

    /// The tracks that animate a parameter: one of the whole, or those of its elements. For the path of an element,
    /// its own track and that of the whole.
    pub fn tracks_of<'a>(&'a self, path: &'a ParamPath) -> impl Iterator<Item = &'a Arc<Track>> {
        let whole = ParamPath { element: None, ..path.clone() };
        let start = self.tracks.partition_point(|track| track.path < whole);
        let same = move |track: &&Arc<Track>| track.path.owner == whole.owner && track.path.name == whole.name;
        let meets = |track: &&Arc<Track>| {
            track.path.element.is_none() || path.element.is_none() || track.path.element == path.element
        };
        self.tracks[start..].iter().take_while(same).filter(meets)
    }

    /// The number of keys of all tracks.
    pub fn key_count(&self) -> usize {
        self.tracks.iter().map(|track| track.keys.len()).sum()
    }

    /// Puts a track in the place of the one with its path, or takes that one away if the new one has no keys. Checks
    /// nothing.
    pub(crate) fn put(&mut self, track: Track) {
        match (self.place(&track.path), track.keys.is_empty()) {
            (Ok(at), true) => {
                self.tracks.remove(at);
            }
            (Ok(at), false) => self.tracks[at] = Arc::new(track),
            (Err(at), false) => self.tracks.insert(at, Arc::new(track)),
            (Err(_), true) => {}
        }
    }

    fn place(&self, path: &ParamPath) -> Result<usize, usize> {
        self.tracks.binary_search_by(|track| track.path.cmp(path))
    }
}

impl Scene {
    /// Sets tracks, each in the place of the one with its path. A track without keys takes that one away.
    ///
    /// # Errors
    /// A track does not suit its parameter, or there are too many of them or of keys. The scene is unchanged.
    pub fn set_tracks(&mut self, tracks: impl IntoIterator<Item = Track>) -> Result<(), SceneError> {
        let mut animation = self.animation.clone();
        let mut paths = Vec::new();
        for track in tracks {
            if !track.keys.is_empty() {
                track.check(self).map_err(|fault| fault.into_error(track.path.to_string()))?;
                paths.push(track.path.clone());
            }
            animation.put(track);
        }
        for path in &paths {
            if let Some(reason) = doubled(&animation, path) {
                return Err(SceneError::Param { path: path.to_string(), reason });
            }
        }
        for (what, count, limit) in [
            ("the number of animated parameters", animation.tracks.len(), MAX_TRACKS),
            ("the number of keys", animation.key_count(), MAX_KEYS),
        ] {
            if count > limit {
                return Err(SceneError::Limit { what, limit });
            }
        }
        self.animation = animation;
        Ok(())
    }
}

/// Why a parameter has two sources of its value.
pub(crate) fn doubled(animation: &Animation, path: &ParamPath) -> Option<String> {
    animation.tracks_of(path).nth(1).map(|_| "is animated as a whole and by its elements; only one is possible".into())
}

/// Whether two parameters belong to the same node, material, environment or display.
fn is_same_owner(a: &ParamPath, b: &ParamPath) -> bool {
    match (a.owner, b.owner) {
        (ParamOwner::Node(a, _), ParamOwner::Node(b, _)) => a == b,
        (a, b) => a == b,
    }
}
