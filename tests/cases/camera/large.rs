//! Large shapes with small details: one origin per component is too coarse for f32 near details a thousand times
//! smaller.

use glam::DQuat;
use isolith::field::eval::field;
use isolith::geometry::Ray;
use isolith::render::{OverlaySettings, Slot};
use isolith::scene::{Blend, BlendKernel, Group, Modifier, Operator};

use super::hand::{self, Seen};
use super::*;

/// Half of a picture of 256 pixels, which keeps the sharpness of the recorded figures.
const SIZE: [u32; 2] = [128, 128];

fn hole() -> DVec3 {
    DVec3::new(49_990.0, 0.0, 49_990.0)
}

/// The slab ends 10 m behind the hole.
fn slab(ray: &Ray, hole: DVec3) -> Seen {
    let floor = hand::floor_with_hole(ray, hole, 0.5, 1.0, true);
    let Some([t, _]) = floor.span else { return floor };
    let at = ray.at(t);
    let beyond = at.x.max(at.z) - 50_000.0;
    let edge = floor.edge.min(beyond.abs() * ray.direction.y.abs() / t);
    Seen { span: floor.span.filter(|_| beyond < 0.0), edge, ..floor }
}

#[test]
fn a_small_hole_at_the_corner_of_100_km_is_right() {
    let found = check(&case("numerics/slab_100km_hole_at_corner"), SIZE, &STRATEGIES, &|ray| slab(ray, hole()));
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn a_hole_that_is_2_mm_elsewhere_is_refused() {
    let found = check(&case("numerics/slab_100km_hole_at_corner"), SIZE, &[EvalStrategy::Interpreter], &|ray| {
        slab(ray, hole() + DVec3::X * 2e-3)
    });
    assert_eq!(found.len(), 1);
}

#[test]
fn two_things_1000_km_apart_are_both_right() {
    let mut bench_scene = case("numerics/blended_pair_1e6_apart");
    let mut found = check(&bench_scene, SIZE, &STRATEGIES, &|ray| hand::ball(ray, DVec3::ZERO, 0.5));
    // The other shape is a cube: seen from its side, a wall that faces the eye.
    let wall = DVec3::new(1e6 + 0.5, 0.0, 0.0);
    bench_scene.camera = Camera::looking_at(wall + DVec3::new(2.0, 0.1, 0.2), wall, 0.1);
    found.extend(check(&bench_scene, SIZE, &STRATEGIES, &|ray| hand::half_space(ray, wall, DVec3::X)));
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// The floor with a hole, as a scene, rotated and moved by `place`.
fn floor(shape: Shape, at: DVec3, center: DVec3, (turn, place): (DQuat, DVec3)) -> Scene {
    let mut scene = Scene::new();
    let group = Node::new("floor", NodeKind::Group(Group::new(Operator::Difference, Blend::HARD)));
    let group = scene.insert(None, 0, group.at(place).rotated(turn)).expect("room");
    let drill = Shape::Cylinder { radius: 0.5, height: 3.0, rounding: 0.0 };
    scene.insert(Some(group), 0, object(shape, at)).expect("room");
    scene.insert(Some(group), 1, object(drill, center)).expect("room");
    for i in 0..4 {
        let away = center + DVec3::new(9.0 + f64::from(i), 0.0, 9.0);
        scene.insert(Some(group), 2, object(Shape::Sphere { radius: 0.25 }, away + DVec3::Y * 2.0)).expect("room");
    }
    scene
}

/// A camera 3 m away that looks into the hole, in the space of the floor.
fn into_hole(center: DVec3, (turn, place): (DQuat, DVec3)) -> Camera {
    let world = |p: DVec3| turn * p + place;
    let mut camera = Camera::looking_at(DVec3::new(0.7, 2.2, 1.9), DVec3::ZERO, 0.6);
    camera.position = world(camera.position + center);
    camera.rotation = turn * camera.rotation;
    camera
}

fn in_space(ray: &Ray, (turn, place): (DQuat, DVec3)) -> Ray {
    Ray { origin: turn.inverse() * (ray.origin - place), direction: turn.inverse() * ray.direction }
}

/// Position and rotation do not matter.
#[test]
fn floors_of_many_kilometers_are_right_however_they_are_turned() {
    let turn = DQuat::from_euler(glam::EulerRot::XYZ, 0.4, -1.1, 0.7);
    let center = DVec3::new(41_234.567, 0.0, -23_456.789);
    let slab = Shape::Box { size: [100_000.0, 6.0, 100_000.0], rounding: 0.0 };
    let mut found = Vec::new();
    for place in [(DQuat::IDENTITY, DVec3::ZERO), (turn, DVec3::new(1234.5, -77.0, 9e4))] {
        for (shape, at) in [(slab.clone(), DVec3::Y * -3.0), (Shape::Plane {}, DVec3::ZERO)] {
            let scene = floor(shape, at, center, place);
            let mut bench_scene = BenchScene::new(&format!("floor at {at}, turned by {}", place.0), &scene, None);
            bench_scene.camera = into_hole(center, place);
            found.extend(check(&bench_scene, SIZE, &STRATEGIES, &|ray| {
                hand::floor_with_hole(&in_space(ray, place), center, 0.5, 1.5, false)
            }));
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// The reference uses the values before rounding: else it would have the same error.
#[test]
fn the_field_of_a_large_thing_is_known_to_a_micrometer() {
    let place = (DQuat::from_euler(glam::EulerRot::XYZ, 0.4, -1.1, 0.7), DVec3::new(1234.5, -77.0, 9e4));
    let center = DVec3::new(41_234.567, 0.0, -23_456.789);
    let slab = Shape::Box { size: [100_000.0, 6.0, 100_000.0], rounding: 0.0 };
    let bench_scene = BenchScene::new("floor", &floor(slab, DVec3::Y * -3.0, center, place), None);
    let [component] = &bench_scene.flat.components[..] else { panic!("one component") };
    for i in 0..50 {
        let (sin, cos) = f64::from(i).sin_cos();
        // On the wall of the hole, and on the floor beside it.
        for (local, meant) in [([0.5 * cos, -0.7, 0.5 * sin], 0.0), ([0.9 * cos, 0.125, 0.9 * sin], 0.125)] {
            let world = place.0 * (DVec3::from(local) + center) + place.1;
            let found = field(&bench_scene.flat, component, world - component.origin);
            assert!((found - meant).abs() < 1e-6, "{found} instead of {meant} at {local:?}");
        }
    }
}

/// Copies blended with each other are one component, as wide as their distance.
#[test]
fn a_mirror_image_80_km_away_is_right() {
    let center = DVec3::new(40_000.3, 1.7, -20_000.9);
    let blended = Group::new(Operator::Union, Blend::new(BlendKernel::Circular, 0.1));
    let mut scene = Scene::new();
    let mirror = Modifier::Mirror { axes: [true, false, true], blend: 0.1 };
    let group = Node::new("both", NodeKind::Group(blended)).modified(mirror);
    let group = scene.insert(None, 0, group).expect("room");
    scene.insert(Some(group), 0, object(Shape::Sphere { radius: 0.5 }, center)).expect("room");
    let post = Shape::Box { size: [0.2, 0.2, 0.2], rounding: 0.0 };
    scene.insert(Some(group), 1, object(post, center + DVec3::X * 3.0)).expect("room");
    let mut bench_scene = BenchScene::new("mirrored", &scene, None);
    assert_eq!(bench_scene.flat.components.len(), 1);
    let mut found = Vec::new();
    for sides in [DVec3::new(1.0, 1.0, 1.0), DVec3::new(-1.0, 1.0, 1.0), DVec3::new(-1.0, 1.0, -1.0)] {
        let there = center * sides;
        bench_scene.camera = Camera::looking_at(there + DVec3::new(0.4, 0.9, 2.1), there, 0.45);
        found.extend(check(&bench_scene, SIZE, &STRATEGIES, &|ray| hand::ball(ray, there, 0.5)));
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// The ball in cell number `cell`: a little off the middle, in mirrored cells on the other side.
fn beads(cell: i32, mirrored: bool) -> DVec3 {
    let side = if mirrored && cell.rem_euclid(2) == 1 { -0.2 } else { 0.2 };
    DVec3::new(2.5 * f64::from(cell) + side, 0.125 * f64::from(cell), 0.0)
}

#[test]
fn the_20000th_copy_is_as_right_as_the_first() {
    let mut found = Vec::new();
    for (mirrored, endless) in [(false, false), (true, false), (true, true)] {
        let repeat = Modifier::Repeat {
            counts: [if endless { 0 } else { 30_000 }, 1, 1],
            spacing: [2.5, 1.0, 1.0],
            offset: [0.0, if endless { 0.0 } else { 0.125 }, 0.0],
            turn: 0.0,
            mirrored: [mirrored, false, false],
            carve_from: [0; 3],
            carve_to: [0; 3],
        };
        let mut scene = Scene::new();
        let group = Node::new("beads", NodeKind::Group(Group::UNION)).modified(repeat);
        let group = scene.insert(None, 0, group).expect("room");
        scene.insert(Some(group), 0, object(Shape::Sphere { radius: 0.3 }, DVec3::X * 0.2)).expect("room");
        let mut bench_scene =
            BenchScene::new(&format!("beads, mirrored: {mirrored}, endless: {endless}"), &scene, None);
        let place = |cell: i32| beads(cell, mirrored) * if endless { DVec3::X } else { DVec3::ONE };
        for cell in [4, 20_001, 29_999] {
            let there = place(cell);
            bench_scene.camera = Camera::looking_at(there + DVec3::new(0.1, 0.9, 1.6), there, 0.6);
            // The other beads are far behind, or not visible.
            bench_scene.camera.far = 4.0;
            let cells = || (cell - 4..=cell + 4).filter(|cell| endless || (0..30_000).contains(cell));
            found.extend(check(&bench_scene, SIZE, &STRATEGIES, &|ray| hand::balls(ray, cells().map(place), 0.3)));
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// A twist far from its axis is not accurate itself. The test only requires that the device draws it like the
/// reference.
#[test]
fn a_twisted_thing_far_from_the_rest_of_its_component_is_right() {
    let far = DVec3::new(60_000.0, 3.0, 0.0);
    let mut scene = Scene::new();
    let blended = Group::new(Operator::Union, Blend::new(BlendKernel::Circular, 0.1));
    let group = scene.insert(None, 0, Node::new("both", NodeKind::Group(blended))).expect("room");
    let column = Shape::Box { size: [0.4, 2.0, 0.3], rounding: 0.0 };
    let twisted = object(column, far).modified(Modifier::Twist { angle: 90.0 });
    scene.insert(Some(group), 0, twisted).expect("room");
    scene.insert(Some(group), 1, object(Shape::Sphere { radius: 0.5 }, DVec3::ZERO)).expect("room");
    let mut near_it = BenchScene::new("twisted", &scene, None);
    near_it.camera = Camera::looking_at(far + DVec3::new(0.8, 0.6, 3.0), far, 0.9);
    // Without the other shape it is at its own origin.
    let mut alone = Scene::new();
    let column = Shape::Box { size: [0.4, 2.0, 0.3], rounding: 0.0 };
    alone.insert(None, 0, object(column, far).modified(Modifier::Twist { angle: 90.0 })).expect("room");
    let mut alone = BenchScene::new("alone", &alone, None);
    alone.camera = near_it.camera;
    for strategy in STRATEGIES {
        let [a, b] = [&near_it, &alone].map(|bench_scene| draw(bench_scene, SIZE, strategy));
        let footprint = near_it.camera.footprint(SIZE[1].into());
        let differs = |i: &usize| {
            let [a, b] = [a.depth[*i], b.depth[*i]].map(f64::from);
            a.is_finite() != b.is_finite() || (a - b).abs() > 0.2 * footprint * b
        };
        let wrong: Vec<_> = (0..a.depth.len()).filter(differs).collect();
        assert!(wrong.len() <= 2, "{strategy:?}: {} pixels differ: {wrong:?}", wrong.len());
        assert!(b.depth.iter().filter(|d| d.is_finite()).count() > 1_000);
    }
}

/// A small camera move uploads only the new standpoint and builds nothing.
#[test]
fn a_small_move_of_the_camera_uploads_no_rows_and_builds_nothing() {
    let mut bench_scene = case("numerics/slab_100km_hole_at_corner");
    let renderer = &mut shared().renderer;
    for strategy in STRATEGIES {
        renderer.set_strategy(strategy);
        let mut uploaded = Vec::new();
        for _ in 0..8 {
            let before = renderer.uploaded();
            let overlay = OverlaySettings::default();
            let frame =
                renderer.begin(Slot::Full, &bench_scene.flat, &bench_scene.meshes, &bench_scene.camera, SIZE, overlay);
            let mut frame = frame.unwrap_or_else(|error| panic!("{error}"));
            assert!(!renderer.is_preparing() || uploaded.is_empty(), "{strategy:?}");
            renderer.advance(&mut frame, std::time::Duration::MAX).unwrap_or_else(|error| panic!("{error}"));
            uploaded.push(renderer.uploaded() - before);
            bench_scene.camera.position += DVec3::new(1e-4, 2e-4, -1e-4);
        }
        // One component's uniforms; the camera may cross a cell's border once.
        let more = uploaded[1..].iter().filter(|bytes| **bytes > 256).count();
        assert!(more <= 1, "{strategy:?}: {uploaded:?}");
    }
}

/// Many small shapes in one blend over 20 km: with tapes, each in its own cell.
#[test]
fn a_heap_of_stones_is_right_in_each_of_its_corners() {
    let mut scene = Scene::new();
    let blended = Group::new(Operator::Union, Blend::new(BlendKernel::Circular, 0.05));
    let group = scene.insert(None, 0, Node::new("stones", NodeKind::Group(blended))).expect("room");
    let places: Vec<DVec3> = (0..40)
        .map(|i| DVec3::new(f64::from(i * 7919 % 40), f64::from(i % 3), f64::from(i * 104_729 % 37)) * 500.3)
        .collect();
    for (i, place) in places.iter().enumerate() {
        scene.insert(Some(group), i, object(Shape::Sphere { radius: 0.4 }, *place)).expect("room");
    }
    let mut bench_scene = BenchScene::new("stones", &scene, None);
    assert_eq!(bench_scene.flat.components.len(), 1);
    let mut found = Vec::new();
    for place in [places[0], places[13], places[39]] {
        bench_scene.camera = Camera::looking_at(place + DVec3::new(1.0, 0.5, 0.8), place, 0.7);
        let all = |ray: &Ray| -> Seen { hand::balls(ray, places.iter().copied(), 0.4) };
        found.extend(check(&bench_scene, SIZE, &STRATEGIES, &all));
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}
