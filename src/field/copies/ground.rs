//! The surface that copies stand on: another node, alone.

use glam::{DAffine3, DQuat, DVec3};

use super::eval::world_gradient;
use crate::ray_limits::RayLimits;
use crate::scene_eval::SceneEvaluator;
use crate::{Component, FlatScene};
use isolith_geometry::{Aabb, Ray};
use isolith_scene::shape_params::{HeightmapParams, OceanParams, TerrainParams};
use isolith_scene::{EvalParams, Node, NodeId, NodeKind, Operation, Scene, ShapeKind};

/// A point of the ground, in the instancer's space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroundPoint {
    /// The point.
    pub position: DVec3,
    /// Unit normal of the surface.
    pub normal: DVec3,
}

/// The ground in the space of an instancer.
pub struct Ground<'a> {
    flat: &'a FlatScene,
    world_from_local: DAffine3,
    local_from_world: DAffine3,
    /// Bounds of the surface, in the instancer's space; may be unbounded.
    pub bounds: Aabb,
    /// Set if the ground is a single upright heightfield: its heights are read directly.
    heights: Option<Heightfield>,
}

/// An upright heightfield: its place, and the numbers by which a value above it becomes a height.
#[derive(Clone, Copy, Debug)]
struct Heightfield {
    shape_from_local: DAffine3,
    component_from_shape: DAffine3,
    half: [f64; 2],
    top: f64,
    /// Field per height.
    slope: f64,
}

/// How far above unbounded ground copies start to fall.
const FALL: f64 = 1e5;
/// Newton steps to the nearest point.
const STEPS: usize = 12;

/// The target of an instancer as a scene of its own, at its place in the world; `None` if there is no such node.
pub fn ground_scene(scene: &Scene, target: NodeId) -> Option<Scene> {
    let index = scene.index_of(target)?;
    let mut alone = Scene::new();
    for material in scene.materials() {
        // A material of the same id is there already.
        let _ = alone.insert_material((**material).clone());
    }
    let mut chain: Vec<&Node> = Vec::new();
    let mut above = scene.nodes()[index].parent.and_then(|id| scene.node(id));
    while let Some(node) = above {
        chain.push(node);
        above = node.parent.and_then(|id| scene.node(id));
    }
    let mut parent = None;
    for node in chain.into_iter().rev() {
        let mut group = Node::new("Group", NodeKind::Group(isolith_scene::Group::UNION));
        group.transform = node.transform;
        parent = Some(alone.insert(parent, 0, group).ok()?);
    }
    // Ids of their own, since those of the groups above may be the same. Instancers stand on nothing that they place.
    let subtree: Vec<&Node> = scene.nodes()[scene.subtree(index)].iter().map(|node| &**node).collect();
    let mut ids = std::collections::HashMap::new();
    for node in subtree {
        if matches!(node.kind, NodeKind::Instancer(_)) {
            continue;
        }
        let above = if node.id == target { parent } else { Some(*ids.get(&node.parent?)?) };
        let operation = if node.id == target { Operation::Add } else { node.operation };
        let copy = Node { id: NodeId(0), parent: None, operation, ..node.clone() };
        ids.insert(node.id, alone.insert(above, usize::MAX, copy).ok()?);
    }
    Some(alone)
}

impl<'a> Ground<'a> {
    /// The ground, flattened, for an instancer at this place.
    pub fn new(flat: &'a FlatScene, world_from_local: DAffine3) -> Self {
        let local_from_world = world_from_local.inverse();
        let of = |all: Aabb, component: &Component| all.union(&component.world_bounds());
        let world = flat.components.iter().fold(Aabb::EMPTY, of);
        let bounds = if world.is_finite() { world.transformed(&local_from_world) } else { world };
        let heights = heightfield(flat, &world_from_local);
        Self { flat, world_from_local, local_from_world, bounds, heights }
    }

    /// Whether there is nothing to stand on.
    pub fn is_empty(&self) -> bool {
        self.flat.components.is_empty()
    }

    /// The first surface below, along the instancer's Y axis.
    pub fn below(&self, x: f64, z: f64) -> Option<GroundPoint> {
        if let Some(heights) = &self.heights {
            return self.height(heights, x, z);
        }
        let top = if self.bounds.is_finite() { self.bounds.max.y + 1.0 } else { FALL };
        let origin = self.world_from_local.transform_point3(DVec3::new(x, top, z));
        let down = self.world_from_local.transform_vector3(DVec3::NEG_Y);
        let ray = Ray { origin, direction: down.normalize() };
        let limits = RayLimits { near: 0.0, far: 2.0 * FALL * down.length() };
        let hit = SceneEvaluator::new(self.flat).ray(&ray, limits).ok().flatten()?;
        Some(self.point(ray.at(hit.t), hit.component))
    }

    fn height(&self, heights: &Heightfield, x: f64, z: f64) -> Option<GroundPoint> {
        let mut p = heights.shape_from_local.transform_point3(DVec3::new(x, 0.0, z));
        if p.x.abs() > heights.half[0] || p.z.abs() > heights.half[1] {
            return None;
        }
        p.y = heights.top;
        let component = &self.flat.components[0];
        let above = component.origin + heights.component_from_shape.transform_point3(p);
        let (value, _) = world_gradient(self.flat, component, above);
        p.y -= value / heights.slope;
        let on = component.origin + heights.component_from_shape.transform_point3(p);
        Some(self.point(on, 0))
    }

    /// The nearest point of the surface, if Newton's method finds one no farther than `most`.
    pub fn nearest(&self, from: DVec3, most: f64) -> Option<GroundPoint> {
        let mut world = self.world_from_local.transform_point3(from);
        let mut evaluator = SceneEvaluator::new(self.flat);
        for _ in 0..STEPS {
            let found = evaluator.distance(world, f64::INFINITY);
            let component = found.component?;
            let (value, gradient) = world_gradient(self.flat, &self.flat.components[component as usize], world);
            let square = gradient.length_squared();
            if square < 1e-12 {
                return None;
            }
            world -= gradient * (value / square);
            if value.abs() < 1e-9 * (1.0 + world.length()) {
                let point = self.point(world, component);
                return (point.position.distance(from) <= most).then_some(point);
            }
        }
        let component = evaluator.distance(world, f64::INFINITY).component?;
        let point = self.point(world, component);
        (point.position.distance(from) <= most).then_some(point)
    }

    /// A lower bound of the distance to the surface, in the instancer's space.
    pub fn distance(&self, from: DVec3) -> f64 {
        let world = self.world_from_local.transform_point3(from);
        let greatest = isolith_geometry::singular_values(&self.world_from_local.matrix3).1;
        SceneEvaluator::new(self.flat).distance(world, f64::INFINITY).value / greatest
    }

    /// A point of the surface of a component.
    fn point(&self, world: DVec3, component: u32) -> GroundPoint {
        let (_, gradient) = world_gradient(self.flat, &self.flat.components[component as usize], world);
        let normal = self.world_from_local.matrix3.transpose() * gradient;
        GroundPoint {
            position: self.local_from_world.transform_point3(world),
            normal: normal.try_normalize().unwrap_or(DVec3::Y),
        }
    }
}

/// The rotation that turns the Y axis by a share of the way to a unit normal.
pub fn aligned(normal: DVec3, share: f64) -> DQuat {
    DQuat::IDENTITY.slerp(DQuat::from_rotation_arc(DVec3::Y, normal), share)
}

/// Half the sides, the greatest height and the slope of a heightfield's parameters.
macro_rules! of_surface {
    ($params:ident, $number:ident) => {{
        let params = $params::read($number);
        (params.half, params.top, params.slope)
    }};
}

/// The heightfield that the scene consists of, if it stands upright in the instancer's space.
fn heightfield(flat: &FlatScene, world_from_local: &DAffine3) -> Option<Heightfield> {
    let ([component], [node]) = (&flat.components[..], &flat.nodes[..]) else { return None };
    let kind = ShapeKind::ALL[(node.code & 0xffff) as usize];
    if !node.is_leaf() {
        return None;
    }
    let rows = component.placing(flat, 0)?;
    let columns = [0, 1, 2, 3].map(|i| DVec3::new(rows[0][i], rows[1][i], rows[2][i]));
    let matrix = glam::DMat3::from_cols(columns[0], columns[1], columns[2]);
    let shape_from_component = DAffine3::from_mat3_translation(matrix, columns[3]);
    let shape_from_local = shape_from_component * DAffine3::from_translation(-component.origin) * *world_from_local;
    let up = shape_from_local.matrix3.y_axis;
    if up.x.abs() > 1e-6 * up.y || up.z.abs() > 1e-6 * up.y {
        return None;
    }
    let params = &flat.params[node.params as usize..];
    let number = |at: usize| f64::from(params[crate::LEAF_ROWS + at / 4][at % 4]);
    let (half, top, slope) = match kind {
        ShapeKind::Terrain => of_surface!(TerrainParams, number),
        ShapeKind::Ocean => of_surface!(OceanParams, number),
        ShapeKind::Heightmap => of_surface!(HeightmapParams, number),
        _ => return None,
    };
    let slope = slope * f64::from(params[0][1]);
    let component_from_shape = shape_from_component.inverse();
    Some(Heightfield { shape_from_local, component_from_shape, half, top, slope })
}
