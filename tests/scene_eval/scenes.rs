//! Scenes for the queries.

use std::collections::BTreeSet;

use glam::{DQuat, DVec3};
use isolith::field::{FlatScene, flatten};
use isolith::geometry::Camera;
use isolith::scene::{
    Blend, BlendKernel, Group, MaterialId, Node, NodeKind, Object, Operator, Scene, Shape, ShapeKind,
};
use isolith::wgsl::{Extended, OpSet};

use crate::contract::samples::Random;
use crate::contract::trees::{Recipe, tree};

/// Number of random scenes.
pub const SCENES: u64 = 200;

/// Their shapes: bounded and unbounded, exact and not. One pipeline serves all of them.
const KINDS: &[ShapeKind] = &[
    ShapeKind::Sphere,
    ShapeKind::Ellipsoid,
    ShapeKind::Box,
    ShapeKind::Torus,
    ShapeKind::Cylinder,
    ShapeKind::Capsule,
    ShapeKind::Plane,
    ShapeKind::InfiniteCylinder,
    ShapeKind::Octahedron,
];

/// A scene, seen from a point within it.
pub struct TestScene {
    pub seed: u64,
    pub flat: FlatScene,
    pub camera: Camera,
}

/// A camera at a place.
pub fn camera_at(position: DVec3) -> Camera {
    Camera::looking_at(position, position + DVec3::NEG_Z, 0.8)
}

/// A random tree with up to forty objects around it; every tenth scene is a thousand kilometers from the origin.
pub fn random_scene(seed: u64) -> TestScene {
    let mut random = Random::new(seed + 5_000);
    let mut scene = tree(seed, Recipe { blends: !seed.is_multiple_of(3), stretching: seed % 2 == 1, kinds: KINDS });
    for _ in 0..random.index(40) {
        let size = random.range(0.1, 1.0);
        // Few shapes are unbounded, else they would hide everything.
        let kinds = if random.chance(0.02) { KINDS } else { &KINDS[..6] };
        let shape = random.pick(kinds).default_shape();
        let node = Node::new("Object", NodeKind::Object(Object { shape, material: MaterialId(2) }));
        let turn = DQuat::from_axis_angle(random.direction(), random.range(0.0, 6.0));
        let node = node.at(random.point(5.0)).rotated(turn).scaled(DVec3::splat(size));
        scene.insert(None, usize::MAX, node).unwrap();
    }
    let place = if seed % 10 == 9 { DVec3::new(1e6, 0.0, -3e5) } else { DVec3::ZERO };
    let tops: Vec<_> = scene.children(None).map(|node| Node::clone(node)).collect();
    for mut node in tops {
        node.transform.translation += place;
        scene.replace(node).unwrap();
    }
    let flat = flatten(&scene, 0.0).unwrap();
    TestScene { seed, flat, camera: camera_at(place + random.point(2.0)) }
}

/// Three crowds, each a component with tapes.
pub fn crowds() -> TestScene {
    let mut scene = Scene::new();
    let mut random = Random::new(1);
    for place in [DVec3::ZERO, DVec3::X * 4.0, DVec3::new(2.0, 3.0, 1.0)] {
        let kind = NodeKind::Group(Group::new(Operator::Union, Blend::new(BlendKernel::Quadratic, 0.05)));
        let parent = scene.insert(None, usize::MAX, Node::new("Crowd", kind).at(place)).unwrap();
        for i in 0..60 {
            let shape = if i % 2 == 0 { Shape::Sphere { radius: 0.3 } } else { ShapeKind::Box.default_shape() };
            let node = Node::new("Object", NodeKind::Object(Object { shape, material: MaterialId(1) }));
            let node = node.at(random.point(1.2)).scaled(DVec3::splat(random.range(0.3, 0.8)));
            scene.insert(Some(parent), usize::MAX, node).unwrap();
        }
    }
    TestScene { seed: 1, flat: flatten(&scene, 0.0).unwrap(), camera: camera_at(DVec3::new(2.0, 1.0, 3.0)) }
}

/// The operators and shapes of all scenes.
pub fn op_set(tests: &[TestScene]) -> OpSet {
    let all: Vec<OpSet> = tests.iter().map(|test| OpSet::of(&test.flat)).collect();
    OpSet {
        shapes: all.iter().flat_map(|ops| ops.shapes.iter().copied()).collect::<BTreeSet<_>>(),
        stack: all.iter().map(|ops| ops.stack).max().unwrap_or(1),
        extended: Extended {
            joins: all.iter().any(|ops| ops.extended.joins),
            kernels: all.iter().any(|ops| ops.extended.kernels),
        },
        ..OpSet::none()
    }
}
