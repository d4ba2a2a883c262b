//! Shadows and occlusion by cones, against many rays.

#![allow(clippy::print_stdout, reason = "the figures are for whoever runs this with `--nocapture`")]

use std::time::Instant;

use glam::DVec3;
use isolith::field::FlatScene;
use isolith::field::eval::gradient;
use isolith::field::flatten;
use isolith::field::light::occlusion::{occlusion_by_rays, scene_occlusion};
use isolith::field::light::shadow::{ShadowCone, ShadowProof, shadow_by_rays, shadow_share};
use isolith::field::scene_eval::{RayLimits, SceneEvaluator, surface_ray};
use isolith::gallery;
use isolith::geometry::{Camera, Ray};

use super::scenes::{SCENES, random_scene};
use crate::contract::samples::Random;

/// Tangent of the angular radius of a light of 4 degrees.
const FOUR_DEGREES: f64 = 0.034_920_8;
/// Footprint of a pixel at distance 1.
const FOOTPRINT: f64 = 2e-3;
/// Rays of a true value.
const RAYS: u32 = 256;

/// A point of a surface.
struct Receiver {
    point: DVec3,
    normal: DVec3,
    footprint: f64,
}

/// Points of a scene that its camera sees, at random.
fn receivers(flat: &FlatScene, camera: &Camera, random: &mut Random, count: usize) -> Vec<Receiver> {
    let mut evaluator = SceneEvaluator::new(flat);
    let mut seen = Vec::new();
    for _ in 0..8 * count {
        let origin = camera.position + random.direction() * random.range(1.0, 12.0);
        let direction = (camera.position + random.point(3.0) - origin).normalize_or(DVec3::Y);
        let ray = Ray { origin, direction };
        if evaluator.distance(origin, 0.1).value < 0.0 {
            continue;
        }
        let Some(hit) = evaluator.ray(&ray, RayLimits { near: 0.01, far: 1e4 }).unwrap() else { continue };
        let component = &flat.components[hit.component as usize];
        let point = ray.at(hit.t);
        let normal = gradient(flat, component, point - component.origin).1.normalize_or_zero();
        if normal.dot(direction) < 0.0 {
            seen.push(Receiver { point, normal, footprint: FOOTPRINT * hit.t });
        }
        if seen.len() == count {
            break;
        }
    }
    seen
}

/// The cone from a receiver to a light at random.
fn cone_from(receiver: &Receiver, random: &mut Random, extent: f64) -> Option<ShadowCone> {
    let direction = random.direction();
    let to_light = if direction.dot(receiver.normal) < 0.0 { -direction } else { direction };
    let ray = surface_ray(receiver.point, receiver.normal, to_light, receiver.footprint);
    let lit = to_light.dot(receiver.normal) > 0.02;
    let distance = if random.chance(0.5) { f64::INFINITY } else { random.range(1.0, 8.0) };
    let extent = if distance.is_finite() { extent * distance } else { extent };
    lit.then(|| ShadowCone::new(ray.origin, to_light, distance, extent, receiver.footprint))
}

/// The sum of errors, and counts.
#[derive(Debug, Default)]
struct Tally {
    error: f64,
    cones: usize,
    proofs: usize,
    evaluations: u64,
    wrong: Vec<String>,
}

impl Tally {
    /// Compares a cone with rays. `claimed`: the cone whose proof is believed.
    fn add(&mut self, evaluator: &mut SceneEvaluator<'_>, cone: &ShadowCone, claimed: &ShadowCone, what: &str) {
        let before = evaluator.counts.evaluations;
        let found = shadow_share(evaluator, claimed);
        self.evaluations += evaluator.counts.evaluations - before;
        // The light is a disc at the end of the axis: rays to its rim are a little longer.
        let rays = ShadowCone { far: cone.far * (1.0 + cone.spread * cone.spread).sqrt(), ..*cone };
        let truth = shadow_by_rays(evaluator, &rays, RAYS).unwrap();
        self.error += (found.share - truth).abs();
        self.cones += 1;
        self.proofs += usize::from(found.proof != ShadowProof::None);
        let right = match found.proof {
            ShadowProof::None => true,
            ShadowProof::Lit => truth == 1.0,
            ShadowProof::Dark => truth == 0.0,
        };
        if !right {
            self.wrong.push(format!("{what}: {found:?}, but {truth} by rays of {cone:?}"));
        }
    }

    fn mean(&self) -> f64 {
        self.error / self.cones as f64
    }
}

/// Compares cones with rays in random scenes from `seeds`; the believed cone is `narrower` times as wide.
fn random_cones(seeds: std::ops::Range<u64>, each: usize, narrower: f64) -> Tally {
    let mut tally = Tally::default();
    for seed in seeds {
        let test = random_scene(seed);
        let mut random = Random::new(seed + 31);
        let mut evaluator = SceneEvaluator::new(&test.flat);
        for receiver in receivers(&test.flat, &test.camera, &mut random, each) {
            let extent = random.pick(&[0.005, FOUR_DEGREES, FOUR_DEGREES, 0.1]);
            let Some(cone) = cone_from(&receiver, &mut random, extent) else { continue };
            let claimed = ShadowCone { spread: cone.spread * narrower, ..cone };
            tally.add(&mut evaluator, &cone, &claimed, &format!("seed {seed}"));
        }
    }
    tally
}

#[test]
fn cones_prove_nothing_wrong() {
    let start = Instant::now();
    let tally = random_cones(0..SCENES, 6, 1.0);
    println!(
        "{} cones, {} proofs, mean error {:.4}, {:.1} evaluations, {:?}",
        tally.cones,
        tally.proofs,
        tally.mean(),
        tally.evaluations as f64 / tally.cones as f64,
        start.elapsed()
    );
    assert!(tally.wrong.is_empty(), "{:#?}", tally.wrong);
    assert!(tally.cones > 500 && tally.proofs * 2 > tally.cones, "{tally:?}");
}

/// The check must be able to fail: the proofs of a cone of half the width are not those of the light.
#[test]
fn wrong_proofs_are_found() {
    assert!(!random_cones(0..60, 6, 0.5).wrong.is_empty());
}

#[test]
fn a_cone_of_four_degrees_errs_little() {
    let mut tally = Tally::default();
    for (name, scene) in gallery::all() {
        if ["fractals", "modifiers", "mesh-and-fields", "drawn"].contains(&name) {
            continue;
        }
        let flat = flatten(&scene, 0.0).unwrap();
        let camera = flat.default_camera(&[], 1.0);
        let mut random = Random::new(77);
        let mut evaluator = SceneEvaluator::new(&flat);
        let before = (tally.error, tally.cones, tally.evaluations);
        for receiver in camera_receivers(&flat, &camera, &mut random, 24) {
            let Some(cone) = cone_from(&receiver, &mut random, FOUR_DEGREES) else { continue };
            tally.add(&mut evaluator, &cone, &cone, name);
        }
        let cones = (tally.cones - before.1) as f64;
        let evaluations = (tally.evaluations - before.2) as f64 / cones;
        println!("{name}: mean error {:.4}, {evaluations:.1} evaluations", (tally.error - before.0) / cones);
    }
    println!("mean error {:.4} of {} cones", tally.mean(), tally.cones);
    assert!(tally.wrong.is_empty(), "{:#?}", tally.wrong);
    assert!(tally.mean() <= 0.02, "{}", tally.mean());
}

#[test]
fn occlusion_by_six_cones_is_near_that_by_many_rays() {
    let (mut error, mut signed, mut turned, mut count, mut evaluations) = (0.0, 0.0, 0.0, 0.0, 0);
    let mut add = |flat: &FlatScene, seen: Vec<Receiver>| {
        let mut evaluator = SceneEvaluator::new(flat);
        for at in seen {
            let origin = surface_ray(at.point, at.normal, at.normal, at.footprint).origin;
            let before = evaluator.counts.evaluations;
            let found = scene_occlusion(&mut evaluator, &[], origin, at.normal, [1.0, 2.0 * at.footprint]);
            evaluations += evaluator.counts.evaluations - before;
            let truth = occlusion_by_rays(&mut evaluator, &[], origin, at.normal, 1.0, RAYS).unwrap();
            error += (found.visibility - truth.visibility).abs();
            signed += found.visibility - truth.visibility;
            turned += found.bent.angle_between(truth.bent).to_degrees() * f64::from(u8::from(truth.visibility > 0.1));
            count += 1.0;
        }
    };
    for seed in 0..40 {
        let test = random_scene(seed);
        let seen = receivers(&test.flat, &test.camera, &mut Random::new(seed + 41), 5);
        add(&test.flat, seen);
    }
    for (name, scene) in gallery::all() {
        if ["chessboard", "pawn", "random-37", "random-145", "showcase", "boolean-operations"].contains(&name) {
            let flat = flatten(&scene, 0.0).unwrap();
            let seen = camera_receivers(&flat, &flat.default_camera(&[], 1.0), &mut Random::new(77), 16);
            add(&flat, seen);
        }
    }
    let (error, signed, turned) = (error / count, signed / count, turned / count);
    let evaluations = evaluations as f64 / count;
    println!(
        "{count} points: mean error {error:.4}, {signed:.4} too light, bent normal off by {turned:.1} degrees, {evaluations:.1} evaluations"
    );
    assert!(count > 150.0 && error <= 0.04 && turned < 6.0, "{error}, {turned}");
}

/// Points of a scene that its camera sees.
fn camera_receivers(flat: &FlatScene, camera: &Camera, random: &mut Random, count: usize) -> Vec<Receiver> {
    let mut evaluator = SceneEvaluator::new(flat);
    let mut seen = Vec::new();
    for _ in 0..4 * count {
        let direction = camera.rotation * (random.direction() * 0.35 + DVec3::NEG_Z).normalize();
        let ray = Ray { origin: camera.position, direction };
        let Some(hit) = evaluator.ray(&ray, RayLimits { near: 0.01, far: 1e4 }).unwrap() else { continue };
        let component = &flat.components[hit.component as usize];
        let point = ray.at(hit.t);
        let normal = gradient(flat, component, point - component.origin).1.normalize_or_zero();
        if normal.dot(direction) < 0.0 {
            seen.push(Receiver { point, normal, footprint: FOOTPRINT * hit.t });
        }
        if seen.len() == count {
            break;
        }
    }
    seen
}
