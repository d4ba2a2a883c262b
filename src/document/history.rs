//! The steps that can be undone and done again.

use std::collections::{HashSet, VecDeque};
use std::sync::Arc;

use isolith_scene::{NodeId, Scene};

/// Most steps that can be undone; beyond it the oldest is forgotten.
pub const MAX_STEPS: usize = 1_000;
/// Most nodes that the kept steps may refer to, all together: a bound on memory, about 8 bytes each.
/// One step is kept whatever its size.
pub const MAX_HISTORY_NODES: usize = 20_000_000;

/// A scene with the selection that belongs to it.
#[derive(Clone, Debug)]
pub(super) struct State {
    pub scene: Arc<Scene>,
    pub selection: Vec<NodeId>,
    /// The revision at which this scene came into being: equal marks, equal scenes.
    pub mark: u64,
}

impl State {
    /// Drops ids from the selection that no node has, and repetitions.
    pub fn drop_unknown(&mut self) {
        let mut seen = HashSet::new();
        self.selection.retain(|id| self.scene.node(*id).is_some() && seen.insert(*id));
    }
}

#[derive(Debug)]
struct Step {
    label: String,
    /// The state that the step leads to when it is taken.
    state: State,
}

/// Both directions. The last entry of each is the next to be taken.
#[derive(Debug, Default)]
pub(super) struct History {
    past: VecDeque<Step>,
    future: Vec<Step>,
    /// Nodes in all states of `past`.
    weight: usize,
}

impl History {
    /// A change from `before` has happened. What had been undone is gone.
    pub fn push(&mut self, label: String, before: State) {
        self.future.clear();
        self.push_past(Step { label, state: before });
    }

    /// Swaps `now` for the state before the latest step.
    pub fn undo(&mut self, now: &mut State) -> bool {
        let Some(step) = self.past.pop_back() else { return false };
        self.weight -= step.state.scene.nodes().len();
        self.future.push(Step { label: step.label, state: std::mem::replace(now, step.state) });
        true
    }

    /// Swaps `now` for the state after the step undone last.
    pub fn redo(&mut self, now: &mut State) -> bool {
        let Some(step) = self.future.pop() else { return false };
        self.push_past(Step { label: step.label, state: std::mem::replace(now, step.state) });
        true
    }

    /// Labels of what can be undone, the latest first.
    pub fn undo_labels(&self) -> impl Iterator<Item = &str> {
        self.past.iter().rev().map(|s| s.label.as_str())
    }

    /// Labels of what can be done again, the next first.
    pub fn redo_labels(&self) -> impl Iterator<Item = &str> {
        self.future.iter().rev().map(|s| s.label.as_str())
    }

    fn push_past(&mut self, step: Step) {
        self.weight += step.state.scene.nodes().len();
        self.past.push_back(step);
        while self.past.len() > MAX_STEPS || (self.weight > MAX_HISTORY_NODES && self.past.len() > 1) {
            let Some(oldest) = self.past.pop_front() else { break };
            self.weight -= oldest.state.scene.nodes().len();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use isolith_scene::{Group, Material, MaterialId, Node, NodeKind};

    #[test]
    fn big_scenes_are_kept_for_fewer_steps() {
        let node = |i| Node { id: NodeId(i), ..Node::new("n", NodeKind::Group(Group::UNION)) };
        let clay = vec![Material::new(MaterialId(1), "Clay", [0.5; 3])];
        let nodes = (0..100_000).map(node).collect();
        let scene = Arc::new(Scene::from_tables(nodes, clay, Default::default(), 1).unwrap());
        let state = || State { scene: Arc::clone(&scene), selection: Vec::new(), mark: 0 };
        let mut history = History::default();
        for i in 0..250 {
            history.push(i.to_string(), state());
        }
        let kept = history.undo_labels().count();
        assert_eq!(kept, MAX_HISTORY_NODES / scene.nodes().len());
        assert_eq!(history.undo_labels().next(), Some("249"));
        let mut now = state();
        assert_eq!(std::iter::from_fn(|| history.undo(&mut now).then_some(())).count(), kept);
        assert_eq!(history.weight, 0);
        assert_eq!(std::iter::from_fn(|| history.redo(&mut now).then_some(())).count(), kept);
    }
}
