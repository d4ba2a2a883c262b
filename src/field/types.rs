//! The types of instancers: each becomes a component in the space of a copy.

use glam::{DAffine3, DVec3};

use super::arrays::{FlatMesh, FlatScene, InstanceType, Warning};
use super::budget::Budget;
use super::collect::type_of;
use super::copies::build::{CopyType, flat_instancer, is_listed};
use super::copies::ground::{Ground, ground_scene};
use super::copies::instancer::{MAX_PLACES, Place};
use super::copies::list::{self, PlaceRefusal, curve_of};
use super::error::FlattenError;
use super::lower_bound::fold_bounds;
use super::non_field::place_mesh;
use super::operand::Operand;
use super::survey::Survey;
use isolith_geometry::Aabb;
use isolith_scene::{
    Instancer, Lattice, MAX_TYPES, Mask, MaterialId, MaterialVariation, MeshNode, Node, NodeId, NodeKind, Operator,
    Scene, Snap,
};

/// See [`MAX_PLACES`].
const PLACES: &str = "the number of copies that stand on a surface, along a curve or in rings";

/// See [`MAX_TYPES`].
const TYPES: &str = "the number of types";

/// Adds a component for operands, and returns its index; `None` if they are empty.
pub(super) type AddComponent<'a, 'f> =
    dyn FnMut(&mut FlatScene, &[Operand<'a>]) -> Result<Option<usize>, FlattenError> + 'f;

/// Flattens a scene at a time.
pub(super) type FlattenScene = fn(&Scene, f64) -> Result<FlatScene, FlattenError>;

/// The scene that is flattened, and how.
#[derive(Clone, Copy)]
pub(super) struct Flattening<'a, 's> {
    pub scene: &'a Scene,
    pub survey: &'s Survey,
    /// In seconds.
    pub time: f64,
    /// Flattens another scene.
    pub flatten: FlattenScene,
}

/// Adds the instancer of the node at `index` and its types.
///
/// # Errors
/// A limit is hit.
pub(super) fn add_instancer<'a>(
    flat: &mut FlatScene,
    of: Flattening<'a, '_>,
    (index, world_from_local): (usize, DAffine3),
    mut budget: Budget,
    palette: &mut dyn FnMut(&mut FlatScene, MaterialId) -> u32,
    add: &mut AddComponent<'a, '_>,
) -> Result<Budget, FlattenError> {
    let Flattening { scene, survey, .. } = of;
    let node: &'a Node = &scene.nodes()[index];
    warn_of_blends(flat, scene, node);
    let mut types = Vec::new();
    for child in survey.children(index) {
        let child_node: &'a Node = &scene.nodes()[child];
        if !child_node.visible || child_node.weight == 0.0 {
            continue;
        }
        if let NodeKind::Mesh(mesh) = &child_node.kind {
            // Its bounds are known to those who read its file.
            let bounds = Aabb::from_center_half(DVec3::ZERO, DVec3::ZERO);
            types.push(TypeFold { weight: child_node.weight, bounds, content: TypeContent::Mesh(child_node, mesh) });
            continue;
        }
        if !child_node.has_field() {
            warn(flat, child_node, "cannot be a type of an instancer: only objects, groups and meshes can");
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
            warn(flat, child_node, "has no end, so that no copies of it can be made");
            continue;
        }
        types.push(TypeFold { weight: child_node.weight, bounds, content: TypeContent::Field(operands) });
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
    add_types(flat, of, (node, world_from_local), &types, palette, add)?;
    Ok(budget)
}

/// A type in the space of a copy.
struct TypeFold<'a> {
    weight: f64,
    bounds: Aabb,
    content: TypeContent<'a>,
}

/// What a type is.
enum TypeContent<'a> {
    /// The fold of its field.
    Field(Vec<Operand<'a>>),
    /// Triangles of a model.
    Mesh(&'a Node, &'a MeshNode),
}

/// Adds the instancer with a component for each type.
fn add_types<'a>(
    flat: &mut FlatScene,
    of: Flattening<'a, '_>,
    (node, world_from_local): (&Node, DAffine3),
    types: &[TypeFold<'a>],
    palette: &mut dyn FnMut(&mut FlatScene, MaterialId) -> u32,
    add: &mut AddComponent<'a, '_>,
) -> Result<(), FlattenError> {
    let NodeKind::Instancer(instancer) = &node.kind else { unreachable!("it is an instancer") };
    warn_of_images(flat, node, instancer);
    warn_of_meshes(flat, of.scene, instancer, types);
    let palette_of_copies = instancer.palette.iter().map(|id| palette(flat, *id)).collect();
    let places = places(flat, of, (node, instancer), world_from_local)?;
    let sizes: Vec<CopyType> =
        types.iter().map(|TypeFold { weight, bounds, .. }| CopyType { weight: *weight, bounds: *bounds }).collect();
    let made = flat_instancer(node, instancer, world_from_local, of.time, &sizes, places, palette_of_copies);
    if made.bounds().is_empty() {
        return Ok(());
    }
    let (at, bounds) = (flat.instancers.len() as u32, made.world_bounds());
    flat.instancers.push(made);
    for (kind, one) in types.iter().enumerate() {
        let instanced = Some(InstanceType { instancer: at, kind: kind as u32, bounds });
        match &one.content {
            TypeContent::Field(operands) => {
                if let Some(component) = add(flat, operands)? {
                    flat.components[component].instanced = instanced;
                }
            }
            TypeContent::Mesh(node, mesh) => {
                let material = mesh.material.map(|id| palette(flat, id));
                let made = place_mesh(node.id, mesh, &node.transform.to_affine(), material, of.time);
                flat.meshes.push(FlatMesh { instanced, ..made });
            }
        }
    }
    Ok(())
}

/// The places of an instancer whose copies stand in a list.
fn places(
    flat: &mut FlatScene,
    Flattening { scene, time, flatten, .. }: Flattening<'_, '_>,
    (node, instancer): (&Node, &Instancer),
    world_from_local: DAffine3,
) -> Result<Vec<Place>, FlattenError> {
    if !is_listed(instancer) {
        return Ok(Vec::new());
    }
    let of_itself = |id: &NodeId| {
        scene
            .index_of(node.id)
            .is_some_and(|own| scene.index_of(*id).is_some_and(|at| scene.subtree(own).contains(&at)))
    };
    let target = match instancer.target {
        Some(id) if scene.node(id).is_none() => {
            warn(flat, node, "stands on a node that does not exist any more");
            None
        }
        Some(id) if of_itself(&id) => {
            warn(flat, node, "cannot stand on itself or on its own types");
            None
        }
        target => target,
    };
    let curve = target.and_then(|_| curve_of(scene, instancer, &world_from_local));
    let alone = target.filter(|_| needs_ground(instancer)).and_then(|id| ground_scene(scene, id));
    let alone = alone.map(|alone| flatten(&alone, time)).transpose()?;
    let ground = alone.as_ref().map(|alone| Ground::new(alone, world_from_local)).filter(|ground| !ground.is_empty());
    match list::places(instancer, ground.as_ref(), curve.as_ref(), MAX_PLACES) {
        Ok(places) => Ok(places),
        Err(PlaceRefusal::Cannot(reason)) => {
            warn(flat, node, &reason);
            Ok(Vec::new())
        }
        Err(PlaceRefusal::TooMany(count)) => Err(FlattenError::new(node, PLACES, count, MAX_PLACES)),
    }
}

/// Whether its copies stand on a surface.
fn needs_ground(instancer: &Instancer) -> bool {
    instancer.snap != Snap::Off || matches!(instancer.lattice, Lattice::Scatter { .. })
}

/// What copies of triangles cannot do.
fn warn_of_meshes(flat: &mut FlatScene, scene: &Scene, instancer: &Instancer, types: &[TypeFold<'_>]) {
    let is_varied = !instancer.palette.is_empty() || instancer.material != MaterialVariation::default();
    let is_shadowed = scene.environment.shadowing.is_on();
    let reason = match (is_varied, is_shadowed) {
        (false, false) => return,
        (true, false) => "the palette and the jitter of materials do not act",
        (false, true) => "shadows and occlusion do not know them",
        (true, true) => "shadows and occlusion do not know them, nor act the palette and the jitter of materials",
    };
    for one in types {
        if let TypeContent::Mesh(node, _) = one.content {
            warn(flat, node, &format!("is copied as triangles: {reason}; convert it to a field for that"));
        }
    }
}

/// Masks whose image is missing.
fn warn_of_images(flat: &mut FlatScene, node: &Node, instancer: &Instancer) {
    for (at, slot) in instancer.masks.iter().enumerate() {
        if matches!(&slot.mask, Mask::Image { image, .. } if image.content().is_none()) {
            warn(flat, node, &format!("has no image for its mask {}, which hides nothing until it has one", at + 1));
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
        if !is_plain || !group.adds() || group.modifiers.iter().any(|slot| slot.enabled) {
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
