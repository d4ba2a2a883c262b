//! The reference renderer, and the comparison of pictures with it.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use glam::{DQuat, DVec2, DVec3};
use isolith::field::eval::{field, gradient};
use isolith::field::reference::image::render_reference;
use isolith::field::reference::trace::{Hit, Tracer};
use isolith::field::{Accuracy, FlatScene, flatten};
use isolith::geometry::{Camera, Ray};
use isolith::render::probe;
use isolith::scene::{
    Blend, Group, MaterialId, Modifier, Node, NodeKind, Object, Operator, Scene, Shape, ShapeKind, file,
};
use isolith::wgsl::{Evaluator, OpSet, Options, Structure};

use crate::contract::samples::{Random, ordinary};
use crate::gpu::shared;

/// A case with its camera.
fn case(name: &str) -> (FlatScene, Camera) {
    let flat = flatten(&file::load(&path(name)).unwrap(), 0.0).unwrap();
    let camera = flat.cameras[0].camera;
    (flat, camera)
}

fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases").join(name)
}

fn object(shape: Shape) -> Node {
    Node::new("Object", NodeKind::Object(Object { shape, material: MaterialId(1) }))
}

fn scene_of(node: Node) -> FlatScene {
    let mut scene = Scene::new();
    scene.insert(None, 0, node).unwrap();
    flatten(&scene, 0.0).unwrap()
}

fn hit(flat: &FlatScene, ray: &Ray) -> Option<Hit> {
    Tracer::new(flat).march(ray, 1e-3, 1e4).unwrap().hit
}

/// The rays of a square picture.
fn rays(camera: &Camera, side: u32) -> impl Iterator<Item = Ray> + '_ {
    let at = move |i: u32| DVec2::new(f64::from(i % side) + 0.5, f64::from(i / side) + 0.5);
    (0..side * side).map(move |i| camera.ray(at(i), DVec2::splat(f64::from(side))))
}

#[test]
fn a_convex_solid_shows_only_what_faces_the_eye() {
    const SIDE: u32 = 128;
    let (flat, camera) = case("numerics/reference_capped_cone_normals.json");
    let buffers = render_reference(&flat, &[], &camera, [SIDE, SIDE], &|_| ()).unwrap().buffers;
    let mut hits = 0;
    for (i, ray) in rays(&camera, SIDE).enumerate() {
        if buffers.depth[i].is_finite() {
            let normal = DVec3::from(buffers.normal[i].map(f64::from));
            assert!(normal.dot(ray.direction) < 1e-6, "pixel {i}: {normal}");
            hits += 1;
        }
    }
    assert!(hits > 2_000, "{hits}");
}

/// Points on the surface of a component, with the normal a little outside. Leaves out points where that normal differs
/// from the normals next to the surface and behind it.
fn surface_points(flat: &FlatScene, random: &mut Random, count: usize) -> Vec<(DVec3, DVec3)> {
    let component = &flat.components[0];
    let reach = if component.bounds.is_finite() { component.bounds.half().length() } else { 1.0 };
    let center = if component.bounds.is_finite() { component.bounds.center() } else { DVec3::ZERO };
    let normal = |p: DVec3| gradient(flat, component, p).1.normalize_or_zero();
    let mut tracer = Tracer::new(flat);
    let mut found = Vec::new();
    for _ in 0..count {
        let origin = center + random.direction() * (2.0 * reach);
        let target = center + random.point(0.7 * reach);
        if reach == 0.0 {
            continue;
        }
        let ray = Ray { origin: origin + component.origin, direction: (target - origin).normalize() };
        let Some(hit) = tracer.march(&ray, 1e-6, 1e3).unwrap().hit else { continue };
        let p = origin + ray.direction * hit.t;
        let out = normal(p - ray.direction * (1e-4 * reach));
        let beside = [1e-5, 3e-5].map(|step| normal(p - ray.direction * (step * reach)));
        let inside = normal(p + ray.direction * (1e-5 * reach));
        if beside.iter().chain([&inside]).all(|other| other.dot(out) > 0.99) {
            found.push((p, out));
        }
    }
    found
}

/// Shapes that take their sign from a test and their magnitude from a distance, so that the two may disagree.
const TWO_FACED: [ShapeKind; 13] = [
    ShapeKind::BoxFrame,
    ShapeKind::CappedCone,
    ShapeKind::CutSphere,
    ShapeKind::DeathStar,
    ShapeKind::Extrusion,
    ShapeKind::Prism,
    ShapeKind::Pyramid,
    ShapeKind::Revolution,
    ShapeKind::Rhombus,
    ShapeKind::SolidAngle,
    ShapeKind::Star,
    ShapeKind::Text,
    ShapeKind::TriangularPrism,
];

fn turned(shape: Shape) -> Node {
    object(shape).rotated(DQuat::from_axis_angle(DVec3::new(1.0, 2.0, 0.5).normalize(), 0.7))
}

#[test]
fn no_shape_turns_its_normal_within_rounding_of_its_surface() {
    let (mut looked, mut faults) = (0, Vec::new());
    for &kind in ShapeKind::ALL {
        let mut random = Random::new(kind as u64);
        for shape in ordinary(kind, 2) {
            let flat = scene_of(turned(shape));
            let Some(component) = flat.components.first() else { continue };
            for (p, normal) in surface_points(&flat, &mut random, 60) {
                let size = p.length() + 1.0;
                for step in -6..=6 {
                    let near = p + normal * (f64::from(step) * f64::EPSILON * size);
                    let (f, gradient) = gradient(&flat, component, near);
                    if gradient.dot(normal) <= 0.0 && f != 0.0 {
                        faults.push(format!("{kind:?} at {near}: {f}, {gradient} instead of {normal}"));
                    }
                    looked += 1;
                }
            }
        }
    }
    assert!(faults.is_empty(), "{} of {looked}: {}", faults.len(), faults[..faults.len().min(20)].join("\n"));
    assert!(looked > 20_000, "{looked}");
}

#[test]
fn no_shape_turns_its_normal_on_the_gpu_either() {
    let gpu = shared().gpu.clone();
    for kind in TWO_FACED {
        let mut random = Random::new(kind as u64);
        let flat = scene_of(turned(kind.default_shape()));
        let points = surface_points(&flat, &mut random, 300);
        assert!(points.len() > 60, "{kind:?}: {}", points.len());
        let step = f64::from(f32::EPSILON);
        let near: Vec<(DVec3, DVec3)> =
            points.iter().flat_map(|(p, n)| (-3..=3).map(move |i| (*p + *n * (f64::from(i) * step), *n))).collect();
        let places: Vec<DVec3> = near.iter().map(|(p, _)| *p).collect();
        let structure = Structure::of(&flat, &flat.components[0]).expect("one shape has a pipeline");
        for evaluator in [Evaluator::Interpreter(OpSet::of(&flat)), Evaluator::StraightLine(structure)] {
            let found = probe::surface(&gpu, &flat, 0, &places, &evaluator, Options::default()).unwrap();
            for ((p, normal), found) in near.iter().zip(found) {
                let is_right = found.gradient.dot(*normal) > 0.0 || found.distance == 0.0;
                assert!(is_right, "{kind:?}, {evaluator:?} at {p}: {found:?} instead of {normal}");
            }
        }
    }
}

#[test]
fn sheets_and_wires_of_a_micrometer_are_hit() {
    const THIN: f64 = 1e-6;
    let sheet = Shape::Box { size: [4.0, 4.0, THIN], rounding: 0.0 };
    let quad = Shape::Quad { width: 4.0, depth: 4.0, skew: 0.0, thickness: THIN };
    let disc = Shape::Cylinder { radius: 2.0, height: THIN, rounding: 0.0 };
    let upright = |shape| object(shape).rotated(DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2));
    let hollow = Modifier::Onion { thickness: THIN, walls: 1, spacing: 0.1 };
    let shell = object(Shape::Box { size: [4.0, 4.0, 1.0], rounding: 0.0 }).modified(hollow).at(DVec3::Z * -0.5);
    let mut random = Random::new(1);
    for (name, node) in [("sheet", object(sheet)), ("quad", upright(quad)), ("disc", upright(disc)), ("shell", shell)] {
        let flat = scene_of(node);
        for distance in [0.1, 10.0, 300.0] {
            for i in 0..60 {
                // Head-on, and at angles up to 84 degrees.
                let aside = if i == 0 { 0.0 } else { 10.0 * distance * random.range(0.0, 1.0).powi(3) };
                let target = DVec3::new(random.range(-1.3, 1.3), random.range(-1.3, 1.3), 0.5 * THIN);
                let origin = target + DVec3::new(aside, 0.3 * aside, distance);
                let ray = Ray { origin, direction: (target - origin).normalize() };
                let found = hit(&flat, &ray).unwrap_or_else(|| panic!("{name} from {origin} to {target} is passed"));
                let error = (found.t - (target - origin).length()).abs();
                assert!(error < 3.0 * THIN * (distance + aside) / distance, "{name} from {origin}: {error}");
            }
        }
    }
    // A ray hits a wire if it meets its axis, and passes it otherwise.
    let wire = Shape::Capsule { start: [0.0, -1.0, 0.0], end: [0.0, 1.0, 0.0], radius: 0.5 * THIN };
    let flat = scene_of(object(wire));
    for x in [0.0, 0.3 * THIN, 0.6 * THIN, -2.0 * THIN] {
        let ray = Ray { origin: DVec3::new(x, 0.1, 10.0), direction: DVec3::NEG_Z };
        assert_eq!(hit(&flat, &ray).is_some(), x.abs() < 0.5 * THIN, "{x}");
    }
}

#[test]
fn a_sheet_of_a_tenth_of_a_millimeter_is_seen_in_pictures_of_any_size() {
    let (flat, camera) = case("thin-sheet/sheet.json");
    for side in [7, 16, 48, 97] {
        let (mut found, mut right) = (0, 0);
        for ray in rays(&camera, side) {
            found += usize::from(hit(&flat, &ray).is_some());
            let front = ray.at((5e-5 - ray.origin.z) / ray.direction.z);
            right += usize::from(front.x.abs().max(front.y.abs()) <= 2.0);
        }
        assert_eq!(found, right, "{side} pixels a side");
        assert!(right * 4 > side as usize * side as usize / 2, "{right}");
    }
}

/// Where a ray meets the upper face of a slab one meter thick, or the wall of a hole through it; `None` if it leaves
/// through the hole.
fn pierced_slab(ray: &Ray, hole: DVec3, radius: f64) -> Option<f64> {
    let top = -ray.origin.y / ray.direction.y;
    let at = |t: f64| {
        let p = ray.at(t) - hole;
        DVec2::new(p.x, p.z)
    };
    if at(top).length() > radius {
        let edge = ray.at(top).abs();
        return (edge.x.max(edge.z) <= 50_000.0).then_some(top);
    }
    let way = DVec2::new(ray.direction.x, ray.direction.z);
    let (a, b, c) = (way.length_squared(), way.dot(at(0.0)), at(0.0).length_squared() - radius * radius);
    let wall = (-b + (b * b - a * c).sqrt()) / a;
    (ray.at(wall).y > -1.0).then_some(wall)
}

#[test]
fn a_hole_at_the_corner_of_a_large_slab_is_where_algebra_says() {
    let (flat, camera) = case("numerics/slab_100km_hole_at_corner.json");
    let hole = DVec3::new(49990.0, 0.0, 49990.0);
    let mut tracer = Tracer::new(&flat);
    let mut in_hole = 0;
    for (i, ray) in rays(&camera, 64).enumerate() {
        if ray.direction.y > -1e-3 {
            continue;
        }
        let found = tracer.march(&ray, camera.near, camera.far).unwrap().hit.map(|hit| hit.t);
        let right = pierced_slab(&ray, hole, 0.5);
        in_hole += usize::from((ray.at(-ray.origin.y / ray.direction.y) - hole).length() < 0.5);
        match (found, right) {
            (None, None) => {}
            (Some(found), Some(right)) => {
                assert!((found - right).abs() < 1e-6 * right, "pixel {i}: {found}, {right}")
            }
            other => panic!("pixel {i}: {other:?}"),
        }
    }
    assert!(in_hole > 30, "{in_hole}");
}

#[test]
fn a_ball_blended_with_a_box_a_thousand_kilometers_away_is_a_ball() {
    let (flat, camera) = case("numerics/blended_pair_1e6_apart.json");
    let mut tracer = Tracer::new(&flat);
    let mut hits = 0;
    for (i, ray) in rays(&camera, 64).enumerate() {
        let (b, c) = (ray.origin.dot(ray.direction), ray.origin.length_squared() - 0.25);
        let square = b * b - c;
        let found = tracer.march(&ray, camera.near, camera.far).unwrap().hit;
        if square.abs() < 1e-6 {
            continue;
        }
        assert_eq!(found.is_some(), square > 0.0, "pixel {i}");
        if let Some(hit) = found {
            assert!((hit.t - (-b - square.sqrt())).abs() < 1e-6, "pixel {i}: {}", hit.t);
            hits += 1;
        }
    }
    assert!(hits > 50, "{hits}");
}

/// A block with a hole whose cutter ends flush with the upper face, at a random position and rotation.
fn flush_hole(random: &mut Random) -> (FlatScene, Ray) {
    let mut scene = Scene::new();
    let turn = DQuat::from_axis_angle(random.direction(), random.range(0.0, 6.0));
    let place = random.point(3.0);
    let group = Node::new("Group", NodeKind::Group(Group::new(Operator::Difference, Blend::HARD)));
    let parent = scene.insert(None, 0, group.at(place).rotated(turn)).unwrap();
    let [half, depth] = [random.range(0.2, 0.6), random.range(0.1, 0.3)];
    let cutter = match random.index(3) {
        0 => Shape::Cylinder { radius: 0.3, height: depth, rounding: 0.0 },
        1 => Shape::Box { size: [0.5, depth, 0.5], rounding: 0.0 },
        _ => Shape::HexagonalPrism { radius: 0.3, height: depth },
    };
    let block = object(Shape::Box { size: [2.0, 2.0 * half, 2.0], rounding: 0.0 });
    scene.insert(Some(parent), 0, block).unwrap();
    scene.insert(Some(parent), 1, object(cutter).at(DVec3::Y * (half - 0.5 * depth))).unwrap();
    // A ray into the hole, down to its floor.
    let [from, to] = [DVec3::new(0.1, half + 3.0, -0.2), DVec3::new(-0.05, half - depth, 0.1)];
    let [from, to] = [from, to].map(|p| place + turn * p);
    (flatten(&scene, 0.0).unwrap(), Ray { origin: from, direction: (to - from).normalize() })
}

#[test]
fn a_flush_cut_leaves_no_skin_however_it_is_turned() {
    let mut random = Random::new(3);
    for i in 0..60 {
        let (flat, ray) = flush_hole(&mut random);
        let found = hit(&flat, &ray).unwrap_or_else(|| panic!("{i}: the block is passed"));
        // The upper face is three meters away, and the floor at least 0.1 m farther.
        assert!(found.t > 3.09, "{i}: hit at {}", found.t);
    }
    // A skin that the artist made remains.
    let mut scene = Scene::new();
    let group = Node::new("Group", NodeKind::Group(Group::new(Operator::Difference, Blend::HARD)));
    let parent = scene.insert(None, 0, group).unwrap();
    let block = |y: f64| object(Shape::Box { size: [2.0, 1.0, 2.0], rounding: 0.0 }).at(DVec3::Y * y);
    scene.insert(Some(parent), 0, block(0.0)).unwrap();
    scene.insert(Some(parent), 1, block(-2e-6)).unwrap();
    let flat = flatten(&scene, 0.0).unwrap();
    let ray = Ray { origin: DVec3::new(0.1, 3.0, 0.2), direction: DVec3::NEG_Y };
    assert!((hit(&flat, &ray).unwrap().t - 2.5).abs() < 1e-6);
}

#[test]
fn what_has_no_thickness_is_nothing_for_the_reference() {
    let (flat, camera) = case("numerics/difference_identical_box.json");
    let mut tracer = Tracer::new(&flat);
    for ray in rays(&camera, 48) {
        if let Some(hit) = tracer.march(&ray, camera.near, camera.far).unwrap().hit {
            // Only the ball next to it is visible.
            assert!(((ray.at(hit.t) - DVec3::X * 1.5).length() - 0.3).abs() < 1e-6, "{hit:?}");
        }
    }
    let component = &flat.components[0];
    assert!(field(&flat, component, DVec3::ZERO) >= 0.0);
}

/// The tracer used to give up rays along faces a thousand kilometers long, after minutes. `cli::failure` tests the
/// message about a ray that is given up.
#[test]
fn rays_along_endless_faces_get_on_and_meet_what_is_there() {
    const SAMPLES: u32 = 20_000;
    let started = Instant::now();
    let (flat, camera) = case("hostile/reference-given-up.json");
    let component = &flat.components[0];
    let mut tracer = Tracer::new(&flat);
    let (mut hits, mut passed) = (0, 0);
    // From the case's camera, and from where its rays hit.
    for (near, back) in [(camera.near, 0.0), (1e-3, 0.0), (1e-3, 40.0)] {
        for i in 0..6 {
            let place = DVec2::new(f64::from(i % 3) + 0.5, f64::from(i / 3) + 0.5);
            let ray = camera.ray(place, DVec2::new(3.0, 2.0));
            let ray = Ray { origin: ray.origin + DVec3::new(0.7, 0.3, back), ..ray };
            let found = tracer.march(&ray, near, 1e7).expect("the ray gets on").hit.map(|hit| hit.t);
            let at = |k: u32| near * (1e7 / near).powf(f64::from(k) / f64::from(SAMPLES));
            let inside = |t: f64| field(&flat, component, ray.at(t) - component.origin) < 0.0;
            let sampled = (0..=SAMPLES).find(|k| inside(at(*k)));
            match (found, sampled) {
                (None, None) => passed += 1,
                (Some(t), Some(k)) => {
                    assert!(at(k.saturating_sub(1)) * (1.0 - 1e-9) <= t && t <= at(k), "ray {i} from {near}: {t}, {k}");
                    hits += 1;
                }
                other => panic!("ray {i} from {near}, {back}: {other:?}"),
            }
        }
    }
    assert!(hits >= 6 && passed >= 3, "{hits} hits, {passed} rays pass");
    assert!(started.elapsed() < Duration::from_secs(60));
}

/// Accuracy of a picture that shows one scene and should show another: the reference draws both.
fn mistaken(shown: &Scene, meant: &Scene, camera: &Camera, side: u32) -> Accuracy {
    let picture = |scene: &Scene| {
        let flat = flatten(scene, 0.0).unwrap();
        (render_reference(&flat, &[], camera, [side; 2], &|_| ()).unwrap(), flat)
    };
    let ((shown, flat), (meant, _)) = (picture(shown), picture(meant));
    Accuracy::against(&shown.buffers, &flat, &meant)
}

/// The scene with its nodes changed.
fn changed(scene: &Scene, change: impl Fn(&mut Node)) -> Scene {
    let mut changed = scene.clone();
    for node in scene.nodes() {
        let mut node = Node::clone(node);
        change(&mut node);
        changed.replace(node).unwrap();
    }
    changed
}

#[test]
fn pockets_drawn_closed_are_seen_though_the_block_stands_behind_them() {
    let scene = file::load(&path("numerics/gate_blind_pockets.json")).unwrap();
    let camera = flatten(&scene, 0.0).unwrap().cameras[0].camera;
    let is_cutter =
        |node: &Node| matches!(&node.kind, NodeKind::Object(o) if matches!(o.shape, Shape::Cylinder { .. }));
    let right = mistaken(&scene, &scene, &camera, 128);
    assert_eq!((right.wrong, right.faults()), (0, vec![]));
    let closed = changed(&scene, |node| node.visible = !is_cutter(node));
    let found = mistaken(&closed, &scene, &camera, 128);
    // Hit or miss and the 99th percentile do not detect it; nodes and depths do.
    assert!(found.hit_miss_differs == 0 && found.wrong > 60, "{found:?}");
    assert!(!found.faults().is_empty());
    // One pocket of four is detected as well.
    let one = changed(&scene, |node| node.visible = node.id.0 != 3);
    let found = mistaken(&one, &scene, &camera, 128);
    assert!(found.depth_p99 < 1e-3 && found.wrong > 10 && !found.faults().is_empty(), "{found:?}");
}

/// A shape in front of a wall, face on.
fn before_a_wall(shape: Shape) -> Scene {
    let mut scene = Scene::new();
    let wall = object(Shape::Box { size: [9.0, 9.0, 1.0], rounding: 0.0 }).at(DVec3::Z * -2.0);
    scene.insert(None, 0, wall).unwrap();
    let turn = DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2);
    scene.insert(None, 1, object(shape).rotated(turn)).unwrap();
    scene
}

#[test]
fn wires_and_sheets_before_a_wall_are_seen() {
    let camera = Camera::looking_at(DVec3::new(0.01, 0.02, 6.0), DVec3::ZERO, 0.7);
    let wire = |radius| before_a_wall(Shape::Capsule { start: [-1.0, 0.0, 0.3], end: [1.0, 0.0, 0.3], radius });
    let hidden = changed(&wire(0.02), |node| node.visible = node.id.0 == 1);
    let found = mistaken(&hidden, &wire(0.02), &camera, 96);
    assert!(found.hit_miss_differs == 0 && found.wrong > 20 && !found.faults().is_empty(), "{found:?}");
    // A disc without thickness is empty, so drawing it is wrong: no ray that meets it face on grazes it.
    let disc = |height| before_a_wall(Shape::Cylinder { radius: 0.8, height, rounding: 0.0 });
    let found = mistaken(&disc(1e-3), &disc(0.0), &camera, 96);
    assert!(found.wrong > 500 && found.grazing == 0, "{found:?}");
    assert!(mistaken(&disc(0.0), &disc(0.0), &camera, 96).wrong == 0);
}

#[test]
fn a_silhouette_off_by_a_rounding_grazes_and_one_off_by_a_hundredth_of_a_pixel_is_wrong() {
    let camera = Camera::looking_at(DVec3::new(0.0, 0.0, 4.0), DVec3::ZERO, 0.7);
    let footprint = camera.footprint(64.0);
    // The edge of a block, exactly through the centers of a row of pixels at distance 3.5.
    let block = |by: f64| {
        let ray = camera.ray(DVec2::new(40.5, 32.0), DVec2::splat(64.0));
        let edge = ray.direction.x / -ray.direction.z * 3.5 + 3.5 * by;
        let mut scene = Scene::new();
        let node = object(Shape::Box { size: [2.0, 1.0, 1.0], rounding: 0.0 }).at(DVec3::X * (edge - 1.0));
        scene.insert(None, 0, node).unwrap();
        scene
    };
    let judged = |shown: f64, meant: f64| {
        let found = mistaken(&block(shown), &block(meant), &camera, 64);
        (found.wrong, found.grazing)
    };
    let (wrong, grazing) = judged(2e-7, -1e-8);
    assert!(wrong == 0 && grazing > 10, "{wrong} {grazing}");
    let (wrong, grazing) = judged(2e-7, -0.01 * footprint);
    assert!(wrong > 10 && grazing == 0, "{wrong} {grazing}");
}
