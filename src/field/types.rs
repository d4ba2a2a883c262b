//! The types of instancers: each becomes a component in the space of a copy.

use glam::DAffine3;

use super::arrays::{FlatScene, InstanceType, Warning};
use super::budget::Budget;
use super::collect::type_of;
use super::copies::build::{CopyType, flat_instancer, is_listed, polar_places};
use super::copies::instancer::{MAX_PLACES, Place};
use super::error::FlattenError;
use super::lower_bound::fold_bounds;
use super::operand::Operand;
use super::survey::Survey;
use isolith_geometry::Aabb;
use isolith_scene::{Instancer, Lattice, MAX_TYPES, Node, NodeKind, Operator, Scene};

/// See [`MAX_PLACES`].
const PLACES: &str = "the number of copies that stand on a surface, along a curve or in rings";

/// See [`MAX_TYPES`].
const TYPES: &str = "the number of types";

/// Adds a component for operands, and returns its index; `None` if they are empty.
pub(super) type AddComponent<'a, 'f> =
    dyn FnMut(&mut FlatScene, &[Operand<'a>]) -> Result<Option<usize>, FlattenError> + 'f;

/// Adds the instancer of the node at `index` and its types.
///
/// # Errors
/// A limit is hit.
pub(super) fn add_instancer<'a>(
    flat: &mut FlatScene,
    (scene, survey): (&'a Scene, &Survey),
    (index, world_from_local): (usize, DAffine3),
    time: f64,
    mut budget: Budget,
    palette: &mut dyn FnMut(&mut FlatScene, isolith_scene::MaterialId) -> u32,
    add: &mut AddComponent<'a, '_>,
) -> Result<Budget, FlattenError> {
    let node: &'a Node = &scene.nodes()[index];
    let NodeKind::Instancer(instancer) = &node.kind else { unreachable!("it is an instancer") };
    warn_of_blends(flat, scene, node);
    let mut types = Vec::new();
    for child in survey.children(index) {
        let of: &'a Node = &scene.nodes()[child];
        if !of.visible || of.weight == 0.0 {
            continue;
        }
        if !of.has_field() {
            warn(flat, of, "cannot be a type of an instancer: only objects and groups can");
            continue;
        }
        let (operands, warnings, left) = type_of(scene, survey, child, budget);
        budget = left;
        flat.warnings.extend(warnings);
        let Some(operands) = operands else { continue };
        let bounds = fold_bounds(&operands).bounds;
        if bounds.is_empty() {
            continue;
        }
        if !bounds.is_finite() {
            warn(flat, of, "has no end, so that no copies of it can be made");
            continue;
        }
        types.push((of.weight, bounds, operands));
    }
    if let Some(problem) = budget.problem.take() {
        return Err(problem);
    }
    if types.len() > MAX_TYPES {
        return Err(FlattenError::new(node, TYPES, types.len(), MAX_TYPES));
    }
    if types.is_empty() {
        let reason = if survey.children(index).next().is_none() {
            "has no children, of which it could make copies"
        } else {
            "has no child of which it could make copies: hidden ones, empty ones and those of weight 0 do not count"
        };
        warn(flat, node, reason);
        return Ok(budget);
    }
    let palette = instancer.palette.iter().map(|id| palette(flat, *id)).collect();
    add_types(flat, node, instancer, (world_from_local, time), &types, palette, add)?;
    Ok(budget)
}

/// A type: its weight, its bounds and its fold, in the space of a copy.
type TypeFold<'a> = (f64, Aabb, Vec<Operand<'a>>);

/// Adds the instancer with a component for each type.
fn add_types<'a>(
    flat: &mut FlatScene,
    node: &Node,
    instancer: &Instancer,
    (world_from_local, time): (DAffine3, f64),
    types: &[TypeFold<'a>],
    palette: Vec<u32>,
    add: &mut AddComponent<'a, '_>,
) -> Result<(), FlattenError> {
    let places = places(flat, node, instancer)?;
    let sizes: Vec<CopyType> = types
        .iter()
        .map(|(weight, bounds, _)| CopyType {
            weight: *weight,
            center: bounds.center(),
            radius: bounds.half().length(),
        })
        .collect();
    let made = flat_instancer(node, instancer, world_from_local, time, &sizes, places, palette);
    let (at, bounds) = (flat.instancers.len() as u32, made.world_bounds());
    flat.instancers.push(made);
    for (kind, (_, _, operands)) in types.iter().enumerate() {
        if let Some(component) = add(flat, operands)? {
            flat.components[component].instanced = Some(InstanceType { instancer: at, kind: kind as u32, bounds });
        }
    }
    Ok(())
}

/// The places of an instancer whose copies stand in a list.
fn places(flat: &mut FlatScene, node: &Node, instancer: &Instancer) -> Result<Vec<Place>, FlattenError> {
    if !is_listed(instancer) {
        return Ok(Vec::new());
    }
    match instancer.lattice {
        Lattice::Polar { count, rings, radius, spacing } => polar_places(count, rings, radius, spacing, MAX_PLACES)
            .map_err(|count| FlattenError::new(node, PLACES, count, MAX_PLACES)),
        _ => {
            warn(flat, node, "stands on no surface");
            Ok(Vec::new())
        }
    }
}

/// Copies join others by hard union only.
fn warn_of_blends(flat: &mut FlatScene, scene: &Scene, node: &Node) {
    let mut above = node.parent.and_then(|id| scene.node(id));
    while let Some(group) = above {
        let is_plain = match &group.kind {
            NodeKind::Group(kind) => kind.operator == Operator::Union && kind.blend.radius == 0.0,
            _ => true,
        };
        if !is_plain || group.negative || group.modifiers.iter().any(|slot| slot.enabled) {
            let name = &group.name;
            let reason =
                format!("joins others by hard union: blends, cuts and modifiers of {name:?} do not act on its copies");
            flat.warnings.push(Warning { node: node.id, name: node.name.clone(), reason });
            return;
        }
        above = group.parent.and_then(|id| scene.node(id));
    }
}

fn warn(flat: &mut FlatScene, node: &Node, reason: &str) {
    flat.warnings.push(Warning { node: node.id, name: node.name.clone(), reason: reason.into() });
}
