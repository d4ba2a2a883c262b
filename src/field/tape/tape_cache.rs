//! A cache of trees between frames. It rebuilds only what an edit changed, on a worker thread where that takes long.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::cached_tree::{CachedTree, isolate};
use super::cell_tree::CellTree;
use super::domain::{can_have_tape, has_tape};
use super::worker::{ComponentKey, Worker};
use crate::{Cancel, Component, FlatScene, MAX_CACHED_ENTRIES};
use isolith_guard::guarded;
use isolith_scene::NodeId;

/// Keeps the trees of the last scene, and builds those of the next scene from them.
#[derive(Debug, Default)]
pub struct TapeCache {
    cached: HashMap<ComponentKey, CachedTree>,
    /// The orders of the worker, each with its expected duration.
    away: HashMap<ComponentKey, Duration>,
    worker: Option<Worker>,
    builds_all: bool,
    cancel: Cancel,
    /// Components whose tapes could not be built.
    failed: HashSet<ComponentKey>,
    failures: Vec<String>,
}

/// The expected time per entry for a component without a measured time. Measured: 186 boxes 40 to 80 ms, a blend of 2
/// 000 leaves 200 to 400 ms.
const FRESH_ENTRY: Duration = Duration::from_micros(200);
/// The expected duration of an order that took longer than expected: the cache does not wait for it again.
const TOO_LONG: Duration = Duration::from_secs(3600);

impl TapeCache {
    /// Builds tapes of small components too from now on. They gain nothing by tapes, but tests can exercise them.
    pub fn build_all(&mut self) {
        self.builds_all = true;
    }

    /// [`TapeCache::trees`] stops waiting when `cancel` says so.
    pub fn set_cancel(&mut self, cancel: &Cancel) {
        self.cancel = cancel.clone();
    }

    /// The reasons of builds that failed since the last call; the interpreter evaluates those components without
    /// tapes.
    pub fn take_failures(&mut self) -> Vec<String> {
        std::mem::take(&mut self.failures)
    }

    /// The trees of those components that are `wanted` and have tapes, in the order of [`FlatScene::components`]. An
    /// unchanged component keeps its tree: the same [`Arc`] as the last time. Waits until all trees are ready or the
    /// caller cancels; then some are missing.
    pub fn trees(&mut self, flat: &FlatScene, wanted: &[bool]) -> Vec<Option<Arc<CellTree>>> {
        while !self.away.is_empty() && !self.cancel.is_canceled() && self.take_next(None) {}
        self.away.clear();
        let with_tapes = self.with_tapes(flat, wanted);
        let mut trees = vec![None; flat.components.len()];
        for (index, key) in with_tapes {
            if self.cancel.is_canceled() {
                break;
            }
            let component = &flat.components[index];
            let cached = match self.cached.remove(&key) {
                Some(cached) if cached.is_current(flat, component) => Ok(cached),
                old => guarded(|| CachedTree::new(isolate(flat, component), old)),
            };
            trees[index] = cached.as_ref().ok().map(|cached| cached.tree.clone());
            self.requeue(key, cached);
        }
        trees
    }

    /// Like [`TapeCache::trees`], but returns only the trees that are ready: the worker builds the others for a later
    /// call. Waits only if it expects all missing trees within `most`, and no longer than that. Never returns a tree
    /// that an edit has invalidated.
    pub fn ready_trees(&mut self, flat: &FlatScene, wanted: &[bool], most: Duration) -> Vec<Option<Arc<CellTree>>> {
        let end = Instant::now() + most;
        self.collect();
        let with_tapes = self.with_tapes(flat, wanted);
        // Twice: an order begun before the last edit returns in its old state, and needs a new order.
        for _ in 0..2 {
            with_tapes.iter().for_each(|(index, key)| self.order_if_changed(flat, &flat.components[*index], *key));
            if self.away.values().sum::<Duration>() <= end.saturating_duration_since(Instant::now()) {
                while !self.away.is_empty() && self.take_next(Some(end)) {}
                self.away.values_mut().for_each(|expected| *expected = TOO_LONG);
            }
        }
        let mut trees = vec![None; flat.components.len()];
        for (index, key) in with_tapes {
            let cached = self.cached.get(&key).filter(|cached| cached.is_current(flat, &flat.components[index]));
            trees[index] = cached.map(|cached| cached.tree.clone());
        }
        trees
    }

    /// Takes over the trees that the worker has finished. True if there were any.
    pub fn collect(&mut self) -> bool {
        let Some(worker) = &self.worker else { return false };
        let finished: Vec<_> = worker.finished().collect();
        let any = !finished.is_empty();
        finished.into_iter().for_each(|(key, cached)| self.requeue(key, cached));
        any
    }

    /// The number of components whose tapes the worker is building.
    pub fn building(&self) -> usize {
        self.away.len()
    }

    /// Waits for the next tree; false if none came before `end`.
    fn take_next(&mut self, end: Option<Instant>) -> bool {
        let Some((key, cached)) = self.worker.as_ref().and_then(|worker| worker.wait(end)) else { return false };
        self.requeue(key, cached);
        true
    }

    fn requeue(&mut self, key: ComponentKey, cached: Result<CachedTree, String>) {
        self.away.remove(&key);
        match cached {
            Ok(cached) => {
                self.cached.insert(key, cached);
            }
            Err(reason) => {
                self.failures.push(format!("the tapes of {} could not be made: {reason}", key.0));
                self.failed.insert(key);
            }
        }
    }

    /// The components that are wanted and have tapes: the largest, as many as [`MAX_CACHED_ENTRIES`] allows. Drops
    /// the trees of all others.
    fn with_tapes(&mut self, flat: &FlatScene, wanted: &[bool]) -> Vec<(usize, ComponentKey)> {
        let mut met: HashMap<NodeId, u32> = HashMap::new();
        let components = flat.components.iter().zip(wanted).enumerate();
        let mut found: Vec<(usize, ComponentKey)> = components
            .filter(|(_, (component, wanted))| {
                **wanted && (has_tape(flat, component) || self.builds_all && can_have_tape(flat, component))
            })
            .map(|(index, (component, _))| {
                let id = flat.ids[component.first as usize];
                let nth = met.entry(id).or_default();
                *nth += 1;
                (index, (id, *nth))
            })
            .collect();
        self.cached.retain(|(id, nth), _| met.get(id).is_some_and(|count| nth <= count));
        found.retain(|(_, key)| !self.failed.contains(key));
        within_room(flat, &mut found);
        found
    }

    fn order_if_changed(&mut self, flat: &FlatScene, component: &Component, key: ComponentKey) {
        if self.failed.contains(&key) {
            return;
        }
        if self.away.contains_key(&key) {
            // An order in progress returns in its old state; the next call orders it again.
            if let Some(worker) = &self.worker {
                worker.correct(key, || isolate(flat, component));
            }
            return;
        }
        let old = match self.cached.remove(&key) {
            Some(cached) if cached.is_current(flat, component) => {
                self.cached.insert(key, cached);
                return;
            }
            old => old,
        };
        self.away.insert(key, old.as_ref().map_or(FRESH_ENTRY * component.count, |old| old.took));
        self.worker.get_or_insert_with(Worker::start).order(key, isolate(flat, component), old);
    }
}

/// Leaves out the smallest components if all together have too many entries: they gain least by tapes.
pub(super) fn within_room(flat: &FlatScene, found: &mut Vec<(usize, ComponentKey)>) {
    let count = |index: usize| flat.components[index].count as usize;
    if found.iter().map(|(index, _)| count(*index)).sum::<usize>() <= MAX_CACHED_ENTRIES {
        return;
    }
    // The sort is stable: among components of equal size the first ones stay.
    found.sort_by_key(|(index, _)| std::cmp::Reverse(count(*index)));
    let mut sum = 0;
    let is_too_much = |(index, _): &(usize, ComponentKey)| {
        sum += count(*index);
        sum > MAX_CACHED_ENTRIES
    };
    let cached = found.iter().position(is_too_much).unwrap_or(found.len());
    found.truncate(cached);
    found.sort_unstable_by_key(|(index, _)| *index);
}
