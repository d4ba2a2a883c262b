//! The visible part of a scene as folds of operands in world space, one fold per component.

use glam::{DAffine3, DVec3};

use super::arrays::{Join, MAX_FLAT_NODES, MAX_FLAT_ROWS, Warning};
use super::body::Body;
use super::enclosure::{Enclosure, fold_bounds};
use super::flatten::{FlattenError, ROWS};
use super::joints::{Joiner, has_own_radius};
use super::leaf::leaf;
use super::modify::{MAX_NEIGHBOURS, Modified, Refusal, is_idle, modify};
use crate::geometry::{Aabb, singular_values};
use crate::scene::{Blend, Group, MaterialId, Modifier, ModifierKind, Node, NodeKind, Operator, Scene};

/// One operand of a fold.
#[derive(Clone)]
pub(super) struct Operand<'a> {
    /// The node it came from.
    pub node: &'a Node,
    /// The outermost node that it belongs to: what a message about its component names.
    pub outermost: &'a Node,
    /// How it joins what precedes it.
    pub join: Join,
    /// How round the joint is, in metres.
    pub blend: Blend,
    /// What else the join needs, see [`super::twin::Joint`]: size and depth.
    pub detail: [f64; 2],
    /// Around its surface, in the world.
    pub bounds: Aabb,
    /// Its field is at least `slope` times the distance to `skip`.
    pub skip: Aabb,
    /// See `skip`.
    pub slope: f64,
    /// What it is.
    pub value: Value<'a>,
}

/// What an operand is.
#[derive(Clone)]
pub(super) enum Value<'a> {
    /// A shape: local-from-world, factor on its local distance, what it is evaluated with.
    Leaf { local_from_world: DAffine3, distance_scale: f64, body: Body, material: MaterialId },
    /// A fold of its own; never of one operand.
    Fold(Vec<Operand<'a>>),
    /// A fold in the local space of a modifier: local-from-world, factor on its local distance, the modifier.
    Modified {
        local_from_world: DAffine3,
        distance_scale: f64,
        kind: ModifierKind,
        modified: Modified,
        content: Vec<Operand<'a>>,
    },
}

/// The folds of all components, and what was noticed on the way.
pub(super) struct Components<'a> {
    pub operands: Vec<Vec<Operand<'a>>>,
    pub warnings: Vec<Warning>,
    /// Whether something at the top is cut away from what precedes it.
    pub has_cuts: bool,
    /// The first limit that was hit.
    pub problem: Option<FlattenError>,
}

/// Whether a node is opened at the top: its children are components of their own.
pub(super) fn is_opened(scene: &Scene, node: &Node) -> bool {
    let Node { negative, kind: NodeKind::Group(group), .. } = node else { return false };
    let is_hard = group.operator == Operator::Union && group.blend.radius == 0.0;
    !negative && active(node).next().is_none() && is_hard && !scene.children(Some(node.id)).any(has_own_radius)
}

/// The modifiers that do something, in their order.
fn active(node: &Node) -> impl DoubleEndedIterator<Item = &Modifier> {
    node.modifiers.iter().filter(|slot| slot.enabled && !is_idle(&slot.modifier)).map(|slot| &slot.modifier)
}

/// The fold of the one component whose outermost node stands at `index`; nothing where it is not one, or where
/// there is something to warn of.
pub(super) fn component_of(scene: &Scene, index: usize) -> Option<Vec<Operand<'_>>> {
    let node: &Node = &scene.nodes()[index];
    let parent = node.parent.map_or(DAffine3::IDENTITY, |p| scene.world_from_local(p));
    let mut nobody = |_: &Node, _: &DAffine3| {};
    let mut collector = Collector::new(scene, MAX_FLAT_ROWS, &mut nobody);
    let mut parts = apart(collector.operand(index, &parent, node)?);
    let is_one = parts.len() == 1 && collector.warnings.is_empty() && collector.problem.is_none();
    if is_one { parts.pop().map(begin_with) } else { None }
}

/// Whether a fold is a hard union: its operands can be traced alone.
pub(super) fn is_plain(fold: &[Operand<'_>]) -> bool {
    fold[1..].iter().all(|o| o.join == Join::Union && o.blend.radius == 0.0)
}

/// Collects the components, of at most `most_rows` rows of data; lights, meshes and cameras go to `bystander` with their
/// world transform.
pub(super) fn collect<'a>(
    scene: &'a Scene,
    most_rows: usize,
    bystander: &mut dyn FnMut(&'a Node, &DAffine3),
) -> Components<'a> {
    let mut collector = Collector::new(scene, most_rows, bystander);
    let mut operands = Vec::new();
    collector.split(0..scene.nodes().len(), DAffine3::IDENTITY, &mut operands);
    let Collector { warnings, has_cuts, problem, .. } = collector;
    Components { operands, warnings, has_cuts, problem }
}

struct Collector<'a, 'b> {
    scene: &'a Scene,
    bystander: &'b mut dyn FnMut(&'a Node, &DAffine3),
    warnings: Vec<Warning>,
    has_cuts: bool,
    problem: Option<FlattenError>,
    /// Leaves so far: copies of copies are many, and must end somewhere.
    leaves: usize,
    /// Rows of data so far, and most of them.
    rows: usize,
    most_rows: usize,
    /// Within a modifier, whose bystanders are known already.
    is_muted: bool,
}

impl<'a, 'b> Collector<'a, 'b> {
    fn new(scene: &'a Scene, most_rows: usize, bystander: &'b mut dyn FnMut(&'a Node, &DAffine3)) -> Self {
        let (warnings, has_cuts, problem, is_muted) = (Vec::new(), false, None, false);
        Self { scene, bystander, warnings, has_cuts, problem, leaves: 0, rows: 0, most_rows, is_muted }
    }

    /// The children in `range` are joined by hard union: each becomes a component, hard unions among
    /// them are opened. A negative child is cut from those before it that it can reach, since
    /// (a ∪ b) − d = (a − d) ∪ (b − d) exactly.
    fn split(&mut self, range: std::ops::Range<usize>, world: DAffine3, out: &mut Vec<Vec<Operand<'a>>>) {
        let start = out.len();
        let mut at = range.start;
        while at < range.end {
            let node: &'a Node = &self.scene.nodes()[at];
            let children = self.scene.subtree(at);
            let first = at;
            at = children.end;
            if !node.visible {
                continue;
            }
            if is_opened(self.scene, node) {
                self.split(first + 1..children.end, world * node.transform.to_affine(), out);
                continue;
            }
            let Some(operand) = self.operand(first, &world, node) else { continue };
            if node.negative {
                self.has_cuts = true;
                self.cut(&mut out[start..], operand);
            } else {
                out.extend(apart(operand).into_iter().map(begin_with));
            }
        }
    }

    fn cut(&mut self, components: &mut [Vec<Operand<'a>>], negative: Operand<'a>) {
        if components.is_empty() {
            self.warn_nothing_to_cut(negative.node);
        }
        for component in components {
            if !fold_bounds(component).bounds.intersection(&negative.bounds).is_empty() {
                let mut copy = negative.clone();
                copy.join = Join::Difference;
                copy.blend = Blend::HARD;
                component.push(copy);
            }
        }
    }

    /// The node at `index` as an operand (its join still to be set), or nothing where nothing is seen.
    fn operand(&mut self, index: usize, parent: &DAffine3, outermost: &'a Node) -> Option<Operand<'a>> {
        let node: &'a Node = &self.scene.nodes()[index];
        if !node.visible {
            return None;
        }
        let world = *parent * node.transform.to_affine();
        let modifiers: Vec<&Modifier> = active(node).collect();
        if modifiers.is_empty() {
            return self.content(index, &world, outermost);
        }
        // What is no field is not modified, and is there once.
        self.bystanders(index, &world);
        let was_muted = std::mem::replace(&mut self.is_muted, true);
        let operand = self.modified(index, &modifiers, &world, outermost);
        self.is_muted = was_muted;
        operand
    }

    /// The node at `index` without its modifiers.
    fn content(&mut self, index: usize, world: &DAffine3, outermost: &'a Node) -> Option<Operand<'a>> {
        let scene = self.scene;
        let node: &'a Node = &scene.nodes()[index];
        match &node.kind {
            NodeKind::Object(object) => {
                self.leaves += 1;
                if self.leaves > MAX_FLAT_NODES {
                    self.hit_limit(outermost, "the number of shapes, copies included", self.leaves, MAX_FLAT_NODES);
                    return None;
                }
                let leaf = leaf(node, outermost, world, &object.shape, object.material);
                let Value::Leaf { body, .. } = &leaf.value else { unreachable!("made as a leaf") };
                self.has_room(node, body.rows.len()).then_some(leaf)
            }
            NodeKind::Group(group) => {
                let range = scene.subtree(index);
                let fold = self.fold(range.start + 1..range.end, group, world, outermost);
                match fold.len() {
                    0 => None,
                    1 => fold.into_iter().next(),
                    _ => Some(Operand { node, outermost, ..group_of(fold) }),
                }
            }
            NodeKind::Mesh(_) | NodeKind::Light(_) | NodeKind::Camera(_) => {
                if !self.is_muted {
                    (self.bystander)(node, world);
                }
                None
            }
        }
    }

    /// The bystanders of the subtree at `index`, whose own world transform is given.
    fn bystanders(&mut self, index: usize, world: &DAffine3) {
        if self.is_muted {
            return;
        }
        let scene = self.scene;
        let node: &'a Node = &scene.nodes()[index];
        if !node.has_field() {
            (self.bystander)(node, world);
        }
        let range = scene.subtree(index);
        let mut at = range.start + 1;
        while at < range.end {
            let child: &'a Node = &scene.nodes()[at];
            if child.visible {
                self.bystanders(at, &(*world * child.transform.to_affine()));
            }
            at = scene.subtree(at).end;
        }
    }

    /// The node at `index` with these modifiers, the last one outermost.
    fn modified(
        &mut self,
        index: usize,
        modifiers: &[&Modifier],
        world: &DAffine3,
        outermost: &'a Node,
    ) -> Option<Operand<'a>> {
        if self.problem.is_some() {
            return None;
        }
        let Some((last, rest)) = modifiers.split_last() else { return self.content(index, world, outermost) };
        let copies = match **last {
            Modifier::Mirror { axes, blend } => {
                let axes: Vec<usize> = (0..3).filter(|i| axes[*i]).collect();
                return self.mirrored(index, rest, world, outermost, &axes, blend);
            }
            Modifier::Polar { count, radius, mirrored } => polar_copies(count, radius, mirrored),
            _ => return self.deformed(index, (last, rest), world, outermost),
        };
        let copies: Vec<_> =
            copies.iter().filter_map(|copy| self.modified(index, rest, &(*world * *copy), outermost)).collect();
        united(&self.scene.nodes()[index], outermost, copies, 0.0)
    }

    /// The node and its mirror images across the planes at right angles to `axes`.
    fn mirrored(
        &mut self,
        index: usize,
        rest: &[&Modifier],
        world: &DAffine3,
        outermost: &'a Node,
        axes: &[usize],
        blend: f64,
    ) -> Option<Operand<'a>> {
        let Some((axis, axes)) = axes.split_last() else { return self.modified(index, rest, world, outermost) };
        let mut flip = DVec3::ONE;
        flip[*axis] = -1.0;
        let sides = [DAffine3::IDENTITY, DAffine3::from_scale(flip)];
        let mut side = |copy: &DAffine3| self.mirrored(index, rest, &(*world * *copy), outermost, axes, blend);
        let sides: Vec<_> = sides.iter().filter_map(&mut side).collect();
        united(&self.scene.nodes()[index], outermost, sides, blend)
    }

    /// The node under a modifier that stays in the arrays.
    fn deformed(
        &mut self,
        index: usize,
        (last, rest): (&Modifier, &[&Modifier]),
        world: &DAffine3,
        outermost: &'a Node,
    ) -> Option<Operand<'a>> {
        let node: &'a Node = &self.scene.nodes()[index];
        let content = begin_with(self.modified(index, rest, &DAffine3::IDENTITY, outermost)?);
        let enclosure = fold_bounds(&content);
        if enclosure.bounds.is_empty() {
            return None;
        }
        let modified = match modify(last, &enclosure) {
            Ok(modified) => modified,
            Err(Refusal::Cannot(reason)) => {
                self.warn(node, reason);
                return self.modified(index, rest, world, outermost);
            }
            Err(Refusal::TooMany(copies)) => {
                let what = "the number of copies that reach into each other and are evaluated at once";
                self.hit_limit(node, what, copies, MAX_NEIGHBOURS as usize);
                return None;
            }
        };
        if !self.has_room(node, modified.data.len()) {
            return None;
        }
        if let Some(warning) = &modified.warning {
            self.warn(node, warning.clone());
        }
        let (least, greatest) = singular_values(&world.matrix3);
        let skip = modified.skip.transformed(world);
        Some(Operand {
            node,
            outermost,
            join: Join::First,
            blend: Blend::HARD,
            detail: [0.0; 2],
            bounds: modified.bounds.transformed(world),
            skip,
            slope: if skip.is_finite() { modified.slope * least / greatest } else { 0.0 },
            value: Value::Modified {
                local_from_world: world.inverse(),
                distance_scale: least,
                kind: last.kind(),
                modified,
                content,
            },
        })
    }

    /// Whether so many more rows of data are within the limit.
    fn has_room(&mut self, node: &Node, rows: usize) -> bool {
        self.rows += rows;
        if self.rows > self.most_rows {
            self.hit_limit(node, ROWS, self.rows, self.most_rows);
        }
        self.rows <= self.most_rows
    }

    fn hit_limit(&mut self, node: &Node, what: &'static str, value: usize, limit: usize) {
        self.problem.get_or_insert(FlattenError { node: node.id, name: node.name.clone(), what, value, limit });
    }

    fn warn(&mut self, node: &Node, reason: String) {
        let warning = Warning { node: node.id, name: node.name.clone(), reason };
        // Copies would say the same again.
        if !self.warnings.contains(&warning) {
            self.warnings.push(warning);
        }
    }

    fn fold(
        &mut self,
        range: std::ops::Range<usize>,
        group: &Group,
        world: &DAffine3,
        outermost: &'a Node,
    ) -> Vec<Operand<'a>> {
        let mut fold: Vec<Operand<'a>> = Vec::new();
        let keeps = self.scene.children(Some(self.scene.nodes()[range.start - 1].id)).any(|n| !n.apart.is_empty());
        let mut joiner = Joiner::new(group, keeps);
        let mut at = range.start;
        while at < range.end {
            let child = at;
            at = self.scene.subtree(child).end;
            let Some(mut operand) = self.operand(child, world, outermost) else { continue };
            let node: &'a Node = &self.scene.nodes()[child];
            if fold.is_empty() {
                if node.negative {
                    self.warn_nothing_to_cut(node);
                } else {
                    joiner.begin(node, &operand);
                    fold = begin_with(operand);
                }
                continue;
            }
            joiner.set_joint(node, &mut operand);
            joiner.join(node, operand, &mut fold);
        }
        fold
    }

    fn warn_nothing_to_cut(&mut self, node: &Node) {
        self.warn(node, "is negative but comes first in its group, so there is nothing to cut it from".into());
    }
}

/// A fold as one operand, named after its first one.
pub(super) fn group_of(fold: Vec<Operand<'_>>) -> Operand<'_> {
    let Enclosure { bounds, skip, slope } = fold_bounds(&fold);
    let Operand { node, outermost, .. } = fold[0];
    let (blend, detail) = (Blend::HARD, [0.0; 2]);
    Operand { node, outermost, join: Join::First, blend, detail, bounds, skip, slope, value: Value::Fold(fold) }
}

/// A fold that starts with `operand`: a group's fold simply goes on.
pub(super) fn begin_with(mut operand: Operand<'_>) -> Vec<Operand<'_>> {
    operand.join = Join::First;
    match operand.value {
        Value::Fold(fold) => {
            let mut operands = fold.into_iter();
            let mut fold = operands.next().map_or(Vec::new(), begin_with);
            fold.extend(operands);
            fold
        }
        Value::Leaf { .. } | Value::Modified { .. } => vec![operand],
    }
}

/// What can be traced alone: the operands of a hard union.
fn apart(operand: Operand<'_>) -> Vec<Operand<'_>> {
    match operand.value {
        Value::Fold(fold) if is_plain(&fold) => fold,
        _ => vec![operand],
    }
}

/// Operands joined by union; nothing where there are none.
fn united<'a>(node: &'a Node, outermost: &'a Node, operands: Vec<Operand<'a>>, radius: f64) -> Option<Operand<'a>> {
    let blend = Blend { radius, ..Blend::HARD };
    let mut operands = operands.into_iter();
    let first = Operand { join: Join::First, ..operands.next()? };
    let mut fold = if radius == 0.0 { apart(first) } else { begin_with(first) };
    for operand in operands {
        join(&mut fold, Operand { join: Join::Union, blend, ..operand });
    }
    if fold.len() == 1 { fold.pop() } else { Some(Operand { node, outermost, ..group_of(fold) }) }
}

/// Where the copies around Y stand: the first one out along X.
fn polar_copies(count: u32, radius: f64, mirrored: bool) -> Vec<DAffine3> {
    let out = DAffine3::from_translation(DVec3::X * radius);
    let copy = |i: u32| {
        let turn = DAffine3::from_rotation_y(-std::f64::consts::TAU * f64::from(i) / f64::from(count));
        let flip = if mirrored && i % 2 == 1 { DVec3::new(1.0, 1.0, -1.0) } else { DVec3::ONE };
        turn * out * DAffine3::from_scale(flip)
    };
    (0..count).map(copy).collect()
}

/// Appends an operand. A hard union inside a hard union is opened: min is associative.
pub(super) fn join<'a>(fold: &mut Vec<Operand<'a>>, operand: Operand<'a>) {
    let hard_union = |o: &Operand<'_>| o.join == Join::Union && o.blend.radius == 0.0;
    match operand.value {
        Value::Fold(ref inner) if hard_union(&operand) && inner[1..].iter().all(hard_union) => {
            let Value::Fold(inner) = operand.value else { unreachable!("matched above") };
            fold.extend(inner.into_iter().map(|o| Operand { join: Join::Union, blend: Blend::HARD, ..o }));
        }
        _ => fold.push(operand),
    }
}
