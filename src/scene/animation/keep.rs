//! Tracks follow what an edit does to their parameters: they go with a node that is removed, come along with a copy,
//! and stay with their modifier or motion when its place in the list changes.

use std::collections::HashMap;
use std::sync::Arc;

use super::track::Track;
use crate::{Node, NodeId, NodeKind, ParamOwner, ParamPath, Part, Scene, SceneError};

impl Scene {
    /// Removes the tracks of parameters that no longer exist or can no longer have the values of the keys. Undo brings
    /// them back, because it brings back the whole scene.
    pub fn drop_lost_tracks(&mut self) {
        let is_lost = |track: &Arc<Track>| track.check(self).is_err();
        if self.animation.tracks.iter().any(is_lost) {
            let kept: Vec<_> = self.animation.tracks.iter().filter(|track| !is_lost(track)).cloned().collect();
            self.animation.tracks = kept;
        }
    }

    /// Copies the tracks of nodes to their copies.
    ///
    /// # Errors
    /// There would be too many tracks or keys.
    pub fn copy_tracks(&mut self, copy_of: &HashMap<NodeId, NodeId>) -> Result<(), SceneError> {
        let copied = |track: &Arc<Track>| {
            let ParamOwner::Node(id, part) = track.path.owner else { return None };
            let owner = ParamOwner::Node(*copy_of.get(&id)?, part);
            Some(Track { path: ParamPath { owner, ..track.path.clone() }, keys: track.keys.clone() })
        };
        let copies: Vec<_> = self.animation.tracks.iter().filter_map(copied).collect();
        if copies.is_empty() { Ok(()) } else { self.set_tracks(copies) }
    }

    /// Moves the tracks of the entries of a node's lists to their new places.
    pub fn move_tracks(&mut self, id: NodeId, parts: &MovedParts) {
        let is_moved = |track: &Arc<Track>| match track.path.owner {
            ParamOwner::Node(owner, part) => owner == id && parts.of(part) != Some(part),
            _ => false,
        };
        let (moved, kept): (Vec<_>, Vec<_>) = self.animation.tracks.drain(..).partition(is_moved);
        self.animation.tracks = kept;
        for track in moved {
            let ParamOwner::Node(_, part) = track.path.owner else { continue };
            if let Some(part) = parts.of(part) {
                let path = ParamPath { owner: ParamOwner::Node(id, part), ..track.path.clone() };
                self.animation.put(Track { path, keys: track.keys.clone() });
            }
        }
    }
}

/// Where the entries of a node's lists stand after a change of the node.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MovedParts {
    modifiers: Vec<Option<usize>>,
    dynamics: Vec<Option<usize>>,
    masks: Vec<Option<usize>>,
}

impl MovedParts {
    /// Compares the lists of a node before and after a change.
    pub fn between(old: &Node, new: &Node) -> Self {
        let masks = |node: &Node| match &node.kind {
            NodeKind::Instancer(instancer) => instancer.masks.clone(),
            _ => Vec::new(),
        };
        Self {
            modifiers: places(&old.modifiers, &new.modifiers, |a, b| a.modifier.kind() == b.modifier.kind()),
            dynamics: places(&old.dynamics, &new.dynamics, |a, b| a.dynamic.kind() == b.dynamic.kind()),
            masks: places(&masks(old), &masks(new), |a, b| a.mask.kind() == b.mask.kind()),
        }
    }

    /// The part after the change; `None` if it is gone.
    pub fn of(&self, part: Part) -> Option<Part> {
        let place = |list: &[Option<usize>], at: usize| list.get(at).copied().flatten();
        match part {
            Part::Modifier(at) => place(&self.modifiers, at).map(Part::Modifier),
            Part::Dynamic(at) => place(&self.dynamics, at).map(Part::Dynamic),
            Part::Mask(at) => place(&self.masks, at).map(Part::Mask),
            other => Some(other),
        }
    }
}

/// Where each entry of the old list stands in the new one. Entries have no identity, so those that are equal are the
/// same, and one that is left over is the same as the one of its kind in its place.
fn places<T: PartialEq>(old: &[T], new: &[T], is_same_kind: impl Fn(&T, &T) -> bool) -> Vec<Option<usize>> {
    let mut places = vec![None; old.len()];
    let mut taken = vec![false; new.len()];
    let mut claim = |old_at: usize, new_at: usize| {
        if places[old_at].is_none() && !taken[new_at] {
            (places[old_at], taken[new_at]) = (Some(new_at), true);
        }
    };
    let both = old.len().min(new.len());
    for at in (0..both).filter(|at| old[*at] == new[*at]) {
        claim(at, at);
    }
    for (at, entry) in old.iter().enumerate() {
        for (new_at, _) in new.iter().enumerate().filter(|(_, other)| *other == entry) {
            claim(at, new_at);
        }
    }
    for at in (0..both).filter(|at| is_same_kind(&old[*at], &new[*at])) {
        claim(at, at);
    }
    places
}
