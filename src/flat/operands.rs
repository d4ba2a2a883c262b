//! The visible part of a scene as folds of operands in world space, one fold per component.

use glam::{DAffine3, DMat3, DVec3};

use super::arrays::{Join, Warning};
use super::body::Body;
use crate::geometry::{Aabb, singular_values};
use crate::scene::{Blend, Group, MaterialId, Node, NodeKind, Operator, Scene, Shape};

/// One operand of a fold.
#[derive(Clone)]
pub(super) struct Operand<'a> {
    /// The node it came from.
    pub node: &'a Node,
    /// The outermost node that it belongs to: what a message about its component names.
    pub outermost: &'a Node,
    /// How it joins what precedes it.
    pub join: Join,
    /// How round the joint is.
    pub blend: Blend,
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
}

/// The folds of all components, and what was noticed on the way.
pub(super) struct Components<'a> {
    pub operands: Vec<Vec<Operand<'a>>>,
    pub warnings: Vec<Warning>,
    /// Whether something at the top is cut away from what precedes it.
    pub has_cuts: bool,
}

/// Whether a node is opened at the top: its children are components of their own.
pub(super) fn is_opened(node: &Node) -> bool {
    let Node { negative, kind: NodeKind::Group(group), .. } = node else { return false };
    !negative && group.operator == Operator::Union && group.blend.radius == 0.0
}

/// The fold of the component whose outermost node stands at `index`.
pub(super) fn component_of(scene: &Scene, index: usize) -> Option<Vec<Operand<'_>>> {
    let node: &Node = &scene.nodes()[index];
    let parent = node.parent.map_or(DAffine3::IDENTITY, |p| scene.world_from_local(p));
    let mut collector = Collector { scene, bystander: &mut |_, _| {}, warnings: Vec::new(), has_cuts: false };
    collector.operand(index, &parent, node).map(begin_with)
}

/// Collects the components; lights, meshes and cameras go to `bystander` with their world transform.
pub(super) fn collect<'a>(scene: &'a Scene, bystander: &mut dyn FnMut(&'a Node, &DAffine3)) -> Components<'a> {
    let mut collector = Collector { scene, bystander, warnings: Vec::new(), has_cuts: false };
    let mut components = Vec::new();
    collector.split(0..scene.nodes().len(), DAffine3::IDENTITY, &mut components);
    Components { operands: components, warnings: collector.warnings, has_cuts: collector.has_cuts }
}

struct Collector<'a, 'b> {
    scene: &'a Scene,
    bystander: &'b mut dyn FnMut(&'a Node, &DAffine3),
    warnings: Vec<Warning>,
    has_cuts: bool,
}

impl<'a> Collector<'a, '_> {
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
            if is_opened(node) {
                self.split(first + 1..children.end, world * node.transform.to_affine(), out);
                continue;
            }
            let Some(operand) = self.operand(first, &world, node) else { continue };
            if node.negative {
                self.has_cuts = true;
                self.cut(&mut out[start..], operand);
            } else {
                out.push(begin_with(operand));
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
        let scene = self.scene;
        let node: &'a Node = &scene.nodes()[index];
        if !node.visible {
            return None;
        }
        let world = *parent * node.transform.to_affine();
        match &node.kind {
            NodeKind::Object(object) => Some(leaf(node, outermost, &world, &object.shape, object.material)),
            NodeKind::Group(group) => {
                let range = scene.subtree(index);
                let fold = self.fold(range.start + 1..range.end, group, &world, outermost);
                match fold.len() {
                    0 => None,
                    1 => fold.into_iter().next(),
                    _ => Some(Operand { node, outermost, ..group_of(fold) }),
                }
            }
            NodeKind::Mesh(_) | NodeKind::Light(_) | NodeKind::Camera(_) => {
                (self.bystander)(node, &world);
                None
            }
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
                    fold = begin_with(operand);
                }
                continue;
            }
            operand.join = match (node.negative, group.operator) {
                (true, _) | (_, Operator::Difference) => Join::Difference,
                (_, Operator::Union) => Join::Union,
                (_, Operator::Intersection) => Join::Intersection,
            };
            operand.blend = group.blend;
            join(&mut fold, operand);
        }
        fold
    }

    fn warn_nothing_to_cut(&mut self, node: &Node) {
        self.warnings.push(Warning {
            node: node.id,
            name: node.name.clone(),
            reason: "is negative but comes first in its group, so there is nothing to cut it from".into(),
        });
    }
}

/// A fold as one operand, named after its first one.
pub(super) fn group_of(fold: Vec<Operand<'_>>) -> Operand<'_> {
    let Enclosure { bounds, skip, slope } = fold_bounds(&fold);
    let Operand { node, outermost, .. } = fold[0];
    Operand { node, outermost, join: Join::First, blend: Blend::HARD, bounds, skip, slope, value: Value::Fold(fold) }
}

/// A fold that starts with `operand`: a group's fold simply goes on.
fn begin_with(mut operand: Operand<'_>) -> Vec<Operand<'_>> {
    operand.join = Join::First;
    match operand.value {
        Value::Fold(fold) => fold,
        Value::Leaf { .. } => vec![operand],
    }
}

/// Appends an operand. A hard union inside a hard union is opened: min is associative.
fn join<'a>(fold: &mut Vec<Operand<'a>>, operand: Operand<'a>) {
    let hard_union = |o: &Operand<'_>| o.join == Join::Union && o.blend.radius == 0.0;
    match operand.value {
        Value::Fold(ref inner) if hard_union(&operand) && inner[1..].iter().all(hard_union) => {
            let Value::Fold(inner) = operand.value else { unreachable!("matched above") };
            fold.extend(inner.into_iter().map(|o| Operand { join: Join::Union, blend: Blend::HARD, ..o }));
        }
        _ => fold.push(operand),
    }
}

fn leaf<'a>(
    node: &'a Node,
    outermost: &'a Node,
    world_from_local: &DAffine3,
    shape: &Shape,
    material: MaterialId,
) -> Operand<'a> {
    let (shape, mut world_from_local, least, greatest) = normalise(shape, world_from_local);
    if least == 1.0 && matches!(shape, Shape::Sphere { .. }) {
        // A ball looks the same from every side: without a rotation its kernel is shorter.
        world_from_local.matrix3 = DMat3::IDENTITY;
    }
    let body = Body::new(&shape);
    let bounds = body.bounds.transformed(&world_from_local);
    Operand {
        node,
        outermost,
        join: Join::First,
        blend: Blend::HARD,
        bounds,
        skip: bounds,
        slope: if bounds.is_finite() { least / greatest } else { 0.0 },
        value: Value::Leaf { local_from_world: world_from_local.inverse(), distance_scale: least, body, material },
    }
}

/// Takes the scale out of the transform and into the shape where the shape can hold it. Returns the
/// least and greatest stretch of what remains: 1 and 1 in that case.
fn normalise(shape: &Shape, world_from_local: &DAffine3) -> (Shape, DAffine3, f64, f64) {
    let m = &world_from_local.matrix3;
    let scale = DVec3::new(m.x_axis.length(), m.y_axis.length(), m.z_axis.length());
    let skew = (m.x_axis.dot(m.y_axis).abs() / (scale.x * scale.y))
        .max(m.x_axis.dot(m.z_axis).abs() / (scale.x * scale.z))
        .max(m.y_axis.dot(m.z_axis).abs() / (scale.y * scale.z));
    if skew < 1e-12 {
        // Factors that differ only by rounding in the chain of rotations are one factor.
        let mean = (scale.x + scale.y + scale.z) / 3.0;
        let scale = if (scale - mean).abs().max_element() < 1e-12 * mean { DVec3::splat(mean) } else { scale };
        if let Some(absorbed) = shape.absorb_scale(scale) {
            let rotation = DMat3::from_cols(m.x_axis / scale.x, m.y_axis / scale.y, m.z_axis / scale.z);
            return (absorbed, DAffine3 { matrix3: rotation, ..*world_from_local }, 1.0, 1.0);
        }
        return (shape.clone(), *world_from_local, scale.min_element(), scale.max_element());
    }
    let (least, greatest) = singular_values(m);
    (shape.clone(), *world_from_local, least, greatest)
}

/// What encloses a fold.
pub(super) struct Enclosure {
    pub bounds: Aabb,
    pub skip: Aabb,
    pub slope: f64,
}

/// Bounds of a fold, and the box and slope below which its field never falls.
///
/// A blended union falls below the least operand by at most its thickening, and a row of them by at
/// most their support. Intersection and difference never fall below their operands.
pub(super) fn fold_bounds(fold: &[Operand<'_>]) -> Enclosure {
    let first = &fold[0];
    let (mut bounds, mut skip, mut slope) = (first.bounds, first.skip, first.slope);
    let mut growth = 0.0_f64;
    for operand in &fold[1..] {
        match operand.join {
            Join::Union => {
                bounds = bounds.union(&operand.bounds);
                skip = skip.union(&operand.skip);
                slope = slope.min(operand.slope);
                growth = growth.max((growth + operand.blend.thickening()).min(operand.blend.support()));
            }
            Join::Intersection => {
                bounds = bounds.expanded(growth).intersection(&operand.bounds);
                skip = skip.expanded(if slope > 0.0 { growth / slope } else { 0.0 });
                growth = 0.0;
                // Both are below the field; the smaller one says more.
                let smaller =
                    operand.slope > 0.0 && (slope == 0.0 || operand.skip.half().length() < skip.half().length());
                if smaller {
                    (skip, slope) = (operand.skip, operand.slope);
                }
            }
            Join::First | Join::Difference => {}
        }
    }
    let skip = skip.expanded(if slope > 0.0 { growth / slope } else { 0.0 });
    let bounds = bounds.expanded(growth);
    Enclosure { bounds, skip, slope: if skip.is_finite() { slope } else { 0.0 } }
}
