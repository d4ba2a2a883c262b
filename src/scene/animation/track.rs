//! Keys, and the track of a parameter.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::param_path::ParamPath;
use crate::params::ParamValue;

/// Two keys of a track nearer than this are the same key for edits, in seconds: frames are counted in numbers that
/// have no exact form.
pub const SAME_TIME: f64 = 1e-6;

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
}
