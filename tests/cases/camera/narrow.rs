//! Narrow and wide pixels: a ball and a plane against closed forms, over all angles of view and in elongated pictures.

use glam::{DAffine3, DMat3, DQuat, DVec3};
use isolith::field::FlatMesh;
use isolith::geometry::Camera;
use isolith::mesh::MeshLibrary;
use isolith::render::EvalStrategy;
use isolith::scene::{Blend, Group, Node, NodeId, NodeKind, Operator, Shape};

use super::hand::{self, Seen};
use super::*;

/// Angles of view along the longer side of a picture, in degrees.
const ANGLES: [f64; 9] = [0.05, 0.1, 0.5, 2.0, 10.0, 40.0, 90.0, 120.0, 170.0];
const SIZES: [[u32; 2]; 3] = [[8, 8192], [8192, 8], [64, 64]];
const CENTER: DVec3 = DVec3::new(12.5, -4.25, 7.0);

/// Every camera: angle, size and distance.
fn cameras() -> impl Iterator<Item = (f64, [u32; 2], f64)> {
    let distances = |angle: f64| if angle <= 2.0 { &[50.0, 5e5][..] } else { &[50.0] };
    let of_angle = move |angle: f64| {
        SIZES.into_iter().flat_map(move |size| distances(angle).iter().map(move |way| (angle, size, *way)))
    };
    ANGLES.into_iter().flat_map(of_angle)
}

/// Radius of a ball that fills four fifths of the longer side.
fn radius(angle: f64, distance: f64) -> f64 {
    f64::from((distance * (0.4 * angle).min(60.0).to_radians().sin()) as f32)
}

/// Builds the shapes for each camera's radius, draws them and compares.
fn sweep(
    name: &str,
    strategies: &[EvalStrategy],
    shapes: &dyn Fn(f64, &mut Scene),
    seen: &dyn Fn(&isolith::geometry::Ray, f64) -> Seen,
) {
    let mut found = Vec::new();
    for (angle, size, distance) in cameras() {
        let radius = radius(angle, distance);
        let mut scene = Scene::new();
        shapes(radius, &mut scene);
        let mut bench_scene = BenchScene::new(&format!("{name} by {angle}° from {distance} m"), &scene, None);
        bench_scene.camera = looking(CENTER, distance, angle, size);
        found.extend(check(&bench_scene, size, strategies, &|ray| seen(ray, radius)));
    }
    assert!(found.is_empty(), "{} pictures are wrong:\n{}", found.len(), found.join("\n"));
}

#[test]
fn a_ball_is_right_from_a_twentieth_of_a_degree_to_170() {
    sweep(
        "ball",
        &[EvalStrategy::Interpreter, EvalStrategy::StraightLine],
        &|radius, scene| {
            scene.insert(None, 0, object(Shape::Sphere { radius }, CENTER)).expect("room");
        },
        &|ray, radius| hand::ball(ray, CENTER, radius),
    );
}

/// A difference with cutters out of reach: enough shapes for tapes and for pipelines with cuts.
#[test]
fn a_ball_among_cuts_is_right_by_every_method() {
    sweep(
        "ball with cuts",
        &STRATEGIES,
        &|radius, scene| {
            let group = Node::new("cut", NodeKind::Group(Group::new(Operator::Difference, Blend::HARD)));
            let group = scene.insert(None, 0, group).expect("room");
            scene.insert(Some(group), 0, object(Shape::Sphere { radius }, CENTER)).expect("room");
            for (i, axis) in [DVec3::X, DVec3::Y, DVec3::Z, -DVec3::X, -DVec3::Y, -DVec3::Z].into_iter().enumerate() {
                let cutter = object(Shape::Sphere { radius: 0.25 * radius }, CENTER + axis * 2.0 * radius);
                scene.insert(Some(group), i + 1, cutter).expect("room");
            }
        },
        &|ray, radius| hand::ball(ray, CENTER, radius),
    );
}

#[test]
fn a_plane_is_right_from_a_twentieth_of_a_degree_to_170() {
    let turn = DQuat::from_rotation_z(0.4) * DQuat::from_rotation_x(0.3);
    sweep(
        "plane",
        &[EvalStrategy::Interpreter, EvalStrategy::StraightLine],
        &|_, scene| {
            scene.insert(None, 0, object(Shape::Plane {}, CENTER).rotated(turn)).expect("room");
        },
        &|ray, _| hand::half_space(ray, CENTER, turn * DVec3::Y),
    );
}

#[test]
fn the_comparison_sees_a_fiftieth_of_a_percent() {
    let size = [64, 64];
    let radius = radius(0.5, 5e5);
    let mut bench_scene = BenchScene::new("ball", &scene_of([object(Shape::Sphere { radius }, CENTER)]), None);
    bench_scene.camera = looking(CENTER, 5e5, 0.5, size);
    let faults = |center: DVec3, factor: f64| {
        check(&bench_scene, size, &[EvalStrategy::StraightLine], &|ray| hand::ball(ray, center, factor * radius)).len()
    };
    assert_eq!(
        [faults(CENTER, 1.0), faults(CENTER, 1.005), faults(CENTER + DVec3::X * 0.004 * radius, 1.0)],
        [0, 1, 1]
    );
}

#[test]
fn long_lenses_of_the_cases_are_right() {
    let ball = |name: &str, radius: f64| {
        check(&case(name), [320, 240], &STRATEGIES, &|ray| hand::ball(ray, DVec3::ZERO, radius))
    };
    let mut found = ball("narrow-pixels/telephoto", 0.61);
    found.extend(ball("narrow-pixels/narrow", 0.015));
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn shapes_by_long_lenses_are_as_the_reference_says() {
    let mut found = check_by_reference("numerics/fov_01_far", [128, 128]);
    // As tall as the faulty picture, and as wide as the time limit of a test permits.
    found.extend(check_by_reference("numerics/fov_10_1080p", [48, 1080]));
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// A mesh of a square, 2 m wide and across Z in its own space.
pub fn square(world_from_local: DAffine3, camera: Camera) -> BenchScene {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases/narrow-pixels");
    let mut bench_scene = BenchScene::new("square", &Scene::new(), None);
    bench_scene.flat.meshes.push(FlatMesh {
        instanced: None,
        id: NodeId(1),
        model: "quad.gltf".into(),
        world_from_local,
        material: None,
    });
    let (meshes, missing) = bench_scene.flat.load_meshes(&mut MeshLibrary::new(Some(folder)));
    assert!(missing.is_empty(), "{missing:?}");
    BenchScene { meshes, camera, ..bench_scene }
}

#[test]
fn a_mesh_is_right_by_long_lenses() {
    let mut found = Vec::new();
    for (angle, size, distance) in
        [(0.05, [8, 8192], 5e5), (0.1, [64, 64], 5e5), (2.0, [64, 64], 50.0), (40.0, [64, 64], 9.0)]
    {
        let (half, turn) = (radius(angle, distance), DQuat::from_rotation_y(1.1) * DQuat::from_rotation_x(-0.5));
        let place = DAffine3 { matrix3: DMat3::from_quat(turn) * half, translation: CENTER };
        let bench_scene = square(place, looking(CENTER, distance, angle, size));
        let normal = turn * DVec3::Z;
        found.extend(check(&bench_scene, size, &[EvalStrategy::Interpreter], &|ray| {
            let plane = hand::half_space(ray, CENTER, normal);
            let Some([t, _]) = plane.span else { return plane };
            let local = turn.inverse() * (ray.at(t) - CENTER);
            let aside = local.abs().max_element() - half;
            // Rasterizers place vertices on a grid of 1/256 pixel.
            let edge = (aside.abs() / (t * plane.slope.hypot(1.0))
                - bench_scene.camera.footprint(size[1].into()) / 128.0)
                .max(0.0);
            Seen { span: plane.span.filter(|_| aside < 0.0), edge, ..plane }
        }));
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}
