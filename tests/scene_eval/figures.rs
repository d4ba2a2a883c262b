//! Cost of a scene query, compared with a query of every component: the figures of `benches/README.md`.

#![allow(clippy::print_stdout, reason = "the figures are for whoever runs this with `--nocapture`")]

use glam::{DVec2, DVec3};
use isolith::field::reference::trace::Tracer;
use isolith::field::scene_eval::{RayLimits, SceneCounts, SceneEvaluator};
use isolith::field::{FlatScene, flatten};
use isolith::gallery;
use isolith::geometry::{Camera, Ray};
use isolith::render::scene_probe::{ProbeRay, SceneProbe};

use super::scenes::{TestScene, op_set};
use crate::contract::samples::Random;
use crate::gpu::shared;

/// Groups of eight blended leaves, each a component.
const COMPONENTS: usize = 10_000;
/// Rays along a side of the picture.
const SIDE: usize = 16;

/// Means over rays.
#[derive(Debug)]
struct PerRay {
    evaluations: f64,
    boxes: f64,
}

fn per_ray(counts: SceneCounts, rays: usize) -> PerRay {
    PerRay { evaluations: counts.evaluations as f64 / rays as f64, boxes: counts.boxes as f64 / rays as f64 }
}

/// The rays of a picture, and rays from random points in random directions.
fn rays(camera: &Camera, flat: &FlatScene) -> [Vec<Ray>; 2] {
    let bounds = flat.content(&[]);
    let mut random = Random::new(3);
    let size = DVec2::splat(SIDE as f64);
    let pixel = |i: usize| DVec2::new((i % SIDE) as f64 + 0.5, (i / SIDE) as f64 + 0.5);
    let primary = (0..SIDE * SIDE).map(|i| camera.ray(pixel(i), size));
    let place = |unit: DVec3| bounds.center() + bounds.half() * unit;
    let anywhere = (0..SIDE * SIDE).map(|_| Ray { origin: place(random.point(1.0)), direction: random.direction() });
    [primary.collect(), anywhere.collect()]
}

#[test]
fn a_hierarchy_spares_boxes_and_evaluations() {
    let flat = flatten(&gallery::random(COMPONENTS * 8, 1), 0.0).unwrap();
    assert_eq!(flat.components.len(), COMPONENTS);
    let camera = flat.default_camera(&[], 1.0);
    let limits = RayLimits { near: camera.near, far: 1e3 };
    for (name, rays) in ["rays of a picture", "rays from anywhere"].iter().zip(rays(&camera, &flat)) {
        let mut tracer = Tracer::new(&flat);
        let mut evaluator = SceneEvaluator::new(&flat);
        for ray in &rays {
            let before = tracer.march(ray, limits.near, limits.far).unwrap().hit;
            let after = evaluator.ray(ray, limits).unwrap();
            assert_eq!(before.map(|hit| hit.leaf), after.map(|hit| hit.leaf), "{name}: {ray:?}");
        }
        let boxes = (COMPONENTS * rays.len()) as u64;
        let before = per_ray(SceneCounts { evaluations: tracer.evaluations, boxes }, rays.len());
        let after = per_ray(evaluator.counts, rays.len());
        println!("{name}: each component by itself {before:?}, by the hierarchy {after:?}");
        assert!(after.evaluations <= before.evaluations);
        assert!(after.boxes * 40.0 < before.boxes, "{name}: {after:?}");
        // Points on them, as in a march by the minimum of all fields.
        let mut evaluator = SceneEvaluator::new(&flat);
        rays.iter().for_each(|ray| _ = evaluator.distance(ray.at(1.0), f64::INFINITY));
        let exact = per_ray(evaluator.counts, rays.len());
        evaluator.counts = SceneCounts::default();
        rays.iter().for_each(|ray| _ = evaluator.distance(ray.at(1.0), 0.1));
        println!("{name}: a point {exact:?} of {COMPONENTS}, within 0.1 m {:?}", per_ray(evaluator.counts, rays.len()));
        assert!(exact.evaluations * 200.0 < COMPONENTS as f64, "{exact:?}");
    }
}

#[test]
fn the_device_visits_few_of_many_components() {
    let flat = flatten(&gallery::random(8_000, 1), 0.0).unwrap();
    let camera = flat.default_camera(&[], 1.0);
    let test = TestScene { seed: 0, flat, camera };
    let shared = shared();
    let probe = SceneProbe::new(&shared.gpu, op_set(std::slice::from_ref(&test)), false).unwrap();
    let loaded = probe.load(&shared.gpu, &test.flat, test.flat.hierarchy(), (&test.camera, 512));
    for (name, rays) in ["rays of a picture", "rays from anywhere"].iter().zip(rays(&camera, &test.flat)) {
        let probe_ray = |ray: &Ray| ProbeRay {
            origin: ray.origin,
            direction: ray.direction,
            limits: [0.01, 1e3],
            gone: 1.0,
            normal: None,
        };
        let found = loaded.rays(&rays.iter().map(probe_ray).collect::<Vec<_>>()).unwrap();
        let mean = |count: fn(&isolith::render::scene_probe::ProbedHit) -> u32| {
            found.iter().map(|found| f64::from(count(found))).sum::<f64>() / found.len() as f64
        };
        let [evaluations, visits] = [mean(|found| found.evaluations), mean(|found| found.visits)];
        println!("{name}: {evaluations:.1} evaluations, {visits:.1} nodes of {}", test.flat.components.len());
        assert!(found.iter().all(|found| found.ended));
        assert!(evaluations < 40.0 && visits < 1_000.0, "{name}: {evaluations} evaluations, {visits} visits");
    }
}
