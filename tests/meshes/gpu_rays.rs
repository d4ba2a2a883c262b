//! Rays against meshes on the GPU, against those on the CPU.

use std::path::Path;
use std::sync::Arc;

use glam::{DAffine3, DQuat, DVec3};
use isolith::field::mesh_rays::{mesh_rays_blocked, mesh_rays_hit};
use isolith::field::{FlatScene, flatten};
use isolith::geometry::Ray;
use isolith::mesh::{TriangleMesh, load, parse};
use isolith::render::MAX_MESH_VISITS;
use isolith::render::mesh_ray_probe::{MeshRayProbe, ProbedMeshHit};
use isolith::scene::{MeshNode, Node, NodeKind, Scene};
use isolith::wgsl::FILES;
use serde_json::json;

use super::asset::scenes;
use super::tiny::{Random, triangle};
use crate::gpu::shared;

/// Near and far limit of the rays.
const LIMITS: [f64; 2] = [0.02, 12.0];
/// Rays that pass an edge more closely than this, relative to their length, may hit or miss by rounding.
const ROUNDING: f64 = 4e-6;

type Meshes = Vec<Option<Arc<TriangleMesh>>>;

/// A scene of these meshes, each in its place.
fn placed(meshes: &[(&Arc<TriangleMesh>, DAffine3)]) -> (FlatScene, Meshes) {
    let mut scene = Scene::new();
    for _ in meshes {
        scene.insert(None, 0, Node::new("mesh", NodeKind::Mesh(MeshNode::new("a.glb")))).unwrap();
    }
    let mut flat = flatten(&scene, 0.0).unwrap();
    flat.meshes.iter_mut().zip(meshes).for_each(|(own, (_, place))| own.world_from_local = *place);
    (flat, meshes.iter().map(|(mesh, _)| Some((*mesh).clone())).collect())
}

/// Random rays toward the box around `center`.
fn rays(center: DVec3, reach: f64, count: usize, seed: u64) -> Vec<Ray> {
    let mut random = Random(seed);
    let mut point = |reach: f64| center + DVec3::from([0; 3].map(|_| random.between(-reach, reach)));
    let mut ray = || {
        let origin = point(2.5 * reach);
        Ray { origin, direction: (point(reach) - origin).normalize() }
    };
    (0..count).map(|_| ray()).collect()
}

/// Number of hits, and a text for each ray whose result on the GPU is wrong.
fn compare(flat: &FlatScene, meshes: &Meshes, rays: &[Ray], found: &[ProbedMeshHit]) -> (usize, Vec<String>) {
    let [near, far] = LIMITS;
    let (mut hits, mut wrong) = (0, Vec::new());
    for (ray, found) in rays.iter().zip(found) {
        let right = mesh_rays_hit(flat, meshes, ray, near, far);
        assert_eq!(mesh_rays_blocked(flat, meshes, ray, near, far), right.is_some());
        hits += usize::from(right.is_some());
        let agrees = |hit: &Option<(usize, isolith::mesh::MeshHit)>| match (hit, found.hit) {
            (None, None) => true,
            (Some((_, hit)), Some((t, ..))) => (hit.t - t).abs() < 1e-4 * (1.0 + hit.t),
            _ => false,
        };
        let turned = |i: usize| {
            let (right, up) = ray.direction.any_orthonormal_pair();
            let (sine, cosine) = (std::f64::consts::TAU * i as f64 / 8.0).sin_cos();
            let direction = (ray.direction + (right * cosine + up * sine) * ROUNDING).normalize();
            mesh_rays_hit(flat, meshes, &Ray { direction, ..*ray }, near, far)
        };
        let is_right = agrees(&right) || (0..8).any(|i| agrees(&turned(i)));
        let is_whole = found.is_blocked == found.hit.is_some() && found.visits.is_some_and(|v| v <= MAX_MESH_VISITS);
        if !is_right || !is_whole {
            wrong.push(format!("{ray:?}: {found:?} instead of {right:?}"));
        }
    }
    (hits, wrong)
}

fn suzanne() -> Arc<TriangleMesh> {
    Arc::new(load(&scenes().join("models/suzanne.glb")).unwrap())
}

/// A head, and a smaller one that is turned, stretched and mirrored, far from the world's origin.
fn two_heads(center: DVec3) -> (FlatScene, Meshes) {
    let mesh = suzanne();
    let turned = DAffine3::from_scale_rotation_translation(
        DVec3::new(-0.5, 0.8, 0.4),
        DQuat::from_rotation_y(0.7),
        center + DVec3::new(1.2, 0.3, 0.2),
    );
    placed(&[(&mesh, DAffine3::from_translation(center)), (&mesh, turned)])
}

#[test]
fn rays_on_the_device_hit_what_those_of_the_cpu_hit() {
    let gpu = shared().gpu.clone();
    let probe = MeshRayProbe::new(&gpu).unwrap();
    for center in [DVec3::ZERO, DVec3::new(400_000.0, 30.0, -5_000_000.0)] {
        let (flat, meshes) = two_heads(center);
        // The origin of queries is near them, as the eye is.
        let rays: Vec<Ray> = rays(center, 1.5, 3_000, 5);
        let found = probe.rays(&gpu, (&flat, &meshes), center + DVec3::new(0.5, 1.0, 2.0), &rays, LIMITS).unwrap();
        let (hits, wrong) = compare(&flat, &meshes, &rays, &found);
        assert!(wrong.is_empty(), "{} of {}: {}", wrong.len(), rays.len(), wrong[0]);
        assert!((600..2_900).contains(&hits), "{hits} hits say little");
        // Must-fail twin: the same results for a scene in which a mesh has moved.
        let mut other = flat.clone();
        other.meshes[1].world_from_local.translation.y += 0.05;
        assert!(compare(&other, &meshes, &rays, &found).1.len() > 100);
    }
    let (flat, _) = two_heads(DVec3::ZERO);
    let nothing =
        probe.rays(&gpu, (&flat, &[None, None]), DVec3::ZERO, &rays(DVec3::ZERO, 1.5, 64, 1), LIMITS).unwrap();
    assert!(nothing.iter().all(|found| found.hit.is_none() && !found.is_blocked));
}

#[test]
fn light_passes_blended_surfaces_and_stops_at_masked_ones() {
    let gpu = shared().gpu.clone();
    let probe = MeshRayProbe::new(&gpu).unwrap();
    for (mode, stops) in [("OPAQUE", true), ("MASK", true), ("BLEND", false)] {
        let mut tiny = triangle();
        let pbr = json!({ "baseColorFactor": [1, 1, 1, 0.25] });
        tiny.json["materials"] = json!([{ "alphaMode": mode, "pbrMetallicRoughness": pbr }]);
        tiny.json["meshes"][0]["primitives"][0]["material"] = json!(0);
        let mesh = Arc::new(parse(&tiny.gltf(), Path::new("tiny.gltf"), None).unwrap());
        let (flat, meshes) = placed(&[(&mesh, DAffine3::IDENTITY)]);
        let ray = Ray { origin: DVec3::new(0.25, 0.25, 2.0), direction: DVec3::NEG_Z };
        let found = probe.rays(&gpu, (&flat, &meshes), DVec3::ZERO, &[ray], LIMITS).unwrap()[0];
        assert_eq!((found.hit.is_some(), found.is_blocked), (stops, stops), "{mode}");
        assert_eq!(mesh_rays_blocked(&flat, &meshes, &ray, LIMITS[0], LIMITS[1]), stops, "{mode}");
        // Neither before the near limit nor behind the far one.
        for limits in [[2.5, 12.0], [0.02, 1.5]] {
            let found = probe.rays(&gpu, (&flat, &meshes), DVec3::ZERO, &[ray], limits).unwrap()[0];
            assert_eq!((found.hit, found.is_blocked), (None, false), "{limits:?}");
        }
    }
}

#[test]
fn shader_and_program_have_the_same_limit() {
    let text = FILES.iter().find(|(name, _)| *name == "scene/mesh_rays.wgsl").unwrap().1;
    assert!(text.contains(&format!("const MAX_MESH_VISITS: u32 = {MAX_MESH_VISITS}u;")));
}
