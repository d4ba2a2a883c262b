//! Cuts by the negative nodes at the top of a scene: each is cut from the components before it that it reaches, since
//! (a ∪ b) − d = (a − d) ∪ (b − d) exactly.

use std::ops::Range;

use super::arrays::Join;
use super::budget::Budget;
use super::lower_bound::fold_bounds;
use super::operand::Operand;
use isolith_geometry::Aabb;
use isolith_scene::Blend;

/// A negative operand, and the components that it is cut from if it reaches them.
pub(super) struct Cut<'a> {
    pub from: Range<usize>,
    pub negative: Operand<'a>,
}

/// Applies the cuts in the order of the negatives in the scene. A cut leaves the bounds of a component unchanged, so
/// one tree serves all cuts, however many components and cuts there are.
pub(super) fn apply<'a>(components: &mut [Vec<Operand<'a>>], cuts: Vec<Cut<'a>>, budget: &mut Budget) {
    if cuts.is_empty() {
        return;
    }
    let tree = BoxTree::new(components.iter().map(|component| fold_bounds(component).bounds).collect());
    let mut found = Vec::new();
    for Cut { from, negative } in cuts {
        let looked_at = tree.meeting(&negative.bounds, &mut found);
        found.retain(|at| from.contains(at));
        let entries = negative.entries.saturating_mul(found.len());
        if !budget.take_steps(negative.node, looked_at) || !budget.take_entries(negative.node, entries) {
            return;
        }
        for at in found.drain(..) {
            components[at].push(Operand { join: Join::Difference, blend: Blend::HARD, ..negative.clone() });
        }
    }
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
