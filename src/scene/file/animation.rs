//! The animation of a scene in files.

use std::path::Path;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::error::FileError;
use super::list::at_most;
use crate::animation::doubled;
use crate::check::Fault;
use crate::limits::{MAX_KEYS, MAX_TRACK_KEYS};
use crate::{Animation, KeyInterpolation, Keyframe, ParamOwner, ParamPath, ParamValue, Scene, Track};

/// The keys of a parameter.
#[derive(Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a track in braces")]
pub(super) struct TrackFile {
    /// The parameter, such as `node.12.transform.translation`, or one of its elements, such as
    /// `material.3.base_color[0]`.
    pub path: String,
    /// Its keys, each later than the one before.
    #[serde(deserialize_with = "at_most::<_, _, MAX_TRACK_KEYS>")]
    pub keys: Vec<KeyFile>,
}

/// The value of a parameter at a moment.
#[derive(Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a key in braces")]
pub(super) struct KeyFile {
    /// The moment, in seconds.
    pub time: f64,
    /// The value, in the form that the parameter has elsewhere in the file.
    pub value: KeyValue,
    /// How the value changes to that of the next key.
    #[serde(default, skip_serializing_if = "is_usual")]
    pub interpolation: KeyInterpolation,
}

fn is_usual(interpolation: &KeyInterpolation) -> bool {
    *interpolation == KeyInterpolation::default()
}

/// A value that can change with time.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "must be a number, true or false, three of them, or a quaternion")]
pub(super) enum KeyValue {
    /// On or off.
    Flag(bool),
    /// A whole number.
    Whole(u32),
    /// A number.
    Number(f64),
    /// On or off for each axis.
    Flags([bool; 3]),
    /// A whole number for each axis.
    Wholes([u32; 3]),
    /// A point, a size, a color.
    Vector([f64; 3]),
    /// A unit quaternion.
    Rotation([f64; 4]),
}

impl KeyValue {
    fn of(value: &ParamValue) -> Option<Self> {
        Some(match value {
            ParamValue::Scalar(v) => Self::Number(*v),
            ParamValue::Vector(v) => Self::Vector(v.to_array()),
            ParamValue::Count(n) => Self::Whole(*n),
            ParamValue::Counts(n) => Self::Wholes(*n),
            ParamValue::Flag(on) => Self::Flag(*on),
            ParamValue::Flags(on) => Self::Flags(*on),
            ParamValue::Rotation(q) => Self::Rotation(q.to_array()),
            ParamValue::Choice(_) | ParamValue::List(_) | ParamValue::Text(_) | ParamValue::File(_) => return None,
        })
    }

    /// The value, if it has the type of `now`.
    fn like(&self, now: &ParamValue) -> Option<ParamValue> {
        Some(match (now, self) {
            (ParamValue::Scalar(_), Self::Number(v)) => ParamValue::Scalar(*v),
            (ParamValue::Scalar(_), Self::Whole(n)) => ParamValue::Scalar(f64::from(*n)),
            (ParamValue::Vector(_), Self::Vector(v)) => ParamValue::Vector((*v).into()),
            (ParamValue::Vector(_), Self::Wholes(n)) => ParamValue::Vector(n.map(f64::from).into()),
            (ParamValue::Count(_), Self::Whole(n)) => ParamValue::Count(*n),
            (ParamValue::Counts(_), Self::Wholes(n)) => ParamValue::Counts(*n),
            (ParamValue::Flag(_), Self::Flag(on)) => ParamValue::Flag(*on),
            (ParamValue::Flags(_), Self::Flags(on)) => ParamValue::Flags(*on),
            (ParamValue::Rotation(_), Self::Rotation(q)) => {
                ParamValue::Rotation(crate::check::settled_rotation(glam::DQuat::from_array(*q)))
            }
            _ => return None,
        })
    }
}

/// The tracks as files hold them.
pub(super) fn written(animation: &Animation) -> Vec<TrackFile> {
    let key = |key: &Keyframe| {
        let value = KeyValue::of(&key.value)?;
        Some(KeyFile { time: key.time, value, interpolation: key.interpolation })
    };
    let track = |track: &std::sync::Arc<Track>| TrackFile {
        path: track.path.to_string(),
        keys: track.keys.iter().filter_map(key).collect(),
    };
    animation.tracks().iter().map(track).collect()
}

/// Checks the animation of a scene that is about to be written.
pub(super) fn check(scene: &Scene, file: &Path) -> Result<(), FileError> {
    scene.animation.timeline.check().map_err(|fault| FileError::from_fault(file, "timeline", fault))?;
    for (i, track) in scene.animation.tracks().iter().enumerate() {
        track.check(scene).map_err(|fault| located(scene, file, i, Some(&track.path), fault))?;
    }
    Ok(())
}

/// Adds the tracks of a file to the scene of the file.
pub(super) fn add_tracks(scene: &mut Scene, tracks: Vec<TrackFile>, file: &Path) -> Result<(), FileError> {
    let mut animation = Animation::default();
    animation.timeline = scene.animation.timeline;
    let mut keys = 0;
    for (i, read) in tracks.into_iter().enumerate() {
        let path: Option<ParamPath> = read.path.parse().ok();
        let track = track(scene, read).map_err(|fault| located(scene, file, i, path.as_ref(), fault))?;
        let path = track.path.clone();
        let fail = |field: &str, reason: String| {
            Err(located(scene, file, i, Some(&path), Fault { field: field.into(), reason }))
        };
        if animation.track(&path).is_some() {
            return fail("path", format!("another track has the path {path}"));
        }
        keys += track.keys.len();
        animation.put(track);
        if let Some(reason) = doubled(&animation, &path) {
            return fail("path", reason);
        }
        if keys > MAX_KEYS {
            return fail("keys", format!("the scene holds more than {MAX_KEYS} keys"));
        }
    }
    scene.animation = animation;
    Ok(())
}

fn track(scene: &Scene, read: TrackFile) -> Result<Track, Fault> {
    let fault = |error: crate::SceneError| Fault { field: "path".into(), reason: error.to_string() };
    let path: ParamPath = read.path.parse().map_err(fault)?;
    let now = path.get(scene).map_err(fault)?;
    let mut keys = Vec::with_capacity(read.keys.len());
    for (i, key) in read.keys.into_iter().enumerate() {
        let value = key.value.like(&now).ok_or_else(|| Fault {
            field: format!("keys[{i}].value"),
            reason: format!("must be a value like {now}"),
        })?;
        keys.push(Keyframe { time: key.time, value, interpolation: key.interpolation });
    }
    let track = Track { path, keys };
    track.check(scene)?;
    Ok(track)
}

/// The error about a track, with the node of its parameter.
fn located(scene: &Scene, file: &Path, index: usize, path: Option<&ParamPath>, fault: Fault) -> FileError {
    let error = FileError::from_fault(file, &format!("tracks[{index}]"), fault);
    match path.map(|path| path.owner) {
        Some(ParamOwner::Node(id, _)) => match scene.node(id) {
            Some(node) => error.of_node(&node.name, id),
            None => error,
        },
        _ => error,
    }
}
