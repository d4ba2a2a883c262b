//! Scene → arrays.
//!
//! Two steps: the visible nodes become folds of operands in world space (`operands`), split into
//! components at hard unions; then each component is written out relative to its own origin (`emit`).
//!
//! What never reaches the arrays: hidden nodes, empty groups, groups of one operand, and groups that
//! come first in their parent (their fold simply is the beginning of the parent's fold).

use std::collections::HashMap;

use glam::{DAffine3, DVec3};
use thiserror::Error;

use super::arrays::*;
use super::emit::emit;
use super::enclosure::fold_bounds;
use super::operands::{Operand, collect, group_of, is_plain};
use crate::geometry::Camera;
use crate::scene::{CameraNode, MaterialId, Node, NodeId, NodeKind, Scene};

/// Why a scene has no arrays.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{name} ({node}): {what} is {value}, more than the limit of {limit}")]
pub struct FlattenError {
    /// The node that hit the limit.
    pub node: NodeId,
    /// Its name.
    pub name: String,
    /// What is limited.
    pub what: &'static str,
    /// The value reached.
    pub value: usize,
    /// The limit.
    pub limit: usize,
}

/// The arrays of `scene` at `time` seconds. Costs about 0.1 µs a node.
pub fn flatten(scene: &Scene, time: f64) -> Result<FlatScene, FlattenError> {
    flatten_with_cuts(scene, time).map(|(flat, _)| flat)
}

/// The arrays with all components joined into one, as a renderer has them that knows of no components: what
/// the benches compare with.
pub fn flatten_whole(scene: &Scene, time: f64) -> Result<FlatScene, FlattenError> {
    let mut flat = flatten(scene, time)?;
    flat.nodes.clear();
    flat.numbers.clear();
    flat.ids.clear();
    flat.components.clear();
    let mut materials =
        Materials { scene, index: flat.material_ids.iter().enumerate().map(|(i, id)| (*id, i as u32)).collect() };
    let components = collect(scene, &mut |_, _| {});
    let mut whole: Vec<Operand<'_>> = Vec::new();
    for mut operands in components.operands {
        if is_plain(&operands) {
            for operand in &mut operands {
                operand.join = Join::Union;
            }
            whole.extend(operands);
        } else {
            whole.push(Operand { join: Join::Union, ..group_of(operands) });
        }
    }
    if let Some(first) = whole.first_mut() {
        first.join = Join::First;
        add_component(&mut flat, &mut materials, &whole)?;
    }
    Ok(flat)
}

/// The same, and whether something is cut away from several components.
pub(super) fn flatten_with_cuts(scene: &Scene, time: f64) -> Result<(FlatScene, bool), FlattenError> {
    let mut flat = FlatScene {
        nodes: Vec::with_capacity(scene.nodes().len()),
        numbers: Vec::with_capacity(scene.nodes().len() * 6),
        ids: Vec::with_capacity(scene.nodes().len()),
        materials: Vec::new(),
        material_ids: Vec::new(),
        components: Vec::new(),
        lights: Vec::new(),
        meshes: Vec::new(),
        cameras: Vec::new(),
        environment: scene.environment,
        warnings: Vec::new(),
    };
    debug_assert!(time.is_finite(), "time is checked at the border");
    let mut materials = Materials { scene, index: HashMap::new() };
    let components = collect(scene, &mut |node, world_from_local| {
        add_bystander(&mut flat, &mut materials, node, world_from_local);
    });
    flat.warnings = components.warnings;
    if let Some(problem) = components.problem {
        return Err(problem);
    }
    for operands in &components.operands {
        add_component(&mut flat, &mut materials, operands)?;
    }
    Ok((flat, components.has_cuts))
}

/// Index of materials in use, in the order of first use.
struct Materials<'a> {
    scene: &'a Scene,
    index: HashMap<MaterialId, u32>,
}

impl Materials<'_> {
    fn resolve(&mut self, flat: &mut FlatScene, id: MaterialId) -> u32 {
        *self.index.entry(id).or_insert_with(|| {
            let material = self.scene.material(id).expect("the scene holds every material that a node names");
            flat.materials.push(FlatMaterial {
                albedo: material.albedo.map(|v| v as f32),
                specular: material.specular as f32,
                emission: material.emission.map(|v| v as f32),
                shininess: material.shininess as f32,
            });
            flat.material_ids.push(id);
            flat.materials.len() as u32 - 1
        })
    }
}

fn add_bystander(flat: &mut FlatScene, materials: &mut Materials<'_>, node: &Node, world_from_local: &DAffine3) {
    let forward = (world_from_local.matrix3 * DVec3::NEG_Z).try_normalize().unwrap_or(DVec3::NEG_Z);
    match &node.kind {
        NodeKind::Light(light) => flat.lights.push(FlatLight {
            id: node.id,
            position: world_from_local.translation,
            direction: forward,
            light: *light,
        }),
        NodeKind::Mesh(mesh) => {
            let material = mesh.material.map(|id| materials.resolve(flat, id));
            flat.meshes.push(FlatMesh {
                id: node.id,
                path: mesh.path.clone(),
                world_from_local: *world_from_local,
                material,
            });
        }
        NodeKind::Camera(camera) => flat.cameras.push(FlatCamera {
            id: node.id,
            name: node.name.clone(),
            camera: place_camera(camera, world_from_local),
        }),
        NodeKind::Group(_) | NodeKind::Object(_) => {}
    }
}

/// A camera's scale has no meaning: only where it stands and where it looks are inherited.
fn place_camera(camera: &CameraNode, world_from_local: &DAffine3) -> Camera {
    let back = (world_from_local.matrix3 * DVec3::Z).try_normalize().unwrap_or(DVec3::Z);
    let up = world_from_local.matrix3 * DVec3::Y;
    let right = up.cross(back).try_normalize().unwrap_or(back.any_orthonormal_vector());
    let rotation = glam::DQuat::from_mat3(&glam::DMat3::from_cols(right, back.cross(right), back));
    Camera {
        position: world_from_local.translation,
        rotation,
        fov_y: camera.fov_y.to_radians(),
        near: camera.near,
        far: camera.far,
    }
}

fn add_component(
    flat: &mut FlatScene,
    materials: &mut Materials<'_>,
    operands: &[Operand<'_>],
) -> Result<(), FlattenError> {
    let first = operands.first().expect("a component has an operand");
    // An intersection of what does not meet: nothing is there to trace.
    if fold_bounds(operands).bounds.is_empty() {
        return Ok(());
    }
    let start = flat.nodes.len();
    let component = emit(flat, operands, &mut |flat, id| materials.resolve(flat, id));
    let limits = [
        ("the number of shapes that are blended or cut together", flat.nodes.len() - start, MAX_COMPONENT_NODES),
        ("the nesting of groups that cannot be simplified", component.stack as usize, MAX_STACK as usize),
        ("the number of shapes and groups", flat.nodes.len(), MAX_FLAT_NODES),
        ("the number of rows of points, letters and images", flat.numbers.len(), MAX_FLAT_ROWS),
    ];
    for (what, value, limit) in limits {
        if value > limit {
            let blamed = first.outermost;
            return Err(FlattenError { node: blamed.id, name: blamed.name.clone(), what, value, limit });
        }
    }
    flat.components.push(component);
    Ok(())
}
