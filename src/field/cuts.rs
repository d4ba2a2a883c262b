//! Cuts by nodes at the top of a scene that subtract or intersect: each acts on the components before it that it
//! reaches, since (a ∪ b) − d = (a − d) ∪ (b − d) exactly, and the same with ∩.

use std::ops::Range;

use super::arrays::Join;
use super::budget::Budget;
use super::lower_bound::fold_bounds;
use super::operand::Operand;
use isolith_geometry::Aabb;
use isolith_scene::{Blend, Operation, Operator};

/// An operand that subtracts or intersects, and the components on which it acts.
pub(super) struct Cut<'a> {
    pub from: Range<usize>,
    pub operation: Operation,
    /// `None` is the empty set, which only an intersection has.
    pub operand: Option<Operand<'a>>,
}

/// Applies the cuts in their order in the scene. A cut does not enlarge a component, so one tree of the bounds before
/// serves all cuts, however many components and cuts there are. A component that an intersection does not reach is gone.
pub(super) fn apply<'a>(components: &mut Vec<Vec<Operand<'a>>>, cuts: Vec<Cut<'a>>, budget: &mut Budget) {
    if cuts.is_empty() {
        return;
    }
    let tree = BoxTree::new(components.iter().map(|component| fold_bounds(component).bounds).collect());
    let mut found = Vec::new();
    for Cut { from, operation, operand } in cuts {
        if let Some(operand) = &operand {
            let looked_at = tree.meeting(&operand.bounds, &mut found);
            found.retain(|at| from.contains(at));
            let entries = operand.entries.saturating_mul(found.len());
            if !budget.take_steps(operand.node, looked_at) || !budget.take_entries(operand.node, entries) {
                return;
            }
        }
        if operation == Operation::Intersect {
            found.sort_unstable();
            for at in from.filter(|at| found.binary_search(at).is_err()) {
                components[at].clear();
            }
        }
        let join = Join::of(operation.in_group(Operator::Union));
        for (at, operand) in found.drain(..).filter_map(|at| Some((at, operand.as_ref()?))) {
            // What an intersection has left nothing of stays gone.
            if !components[at].is_empty() {
                components[at].push(Operand { join, blend: Blend::HARD, ..operand.clone() });
            }
        }
    }
    components.retain(|component| !component.is_empty());
}

/// Most boxes in a leaf of the tree; a query compares them one by one.
const LEAF: usize = 8;

/// A binary tree over boxes.
struct BoxTree {
    boxes: Vec<Aabb>,
    /// Bounded boxes, in the order of the leaves.
    order: Vec<usize>,
    /// Unbounded boxes.
    endless: Vec<usize>,
    nodes: Vec<TreeNode>,
}

struct TreeNode {
    bounds: Aabb,
    /// Range of [`BoxTree::order`].
    range: Range<usize>,
    /// Index of the second child; the first one follows its parent. `None` in a leaf.
    second: Option<usize>,
}

impl BoxTree {
    fn new(boxes: Vec<Aabb>) -> Self {
        let all = (0..boxes.len()).filter(|at| !boxes[*at].is_empty());
        let (order, endless) = all.partition::<Vec<_>, _>(|at| boxes[*at].is_finite());
        let mut tree = Self { boxes, order, endless, nodes: Vec::new() };
        if !tree.order.is_empty() {
            tree.add(0..tree.order.len());
        }
        tree
    }

    fn add(&mut self, range: Range<usize>) {
        let members = &mut self.order[range.clone()];
        let boxes = &self.boxes;
        let bounds = members.iter().fold(Aabb::EMPTY, |all, at| all.union(&boxes[*at]));
        let index = self.nodes.len();
        self.nodes.push(TreeNode { bounds, range: range.clone(), second: None });
        if range.len() <= LEAF {
            return;
        }
        let half = bounds.half();
        let axis = (0..3).max_by(|a, b| half[*a].total_cmp(&half[*b])).unwrap_or_default();
        let middle = members.len() / 2;
        members.select_nth_unstable_by(middle, |a, b| boxes[*a].center()[axis].total_cmp(&boxes[*b].center()[axis]));
        self.add(range.start..range.start + middle);
        self.nodes[index].second = Some(self.nodes.len());
        self.add(range.start + middle..range.end);
    }

    /// Appends the boxes that meet `bounds` to `found`; returns how many boxes were compared with it.
    fn meeting(&self, bounds: &Aabb, found: &mut Vec<usize>) -> usize {
        let meets = |other: &Aabb| !other.intersection(bounds).is_empty();
        let mut compared = self.endless.len();
        found.extend(self.endless.iter().filter(|at| meets(&self.boxes[**at])));
        let mut open: Vec<usize> = if self.nodes.is_empty() { Vec::new() } else { vec![0] };
        while let Some(index) = open.pop() {
            let node = &self.nodes[index];
            compared += 1;
            if !meets(&node.bounds) {
                continue;
            }
            match node.second {
                Some(second) => open.extend([index + 1, second]),
                None => {
                    compared += node.range.len();
                    found.extend(self.order[node.range.clone()].iter().filter(|at| meets(&self.boxes[**at])));
                }
            }
        }
        compared
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    #[test]
    fn the_tree_finds_what_a_look_at_every_box_finds() {
        let place = |i: usize, j: f64| DVec3::new(1.3, 2.9, 4.7).map(|v| (v * j * i as f64).sin() * 10.0);
        let mut boxes: Vec<Aabb> =
            (0..200).map(|i| Aabb::from_center_half(place(i, 1.0), place(i, 0.7).abs() * 0.2)).collect();
        boxes[7] = Aabb::EMPTY;
        boxes[70] = Aabb::EVERYTHING;
        boxes[71] = Aabb::new(DVec3::new(f64::NEG_INFINITY, -1.0, 0.0), DVec3::splat(f64::INFINITY));
        let tree = BoxTree::new(boxes.clone());
        let mut found = Vec::new();
        for i in 0..50 {
            let wanted = Aabb::from_center_half(place(i, 1.7), DVec3::splat(0.1 * i as f64));
            let compared = tree.meeting(&wanted, &mut found);
            found.sort_unstable();
            let each = (0..boxes.len()).filter(|at| !boxes[*at].intersection(&wanted).is_empty());
            assert!(found.drain(..).eq(each), "{wanted:?}");
            assert!(i > 3 || compared < boxes.len(), "{compared} boxes were compared");
        }
        assert_eq!(BoxTree::new(Vec::new()).meeting(&Aabb::EVERYTHING, &mut found), 0);
    }
}
