//! Edits of keys.

use std::sync::Arc;

use super::change::Change;
use isolith_scene::{Changed, Keyframe, ParamPath, ParamValue, Scene, SceneError, Track};

/// Sets keys; a parameter without a track gets one.
pub(super) fn set_keys(scene: &mut Arc<Scene>, keys: Vec<(ParamPath, Keyframe)>) -> Result<Change, SceneError> {
    let mut tracks: Vec<Track> = Vec::new();
    for (path, key) in keys {
        let at = tracks.iter().position(|track| track.path == path).unwrap_or_else(|| {
            let known = scene.animation.track(&path).map(|track| Track::clone(track));
            tracks.push(known.unwrap_or(Track { path, keys: Vec::new() }));
            tracks.len() - 1
        });
        tracks[at].set(key);
    }
    set_tracks(scene, tracks)
}

/// Replaces tracks by their paths.
pub(super) fn set_tracks(scene: &mut Arc<Scene>, tracks: Vec<Track>) -> Result<Change, SceneError> {
    let is_same = |track: &Track| match scene.animation.track(&track.path) {
        Some(known) => **known == *track,
        None => track.keys.is_empty(),
    };
    if tracks.iter().all(is_same) {
        return Ok(Change::NONE);
    }
    let mut next = Scene::clone(scene);
    next.set_tracks(tracks)?;
    *scene = Arc::new(next);
    Ok(Change::VALUE)
}

/// Removes the keys at moments. A parameter that loses its last key keeps the value of that key.
pub(super) fn remove_keys(scene: &mut Arc<Scene>, keys: &[(ParamPath, f64)]) -> Result<Change, SceneError> {
    let mut tracks: Vec<Track> = Vec::new();
    let mut left = Vec::new();
    for (path, time) in keys {
        let at = match tracks.iter().position(|track| track.path == *path) {
            Some(at) => at,
            None => {
                let Some(track) = scene.animation.track(path) else { continue };
                tracks.push(Track::clone(track));
                tracks.len() - 1
            }
        };
        if let Some(key) = tracks[at].key_at(*time) {
            let gone = tracks[at].keys.remove(key);
            if tracks[at].keys.is_empty() {
                left.push((path, gone.value));
            }
        }
    }
    let change = set_tracks(scene, tracks)?;
    for (path, value) in left {
        rest(Arc::make_mut(scene), path, value)?;
    }
    Ok(change)
}

/// Sets the resting value of a parameter.
fn rest(scene: &mut Scene, path: &ParamPath, value: ParamValue) -> Result<(), SceneError> {
    match path.changed(scene, value)? {
        Changed::Node(node) => scene.replace(*node),
        Changed::Material(material) => scene.replace_material(*material),
        Changed::Environment(environment) => scene.set_environment(environment),
        Changed::Display(display) => {
            scene.display = display;
            Ok(())
        }
    }
}
