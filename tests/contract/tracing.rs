//! The reference tracer, picking and the reference picture.

use std::sync::atomic::{AtomicUsize, Ordering};

use glam::{DVec2, DVec3};
use isolith::field::pick::pick;
use isolith::field::reference::image::render_reference;
use isolith::field::reference::trace::{Tracer, trace};
use isolith::field::{FlatScene, HitTarget, flatten};
use isolith::geometry::{Camera, Ray};
use isolith::mesh::MeshLibrary;
use isolith::scene::{Blend, Group, MaterialId, MeshNode, Node, NodeId, NodeKind, Object, Operator, Scene, Shape};

use super::samples::Random;

fn object(shape: Shape) -> Node {
    Node::new("Object", NodeKind::Object(Object { shape, material: MaterialId(1) }))
}

fn scene_of(nodes: impl IntoIterator<Item = Node>) -> (FlatScene, Vec<NodeId>) {
    let mut scene = Scene::new();
    let ids = nodes.into_iter().map(|node| scene.insert(None, usize::MAX, node).unwrap()).collect();
    (flatten(&scene, 0.0).unwrap(), ids)
}

fn ray(origin: DVec3, target: DVec3) -> Ray {
    Ray { origin, direction: (target - origin).normalize() }
}

#[test]
fn a_sphere_is_hit_where_algebra_says() {
    // A radius that f32 represents exactly.
    let (flat, _) = scene_of([object(Shape::Sphere { radius: 0.75 })]);
    let mut tracer = Tracer::new(&flat);
    let mut random = Random::new(1);
    let (mut hits, mut misses) = (0, 0);
    for i in 0..4_000 {
        let origin = random.direction() * 4.0;
        // Every other ray grazes: it passes the center at about the radius.
        let offset = if i % 2 == 0 { random.range(0.0, 3.0) } else { 0.75 + random.range(-1.0, 1.0) * 1e-6 };
        let side = origin.cross(random.direction()).normalize();
        let direction = (side * offset - origin).normalize();
        let ray = Ray { origin, direction };
        let middle = -origin.dot(direction);
        let square = 0.75 * 0.75 - (origin.length_squared() - middle * middle);
        let march = tracer.march(&ray, 1e-3, 100.0).unwrap();
        match march.hit {
            Some(hit) => {
                assert!(square > -1e-12, "a miss was hit: {square}");
                let error = (hit.t - (middle - square.max(0.0).sqrt())).abs();
                assert!(error < 1e-11 / square.max(1e-12).sqrt().min(1.0), "{error} at {square}");
                hits += 1;
            }
            None => {
                assert!(square < 1e-9, "a hit was missed: {square}");
                misses += 1;
            }
        }
    }
    assert!(hits > 1_000 && misses > 1_000);
}

#[test]
fn the_margin_says_how_near_a_ray_passed() {
    let (flat, _) = scene_of([object(Shape::Sphere { radius: 0.75 })]);
    let mut tracer = Tracer::new(&flat);
    let origin = DVec3::new(0.0, 0.0, 4.0);
    for offset in [1e-9, 1e-7, 1e-6, 1e-5] {
        // Slightly more than the half angle of the tangent cone.
        let angle = (0.75_f64 / 4.0).asin();
        let at = |angle: f64| Ray { origin, direction: DVec3::new(angle.sin(), 0.0, -angle.cos()) };
        for side in [-1.0, 1.0] {
            let march = tracer.march(&at(angle + side * offset), 1e-3, 100.0).unwrap();
            assert_eq!(march.hit.is_some(), side < 0.0, "{offset}");
            let ratio = march.margin / offset;
            assert!((0.4..=1.3).contains(&ratio), "{offset} {side}: {ratio}");
        }
    }
    let clear = tracer.march(&ray(origin, DVec3::ZERO), 1e-3, 100.0).unwrap();
    assert!(clear.margin > 1e-4);
}

#[test]
fn a_ray_that_starts_inside_hits_at_once() {
    let (flat, _) = scene_of([object(Shape::Sphere { radius: 0.75 })]);
    let hit = trace(&flat, &ray(DVec3::ZERO, DVec3::X), 0.01, 10.0).unwrap().unwrap();
    assert_eq!(hit.t, 0.01);
}

#[test]
fn what_has_no_volume_is_not_seen() {
    let disc = Shape::Cylinder { radius: 1.0, height: 0.0, rounding: 0.0 };
    let (flat, _) = scene_of([object(disc)]);
    for x in [0.0, 0.3, 0.99] {
        let through = ray(DVec3::new(x, 2.0, 0.1), DVec3::new(x, -1.0, 0.2));
        assert_eq!(trace(&flat, &through, 1e-3, 10.0), Ok(None));
    }
}

#[test]
fn the_nearest_of_many_is_picked() {
    let at = |z: f64| object(Shape::Box { size: [1.0; 3], rounding: 0.1 }).at(DVec3::new(0.0, 0.0, z));
    let (flat, ids) = scene_of([at(-6.0), at(0.0), at(-3.0)]);
    let origin = DVec3::new(0.1, 0.2, 5.0);
    let forward = Ray { origin, direction: DVec3::NEG_Z };
    assert_eq!(pick(&flat, &[], &forward, 1e-3, 100.0), Some(ids[1]));
    assert_eq!(pick(&flat, &[], &forward, 6.0, 100.0), Some(ids[2]));
    assert_eq!(pick(&flat, &[], &forward, 6.0, 7.0), None);
    assert_eq!(pick(&flat, &[], &Ray { origin, direction: DVec3::Z }, 1e-3, 100.0), None);
}

#[test]
fn a_blend_belongs_to_the_object_that_weighs_most() {
    let mut scene = Scene::new();
    let blend = Blend { radius: 0.3, ..Blend::HARD };
    let group = Node::new("Group", NodeKind::Group(Group::new(Operator::Union, blend)));
    let parent = scene.insert(None, 0, group).unwrap();
    let ball = |x: f64| object(Shape::Sphere { radius: 0.5 }).at(DVec3::X * x);
    let ids = [-0.4, 0.4].map(|x| scene.insert(Some(parent), usize::MAX, ball(x)).unwrap());
    let flat = flatten(&scene, 0.0).unwrap();
    for (x, id) in [(-0.1, ids[0]), (0.1, ids[1])] {
        let down = Ray { origin: DVec3::new(x, 3.0, 0.0), direction: DVec3::NEG_Y };
        assert_eq!(pick(&flat, &[], &down, 1e-3, 10.0), Some(id));
    }
}

#[test]
fn a_reference_picture_has_every_buffer() {
    let (flat, _) = scene_of([object(Shape::Sphere { radius: 1.0 }), object(Shape::Plane {}).at(DVec3::NEG_Y)]);
    let camera = Camera::looking_at(DVec3::new(0.0, 1.0, 5.0), DVec3::ZERO, 0.7);
    let rows = AtomicUsize::new(0);
    let count = |_: f64| {
        rows.fetch_add(1, Ordering::Relaxed);
    };
    let size = [96, 64];
    let picture = render_reference(&flat, &[], &camera, size, &count).unwrap();
    assert_eq!(rows.load(Ordering::Relaxed), 64);
    let buffers = &picture.buffers;
    let mut seen = [0; 3];
    for y in 0..size[1] {
        for x in 0..size[0] {
            let i = buffers.index(x, y);
            let pixel = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let p = camera.ray(pixel, DVec2::new(96.0, 64.0)).at(f64::from(buffers.depth[i]));
            let normal = DVec3::from(buffers.normal[i].map(f64::from));
            let (kind, expected) = match buffers.hit_target(i) {
                HitTarget::Background => (0, DVec3::ZERO),
                HitTarget::Leaf(0) => (1, p),
                HitTarget::Leaf(_) => (2, DVec3::Y),
                HitTarget::Mesh(_) => panic!("there is no mesh"),
            };
            seen[kind] += 1;
            assert!((normal - expected).length() < 1e-5, "{normal} {expected}");
            assert_eq!(buffers.depth[i].is_finite(), kind != 0);
        }
    }
    assert!(seen.iter().all(|n| *n > 100), "{seen:?}");
}

#[test]
fn meshes_stand_among_fields() {
    let mut scene = Scene::new();
    let mesh = NodeKind::Mesh(MeshNode::new("models/suzanne.glb"));
    let stretched = Node::new("Mesh", mesh).at(DVec3::new(0.3, 0.0, 0.0)).scaled(DVec3::new(1.5, 1.0, 0.5));
    let mesh_id = scene.insert(None, 0, stretched).unwrap();
    // In front of the lower half.
    let wall = object(Shape::Box { size: [10.0, 10.0, 0.2], rounding: 0.0 }).at(DVec3::new(0.0, -5.0, 3.0));
    let wall_id = scene.insert(None, 1, wall).unwrap();
    let flat = flatten(&scene, 0.0).unwrap();
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes");
    let (meshes, missing) = flat.load_meshes(&mut MeshLibrary::new(Some(folder.into())));
    assert!(missing.is_empty(), "{missing:?}");
    let camera = Camera::looking_at(DVec3::new(0.0, 0.0, 8.0), DVec3::ZERO, 0.5);
    let size = [64, 64];
    let picture = render_reference(&flat, &meshes, &camera, size, &|_| {}).unwrap().buffers;
    let world_from_local = scene.world_from_local(mesh_id);
    let triangles = meshes[0].as_ref().unwrap();
    let mut seen = [0; 3];
    for y in 0..size[1] {
        for x in 0..size[0] {
            let i = picture.index(x, y);
            let ray = camera.ray(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5), DVec2::splat(64.0));
            let p = ray.at(f64::from(picture.depth[i]));
            let picked = pick(&flat, &meshes, &ray, camera.near, camera.far);
            match picture.hit_target(i) {
                HitTarget::Background => {
                    assert_eq!(picked, None);
                    seen[0] += 1;
                }
                HitTarget::Leaf(leaf) => {
                    assert_eq!((flat.ids[leaf], picked), (wall_id, Some(wall_id)));
                    seen[1] += 1;
                }
                HitTarget::Mesh(index) => {
                    assert_eq!((flat.meshes[index].id, picked), (mesh_id, Some(mesh_id)));
                    // The point lies on the mesh: a ray along the normal from just before it hits at once.
                    let normal = DVec3::from(picture.normal[i].map(f64::from));
                    assert!((normal.length() - 1.0).abs() < 1e-6 && normal.dot(ray.direction) <= 0.0);
                    let local_from_world = world_from_local.inverse();
                    let local = Ray {
                        origin: local_from_world.transform_point3(p - ray.direction * 1e-3),
                        direction: local_from_world.transform_vector3(ray.direction),
                    };
                    let hit = triangles.hit(&local, 1.0).expect("a triangle is there");
                    assert!((hit.t - 1e-3).abs() < 1e-5, "{}", hit.t);
                    seen[2] += 1;
                }
            }
        }
    }
    assert!(seen.iter().all(|n| *n > 100), "{seen:?}");
}
