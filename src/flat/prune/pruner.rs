//! Trees kept between frames, made anew only where an edit reached, and beside the frames where that takes long.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::kept::{Kept, alone};
use super::worker::Worker;
use super::{CellTree, can_be_pruned, is_pruned};
use crate::flat::{Cancel, Component, FlatScene, MAX_LISTED_ENTRIES};
use crate::guard::guarded;
use crate::scene::NodeId;

/// Keeps the trees of the last scene, and makes those of the next one from them.
#[derive(Debug, Default)]
pub struct Pruner {
    kept: HashMap<Key, Kept>,
    /// What the worker is at, with how long it is expected to take.
    away: HashMap<Key, Duration>,
    worker: Option<Worker>,
    prunes_all: bool,
    cancel: Cancel,
    /// Components whose lists cannot be made, and why, until somebody asks.
    failed: HashSet<Key>,
    failures: Vec<String>,
}

/// The node at the top of a component, and which one of those with this node it is.
pub(super) type Key = (NodeId, u32);

/// What an entry is expected to take where nothing is known of its component yet. Measured: 186 boxes 40 to 80 ms,
/// a blend of 2 000 leaves 200 to 400 ms.
const FRESH_ENTRY: Duration = Duration::from_micros(200);
/// What has taken longer than expected is not waited for again.
const TOO_LONG: Duration = Duration::from_secs(3600);

impl Pruner {
    /// Makes lists of small components too from now on: they gain nothing, but the lists can be tried.
    pub fn prune_all(&mut self) {
        self.prunes_all = true;
    }

    /// [`Pruner::trees`] stops waiting where this says so.
    pub fn set_cancel(&mut self, cancel: &Cancel) {
        self.cancel = cancel.clone();
    }

    /// Why lists could not be made since the last call; those components are walked without.
    pub fn take_failures(&mut self) -> Vec<String> {
        std::mem::take(&mut self.failures)
    }

    /// The trees of those components that are `wanted` and have lists, beside [`FlatScene::components`]. One that
    /// has not changed keeps its tree: the same [`Arc`] as the last time. Waits until all are made, or until it is
    /// cancelled; then some are missing.
    pub fn trees(&mut self, flat: &FlatScene, wanted: &[bool]) -> Vec<Option<Arc<CellTree>>> {
        while !self.away.is_empty() && !self.cancel.is_cancelled() && self.take_next(None) {}
        self.away.clear();
        let pruned = self.pruned(flat, wanted);
        let mut trees = vec![None; flat.components.len()];
        for (index, key) in pruned {
            if self.cancel.is_cancelled() {
                break;
            }
            let component = &flat.components[index];
            let kept = match self.kept.remove(&key) {
                Some(kept) if kept.is_current(flat, component) => Ok(kept),
                old => guarded(|| Kept::new(alone(flat, component), old)),
            };
            trees[index] = kept.as_ref().ok().map(|kept| kept.tree.clone());
            self.take_back(key, kept);
        }
        trees
    }

    /// The same, of those trees that are there: the others are made by a thread of their own and come with a later
    /// call. Waits only where all that is missing is expected within `most`, and no longer. What an edit has made
    /// wrong is never given out.
    pub fn trees_so_far(&mut self, flat: &FlatScene, wanted: &[bool], most: Duration) -> Vec<Option<Arc<CellTree>>> {
        let end = Instant::now() + most;
        self.collect();
        let pruned = self.pruned(flat, wanted);
        // Twice: what was begun before the last edit comes back as it was, and is ordered anew.
        for _ in 0..2 {
            pruned.iter().for_each(|(index, key)| self.order_if_changed(flat, &flat.components[*index], *key));
            if self.away.values().sum::<Duration>() <= end.saturating_duration_since(Instant::now()) {
                while !self.away.is_empty() && self.take_next(Some(end)) {}
                self.away.values_mut().for_each(|expected| *expected = TOO_LONG);
            }
        }
        let mut trees = vec![None; flat.components.len()];
        for (index, key) in pruned {
            let kept = self.kept.get(&key).filter(|kept| kept.is_current(flat, &flat.components[index]));
            trees[index] = kept.map(|kept| kept.tree.clone());
        }
        trees
    }

    /// Takes over what has been made beside the frames. True if there was anything.
    pub fn collect(&mut self) -> bool {
        let Some(worker) = &self.worker else { return false };
        let finished: Vec<_> = worker.finished().collect();
        let any = !finished.is_empty();
        finished.into_iter().for_each(|(key, kept)| self.take_back(key, kept));
        any
    }

    /// Components whose lists are being made beside the frames.
    pub fn building(&self) -> usize {
        self.away.len()
    }

    /// Waits for the next tree; false where none came before `end`.
    fn take_next(&mut self, end: Option<Instant>) -> bool {
        let Some((key, kept)) = self.worker.as_ref().and_then(|worker| worker.wait(end)) else { return false };
        self.take_back(key, kept);
        true
    }

    fn take_back(&mut self, key: Key, kept: Result<Kept, String>) {
        self.away.remove(&key);
        match kept {
            Ok(kept) => {
                self.kept.insert(key, kept);
            }
            Err(reason) => {
                self.failures.push(format!("the lists of {} could not be made: {reason}", key.0));
                self.failed.insert(key);
            }
        }
    }

    /// Which components are wanted and have lists: the largest, as many as [`MAX_LISTED_ENTRIES`] allows. What is kept of
    /// others is forgotten.
    fn pruned(&mut self, flat: &FlatScene, wanted: &[bool]) -> Vec<(usize, Key)> {
        let mut met: HashMap<NodeId, u32> = HashMap::new();
        let components = flat.components.iter().zip(wanted).enumerate();
        let mut found: Vec<(usize, Key)> = components
            .filter(|(_, (component, wanted))| {
                **wanted && (is_pruned(flat, component) || self.prunes_all && can_be_pruned(flat, component))
            })
            .map(|(index, (component, _))| {
                let id = flat.ids[component.first as usize];
                let nth = met.entry(id).or_default();
                *nth += 1;
                (index, (id, *nth))
            })
            .collect();
        self.kept.retain(|(id, nth), _| met.get(id).is_some_and(|count| nth <= count));
        found.retain(|(_, key)| !self.failed.contains(key));
        within_room(flat, &mut found);
        found
    }

    fn order_if_changed(&mut self, flat: &FlatScene, component: &Component, key: Key) {
        if self.failed.contains(&key) {
            return;
        }
        if self.away.contains_key(&key) {
            // What is begun comes back as it is, and is ordered anew then.
            if let Some(worker) = &self.worker {
                worker.correct(key, || alone(flat, component));
            }
            return;
        }
        let old = match self.kept.remove(&key) {
            Some(kept) if kept.is_current(flat, component) => {
                self.kept.insert(key, kept);
                return;
            }
            old => old,
        };
        self.away.insert(key, old.as_ref().map_or(FRESH_ENTRY * component.count, |old| old.took));
        self.worker.get_or_insert_with(Worker::start).order(key, alone(flat, component), old);
    }
}

/// Leaves out the smallest components where all together have too many entries: they gain least by lists.
pub(super) fn within_room(flat: &FlatScene, found: &mut Vec<(usize, Key)>) {
    let count = |index: usize| flat.components[index].count as usize;
    if found.iter().map(|(index, _)| count(*index)).sum::<usize>() <= MAX_LISTED_ENTRIES {
        return;
    }
    // The sort is stable: of components alike those stay that come first.
    found.sort_by_key(|(index, _)| std::cmp::Reverse(count(*index)));
    let mut sum = 0;
    let is_too_much = |(index, _): &(usize, Key)| {
        sum += count(*index);
        sum > MAX_LISTED_ENTRIES
    };
    let kept = found.iter().position(is_too_much).unwrap_or(found.len());
    found.truncate(kept);
    found.sort_unstable_by_key(|(index, _)| *index);
}
