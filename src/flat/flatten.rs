//! Scene → arrays.
//!
//! Two steps: the visible nodes become folds of operands in world space (`operands`), split into
//! components at hard unions, small ones joined again by place (`batch`); then each component is written out relative to
//! its own origin (`emit`).
//!
//! What never reaches the arrays: hidden nodes, empty groups, groups of one operand, and groups that
//! come first in their parent (their fold simply is the beginning of the parent's fold).

use std::collections::HashMap;

use glam::{DAffine3, DVec3};
use thiserror::Error;

use super::arrays::*;
use super::batch::{batched, united};
use super::emit::emit;
use super::enclosure::fold_bounds;
use super::operands::{Operand, collect};
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

/// What is limited by [`MAX_FLAT_ROWS`].
pub(super) const ROWS: &str = "the number of rows of points, letters and images, copies included";

/// The arrays of `scene` at `time` seconds. Costs about 0.1 µs a node, four times as much where thousands of separate shapes
/// are joined by place.
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
    let components = collect(scene, MAX_FLAT_ROWS, &mut |_, _| {});
    let whole = united(components.operands);
    if !whole.is_empty() {
        add_component(&mut flat, &mut materials, &whole, MAX_FLAT_ROWS)?;
    }
    Ok(flat)
}

/// The same, and whether something is cut away from several components.
pub(super) fn flatten_with_cuts(scene: &Scene, time: f64) -> Result<(FlatScene, bool), FlattenError> {
    flatten_within(scene, time, MAX_FLAT_ROWS)
}

fn flatten_within(scene: &Scene, time: f64, most_rows: usize) -> Result<(FlatScene, bool), FlattenError> {
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
    let components = collect(scene, most_rows, &mut |node, world_from_local| {
        add_bystander(&mut flat, &mut materials, node, world_from_local);
    });
    flat.warnings = components.warnings;
    if let Some(problem) = components.problem {
        return Err(problem);
    }
    for operands in &batched(components.operands) {
        add_component(&mut flat, &mut materials, operands, most_rows)?;
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
    most_rows: usize,
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
        (ROWS, flat.numbers.len(), most_rows),
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Attachment, Axis, Modifier, Object, ShapeKind};

    /// Sixty-four copies of a plate that is displaced by an image of 900 pixels; the name of the plate's node.
    fn copies() -> (Scene, NodeId) {
        let image = Attachment::drawn("x.png", [30, 30], |x, y| (x * y % 256) as u8);
        let displaced = Modifier::Displacement { image, height: 0.1, tile: 1.0, axis: Axis::Y };
        let mut scene = Scene::new();
        let object = Object { shape: ShapeKind::Box.default_shape(), material: scene.materials()[0].id };
        let ring = Modifier::Polar { count: 64, radius: 9.0, mirrored: false };
        let plate = Node::new("Plate", NodeKind::Object(object)).modified(displaced).modified(ring);
        let id = scene.insert(None, 0, plate).unwrap();
        (scene, id)
    }

    #[test]
    fn too_many_rows_are_refused_with_the_node_before_they_are_made() {
        let (scene, id) = copies();
        let rows = flatten(&scene, 0.0).unwrap().numbers.len();
        assert!(rows > 64 * 900);
        assert!(flatten_within(&scene, 0.0, rows).is_ok());
        let refused = |most| flatten_within(&scene, 0.0, most).unwrap_err();
        // The last component is one row too long.
        let error = refused(rows - 1);
        assert_eq!((error.node, error.value, error.limit), (id, rows, rows - 1));
        // Data alone are too many: no more copies are made than it takes to know.
        let error = refused(5_000);
        assert_eq!((error.node, error.value, error.limit), (id, 5_400, 5_000));
        let told = format!("Plate ({id}): the number of rows of points, letters and images, copies included is 5400");
        assert!(error.to_string().starts_with(&told), "{error}");
        assert_eq!(refused(0).value, 900);
    }

    #[test]
    fn rows_of_shapes_count_as_well() {
        let mut scene = Scene::new();
        let object = Object { shape: ShapeKind::Heightmap.default_shape(), material: scene.materials()[0].id };
        let id = scene.insert(None, 0, Node::new("Alps", NodeKind::Object(object))).unwrap();
        let error = flatten_within(&scene, 0.0, 500).unwrap_err();
        // 24 times 24 heights, and the ball around them.
        assert_eq!((error.node, error.value, error.limit), (id, 577, 500));
    }
}
