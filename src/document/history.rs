//! The steps of undo and redo.

use std::collections::{HashSet, VecDeque};
use std::sync::Arc;

use isolith_scene::{NodeId, Scene};

/// Most steps that can be undone; beyond it the oldest is dropped.
pub const MAX_STEPS: usize = 1_000;
/// Most nodes in all kept steps together: a bound on memory, about 8 bytes each. One step is kept whatever its size.
pub const MAX_HISTORY_NODES: usize = 20_000_000;

/// A scene with its selection.
#[derive(Clone, Debug)]
pub(super) struct State {
    pub scene: Arc<Scene>,
    pub selection: Vec<NodeId>,
    /// The revision that created this scene: equal marks mean equal scenes.
    pub mark: u64,
}

impl State {
    /// Removes unknown and repeated ids from the selection.
    pub fn drop_unknown(&mut self) {
        let mut seen = HashSet::new();
        self.selection.retain(|id| self.scene.node(*id).is_some() && seen.insert(*id));
    }
}

#[derive(Debug)]
struct Step {
    label: String,
    /// The state that undoing or redoing the step restores.
    state: State,
}

/// The steps in both directions. The last entry of each list is the next step.
#[derive(Debug, Default)]
pub(super) struct History {
    past: VecDeque<Step>,
    future: Vec<Step>,
    /// Nodes in all states of `past`, summed up.
    weight: usize,
}

impl History {
    /// Records a change from `before`. Drops the steps that could be redone.
    pub fn push(&mut self, label: String, before: State) {
        self.future.clear();
        self.push_past(Step { label, state: before });
    }

    /// Swaps `now` with the state before the latest step.
    pub fn undo(&mut self, now: &mut State) -> bool {
        let Some(step) = self.past.pop_back() else { return false };
        self.weight -= step.state.scene.nodes().len();
        self.future.push(Step { label: step.label, state: std::mem::replace(now, step.state) });
        true
    }

    /// Swaps `now` with the state after the step undone last.
    pub fn redo(&mut self, now: &mut State) -> bool {
        let Some(step) = self.future.pop() else { return false };
        self.push_past(Step { label: step.label, state: std::mem::replace(now, step.state) });
        true
    }

    /// Labels of the steps to undo, latest first.
    pub fn undo_labels(&self) -> impl Iterator<Item = &str> {
        self.past.iter().rev().map(|s| s.label.as_str())
    }

    /// Labels of the steps to redo, next first.
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
