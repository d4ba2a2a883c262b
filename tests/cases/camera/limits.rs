//! The near and far limits: distances along the ray, for everything drawn or picked.

use glam::{DAffine3, DQuat};
use isolith::field::pick::pick;
use isolith::scene::{Blend, Group, Operator};

use super::hand::{self, Seen};
use super::narrow::square;
use super::*;

#[test]
fn what_stands_in_a_corner_is_not_nearer_than_it_is() {
    let balls = [([0.75, 0.7, -0.45], 0.03), ([-0.8, -0.75, -0.46], 0.03), ([0.0, 0.0, -5.0], 0.5)];
    let bench_scene = case("numerics/near_cull_120");
    assert_eq!((bench_scene.camera.near, bench_scene.camera.position), (1.0, DVec3::ZERO));
    let found = check(&bench_scene, [256, 256], &STRATEGIES, &|ray| {
        balls
            .iter()
            .map(|(center, radius)| hand::ball(ray, DVec3::from(*center), *radius))
            .fold(hand::NOTHING, Seen::or)
    });
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn nothing_behind_the_far_limit_is_drawn() {
    for name in ["numerics/far_cut", "numerics/near_far_cut"] {
        let found = check_by_reference(name, [256, 256]);
        assert!(found.is_empty(), "{}", found.join("\n"));
        let bench_scene = case(name);
        for strategy in STRATEGIES {
            let picture = draw(&bench_scene, [256, 256], strategy);
            let limits = bench_scene.camera.near as f32..=bench_scene.camera.far as f32;
            let outside = picture.depth.iter().filter(|d| d.is_finite() && !limits.contains(d)).count();
            assert_eq!(outside, 0, "{name}, {strategy:?}");
        }
    }
}

/// A ball cut by both limits, off the center of a wide picture. Its own pipeline oversteps; the one of a difference
/// does not.
#[test]
fn a_ball_is_cut_at_distances_along_the_ray() {
    let (center, radius) = (DVec3::new(3.0, 2.5, -3.5), 1.75);
    let ball = || object(Shape::Sphere { radius }, center);
    let cut = || {
        let mut scene = Scene::new();
        let group = Node::new("cut", NodeKind::Group(Group::new(Operator::Difference, Blend::HARD)));
        let group = scene.insert(None, 0, group).expect("room");
        scene.insert(Some(group), 0, ball()).expect("room");
        for i in 1..6 {
            let away = object(Shape::Sphere { radius: 0.1 }, center + DVec3::X * (2.0 * f64::from(i)));
            scene.insert(Some(group), usize::MAX, away).expect("room");
        }
        scene
    };
    let mut found = Vec::new();
    for scene in [scene_of([ball()]), cut()] {
        for [near, far] in [[1e-3, 1e4], [4.2, 1e4], [1e-3, 4.2], [3.9, 4.1], [5.5, 9.0]] {
            let mut bench_scene = BenchScene::new(&format!("ball from {near} to {far}"), &scene, None);
            bench_scene.camera = Camera::looking_at(DVec3::ZERO, DVec3::new(0.3, 0.2, -1.0), 120.0_f64.to_radians());
            (bench_scene.camera.near, bench_scene.camera.far) = (near, far);
            let seen = |ray: &isolith::geometry::Ray| hand::ball(ray, center, radius);
            found.extend(check(&bench_scene, [96, 64], &STRATEGIES, &seen));
            found.extend(check_picking(&bench_scene, [96, 64], &seen));
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// Describes where picking disagrees with the picture.
fn check_picking(
    bench_scene: &BenchScene,
    [width, height]: [u32; 2],
    seen: &dyn Fn(&isolith::geometry::Ray) -> Seen,
) -> Vec<String> {
    let size = DVec2::new(width.into(), height.into());
    let Camera { near, far, .. } = bench_scene.camera;
    let mut wrong = Vec::new();
    for y in (0..height).step_by(3) {
        for x in (0..width).step_by(3) {
            let ray = bench_scene.camera.ray(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5), size);
            let meant = seen(&ray).span.filter(|[entry, exit]| *exit >= near && *entry <= far);
            let found = pick(&bench_scene.flat, &bench_scene.meshes, &ray, near, far);
            if found.is_some() != meant.is_some() {
                wrong.push(format!("{}: picked {found:?} at ({x}, {y}) instead of {meant:?}", bench_scene.name));
            }
        }
    }
    wrong
}

/// The graphics driver clips a mesh along the view axis.
#[test]
fn a_mesh_is_cut_at_distances_along_the_ray() {
    let turn = DQuat::from_rotation_y(0.2);
    // At most 0.8 away along the view axis; in the corners of the picture more than 1 along the ray.
    let place = DAffine3::from_scale_rotation_translation(DVec3::splat(9.0), turn, DVec3::new(0.0, 0.0, -0.6));
    let mut found = Vec::new();
    for [near, far] in [[1e-3, 1e4], [1.0, 1e4], [1.0, 1.3]] {
        let mut camera = Camera::looking_at(DVec3::ZERO, DVec3::NEG_Z, 120.0_f64.to_radians());
        (camera.near, camera.far) = (near, far);
        let bench_scene = square(place, camera);
        let normal = turn * DVec3::Z;
        let seen = |ray: &isolith::geometry::Ray| {
            let plane = hand::half_space(ray, DVec3::new(0.0, 0.0, -0.6), normal);
            let Some([t, _]) = plane.span else { return plane };
            let aside = (turn.inverse() * (ray.at(t) - DVec3::new(0.0, 0.0, -0.6))).abs().max_element() - 9.0;
            // The square has no thickness: where the near limit cuts it off, nothing shows behind.
            Seen { span: plane.span.map(|[t, _]| [t, t]).filter(|_| aside < 0.0), ..plane }
        };
        found.extend(check(&bench_scene, [64, 64], &[EvalStrategy::Interpreter], &seen));
        found.extend(check_picking(&bench_scene, [64, 64], &seen));
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}
