//! Random trees of shapes and groups, through flattening.

use glam::{DAffine3, DQuat, DVec3};
use isolith::field::eval::{field, gradient, surface};
use isolith::field::{Component, FlatScene, flatten};
use isolith::scene::{
    Blend, BlendKernel, BlendOverride, Group, Material, MaterialId, Node, NodeId, NodeKind, Object, Operation,
    Operator, RadiusUnit, Scene, ShapeKind,
};

use super::rules::{gradient_is_right, steps_are_safe};
use super::samples::{Random, many, ordinary, shape_with, usual};
use super::surfaces::inside;

const TREES: u64 = 80;

/// The ingredients of a random tree.
#[derive(Clone, Copy)]
pub struct Recipe {
    pub blends: bool,
    pub stretching: bool,
    pub kinds: &'static [ShapeKind],
}

/// A tree of a few levels, with negative and hidden nodes and every operator.
pub fn tree(seed: u64, recipe: Recipe) -> Scene {
    let mut random = Random::new(seed);
    let mut scene = Scene::new();
    for (id, albedo) in [(2, [1.0, 0.0, 0.0]), (3, [0.0, 1.0, 0.0]), (4, [0.0, 0.0, 1.0])] {
        scene.insert_material(Material::new(MaterialId(id), "Primary", albedo)).unwrap();
    }
    for _ in 0..1 + random.index(3) {
        grow(&mut scene, &mut random, None, 0, recipe);
    }
    scene
}

fn grow(scene: &mut Scene, random: &mut Random, parent: Option<NodeId>, depth: usize, recipe: Recipe) {
    let is_group = depth < 4 && random.chance(if depth == 0 { 0.9 } else { 0.5 });
    let kind = if is_group {
        let radius = if recipe.blends && random.chance(0.7) { random.range(0.01, 0.5) } else { 0.0 };
        let unit = random.pick(&[RadiusUnit::Meters, RadiusUnit::Meters, RadiusUnit::Size]);
        let steps = 1 + random.index(5) as u32;
        let blend = Blend { unit, steps, ..Blend::new(random.pick(&BlendKernel::ALL), radius) };
        // Without blends, every operator is a set operator, so that the tree defines inside and outside. The other
        // operators are rarer, because what they cut is often empty.
        let operator = match () {
            () if !recipe.blends => random.pick(&[Operator::SETS.as_slice(), &[Operator::Paint]].concat()),
            () if random.chance(0.5) => random.pick(&Operator::SETS),
            () => random.pick(&Operator::ALL),
        };
        let (width, depth, share) = (random.range(0.0, 0.6), random.range(0.0, 0.3), random.range(0.0, 1.0));
        NodeKind::Group(Group { width, depth, share, ..Group::new(operator, blend) })
    } else {
        let shape = shape_with(random.pick(recipe.kinds), |limits| {
            if limits.unit == "m" { random.range(0.05, 1.2) } else { usual(random, limits, 1.2) }
        });
        NodeKind::Object(Object { shape, material: MaterialId(2 + random.index(3) as u64) })
    };
    let mut node = Node::new("Node", kind).at(random.point(0.8));
    node.transform.rotation = DQuat::from_axis_angle(random.direction(), random.range(0.0, 6.0));
    let uniform = random.range(0.5, 1.5);
    node.transform.scale = DVec3::splat(uniform);
    if recipe.stretching && random.chance(0.4) {
        let mut factor = || random.range(0.4, 2.0) * random.pick(&[1.0, 1.0, -1.0]);
        node.transform.scale = DVec3::new(factor(), factor(), factor());
    }
    if random.chance(0.2) {
        // Every eighth cut keeps what is inside; the sequence of random numbers stays.
        node.operation =
            if node.transform.translation.x.abs() < 0.1 { Operation::Intersect } else { Operation::Subtract };
    }
    node.visible = !random.chance(0.08);
    if recipe.blends && parent.is_some() && random.chance(0.2) {
        node.blend_override = random.pick(&[BlendOverride::Hard, BlendOverride::Radius(0.1)]);
        node.apart = scene.children(parent).take(1).map(|n| n.id).collect();
    }
    let id = scene.insert(parent, usize::MAX, node).unwrap();
    if is_group {
        for _ in 0..1 + random.index(4) {
            grow(scene, random, Some(id), depth + 1, recipe);
        }
    }
}

/// Visits every component of a tree of each recipe once, with the arrays.
fn for_each_component(mut visit: impl FnMut(&Scene, &FlatScene, &Component, &mut Random)) {
    let mut count = 0;
    for seed in 0..TREES {
        let recipe = Recipe { blends: seed % 3 != 0, stretching: seed % 2 == 1, kinds: ShapeKind::ALL };
        let scene = tree(seed, recipe);
        let flat = flatten(&scene, 0.0).unwrap();
        for component in &flat.components {
            visit(&scene, &flat, component, &mut Random::new(seed + 1_000));
            count += 1;
        }
    }
    assert!(count > TREES);
}

/// A bounding sphere as center and radius; for unbounded components one of a fixed size.
fn surroundings(component: &Component) -> (DVec3, f64) {
    if component.bounds.is_finite() {
        (component.bounds.center(), 0.2 + component.bounds.half().length())
    } else {
        (DVec3::ZERO, 4.0)
    }
}

/// Whether the point is inside the node, by definition of the tree; `None` if the node is hidden. A group without
/// visible nodes is the empty set.
fn solid(scene: &Scene, node: &Node, world: &DAffine3, p: DVec3) -> Option<bool> {
    if !node.visible {
        return None;
    }
    let world = *world * node.transform.to_affine();
    match &node.kind {
        NodeKind::Object(object) => Some(inside(&object.shape, world.inverse().transform_point3(p))),
        NodeKind::Group(group) => Some(fold(scene, Some(node.id), group.operator, &world, p).unwrap_or(false)),
        _ => None,
    }
}

fn fold(scene: &Scene, parent: Option<NodeId>, operator: Operator, world: &DAffine3, p: DVec3) -> Option<bool> {
    let mut so_far = None;
    for child in scene.children(parent) {
        let Some(holds) = solid(scene, child, world, p) else {
            // Otherwise the remaining children would apply to each other.
            if so_far.is_none() && child.adds() && operator.needs_first() {
                so_far = Some(false);
            }
            continue;
        };
        so_far = match (so_far, child.operation, operator) {
            // A cut from the empty set is empty.
            (None, Operation::Subtract | Operation::Intersect, _) => None,
            (None, Operation::Add, _) => Some(holds),
            (Some(before), Operation::Subtract, _) | (Some(before), Operation::Add, Operator::Difference) => {
                Some(before && !holds)
            }
            (Some(before), Operation::Add, Operator::Union) => Some(before || holds),
            (Some(before), Operation::Intersect, _) | (Some(before), Operation::Add, Operator::Intersection) => {
                Some(before && holds)
            }
            (Some(before), Operation::Add, Operator::Xor) => Some(before != holds),
            (Some(before), Operation::Add, Operator::Paint) => Some(before),
            (Some(_), Operation::Add, other) => panic!("{other:?} is no operator on sets"),
        };
    }
    so_far
}

#[test]
fn hard_trees_hold_the_points_that_their_meaning_says() {
    let (mut held, mut compared) = (0, 0);
    for seed in 0..3 * TREES {
        let scene = tree(seed, Recipe { blends: false, stretching: seed % 2 == 0, kinds: ShapeKind::ALL });
        let flat = flatten(&scene, 0.0).unwrap();
        let mut random = Random::new(seed);
        for _ in 0..150 {
            let p = random.point(2.5);
            let f = flat.components.iter().map(|c| field(&flat, c, p - c.origin)).fold(f64::INFINITY, f64::min);
            // Near zero, the rounding of the arrays to f32 may decide the sign.
            if f.abs() < 1e-5 {
                continue;
            }
            let expected = fold(&scene, None, Operator::Union, &DAffine3::IDENTITY, p).unwrap_or(false);
            assert_eq!(f < 0.0, expected, "tree {seed} at {p}: {f}");
            compared += 1;
            held += usize::from(expected);
        }
    }
    // One of 26: a node that intersects keeps little of what is before it.
    assert!(held * 30 > compared, "points inside are rare: {held} of {compared}");
}

#[test]
fn steps_are_safe_in_every_tree() {
    for_each_component(|_, flat, component, _| {
        let (center, reach) = surroundings(component);
        // The arrays round rotations and scales to f32.
        steps_are_safe(&|p| field(flat, component, p), center, reach, 300, 2e-6 * reach).unwrap();
    });
}

#[test]
fn bounds_enclose_every_component() {
    for_each_component(|_, flat, component, random| {
        let (center, reach) = surroundings(component);
        for _ in 0..many(400) {
            let p = center + random.point(1.5 * reach);
            let f = field(flat, component, p);
            assert!(f.is_finite());
            assert!(component.bounds.contains(p) || f > -1e-5, "{f} at {p} outside {:?}", component.bounds);
        }
    });
}

#[test]
fn groups_rise_with_the_distance_from_their_bounds() {
    let mut groups = 0;
    for_each_component(|_, flat, component, random| {
        let (center, reach) = surroundings(component);
        for index in component.first..component.first + component.count {
            let node = &flat.nodes[index as usize];
            let [blend_params, low, half] = [0, 1, 2].map(|row| flat.params[node.params as usize + row].map(f64::from));
            if !node.is_group() || blend_params[1] == 0.0 {
                continue;
            }
            groups += 1;
            let inner = Component { first: index + 1, count: node.extent - 1, ..component.clone() };
            let [low, half] = [low, half].map(|[x, y, z, _]| DVec3::new(x, y, z));
            for _ in 0..many(200) {
                let p = center + random.point(2.0 * reach);
                let least = blend_params[1] * ((p - low).abs() - half).max(DVec3::ZERO).length();
                let f = field(flat, &inner, p);
                assert!(least == 0.0 || f >= least - 1e-6 * reach, "{f} at {p}, said to be at least {least}");
            }
        }
    });
    assert!(groups > 50, "{groups}");
}

#[test]
fn gradients_of_trees_are_those_of_central_differences() {
    for_each_component(|_, flat, component, random| {
        // The gradient of a model is taken over a voxel and a half, see `bricks`.
        let range = component.first as usize..(component.first + component.count) as usize;
        if flat.nodes[range].iter().any(|node| node.is_leaf() && node.code & 0xffff == ShapeKind::MeshField as u32) {
            return;
        }
        let (center, reach) = surroundings(component);
        let points: Vec<DVec3> = (0..40).map(|_| center + random.point(reach)).collect();
        gradient_is_right(&|p| gradient(flat, component, p), points.into_iter(), 1e-5).unwrap();
    });
}

#[test]
fn the_weights_of_the_materials_sum_to_one() {
    let mut mixed = 0;
    for_each_component(|_, flat, component, random| {
        let (center, reach) = surroundings(component);
        for _ in 0..60 {
            let p = center + random.point(reach);
            let point = surface(flat, component, p);
            assert_eq!((point.distance, point.gradient), gradient(flat, component, p));
            // The materials are the primary colors, so a color is the list of weights.
            let shares = point.material.base_color;
            assert!((shares.element_sum() - 1.0).abs() < 1e-12 && shares.min_element() >= 0.0, "{shares}");
            mixed += usize::from(shares.max_element() < 0.99);
            let leaf = flat.nodes[point.leaf as usize];
            assert!(leaf.is_leaf() && (component.first..component.first + component.count).contains(&point.leaf));
        }
    });
    assert!(mixed > 100, "{mixed}");
}

#[test]
fn a_scene_far_from_the_origin_has_the_field_of_one_at_the_origin() {
    for seed in 0..20 {
        let scene = tree(seed, Recipe { blends: true, stretching: true, kinds: ShapeKind::ALL });
        let mut moved = scene.clone();
        let shift = DVec3::new(1e6, -2e6, 5e5);
        for node in scene.nodes().iter().filter(|n| n.parent.is_none()) {
            let mut node = Node::clone(node);
            node.transform.translation += shift;
            moved.replace(node).unwrap();
        }
        let (near, far) = (flatten(&scene, 0.0).unwrap(), flatten(&moved, 0.0).unwrap());
        let mut random = Random::new(seed);
        for (a, b) in near.components.iter().zip(&far.components) {
            for _ in 0..50 {
                let p = random.point(3.0);
                let (fa, fb) = (field(&near, a, p - a.origin), field(&far, b, p + shift - b.origin));
                assert!((fa - fb).abs() < 1e-5, "tree {seed} at {p}: {fa}, {fb}");
            }
        }
    }
}

#[test]
fn every_shape_in_a_blend_with_every_other_steps_safely() {
    for &first in ShapeKind::ALL {
        for &second in ShapeKind::ALL {
            let mut random = Random::new(first as u64 * 64 + second as u64);
            let mut scene = Scene::new();
            let blend = Blend::new(random.pick(&BlendKernel::ALL), 0.2);
            let group = Group::new(random.pick(&Operator::ALL), blend);
            let parent = scene.insert(None, 0, Node::new("Group", NodeKind::Group(group))).unwrap();
            for kind in [first, second] {
                let shape = ordinary(kind, 5).swap_remove(random.index(7));
                let node = Node::new("Leaf", NodeKind::Object(Object { shape, material: MaterialId(1) }));
                scene.insert(Some(parent), usize::MAX, node.at(random.point(0.3))).unwrap();
            }
            let flat = flatten(&scene, 0.0).unwrap();
            for component in &flat.components {
                let (center, reach) = surroundings(component);
                steps_are_safe(&|p| field(&flat, component, p), center, reach, 200, 2e-6 * reach).unwrap();
            }
        }
    }
}
