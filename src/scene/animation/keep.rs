//! Tracks follow what an edit does to their parameters: they go with a node that is removed, come along with a copy,
//! and stay with their modifier when its place in the list changes.

use std::collections::HashMap;
use std::sync::Arc;

use crate::{ModifierSlot, NodeId, ParamOwner, ParamPath, Part, Scene, SceneError, Track};

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

    /// Moves the tracks of a node's modifiers to their new places in the list; `places` has one for each old place,
    /// `None` for a modifier that is gone.
    pub fn move_modifier_tracks(&mut self, id: NodeId, places: &[Option<usize>]) {
        let is_moved = |track: &Arc<Track>| match track.path.owner {
            ParamOwner::Node(owner, Part::Modifier(place)) => owner == id && places.get(place) != Some(&Some(place)),
            _ => false,
        };
        let (moved, kept): (Vec<_>, Vec<_>) = self.animation.tracks.drain(..).partition(is_moved);
        self.animation.tracks = kept;
        for track in moved {
            let ParamOwner::Node(_, Part::Modifier(old)) = track.path.owner else { continue };
            if let Some(new) = places.get(old).copied().flatten() {
                let path = ParamPath { owner: ParamOwner::Node(id, Part::Modifier(new)), ..track.path.clone() };
                self.animation.put(Track { path, keys: track.keys.clone() });
            }
        }
    }
}

/// Where each modifier of the old list stands in the new one. Modifiers have no identity, so those that are equal are
/// the same, and one that is left over is the same as the one of its kind in its place.
pub fn modifier_places(old: &[ModifierSlot], new: &[ModifierSlot]) -> Vec<Option<usize>> {
    let mut places = vec![None; old.len()];
    let mut taken = vec![false; new.len()];
    let mut claim = |old_at: usize, new_at: usize, places: &mut Vec<Option<usize>>| {
        if places[old_at].is_none() && !taken[new_at] {
            (places[old_at], taken[new_at]) = (Some(new_at), true);
        }
    };
    for at in (0..old.len().min(new.len())).filter(|at| old[*at] == new[*at]) {
        claim(at, at, &mut places);
    }
    for (at, slot) in old.iter().enumerate() {
        for (new_at, _) in new.iter().enumerate().filter(|(_, other)| *other == slot) {
            claim(at, new_at, &mut places);
        }
    }
    for at in 0..old.len().min(new.len()) {
        if old[at].modifier.kind() == new[at].modifier.kind() {
            claim(at, at, &mut places);
        }
    }
    places
}
