//! Compares the ray query with a loop over all triangles.

use glam::{DMat3, DVec3};
use isolith::geometry::Ray;
use isolith::mesh::{Bvh, TriangleMesh, load, parse};
use serde_json::json;

use super::asset::scenes;
use super::tiny::{Random, Tiny};

/// The nearest hit over all triangles: solves origin + t · direction = a + u (b − a) + v (c − a).
fn nearest_of_all(mesh: &TriangleMesh, ray: &Ray) -> Option<f64> {
    let hits = (0..mesh.triangle_count() as u32).filter_map(|triangle| {
        let [a, b, c] = mesh.corners(triangle);
        let system = DMat3::from_cols(-ray.direction, b - a, c - a);
        if system.determinant() == 0.0 {
            return None;
        }
        let solved = system.inverse() * (ray.origin - a);
        (solved.x >= 0.0 && solved.y >= 0.0 && solved.z >= 0.0 && solved.y + solved.z <= 1.0).then_some(solved.x)
    });
    hits.reduce(f64::min)
}

fn check(mesh: &TriangleMesh, count: usize, seed: u64) -> usize {
    let mut random = Random(seed);
    let mut hits = 0;
    for i in 0..count {
        let mut point = |reach: f64| {
            let p = [0; 3].map(|_| random.between(-reach, reach));
            mesh.bounds.center() + mesh.bounds.half() * DVec3::from(p)
        };
        let (origin, target) = (point(3.0), point(1.0));
        // Directions of different lengths: `t` is in units of the direction.
        let ray = Ray { origin, direction: (target - origin) * (0.5 + i as f64 / 1000.0) };
        let (have, want) = (mesh.hit(&ray, f64::INFINITY), nearest_of_all(mesh, &ray));
        match (have, want) {
            (None, None) => {}
            (Some(hit), Some(t)) => {
                assert!((hit.t - t).abs() <= 1e-9 * (1.0 + t), "ray {i}: {} and {t}", hit.t);
                let corners = mesh.corners(hit.triangle);
                let met: DVec3 = (0..3).map(|c| corners[c] * hit.weights[c]).sum();
                assert!((met - ray.at(hit.t)).length() < 1e-9 * (1.0 + ray.at(hit.t).length()));
                assert!((hit.normal.length() - 1.0).abs() < 1e-9);
                assert_eq!(mesh.hit(&ray, t * (1.0 - 1e-6)), None, "nothing is nearer than the limit");
                hits += 1;
            }
            other => panic!("ray {i}: {other:?}"),
        }
    }
    hits
}

/// Distance from the triangle by the greatest of many ways to look at it: any direction from the nearest point on.
fn distance_by_grid([a, b, c]: [DVec3; 3], p: DVec3) -> f64 {
    const STEPS: u32 = 24;
    let at =
        |i: u32, j: u32| a + (b - a) * (f64::from(i) / f64::from(STEPS)) + (c - a) * (f64::from(j) / f64::from(STEPS));
    let points = (0..=STEPS).flat_map(|i| (0..=STEPS - i).map(move |j| at(i, j)));
    points.map(|q| q.distance(p)).fold(f64::INFINITY, f64::min)
}

#[test]
fn distances_are_those_of_the_nearest_triangle_also_if_the_mesh_is_stretched() {
    let mesh = load(&scenes().join("models/suzanne.glb")).unwrap();
    let mut random = Random(7);
    for place in [DMat3::IDENTITY, DMat3::from_diagonal(DVec3::new(0.4, 3.0, 1.0)) * DMat3::from_rotation_z(0.7)] {
        for _ in 0..30 {
            let p = mesh.bounds.center() + mesh.bounds.half() * DVec3::from([0; 3].map(|_| random.between(-2.0, 2.0)));
            let distance = mesh.distance_to_solid(p, &place, f64::INFINITY);
            let corners = |t: u32| mesh.corners(t).map(|corner| place * (corner - p));
            let all = 0..mesh.triangle_count() as u32;
            let (by_grid, size) = all.map(|t| (distance_by_grid(corners(t), DVec3::ZERO), corners(t))).fold(
                (f64::INFINITY, 0.0),
                |best, (d, [a, b, c])| {
                    if d < best.0 { (d, (b - a).length().max((c - a).length())) } else { best }
                },
            );
            assert!(distance <= by_grid + 1e-9 && distance >= by_grid - 0.06 * size, "{distance}, {by_grid}, {size}");
            assert_eq!(mesh.distance_to_solid(p, &place, 0.5 * distance), 0.5 * distance, "none is nearer");
        }
    }
}

#[test]
fn two_thousand_rays_find_what_a_search_of_all_triangles_finds() {
    let mesh = load(&scenes().join("models/suzanne.glb")).unwrap();
    let hits = check(&mesh, 2_000, 1);
    assert!((400..1_900).contains(&hits), "{hits} hits say little");
}

#[test]
fn a_soup_of_slivers_and_flat_boxes_is_searched_rightly() {
    let mut random = Random(7);
    let mut corners = Vec::new();
    for i in 0..600 {
        let middle = [0; 3].map(|_| random.between(-1.0, 1.0));
        for _ in 0..3 {
            // Every third triangle lies in a plane of constant X: its box has no thickness.
            let reach = [if i % 3 == 0 { 0.0 } else { 0.3 }, 0.3, if i % 5 == 0 { 1e-4 } else { 0.3 }];
            let offset = reach.map(|r| random.between(-r, r));
            corners.push([0, 1, 2].map(|c| (middle[c] + offset[c]) as f32));
        }
    }
    let mut tiny = Tiny::new();
    let positions = tiny.floats(&corners);
    tiny.mesh(json!({ "attributes": { "POSITION": positions } }));
    let mesh = parse(&tiny.gltf(), std::path::Path::new("soup.gltf"), None).unwrap();
    assert!(check(&mesh, 2_000, 3) > 500);
}

#[test]
fn many_equal_triangles_do_not_deepen_the_tree() {
    let same = |_| [DVec3::ZERO, DVec3::X, DVec3::Y];
    let bvh = Bvh::build(10_000, same);
    let mut depths = vec![0_usize; bvh.nodes.len()];
    for (i, node) in bvh.nodes.iter().enumerate().filter(|(_, n)| n.count == 0) {
        depths[i + 1] = depths[i] + 1;
        depths[node.first as usize] = depths[i] + 1;
    }
    assert!(depths.iter().max().is_some_and(|d| *d < 64));
    let ray = Ray { origin: DVec3::new(0.2, 0.2, 1.0), direction: DVec3::NEG_Z };
    let (t, triangle, _) = bvh.hit(&ray, 2.0, same, |_, _| true).unwrap();
    assert_eq!((t, triangle), (1.0, 0), "of equal hits the first");
}

#[test]
fn every_triangle_stands_in_one_leaf() {
    let mesh = load(&scenes().join("models/suzanne.glb")).unwrap();
    let bvh = mesh.bvh();
    let mut seen = vec![0; mesh.triangle_count()];
    for node in bvh.nodes.iter().filter(|n| n.count > 0) {
        for t in &bvh.triangles[node.first as usize..][..node.count as usize] {
            seen[*t as usize] += 1;
            for corner in mesh.corners(*t) {
                let inside = |axis: usize| (node.bounds.min[axis]..=node.bounds.max[axis]).contains(&corner[axis]);
                assert!((0..3).all(inside));
            }
        }
    }
    assert!(seen.iter().all(|n| *n == 1));
}
