//! A tree of boxes over bounded items (components today), for queries by points and rays.
//!
//! Nodes are in pre-order, the left child directly behind its parent. A refit updates the box of one item and those
//! of its ancestors, nothing else. Unbounded items are in a separate list.

use isolith_geometry::Aabb;

/// A node of the tree; a leaf holds one item.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HierarchyNode {
    /// Bounds of everything below.
    pub bounds: Aabb,
    /// Leaf: the item. Inner node: index of the right child.
    pub link: u32,
    /// The axis along which the children lie, the left one lower; [`HierarchyNode::LEAF`] for a leaf.
    pub axis: u32,
}

impl HierarchyNode {
    /// The axis of a leaf.
    pub const LEAF: u32 = 3;

    /// Whether it holds one item.
    pub fn is_leaf(&self) -> bool {
        self.axis == Self::LEAF
    }
}

/// The tree, and the items that have no place in it.
#[derive(Clone, Debug, Default)]
pub struct Hierarchy {
    /// Pre-order, the root first; empty if no item is bounded.
    pub nodes: Vec<HierarchyNode>,
    /// Unbounded items.
    pub unbounded: Vec<u32>,
    /// The parent of each node; the root is its own.
    parents: Vec<u32>,
    /// The leaf of each item; [`Hierarchy::NONE`] for those without one.
    leaves: Vec<u32>,
    /// Total area of all boxes: as built, and now.
    areas: [f64; 2],
}

/// Greatest depth of a leaf: shaders hold a stack of [`MAX_HIERARCHY_DEPTH`] + 2 nodes.
pub const MAX_HIERARCHY_DEPTH: u32 = 30;
/// Refits let boxes grow; beyond this factor of the total area the scene rebuilds the tree.
const MAX_GROWTH: f64 = 2.0;

impl Hierarchy {
    /// No node.
    pub const NONE: u32 = u32::MAX;

    /// Builds the tree over `boxes`. Empty boxes belong to nothing and are left out.
    pub fn build(boxes: &[Aabb]) -> Self {
        let all = || 0..boxes.len() as u32;
        let mut items: Vec<u32> = all().filter(|i| boxes[*i as usize].is_finite()).collect();
        let unbounded = all().filter(|i| !boxes[*i as usize].is_finite() && !boxes[*i as usize].is_empty()).collect();
        let mut tree = Self { unbounded, leaves: vec![Self::NONE; boxes.len()], ..Self::default() };
        tree.nodes.reserve(2 * items.len());
        // Ranges to build, each with its parent, whether it is the right child, and its depth.
        let mut open = vec![(0..items.len(), 0_u32, false, 0)];
        while let Some((range, parent, is_right, depth)) = open.pop() {
            if range.is_empty() {
                continue;
            }
            let index = tree.nodes.len() as u32;
            if is_right {
                tree.nodes[parent as usize].link = index;
            }
            let own = &mut items[range.clone()];
            let bounds = own.iter().fold(Aabb::EMPTY, |all, i| all.union(&boxes[*i as usize]));
            let mut node = HierarchyNode { bounds, link: own[0], axis: HierarchyNode::LEAF };
            if own.len() > 1 {
                let (left, axis) = split(own, boxes, depth);
                node.axis = axis;
                let middle = range.start + left;
                open.push((middle..range.end, index, true, depth + 1));
                open.push((range.start..middle, index, false, depth + 1));
            } else {
                tree.leaves[own[0] as usize] = index;
            }
            tree.nodes.push(node);
            tree.parents.push(parent);
        }
        tree.areas = [tree.nodes.iter().map(|node| area(&node.bounds)).sum(); 2];
        tree
    }

    /// One tree of several, each of which stays whole: those of the parts begin at the nodes that are returned. The items
    /// of a part follow those of the parts before; `counts` are their numbers. It cannot be refitted.
    pub fn joined(parts: &[Self], counts: &[u32]) -> (Self, Vec<u32>) {
        let (mut tree, mut roots) = (Self::default(), vec![Self::NONE; parts.len()]);
        let filled: Vec<usize> = (0..parts.len()).filter(|at| !parts[*at].nodes.is_empty()).collect();
        let firsts: Vec<u32> = counts.iter().scan(0, |sum, count| Some(std::mem::replace(sum, *sum + count))).collect();
        join(&mut tree.nodes, &mut roots, parts, &firsts, &filled);
        (tree, roots)
    }

    /// Gives an item another box. False if the tree has to be rebuilt: the item has become bounded or unbounded, or
    /// the boxes have grown too much to be useful.
    #[must_use]
    pub fn refit(&mut self, item: u32, bounds: Aabb) -> bool {
        let Some(leaf) = self.leaves.get(item as usize).copied() else { return false };
        if leaf == Self::NONE {
            return self.unbounded.contains(&item) && !bounds.is_finite() && !bounds.is_empty();
        }
        if !bounds.is_finite() {
            return false;
        }
        let mut at = leaf;
        loop {
            let node = self.nodes[at as usize];
            let new = match node.is_leaf() {
                true => bounds,
                false => self.nodes[at as usize + 1].bounds.union(&self.nodes[node.link as usize].bounds),
            };
            self.areas[1] += area(&new) - area(&node.bounds);
            self.nodes[at as usize].bounds = new;
            let parent = self.parents[at as usize];
            if parent == at {
                return self.areas[1] <= MAX_GROWTH * self.areas[0];
            }
            at = parent;
        }
    }
}

/// Appends the trees of these parts, and tells where each begins.
fn join(nodes: &mut Vec<HierarchyNode>, roots: &mut [u32], parts: &[Hierarchy], firsts: &[u32], filled: &[usize]) {
    let index = nodes.len();
    if let [at] = filled {
        roots[*at] = index as u32;
        let moved = |node: &HierarchyNode| HierarchyNode {
            link: node.link + if node.is_leaf() { firsts[*at] } else { index as u32 },
            ..*node
        };
        nodes.extend(parts[*at].nodes.iter().map(moved));
        return;
    }
    let (left, right) = filled.split_at(filled.len() / 2);
    if right.is_empty() {
        return;
    }
    nodes.push(HierarchyNode { bounds: Aabb::EMPTY, link: 0, axis: 0 });
    join(nodes, roots, parts, firsts, left);
    let middle = nodes.len();
    join(nodes, roots, parts, firsts, right);
    let bounds = nodes[index + 1].bounds.union(&nodes[middle].bounds);
    nodes[index] = HierarchyNode { bounds, link: middle as u32, axis: 0 };
}

/// Half the surface area, a measure of the probability that a ray meets the box (Goldsmith and Salmon, "Automatic
/// creation of object hierarchies for ray tracing", 1987).
fn area(bounds: &Aabb) -> f64 {
    let size = bounds.max - bounds.min;
    size.x * size.y + size.y * size.z + size.z * size.x
}

/// Orders the items so that the first `n` go left, and returns `n` and the axis; neither side is empty. Splits at the
/// cheapest place if the depth allows it, else in the middle.
fn split(items: &mut [u32], boxes: &[Aabb], depth: u32) -> (usize, u32) {
    let center = |i: u32| boxes[i as usize].center();
    let centers = Aabb::from_points(items.iter().map(|i| center(*i)));
    let extent = centers.max - centers.min;
    let axis = (0..3).max_by(|a, b| extent[*a].total_cmp(&extent[*b])).unwrap_or(0);
    items.sort_unstable_by(|a, b| center(*a)[axis].total_cmp(&center(*b)[axis]).then(a.cmp(b)));
    let count = items.len();
    // One more level, then halves.
    let fits = depth + 1 + usize::BITS - count.leading_zeros() < MAX_HIERARCHY_DEPTH;
    let n = if fits { cheapest(items, boxes) } else { count / 2 };
    (n, axis as u32)
}

/// The number of items on the left that minimizes the sum of areas times items.
fn cheapest(items: &[u32], boxes: &[Aabb]) -> usize {
    let grow = |all: &mut Aabb, i: &u32| {
        *all = all.union(&boxes[*i as usize]);
        Some(area(all))
    };
    let left: Vec<f64> = items.iter().scan(Aabb::EMPTY, grow).collect();
    let right: Vec<f64> = items.iter().rev().scan(Aabb::EMPTY, grow).collect();
    let count = items.len();
    let cost = |n: usize| left[n - 1] * n as f64 + right[count - n - 1] * (count - n) as f64;
    // The most balanced of equal costs.
    let rank = |n: usize| (cost(n), n.abs_diff(count / 2));
    let is_less = |a: &(f64, usize), b: &(f64, usize)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
    (1..count).min_by(|a, b| is_less(&rank(*a), &rank(*b))).unwrap_or(1)
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    fn boxes(count: usize, place: impl Fn(f64) -> DVec3) -> Vec<Aabb> {
        (0..count).map(|i| Aabb::from_center_half(place(i as f64), DVec3::splat(0.1))).collect()
    }

    fn scattered(count: usize) -> Vec<Aabb> {
        boxes(count, |i| DVec3::new(1.3, 2.9, 4.7).map(|v| 10.0 * (v * i).sin()))
    }

    /// Checks that every node contains its children, every item is a leaf once, and no leaf is too deep.
    fn is_right(tree: &Hierarchy, boxes: &[Aabb]) -> Result<(), String> {
        let mut seen = vec![0; boxes.len()];
        let mut open = if tree.nodes.is_empty() { vec![] } else { vec![(0, 0)] };
        while let Some((at, depth)) = open.pop() {
            let node: &HierarchyNode = &tree.nodes[at];
            if depth > MAX_HIERARCHY_DEPTH {
                return Err(format!("node {at} stands at depth {depth}"));
            }
            if node.is_leaf() {
                seen[node.link as usize] += 1;
                if node.bounds != boxes[node.link as usize] {
                    return Err(format!("item {} has another box", node.link));
                }
                continue;
            }
            for child in [at + 1, node.link as usize] {
                if node.bounds.union(&tree.nodes[child].bounds) != node.bounds {
                    return Err(format!("node {child} reaches out of node {at}"));
                }
                open.push((child, depth + 1));
            }
        }
        tree.unbounded.iter().for_each(|i| seen[*i as usize] += 1);
        if seen.iter().any(|n| *n != 1) { Err(format!("seen {seen:?} times")) } else { Ok(()) }
    }

    #[test]
    fn every_item_is_in_it_once() {
        for count in [0, 1, 2, 3, 100, 1_000] {
            let boxes = scattered(count);
            assert_eq!(is_right(&Hierarchy::build(&boxes), &boxes), Ok(()), "{count}");
        }
        // All at one place, and ever farther apart: no order of splits may make the tree too deep.
        for boxes in [boxes(500, |_| DVec3::ONE), boxes(300, |i| DVec3::X * 2_f64.powf(i))] {
            assert_eq!(is_right(&Hierarchy::build(&boxes), &boxes), Ok(()));
        }
    }

    #[test]
    fn joined_trees_stay_whole() {
        for counts in [vec![], vec![0], vec![5], vec![3, 0, 40], vec![1, 2, 3, 4, 5, 6, 7]] {
            let boxes = scattered(counts.iter().sum());
            let mut rest = boxes.as_slice();
            let mut taken = |count: &usize| {
                let (own, others) = rest.split_at(*count);
                rest = others;
                Hierarchy::build(own)
            };
            let parts: Vec<Hierarchy> = counts.iter().map(&mut taken).collect();
            let counts: Vec<u32> = counts.iter().map(|count| *count as u32).collect();
            let (all, roots) = Hierarchy::joined(&parts, &counts);
            assert_eq!(is_right(&all, &boxes), Ok(()), "{counts:?}");
            let mut first = 0;
            for ((part, root), count) in parts.iter().zip(&roots).zip(&counts) {
                assert_eq!(*root == Hierarchy::NONE, part.nodes.is_empty(), "{counts:?}");
                for (i, node) in part.nodes.iter().enumerate() {
                    let moved = all.nodes[*root as usize + i];
                    let by = if node.is_leaf() { first } else { *root };
                    assert_eq!(moved, HierarchyNode { link: node.link + by, ..*node }, "{counts:?}");
                }
                first += count;
            }
        }
    }

    #[test]
    fn what_has_no_end_stands_in_a_list() {
        let mut boxes = scattered(10);
        boxes[3] = Aabb::EVERYTHING;
        boxes[7].max.x = f64::INFINITY;
        let mut tree = Hierarchy::build(&boxes);
        assert_eq!(tree.unbounded, [3, 7]);
        assert_eq!(is_right(&tree, &boxes), Ok(()));
        assert!(tree.refit(3, boxes[7]), "it still has none");
        assert!(!tree.refit(3, boxes[0]), "it has one now");
        assert!(!tree.refit(0, Aabb::EVERYTHING), "it has none any more");
        assert!(!tree.refit(10, boxes[0]), "there is no such item");
    }

    #[test]
    fn a_moved_item_is_refitted_until_the_boxes_have_grown_too_much() {
        let mut boxes = scattered(200);
        let mut tree = Hierarchy::build(&boxes);
        for (item, by) in [(17, 0.5), (100, -2.0), (17, 1.0)] {
            boxes[item] = boxes[item].translated(DVec3::splat(by));
            assert!(tree.refit(item as u32, boxes[item]));
            assert_eq!(is_right(&tree, &boxes), Ok(()));
        }
        assert!(!tree.refit(5, boxes[5].translated(DVec3::splat(1e4))));
    }

    #[test]
    fn a_wrong_tree_is_caught() {
        let boxes = scattered(20);
        let mut tree = Hierarchy::build(&boxes);
        let leaf = tree.nodes.iter().position(HierarchyNode::is_leaf).expect("a leaf");
        tree.nodes[leaf].link = (tree.nodes[leaf].link + 1) % 20;
        assert!(is_right(&tree, &boxes).is_err());
    }
}
