//! The tracks of a scene are checked when they are set.

use super::track::Track;
use super::tracks::doubled;
use crate::check::{self, Fault};
use crate::limits::{KEY_TIME, MAX_KEYS, MAX_TRACK_KEYS, MAX_TRACKS};
use crate::{Scene, SceneError};

impl Track {
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
