//! The flattened arrays have the field of their scene: compares them with an evaluator that walks the scene's tree in
//! f64.

use glam::{DQuat, DVec3};
use isolith::field::eval::field;
use isolith::field::reference::trace::Tracer;
use isolith::field::unflattened::SceneField;
use isolith::field::{Component, FlatScene, flatten};
use isolith::gallery;
use isolith::geometry::Ray;
use isolith::scene::{
    Blend, BlendKernel, Group, MaterialId, Modifier, ModifierKind, Node, NodeId, NodeKind, Object, Operation, Operator,
    RadiusUnit, Scene, Shape, ShapeKind,
};

use crate::contract::modifiers::{modified, samples};
use crate::contract::samples::Random;
use crate::contract::trees::{Recipe, tree};
use crate::random_scene::random_scene;

/// Rays through each component, and random points in it.
const RAYS: usize = 60;
const POINTS: usize = 120;
/// Allowed movement of a surface by rounding the arrays to f32, relative to the size of the component: a few steps of
/// each number that places it.
const ROUNDED: f64 = 4e-6;
/// Distance from the surface within which the values agree, relative to the component's size. Farther away, a cut of
/// several components applies only to those that it can reach.
const NEAR: f64 = 0.02;
/// Warnings of a modifier with less effect, or a less exact one, than the scene asks for.
const LESSENED: [&str; 4] = ["is bent by", "is tapered by", "has no end", "to be exact"];

/// The minimum of the fields of all components.
fn of_arrays(flat: &FlatScene, p: DVec3) -> f64 {
    flat.components.iter().map(|c| field(flat, c, p - c.origin)).fold(f64::INFINITY, f64::min)
}

/// Center and radius of a component, in world space.
fn around(component: &Component) -> (DVec3, f64) {
    let is_finite = component.bounds.is_finite();
    let (center, reach) =
        if is_finite { (component.bounds.center(), component.bounds.half().length()) } else { (DVec3::ZERO, 3.0) };
    (center + component.origin, reach)
}

/// Compares both near the surface of each component and elsewhere. Returns the number of points that distinguish the
/// two sides, or the first disagreement.
fn compare(flat: &FlatScene, tree: &SceneField, random: &mut Random) -> Result<usize, String> {
    let mut tracer = Tracer::new(flat);
    let mut told = 0;
    for component in &flat.components {
        let (center, reach) = around(component);
        let mut points: Vec<DVec3> = (0..POINTS).map(|_| center + random.point(1.1 * reach)).collect();
        for _ in 0..RAYS {
            let origin = center + random.direction() * (1.5 * reach);
            let direction = (center + random.point(0.7 * reach) - origin).normalize_or(DVec3::X);
            let Ok(march) = tracer.march(&Ray { origin, direction }, 1e-9 * reach, 4.0 * reach) else { continue };
            let Some(hit) = march.hit else { continue };
            points.extend(STEPS.map(|step| origin + direction * (hit.t + step * reach)));
        }
        told += agree(flat, tree, component, points)?;
    }
    Ok(told)
}

/// Like [`compare`], but finds the surface by bisection between points inside and outside: a ray through a wild scene
/// may take minutes.
fn compare_by_halving(flat: &FlatScene, tree: &SceneField, random: &mut Random) -> Result<usize, String> {
    let mut told = 0;
    for component in &flat.components {
        let (center, reach) = around(component);
        let mut points: Vec<DVec3> = (0..POINTS).map(|_| center + random.point(1.1 * reach)).collect();
        let (inside, outside): (Vec<DVec3>, Vec<DVec3>) = points.iter().partition(|p| tree.value(**p) < 0.0);
        for (mut inside, mut outside) in inside.into_iter().zip(outside) {
            let direction = (outside - inside).normalize_or_zero();
            for _ in 0..48 {
                let middle = 0.5 * (inside + outside);
                *(if tree.value(middle) < 0.0 { &mut inside } else { &mut outside }) = middle;
            }
            points.extend(STEPS.map(|step| inside + direction * (step * reach)));
        }
        told += agree(flat, tree, component, points)?;
    }
    Ok(told)
}

/// Offsets along a line through the surface for the comparison, relative to the size of the component.
const STEPS: [f64; 6] = [0.0, 1e-4, -1e-4, 3e-3, -3e-3, 0.03];

/// Compares both at these points. What an intersection at the top does not reach is gone from the arrays, which then say
/// more than the tree, where what is gone is a lower bound.
fn agree(flat: &FlatScene, tree: &SceneField, component: &Component, points: Vec<DVec3>) -> Result<usize, String> {
    let (center, reach) = around(component);
    // Where a point is in the world is known to the rounding of f64 only: 80 nm at 700 000 km.
    let of_place = center.length() * f64::EPSILON;
    let room = ROUNDED * (reach + (center - component.origin).length()) + of_place;
    let mut told = 0;
    for p in points {
        let (arrays, scene) = (of_arrays(flat, p), tree.value(p));
        if scene.abs() > room {
            if (arrays < 0.0) != (scene < 0.0) {
                return Err(format!("at {p} the arrays say {arrays:e}, the scene {scene:e}, rounding is {room:e}"));
            }
            told += 1;
        }
        let is_near = scene.abs() < NEAR * reach;
        let is_farther = tree.has_intersections() && arrays > scene && scene > 0.0;
        if tree.is_exact() && is_near && !is_farther && (arrays - scene).abs() > room + 1e-5 * scene.abs() {
            return Err(format!("at {p} the arrays say {arrays:e}, the scene {scene:e}: off by more than {room:e}"));
        }
    }
    Ok(told)
}

/// The gallery, without the largest scenes: the smaller ones of their kind suffice; and without instancers, whose
/// copies the tests in `copies` compare with the same copies placed one by one.
fn scenes() -> impl Iterator<Item = (&'static str, Scene)> {
    let has_copies = |scene: &Scene| scene.nodes().iter().any(|node| matches!(node.kind, NodeKind::Instancer(_)));
    gallery::all().into_iter().filter(move |(name, scene)| *name != "random-577" && !has_copies(scene))
}

#[test]
fn the_arrays_of_every_example_are_the_scene() {
    let (mut faults, mut told) = (Vec::new(), 0);
    for (name, scene) in scenes() {
        let flat = flatten(&scene, 0.0).unwrap();
        let tree = SceneField::new(&scene).unwrap_or_else(|error| panic!("{name}: {error}"));
        match compare(&flat, &tree, &mut Random::new(1)) {
            Ok(points) => told += points,
            Err(fault) => faults.push(format!("{name}: {fault}")),
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    assert!(told > 50_000, "{told}");
}

/// The scene with all hidden nodes shown, and blends in meters.
fn plain(scene: &Scene) -> Scene {
    let mut plain = scene.clone();
    for node in scene.nodes() {
        let mut node = Node { visible: true, ..Node::clone(node) };
        if let NodeKind::Group(group) = &mut node.kind {
            group.blend.unit = RadiusUnit::Meters;
        }
        plain.replace(node).unwrap();
    }
    plain
}

#[test]
fn the_arrays_of_random_trees_are_the_scene() {
    let (mut faults, mut told) = (Vec::new(), 0);
    for seed in 0..60 {
        let recipe = Recipe { blends: seed % 3 != 0, stretching: seed % 2 == 1, kinds: ShapeKind::ALL };
        let scene = plain(&tree(seed, recipe));
        let flat = flatten(&scene, 0.0).unwrap();
        let tree = SceneField::new(&scene).unwrap_or_else(|error| panic!("tree {seed}: {error}"));
        match compare(&flat, &tree, &mut Random::new(seed)) {
            Ok(points) => told += points,
            Err(fault) => faults.push(format!("tree {seed}: {fault}")),
        }
    }
    assert!(faults.is_empty(), "{} of 60:\n{}", faults.len(), faults.join("\n"));
    assert!(told > 10_000, "{told}");
}

/// Flattens and builds the evaluator; `None` if flattening changes the scene, or if this evaluator does not support it.
fn both(scene: &Scene) -> Option<(FlatScene, SceneField)> {
    let flat = flatten(scene, 0.0).ok()?;
    let is_whole = !flat.warnings.iter().any(|w| LESSENED.iter().any(|lessened| w.reason.contains(lessened)));
    if is_whole { Some((flat, SceneField::new(scene).ok()?)) } else { None }
}

/// One ball under each modifier, blended with a box if the modifier keeps values.
#[test]
fn the_arrays_of_every_modifier_are_the_scene() {
    let mut told = 0;
    for (seed, &kind) in ModifierKind::ALL.iter().enumerate() {
        for modifier in samples(kind, 4) {
            let scene = plain(&modified(std::slice::from_ref(&modifier)));
            let Some((flat, tree)) = both(&scene) else { continue };
            match compare(&flat, &tree, &mut Random::new(seed as u64)) {
                Ok(points) => told += points,
                Err(fault) => panic!("{modifier:?}: {fault}"),
            }
        }
    }
    assert!(told > 5_000, "{told}");
}

/// Twisted content fills a cylinder, so its copies stay clear of each other at every angle; the corners of a box would
/// not.
#[test]
fn turned_copies_of_what_is_twisted_are_the_scene() {
    let twist = |angle| Modifier::Twist { angle };
    let repeat = |width: f64, counts| Modifier::Repeat {
        counts,
        spacing: [width, 1.0, width],
        offset: [0.0; 3],
        turn: 17.0,
        mirrored: [false; 3],
        carve_from: [0; 3],
        carve_to: [0; 3],
    };
    let mut told = 0;
    for (modifiers, copies) in [
        // The post reaches 0.283 from its axis; the corners of its bounding box, when rotated, 0.4.
        (vec![twist(300.0), repeat(0.45, [3, 1, 3])], 4),
        (vec![twist(90.0), twist(-300.0), repeat(0.45, [0, 1, 3])], 4),
        (vec![twist(300.0), repeat(0.8, [3, 1, 0])], 1),
        // For content that is elongated as well, only the box is known.
        (vec![twist(300.0), Modifier::Elongate { length: [0.0, 0.1, 0.0] }, repeat(0.45, [3, 1, 3])], 16),
    ] {
        let object = Object { shape: Shape::Box { size: [0.4, 1.2, 0.4], rounding: 0.0 }, material: MaterialId(1) };
        let node = Node::new("Post", NodeKind::Object(object));
        let mut scene = Scene::new();
        scene.insert(None, 0, modifiers.iter().fold(node, |node, modifier| node.modified(modifier.clone()))).unwrap();
        let flat = flatten(&scene, 0.0).unwrap();
        assert_eq!(flat.components[0].copies, copies, "{modifiers:?}");
        let found = compare(&flat, &SceneField::new(&scene).unwrap(), &mut Random::new(1));
        told += found.unwrap_or_else(|fault| panic!("{modifiers:?}: {fault}"));
    }
    assert!(told > 500, "{told}");
}

/// Wild scenes: any parameters within their limits, any modifiers, children with any operators, random nesting.
#[test]
fn the_arrays_of_wild_scenes_are_the_scene() {
    let (mut faults, mut compared, mut told) = (Vec::new(), 0, 0);
    for seed in 0..150 {
        let Some((flat, tree)) = both(&random_scene(seed, 3 + seed as usize % 8)) else { continue };
        match compare_by_halving(&flat, &tree, &mut Random::new(seed)) {
            Ok(points) => told += points,
            Err(fault) => faults.push(format!("scene {seed}: {fault}")),
        }
        compared += 1;
    }
    assert!(faults.is_empty(), "{} of {compared}:\n{}", faults.len(), faults.join("\n"));
    assert!(compared > 100 && told > 500, "{compared}, {told}");
}

#[test]
fn a_scene_that_differs_by_a_millimeter_is_told() {
    for (name, scene) in scenes() {
        let Some(changed) = moved(&scene) else { continue };
        let flat = flatten(&scene, 0.0).unwrap();
        let tree = SceneField::new(&changed).unwrap();
        let found = (0..8).find_map(|seed| compare(&flat, &tree, &mut Random::new(seed)).err());
        assert!(found.is_some(), "{name}: a millimeter is not seen");
    }
}

/// The scene with its largest shape moved by a millimeter.
fn moved(scene: &Scene) -> Option<Scene> {
    let size = |node: &Node| match &node.kind {
        NodeKind::Object(Object { shape, .. }) if node.visible && shape.bounds().is_finite() => {
            Some(shape.bounds().half().length())
        }
        _ => None,
    };
    let of_each = scene.nodes().iter().filter_map(|node| Some((size(node)?, node)));
    let (_, largest) = of_each.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let mut node = Node::clone(largest);
    node.transform.translation += DVec3::splat(1e-3 / 3.0_f64.sqrt());
    let mut changed = scene.clone();
    changed.replace(node).unwrap();
    Some(changed)
}

/// Two blended balls with a box cut from them, all of it rotated.
fn blended() -> Scene {
    let mut scene = Scene::new();
    let group = Group::new(Operator::Union, Blend::new(BlendKernel::Circular, 0.2));
    let turn = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, 0.5).normalize(), 0.7);
    let parent = scene.insert(None, 0, Node::new("Group", NodeKind::Group(group)).rotated(turn)).unwrap();
    let object = |shape| Node::new("Object", NodeKind::Object(Object { shape, material: MaterialId(1) }));
    let ball = |x: f64| object(Shape::Sphere { radius: 0.5 }).at(DVec3::X * x);
    let cut = object(Shape::Box { size: [0.4, 2.0, 0.4], rounding: 0.0 }).at(DVec3::X * 0.4).subtracted();
    for node in [ball(-0.4), ball(0.4), cut] {
        scene.insert(Some(parent), usize::MAX, node).unwrap();
    }
    scene
}

#[test]
fn whatever_flattening_could_forget_is_told() {
    type Change = fn(&mut Node);
    let changes: [(&str, Change); 6] = [
        ("the radius of a blend", |node| {
            if let NodeKind::Group(group) = &mut node.kind {
                group.blend.radius = 0.21;
            }
        }),
        ("the kernel of a blend", |node| {
            if let NodeKind::Group(group) = &mut node.kind {
                group.blend.kernel = BlendKernel::Quadratic;
            }
        }),
        ("what is cut away", |node| node.operation = Operation::Add),
        ("who keeps apart", |node| node.apart = if node.id.0 == 3 { vec![NodeId(2)] } else { vec![] }),
        ("a modifier", |node| {
            if node.id.0 == 2 {
                node.modifiers.push(Modifier::Round { radius: 1e-3 }.into());
            }
        }),
        ("what is hidden", |node| node.visible = node.id.0 != 3),
    ];
    let flat = flatten(&blended(), 0.0).unwrap();
    let differs = |scene: &Scene| compare(&flat, &SceneField::new(scene).unwrap(), &mut Random::new(1)).is_err();
    assert!(!differs(&blended()));
    for (what, change) in changes {
        let mut changed = blended();
        for node in blended().nodes() {
            let mut node = Node::clone(node);
            change(&mut node);
            changed.replace(node).unwrap();
        }
        assert!(differs(&changed), "{what}");
    }
}

#[test]
fn what_only_flattening_decides_is_refused() {
    let mut scene = blended();
    let mut group = Node::clone(&scene.nodes()[0]);
    if let NodeKind::Group(group) = &mut group.kind {
        group.blend.unit = RadiusUnit::Size;
    }
    scene.replace(group).unwrap();
    assert_eq!(SceneField::new(&scene).err().map(|error| error.node), Some(NodeId(3)));
    let mut scene = blended();
    let twisted = Node::clone(&scene.nodes()[1]).modified(Modifier::Twist { angle: 30.0 });
    scene.replace(twisted).unwrap();
    assert!(SceneField::new(&scene).err().is_some_and(|error| error.to_string().contains("only the surface")));
    let mut scene = Scene::new();
    let twisted = Node::clone(&blended().nodes()[1]).modified(Modifier::Twist { angle: 30.0 });
    scene.insert(None, 0, twisted.modified(Modifier::Round { radius: 0.1 })).unwrap();
    assert!(SceneField::new(&scene).err().is_some_and(|error| error.to_string().contains("moves the surface")));
}
