//! Edits of an animated scene. Whoever edits sees the scene at a moment, so an edit names the values of that moment: a
//! changed value of an animated parameter becomes a key there, and the resting value stays.

use std::sync::Arc;

use super::change::Change;
use super::edit::Edit;
use isolith_scene::{
    MovedParts, Node, NodeId, ParamOwner, ParamPath, ParamValue, Params, Part, Scene, SceneError, Track,
};

/// New values of animated parameters, by their paths after the edit.
type NewValues = Vec<(ParamPath, ParamValue)>;

/// Performs an edit that was made on `shown`, the scene at `time` seconds. On failure the scene may be half changed.
pub(super) fn perform(edit: Edit, scene: &mut Arc<Scene>, shown: &Scene, time: f64) -> Result<Change, SceneError> {
    let mut values = Vec::new();
    let mut parts = None;
    let edit = match edit.resolved(shown)? {
        Edit::Replace(mut node) => {
            parts = hold_node(&mut node, scene, shown, &mut values).map(|parts| (node.id, parts));
            Edit::Replace(node)
        }
        Edit::ReplaceMaterial(mut material) => {
            if let (Some(was), Some(rest)) = (shown.material(material.id), scene.material(material.id)) {
                hold(ParamOwner::Material(material.id), scene, [&**was, &**rest], &mut material, &mut values);
            }
            Edit::ReplaceMaterial(material)
        }
        Edit::SetEnvironment(mut new) => {
            hold(ParamOwner::Environment, scene, [&shown.environment, &scene.environment], &mut new, &mut values);
            Edit::SetEnvironment(new)
        }
        Edit::SetDisplay(mut new) => {
            hold(ParamOwner::Display, scene, [&shown.display, &scene.display], &mut new, &mut values);
            Edit::SetDisplay(new)
        }
        edit @ (Edit::Move { .. } | Edit::Group { .. }) => return moved(edit, scene, shown),
        other => other,
    };
    let mut change = edit.perform(scene)?;
    if let Some((id, parts)) = parts {
        Arc::make_mut(scene).move_tracks(id, &parts);
    }
    if change.changed {
        Arc::make_mut(scene).drop_lost_tracks();
    }
    if !values.is_empty() {
        set_values(scene, values, time)?;
        change.changed = true;
    }
    Ok(change)
}

/// Sets keys at a moment in tracks that exist.
fn set_values(scene: &mut Arc<Scene>, values: NewValues, time: f64) -> Result<(), SceneError> {
    let track = |(path, value): (ParamPath, ParamValue)| {
        let mut track = Track::clone(scene.animation.track(&path)?);
        track.set_value(time, value);
        Some(track)
    };
    let tracks: Vec<_> = values.into_iter().filter_map(track).collect();
    Arc::make_mut(scene).set_tracks(tracks)
}

/// Puts the resting values of animated parameters back into `new`, and adds what was changed to `values`. `was` are the
/// parameters as the editor saw them, `rest` those at rest.
fn hold(owner: ParamOwner, scene: &Scene, [was, rest]: [&dyn Params; 2], new: &mut dyn Params, values: &mut NewValues) {
    for track in scene.animation.tracks().iter().filter(|track| track.path.owner == owner) {
        hold_value(&track.path, track.path.clone(), [was, rest], new, values);
    }
}

fn hold_value(
    path: &ParamPath,
    new_path: ParamPath,
    [was, rest]: [&dyn Params; 2],
    new: &mut dyn Params,
    values: &mut NewValues,
) {
    if let (Some(was), Some(now), Some(rest)) = (path.value_in(was), new_path.value_in(new), path.value_in(rest))
        && new_path.set_value(new, rest)
        && was != now
    {
        values.push((new_path, now));
    }
}

/// The same for all parts of a node. Returns where the entries of its lists stand now.
fn hold_node(new: &mut Node, scene: &Scene, shown: &Scene, values: &mut NewValues) -> Option<MovedParts> {
    let (was, rest) = (shown.node(new.id)?, scene.node(new.id)?);
    let parts = MovedParts::between(was, new);
    for track in scene.animation.tracks() {
        let ParamOwner::Node(id, part) = track.path.owner else { continue };
        if id != new.id {
            continue;
        }
        let Some(new_part) = parts.of(part) else { continue };
        let new_path = ParamPath { owner: ParamOwner::Node(id, new_part), ..track.path.clone() };
        if let (Some(was), Some(rest), Some(new)) = (part.params(was), part.params(rest), new_part.params_mut(new)) {
            hold_value(&track.path, new_path, [was, rest], new, values);
        }
    }
    Some(parts)
}

/// Moves nodes so that they keep the place in the world that they are seen at. Those that move with time keep their
/// own motion.
fn moved(edit: Edit, scene: &mut Arc<Scene>, shown: &Scene) -> Result<Change, SceneError> {
    let ids: Vec<NodeId> = match &edit {
        Edit::Move { ids, .. } | Edit::Group { ids, .. } => ids.clone(),
        _ => Vec::new(),
    };
    let mut as_seen = Arc::new(shown.clone());
    edit.clone().perform(&mut as_seen)?;
    let change = edit.perform(scene)?;
    let is_animated = |id: NodeId| {
        let owner = ParamOwner::Node(id, Part::Transform);
        scene.animation.tracks().iter().any(|track| track.path.owner == owner)
    };
    let still: Vec<NodeId> = ids.into_iter().filter(|id| !is_animated(*id)).collect();
    for id in still {
        if let (Some(node), Some(seen)) = (scene.node(id), as_seen.node(id))
            && node.transform != seen.transform
        {
            let node = Node { transform: seen.transform, ..Node::clone(node) };
            Arc::make_mut(scene).replace(node)?;
        }
    }
    Ok(change)
}
