//! How the children of a group join: operator, kernel, radius in meters, and siblings that do not blend.

use std::collections::{HashMap, HashSet};

use super::arrays::Join;
use super::budget::Budget;
use super::composition::{begin_with, group_of, join, size_of_fold};
use super::operand::Operand;
use isolith_geometry::Aabb;
use isolith_scene::{Blend, BlendKernel, BlendOverride, Group, Node, NodeId, Operator};

/// Smaller radii have no effect in f32 and count as 0.
const LEAST_RADIUS: f64 = 1e-30;

/// Whether the node overrides the blend of its group with a radius of its own.
pub(super) fn has_own_radius(node: &std::sync::Arc<Node>) -> bool {
    matches!(node.blend_override, BlendOverride::Radius(radius) if radius > 0.0)
}

/// Joins the children of one group.
pub(super) struct Joiner<'g, 'a> {
    group: &'g Group,
    /// The largest half extent of the result so far; `None` if unbounded.
    size: Option<f64>,
    bounds: Aabb,
    /// The operands so far with their nodes; filled only if one of the children keeps apart from siblings.
    so_far: Vec<(&'a Node, Operand<'a>)>,
    /// The siblings that each child keeps apart from, whichever of the two declares it.
    apart: HashMap<NodeId, HashSet<NodeId>>,
}

impl<'g, 'a> Joiner<'g, 'a> {
    /// A joiner for these children of the group.
    pub fn new(group: &'g Group, children: impl Iterator<Item = &'a Node> + Clone) -> Self {
        let mut apart: HashMap<NodeId, HashSet<NodeId>> = HashMap::new();
        if children.clone().any(|child| !child.apart.is_empty()) {
            let siblings: HashSet<NodeId> = children.clone().map(|child| child.id).collect();
            for child in children {
                for other in child.apart.iter().filter(|id| siblings.contains(id)) {
                    apart.entry(child.id).or_default().insert(*other);
                    apart.entry(*other).or_default().insert(child.id);
                }
            }
        }
        Self { group, size: None, bounds: Aabb::EMPTY, so_far: Vec::new(), apart }
    }

    /// Starts with the first operand.
    pub fn begin(&mut self, node: &'a Node, operand: &Operand<'a>) {
        (self.bounds, self.size) = (Aabb::EMPTY, None);
        self.so_far.clear();
        self.grow(&operand.bounds);
        if !self.apart.is_empty() {
            self.so_far.push((node, operand.clone()));
        }
    }

    fn grow(&mut self, bounds: &Aabb) {
        self.bounds = self.bounds.union(bounds);
        self.size = size(&self.bounds);
    }

    /// Sets the join and the blend of the operand from its group and its own override.
    pub fn set_blend(&mut self, node: &Node, operand: &mut Operand<'a>) {
        let group = self.group;
        operand.join = Join::of(node.operation.in_group(group.operator));
        let blend = match node.blend_override {
            BlendOverride::Inherit => group.blend,
            BlendOverride::Hard => Blend { radius: 0.0, ..group.blend },
            BlendOverride::Radius(radius) => Blend { radius, ..group.blend },
        };
        let common = match (self.size, size(&operand.bounds)) {
            (Some(a), Some(b)) => a.min(b),
            (a, b) => a.or(b).unwrap_or(1.0),
        };
        let mut blend = blend.in_meters(common);
        if blend.radius < LEAST_RADIUS {
            blend.radius = 0.0;
        }
        let width = 0.5 * group.width;
        (operand.blend, operand.detail) = match operand.join {
            Join::Pipe => (Blend::HARD, [width, 0.0]),
            Join::Morph => (Blend::HARD, [0.0, group.share]),
            // The support of this kernel is the radius itself: half the width of the soft edge.
            Join::Paint => (Blend { kernel: BlendKernel::Circular, ..blend }, [0.0; 2]),
            Join::Groove | Join::Tongue => (without_steps(blend), [width, group.depth]),
            Join::Engrave => (blend, [blend.steps.into(), group.depth]),
            _ => (blend, [blend.steps.into(), 0.0]),
        };
        if matches!(operand.join, Join::Union | Join::Xor | Join::Morph) {
            self.grow(&operand.bounds);
        }
    }

    /// Appends the operand. If it must not blend with some operands before it, it blends with a fold of all the
    /// others alone, and the result joins the result so far without a blend: nothing of that is lost, and where none
    /// of the others is near, the blend is hard. A cut is hard if there is any such sibling.
    pub fn join(&mut self, node: &'a Node, mut operand: Operand<'a>, fold: &mut Vec<Operand<'a>>, budget: &mut Budget) {
        if self.apart.is_empty() {
            join(fold, operand);
            return;
        }
        let own = operand.clone();
        let is_symmetric = is_symmetric(node, self.group.operator);
        let is_apart = |other: &Node| self.apart.get(&node.id).is_some_and(|apart| apart.contains(&other.id));
        if operand.blend.radius > 0.0
            && self.apart.contains_key(&node.id)
            && self.so_far.iter().any(|(other, _)| is_apart(other))
        {
            let hard = Blend { radius: 0.0, ..operand.blend };
            let allowed = if is_symmetric { self.allowed(&is_apart) } else { Vec::new() };
            let how = operand.join;
            // The arrays then hold the operands before it a second time.
            if !budget.take_entries(node, size_of_fold(&allowed).0) || !budget.take_steps(node, self.so_far.len()) {
                return;
            }
            if let [_, ..] = allowed[..] {
                let mut inner = allowed;
                inner.push(operand);
                operand = Operand { node, ..group_of(inner) };
                operand.join = how;
            }
            operand.blend = hard;
        }
        join(fold, operand);
        self.so_far.push((node, own));
    }

    /// The fold of those operands so far that may blend with the next one.
    fn allowed(&self, is_apart: &dyn Fn(&Node) -> bool) -> Vec<Operand<'a>> {
        let mut fold: Vec<Operand<'a>> = Vec::new();
        for (other, operand) in &self.so_far {
            match () {
                // What the others lost to a cut stays lost.
                () if is_apart(other) && other.adds() => {}
                () if !fold.is_empty() => join(&mut fold, operand.clone()),
                // Cutting from nothing leaves nothing.
                () if !other.adds() => {}
                () => fold = begin_with(operand.clone()),
            }
        }
        fold
    }
}

/// Whether it does not matter which of the node and those before it in its group comes first.
pub(super) fn is_symmetric(node: &Node, operator: Operator) -> bool {
    node.operation.in_group(operator) == operator && matches!(operator, Operator::Union | Operator::Intersection)
}

/// The largest half extent; `None` if unbounded, 0 if empty.
fn size(bounds: &Aabb) -> Option<f64> {
    match () {
        () if bounds.is_empty() => Some(0.0),
        () if bounds.is_finite() => Some(bounds.half().max_element()),
        () => None,
    }
}

/// Grooves and tongues have no parameter for a number of steps: their edges become plain bevels.
fn without_steps(blend: Blend) -> Blend {
    if blend.kernel.has_steps() { Blend { kernel: BlendKernel::Chamfer, ..blend } } else { blend }
}
