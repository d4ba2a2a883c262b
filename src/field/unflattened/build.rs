//! Builds parts from nodes.

use glam::{DAffine3, DMat3, DVec3};
use thiserror::Error;

use super::modifier::Deformation;
use super::part::{Deformed, Leaf, Link, Part};
use crate::Join;
use crate::blends::is_symmetric;
use crate::eval::BlendParams;
use crate::prepare::PreparedShape;
use crate::survey::active;
use isolith_geometry::singular_values;
use isolith_scene::{
    Blend, BlendKernel, BlendOverride, Group, Modifier, Node, NodeId, NodeKind, Operator, RadiusUnit, Scene, Shape,
};

/// The reason why a scene cannot be evaluated without flattening.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{node}: {reason}")]
pub struct Unsupported {
    /// The node.
    pub node: NodeId,
    /// The unsupported property.
    pub reason: &'static str,
}

/// The whole scene: its top is a hard union.
pub(super) fn whole(scene: &Scene) -> Result<Part, Unsupported> {
    let top = Group::new(Operator::Union, Blend::HARD);
    Ok(Builder { scene }.fold(None, &top, &DAffine3::IDENTITY)?.unwrap_or(Part::Nothing))
}

struct Builder<'a> {
    scene: &'a Scene,
}

/// A part, or `None` for a node that is not an operand.
type Found = Result<Option<Part>, Unsupported>;

/// An operand with its node and its link; the first of a group has no link.
type SiblingOperand<'n> = (&'n Node, Option<Link>, Part);

impl Builder<'_> {
    /// The node as an operand.
    fn operand(&self, node: &Node, parent: &DAffine3) -> Found {
        if !node.visible || !node.has_field() {
            return Ok(None);
        }
        // An idle modifier has no space of its own, in which radii of blends would be measured.
        let modifiers: Vec<&Modifier> = active(node).collect();
        let found = self.modified(node, &modifiers, &(*parent * node.transform.to_affine()))?;
        // An empty group is the empty set; a group of lights, cameras and meshes is not an operand.
        Ok(found.or_else(|| (!self.is_folder(node)).then_some(Part::Nothing)))
    }

    /// Whether a modifier of the node, or of a group around it, makes a solid of a point.
    fn is_thickened(&self, node: &Node) -> bool {
        active(node).any(Modifier::thickens)
            || node.parent.and_then(|id| self.scene.node(id)).is_some_and(|parent| self.is_thickened(parent))
    }

    /// Whether a group holds lights, cameras or meshes, but no object.
    fn is_folder(&self, node: &Node) -> bool {
        let [has_object, has_other] = self.holds(node);
        has_other && !has_object
    }

    /// Whether the node is or holds an object, and whether it is or holds a node without a field.
    fn holds(&self, node: &Node) -> [bool; 2] {
        let own = [matches!(node.kind, NodeKind::Object(_)), !node.has_field()];
        self.scene.children(Some(node.id)).fold(own, |[object, other], child| {
            let [o, n] = self.holds(child);
            [object || o, other || n]
        })
    }

    /// The node with these modifiers, the last one outermost; `outer` maps the node's own space.
    fn modified(&self, node: &Node, modifiers: &[&Modifier], outer: &DAffine3) -> Found {
        let Some((last, rest)) = modifiers.split_last() else { return self.plain(node, outer) };
        match last {
            Modifier::Mirror { axes, blend } => {
                let axes: Vec<usize> = (0..3).filter(|axis| axes[*axis]).collect();
                self.mirrored(node, rest, outer, &axes, *blend)
            }
            Modifier::Polar { count, radius, mirrored } => {
                let copy = |i: u32| {
                    let turn = DAffine3::from_rotation_y(-std::f64::consts::TAU * f64::from(i) / f64::from(*count));
                    let side = if *mirrored && i % 2 == 1 { -1.0 } else { 1.0 };
                    turn * DAffine3::from_translation(DVec3::X * *radius)
                        * DAffine3::from_scale(DVec3::new(1.0, 1.0, side))
                };
                let copies = (0..*count).map(|i| self.modified(node, rest, &(*outer * copy(i))));
                united(copies.collect::<Result<_, _>>()?, 0.0)
            }
            other => {
                let Some(content) = self.modified(node, rest, &DAffine3::IDENTITY)? else { return Ok(None) };
                if moves_by_values(other) && !content.is_exact() {
                    return Err(Unsupported { node: node.id, reason: MOVED });
                }
                let deformation = Deformation::new(other, || content.bounds())
                    .map_err(|reason| Unsupported { node: node.id, reason })?;
                Ok(Some(Part::Deformed(Deformed {
                    local_from_outer: outer.inverse(),
                    scale: singular_values(&outer.matrix3).0,
                    deformation,
                    content: Box::new(content),
                })))
            }
        }
    }

    fn mirrored(&self, node: &Node, rest: &[&Modifier], outer: &DAffine3, axes: &[usize], blend: f64) -> Found {
        let Some((axis, axes)) = axes.split_last() else { return self.modified(node, rest, outer) };
        let mut flip = DVec3::ONE;
        flip[*axis] = -1.0;
        let sides = [DVec3::ONE, flip]
            .map(|side| self.mirrored(node, rest, &(*outer * DAffine3::from_scale(side)), axes, blend));
        let sides: Vec<Option<Part>> = sides.into_iter().collect::<Result<_, _>>()?;
        if blend > 0.0 && sides.iter().flatten().any(|part| !part.is_exact()) {
            return Err(Unsupported { node: node.id, reason: BLENDED });
        }
        united(sides, blend)
    }

    fn plain(&self, node: &Node, outer: &DAffine3) -> Found {
        match &node.kind {
            NodeKind::Object(object) => {
                let leaf = leaf(&object.shape, outer);
                let is_blank = object.shape.is_blank(&leaf.prepared.bounds);
                let is_point = !object.shape.kind().has_data() && Shape::is_point(&object.shape.bounds());
                let is_nothing = is_blank || (is_point && !self.is_thickened(node));
                Ok(Some(if is_nothing { Part::Nothing } else { Part::Leaf(leaf) }))
            }
            NodeKind::Group(group) => self.fold(Some(node.id), group, outer),
            NodeKind::Instancer(_) | NodeKind::Mesh(_) | NodeKind::Light(_) | NodeKind::Camera(_) => Ok(None),
        }
    }

    /// The children of a group, in their order; `None` without an operand.
    fn fold(&self, parent: Option<NodeId>, group: &Group, outer: &DAffine3) -> Found {
        let mut so_far: Vec<SiblingOperand<'_>> = Vec::new();
        let mut whole: Option<Part> = None;
        for child in self.scene.children(parent) {
            let child: &Node = child;
            let Some(part) = self.operand(child, outer)? else { continue };
            let Some(before) = whole.take() else {
                // Subtracting from nothing leaves nothing.
                if child.adds() {
                    so_far.push((child, None, part.clone()));
                    whole = Some(part);
                }
                continue;
            };
            // At the top of the scene nothing blends.
            let blend_override = if parent.is_some() { child.blend_override } else { BlendOverride::Hard };
            let link = link(group, child, blend_override).map_err(|reason| Unsupported { node: child.id, reason })?;
            let needs_values = link.blend_params.support > 0.0 || !is_on_sets(link);
            if needs_values && !(part.is_exact() && before.is_exact()) {
                return Err(Unsupported { node: child.id, reason: BLENDED });
            }
            so_far.push((child, Some(link), part.clone()));
            whole = Some(joined(group, before, &so_far, link, part));
        }
        Ok(whole)
    }
}

/// Joins one more operand, the last of `so_far`, to the result before it. It does not blend with the operands that it
/// is kept apart from: it blends with the others alone, and the result joins hard.
fn joined(group: &Group, before: Part, so_far: &[SiblingOperand<'_>], link: Link, part: Part) -> Part {
    let Some(((node, ..), others)) = so_far.split_last() else { return before };
    let is_apart = |other: &Node| node.apart.contains(&other.id) || other.apart.contains(&node.id);
    if link.blend_params.support == 0.0 || !others.iter().any(|(other, ..)| is_apart(other)) {
        return join(group, before, link, part);
    }
    let hard = Link { blend_params: BlendParams { support: 0.0, ..link.blend_params }, ..link };
    let is_symmetric = is_symmetric(node, group.operator);
    let mut allowed: Option<Part> = None;
    // What the others lost to a cut stays lost.
    for (other, own, part) in others.iter().filter(|(other, ..)| is_symmetric && (!is_apart(other) || !other.adds())) {
        allowed = match (allowed, own) {
            (None, _) if !other.adds() => None,
            (Some(fold), Some(own)) => Some(join(group, fold, *own, part.clone())),
            (_, _) => Some(part.clone()),
        };
    }
    let operand = match allowed {
        Some(allowed) => join(group, allowed, link, part),
        None => part,
    };
    join(group, before, hard, operand)
}

/// Why a blend cannot be compared.
const BLENDED: &str = "it joins by the values of a deformation or repetition, of which only the surface is given";

/// Why a moved surface cannot be compared.
const MOVED: &str =
    "it moves the surface by the values of a deformation or repetition, of which only the surface is given";

/// Whether a modifier makes its surface of values of its content other than 0.
fn moves_by_values(modifier: &Modifier) -> bool {
    matches!(
        modifier,
        Modifier::Round { .. }
            | Modifier::Onion { .. }
            | Modifier::Waves { .. }
            | Modifier::Noise { .. }
            | Modifier::Displacement { .. }
    )
}

/// Whether a hard join depends on inside and outside only.
fn is_on_sets(link: Link) -> bool {
    let sets = [Join::Union, Join::Intersection, Join::Difference, Join::Xor, Join::Paint];
    sets.map(|join| join as u32).contains(&link.join)
}

/// Joins two operands, either of which may be the empty set.
fn join(group: &Group, a: Part, link: Link, b: Part) -> Part {
    let is = |join: Join| link.join == join as u32;
    match (a, b) {
        (Part::Nothing, b) if is(Join::Union) || is(Join::Xor) || (is(Join::Morph) && group.share == 1.0) => b,
        (Part::Nothing, _) => Part::Nothing,
        (a, Part::Nothing) => {
            let loses = is(Join::Intersection) || is(Join::Pipe) || (is(Join::Morph) && group.share > 0.0);
            if loses { Part::Nothing } else { a }
        }
        (Part::Fold { first, mut rest }, b) => {
            rest.push((link, b));
            Part::Fold { first, rest }
        }
        (a, b) => Part::Fold { first: Box::new(a), rest: vec![(link, b)] },
    }
}

/// Copies in a union with a blend of this radius.
fn united(parts: Vec<Option<Part>>, radius: f64) -> Found {
    let link = Link {
        join: Join::Union as u32,
        blend_params: BlendParams::blend(radius),
        kernel: BlendKernel::Circular as u32,
    };
    let parts = parts.into_iter().flatten();
    Ok(parts.reduce(|all, part| join(&Group::UNION, all, link, part)))
}

/// The link of a child, from its group and its own override.
fn link(group: &Group, node: &Node, blend_override: BlendOverride) -> Result<Link, &'static str> {
    let join = Join::of(node.operation.in_group(group.operator));
    let radius = match blend_override {
        BlendOverride::Inherit => group.blend.radius,
        BlendOverride::Hard => 0.0,
        BlendOverride::Radius(radius) => radius,
    };
    let has_radius = !matches!(join, Join::Pipe | Join::Morph);
    if has_radius && radius > 0.0 && group.blend.unit == RadiusUnit::Size {
        return Err("its blend is a share of the size of what flattening takes for bounds");
    }
    let mut kernel = group.blend.kernel;
    if matches!(join, Join::Groove | Join::Tongue) && kernel.has_steps() {
        // Grooves and tongues use plain bevels instead.
        kernel = BlendKernel::Chamfer;
    }
    let steps = f64::from(group.blend.steps);
    let [size, depth] = match join {
        Join::Pipe => [0.5 * group.width, 0.0],
        Join::Groove | Join::Tongue => [0.5 * group.width, group.depth],
        Join::Morph => [0.0, group.share],
        Join::Paint => [0.0; 2],
        Join::Engrave => [steps, group.depth],
        _ => [steps, 0.0],
    };
    let support = match join {
        Join::Pipe | Join::Morph => 0.0,
        // Half the width of the soft edge.
        Join::Paint => radius,
        _ => Blend { kernel, radius, ..group.blend }.support(),
    };
    Ok(Link { join: join as u32, blend_params: BlendParams { support, size, depth }, kernel: kernel as u32 })
}

/// A placed shape. A scale along its own axes is applied to its parameters if such a shape exists, so that its field
/// is the distance. Otherwise the local distance is multiplied by the least stretch of space.
fn leaf(shape: &Shape, outer: &DAffine3) -> Leaf {
    let axes = [outer.matrix3.x_axis, outer.matrix3.y_axis, outer.matrix3.z_axis];
    let lengths = DVec3::from_array(axes.map(DVec3::length));
    let [x, y, z] = [0, 1, 2].map(|i| axes[i] / lengths[i]);
    let is_square = [x.dot(y), x.dot(z), y.dot(z)].into_iter().all(|cosine| cosine.abs() < 1e-12);
    let mean = lengths.element_sum() / 3.0;
    let is_even = (lengths - mean).abs().max_element() < 1e-12 * mean;
    let scale = if is_even { DVec3::splat(mean) } else { lengths };
    if is_square && let Some(absorbed) = shape.absorb_scale(scale) {
        let turned = DAffine3 { matrix3: DMat3::from_cols(x, y, z), ..*outer };
        return Leaf { local_from_outer: turned.inverse(), scale: 1.0, prepared: PreparedShape::new(&absorbed) };
    }
    let least = if is_square { scale.min_element() } else { singular_values(&outer.matrix3).0 };
    Leaf { local_from_outer: outer.inverse(), scale: least, prepared: PreparedShape::new(shape) }
}
