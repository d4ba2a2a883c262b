//! Pairs that blend, and their radii: relative to the size, overrides of single operands, excluded pairs; and the
//! volume that kernels add.

use glam::DVec3;
use isolith::field::eval::{BlendParams, field, op_union, surface};
use isolith::field::{FlatScene, flatten};
use isolith::scene::{
    Blend, BlendKernel, BlendOverride, Group, Material, MaterialId, Node, NodeId, NodeKind, Object, Operator,
    RadiusUnit, Scene, Shape,
};

use super::samples::Random;

fn ball(x: f64, radius: f64) -> Node {
    let shape = Shape::Sphere { radius };
    Node::new("Ball", NodeKind::Object(Object { shape, material: MaterialId(1) })).at(DVec3::X * x)
}

fn scene(group: Group, children: Vec<Node>) -> (Scene, Vec<NodeId>) {
    let mut scene = Scene::new();
    let parent = scene.insert(None, 0, Node::new("Group", NodeKind::Group(group))).unwrap();
    let ids = children.into_iter().map(|child| scene.insert(Some(parent), usize::MAX, child).unwrap()).collect();
    (scene, ids)
}

/// The field of a scene at a world position.
fn at(flat: &FlatScene, p: DVec3) -> f64 {
    flat.components.iter().map(|c| field(flat, c, p - c.origin)).fold(f64::INFINITY, f64::min)
}

fn distance(p: DVec3, x: f64, radius: f64) -> f64 {
    (p - DVec3::X * x).length() - radius
}

fn blended(a: f64, b: f64, radius: f64) -> f64 {
    op_union(a, b, &BlendParams::blend(Blend::new(BlendKernel::Circular, radius).support()), 0).value
}

fn same(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-6
}

const UNION: Group = Group::new(Operator::Union, Blend::new(BlendKernel::Circular, 0.4));

#[test]
fn a_relative_radius_scales_along() {
    let mut random = Random::new(1);
    for size in [1e-2, 1.0, 30.0] {
        let blend = Blend { unit: RadiusUnit::Size, ..Blend::new(BlendKernel::Circular, 0.5) };
        let group = Group::new(Operator::Union, blend);
        let (scene, _) = scene(group, vec![ball(0.0, 1.0 * size), ball(1.2 * size, 0.6 * size)]);
        let flat = flatten(&scene, 0.0).unwrap();
        for _ in 0..100 {
            let p = random.point(2.0);
            let reference = blended(distance(p, 0.0, 1.0), distance(p, 1.2, 0.6), 0.5 * 0.6);
            assert!(same(at(&flat, p * size) / size, reference), "{p}");
        }
    }
}

#[test]
fn an_operand_joins_hard_or_with_a_radius_of_its_own() {
    let mut random = Random::new(2);
    for (blend_override, radius) in
        [(BlendOverride::Inherit, 0.4), (BlendOverride::Hard, 0.0), (BlendOverride::Radius(0.1), 0.1)]
    {
        let third = Node { blend_override, ..ball(1.0, 0.5) };
        let (scene, _) = scene(UNION, vec![ball(0.0, 0.5), ball(0.5, 0.5), third]);
        let flat = flatten(&scene, 0.0).unwrap();
        for _ in 0..200 {
            let p = random.point(1.5);
            let before = blended(distance(p, 0.0, 0.5), distance(p, 0.5, 0.5), 0.4);
            assert!(same(at(&flat, p), blended(before, distance(p, 1.0, 0.5), radius)), "{blend_override:?} at {p}");
        }
    }
}

#[test]
fn a_radius_of_its_own_counts_in_a_group_that_does_not_blend() {
    let own = Node { blend_override: BlendOverride::Radius(0.3), ..ball(0.8, 0.5) };
    let (scene, _) = scene(Group::UNION, vec![ball(0.0, 0.5), own]);
    let flat = flatten(&scene, 0.0).unwrap();
    assert_eq!(flat.components.len(), 1);
    let p = DVec3::new(0.4, 0.35, 0.0);
    assert!(same(at(&flat, p), blended(distance(p, 0.0, 0.5), distance(p, 0.8, 0.5), 0.3)));
}

/// The body and the arm blend with the shoulder, but not with each other.
#[test]
fn pairs_kept_apart_do_not_blend() {
    let (mut scene, ids) = scene(UNION, vec![ball(0.0, 0.5), ball(0.8, 0.4), ball(0.3, 0.45)]);
    for swapped in [false, true] {
        let (holder, named) = if swapped { (ids[0], ids[2]) } else { (ids[2], ids[0]) };
        for id in &ids {
            let node = Node::clone(scene.node(*id).unwrap());
            let apart = if *id == holder { vec![named, NodeId(999)] } else { Vec::new() };
            scene.replace(Node { apart, ..node }).unwrap();
        }
        let flat = flatten(&scene, 0.0).unwrap();
        let mut random = Random::new(3);
        let mut differs = 0;
        for _ in 0..500 {
            let p = random.point(1.2);
            let [body, shoulder, arm] = [(0.0, 0.5), (0.8, 0.4), (0.3, 0.45)].map(|(x, r)| distance(p, x, r));
            let before = blended(body, shoulder, 0.4);
            let reference = before.min(blended(shoulder, arm, 0.4));
            assert!(same(at(&flat, p), reference), "{swapped} at {p}");
            differs += usize::from(!same(reference, blended(before, arm, 0.4)));
        }
        assert!(differs > 50, "{differs}");
    }
}

#[test]
fn paint_changes_only_the_material() {
    let mut red = ball(0.4, 0.5);
    let NodeKind::Object(object) = &mut red.kind else { unreachable!("a ball") };
    object.material = MaterialId(2);
    let group = Group::new(Operator::Paint, Blend::new(BlendKernel::Circular, 0.05));
    let (mut scene, _) = scene(group, vec![ball(0.0, 0.5)]);
    scene.insert_material(Material::new(MaterialId(2), "Red", [1.0, 0.0, 0.0])).unwrap();
    let parent = scene.nodes()[0].id;
    scene.insert(Some(parent), usize::MAX, red).unwrap();
    let flat = flatten(&scene, 0.0).unwrap();
    let component = &flat.components[0];
    assert_eq!(component.bounds.translated(component.origin).max.x, 0.5);
    let red = |p: DVec3| surface(&flat, component, p - component.origin).material.base_color == DVec3::X;
    assert!(red(DVec3::X * 0.5) && !red(DVec3::X * -0.5));
    assert!(same(at(&flat, DVec3::X), 0.5));
}

/// The volume that a blend adds, in cubic meters: points inside the group, but outside without the blend.
fn added(shapes: &[(Shape, DVec3)], kernel: BlendKernel, half: DVec3) -> f64 {
    let flat = |radius: f64| {
        let children = shapes.iter().map(|(shape, place)| {
            Node::new("", NodeKind::Object(Object { shape: shape.clone(), material: MaterialId(1) })).at(*place)
        });
        let (scene, _) = scene(Group::new(Operator::Union, Blend::new(kernel, radius)), children.collect());
        flatten(&scene, 0.0).unwrap()
    };
    const CELLS: usize = 60;
    let (soft, hard) = (flat(0.2), flat(0.0));
    let mut sum = 0.0;
    let side = 2.0 * half / CELLS as f64;
    for i in 0..CELLS.pow(3) {
        let index = DVec3::new((i % CELLS) as f64, (i / CELLS % CELLS) as f64, (i / CELLS / CELLS) as f64);
        let p = (index + 0.5) * side - half;
        // Approximate fraction of the cell that is inside.
        let width = side.max_element();
        let share = |f: f64| (0.5 - f / width).clamp(0.0, 1.0);
        sum += share(at(&soft, p)) - share(at(&hard, p));
    }
    sum * side.x * side.y * side.z
}

/// Among kernels with a smooth middle and equal thickening, none can add less to a right-angled corner than the bevel
/// (their profiles are convex). Where surfaces coincide, all add the same. The smooth chamfer comes near the bevel.
#[test]
fn the_smooth_chamfer_adds_the_least_of_all_smooth_ones() {
    let capsule = Shape::Capsule { start: [-0.5, 0.0, 0.0], end: [0.5, 0.0, 0.0], radius: 0.25 };
    let bar = |x, y, z| Shape::Box { size: [x, y, z], rounding: 0.0 };
    let in_line = [(capsule.clone(), DVec3::X * -0.4), (capsule, DVec3::X * 0.4)];
    let crossing = [(bar(2.0, 0.5, 0.5), DVec3::ZERO), (bar(0.5, 2.0, 0.5), DVec3::ZERO)];
    for (name, shapes, half) in
        [("in line", &in_line, DVec3::new(1.3, 0.4, 0.4)), ("crossing", &crossing, DVec3::new(1.1, 1.1, 0.4))]
    {
        let of = |kernel| added(shapes, kernel, half);
        use BlendKernel::{Chamfer, Circular, Cubic, Quadratic, SmoothChamfer};
        let [chamfer, smooth, circular, quadratic, cubic] =
            [Chamfer, SmoothChamfer, Circular, Quadratic, Cubic].map(of);
        assert!(chamfer < smooth && smooth < circular && circular < quadratic && quadratic < cubic);
        assert!(smooth < 1.1 * chamfer, "{name}: {smooth} {chamfer}");
    }
}
