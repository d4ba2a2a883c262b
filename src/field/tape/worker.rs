//! A thread that builds tapes while the renderer draws frames without them.

use std::collections::VecDeque;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use super::cached_tree::CachedTree;
use crate::FlatScene;
use isolith_guard::guarded;
use isolith_scene::NodeId;

/// The top node of a component, and its index among the components with this node.
pub(super) type ComponentKey = (NodeId, u32);

/// A finished tree, or the message of the panic that ended its build.
pub(super) type Finished = (ComponentKey, Result<CachedTree, String>);

/// The worker; see the module.
#[derive(Debug)]
pub(super) struct Worker {
    orders: Arc<Orders>,
    finished: Receiver<Finished>,
}

#[derive(Debug, Default)]
struct Orders {
    state: Mutex<State>,
    news: Condvar,
}

#[derive(Debug, Default)]
struct State {
    waiting: VecDeque<Order>,
    is_unwanted: bool,
}

/// An isolated component, and its previous tree if it had one.
#[derive(Debug)]
struct Order {
    key: ComponentKey,
    of: FlatScene,
    old: Option<CachedTree>,
}

impl Worker {
    pub fn start() -> Self {
        let orders = Arc::new(Orders::default());
        let (finish, finished) = channel();
        let of_thread = orders.clone();
        // If the thread does not start, no tree is ever finished, and components evaluate without tapes.
        let _ = std::thread::Builder::new().name("tapes".into()).spawn(move || work(&of_thread, &finish));
        Self { orders, finished }
    }

    /// Orders the tree of a component; the worker returns it under `key`.
    pub fn order(&self, key: ComponentKey, of: FlatScene, old: Option<CachedTree>) {
        self.orders.lock().waiting.push_back(Order { key, of, old });
        self.orders.news.notify_one();
    }

    /// Updates the state of the component in an order that the worker has not begun. One that it has begun returns
    /// under `key` as ordered.
    pub fn correct(&self, key: ComponentKey, of: impl FnOnce() -> FlatScene) {
        let mut state = self.orders.lock();
        if let Some(order) = state.waiting.iter_mut().find(|order| order.key == key) {
            order.of = of();
        }
    }

    /// All finished trees.
    pub fn finished(&self) -> impl Iterator<Item = Finished> + '_ {
        self.finished.try_iter()
    }

    /// The next tree that finishes before `end`, or at all without `end`; `None` also if none will come.
    pub fn wait(&self, end: Option<Instant>) -> Option<Finished> {
        match end {
            None => self.finished.recv().ok(),
            Some(end) => self.finished.recv_timeout(end.saturating_duration_since(Instant::now())).ok(),
        }
    }
}

/// The thread ends by itself after its current tree: nobody waits for it.
impl Drop for Worker {
    fn drop(&mut self) {
        self.orders.lock().is_unwanted = true;
        self.orders.news.notify_one();
    }
}

impl Orders {
    fn lock(&self) -> MutexGuard<'_, State> {
        // No code that holds the lock can leave an order half written.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The next order; `None` after the worker is dropped.
    fn next(&self) -> Option<Order> {
        let mut state = self.lock();
        loop {
            if state.is_unwanted {
                return None;
            }
            if let Some(order) = state.waiting.pop_front() {
                return Some(order);
            }
            state = self.news.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }
}

fn work(orders: &Orders, finish: &Sender<Finished>) {
    while let Some(Order { key, of, old }) = orders.next() {
        if finish.send((key, guarded(|| CachedTree::new(of, old)))).is_err() {
            return;
        }
    }
}
