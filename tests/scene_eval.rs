//! The scene evaluator: distances and rays to all components at once, on CPU and GPU, against the reference and against
//! each component alone.

mod figures;
mod scenes;
mod shadows;

use glam::DVec3;
use isolith::field::eval::{field, gradient};
use isolith::field::hierarchy::Hierarchy;
use isolith::field::reference::trace::Tracer;
use isolith::field::scene_eval::{RayLimits, SURFACE_BIAS, SceneEvaluator, surface_ray};
use isolith::field::{FlatScene, Flattener, flatten};
use isolith::geometry::{Camera, Ray};
use isolith::render::EvalStrategy;
use isolith::render::scene_probe::{LoadedScene, ProbeRay, ProbedHit, SceneProbe};
use isolith::scene::Node;
use isolith::wgsl::FILES;

use crate::contract::samples::Random;
use crate::gpu::{BenchScene, shared};
use scenes::{SCENES, TestScene, camera_at, crowds, op_set, random_scene};

/// Picture height in pixels that defines the footprints.
const ROWS: u32 = 512;
/// Assumed length of the path from the eye to the rays' origins.
const GONE: f64 = 3.0;
/// Start and end of rays.
const LIMITS: [f64; 2] = [0.01, 30.0];
/// Rays that pass a surface by less than this angle may hit it by rounding: f32 moves points by 1e-6 m here.
const GRAZING: f64 = 2e-5;
/// Tolerance of depths, in footprints.
const MOST_FOOTPRINTS: f64 = 1.0;
/// Tolerance of values, relative to 1 m plus the value.
const TOLERANCE: f64 = 1e-4;

/// The minimum of the fields of all components.
fn least_field(flat: &FlatScene, p: DVec3) -> f64 {
    flat.components.iter().map(|c| field(flat, c, p - c.origin)).fold(f64::INFINITY, f64::min)
}

/// Checks that a value at `p` does not exceed the distance: rays in some directions, one of them along the field's
/// descent, hit nothing nearer.
fn is_safe(flat: &FlatScene, tracer: &mut Tracer<'_>, p: DVec3, value: f64, random: &mut Random) -> Result<(), String> {
    let nearest = flat.components.iter().min_by(|a, b| {
        let [a, b] = [a, b].map(|c| field(flat, c, p - c.origin));
        a.total_cmp(&b)
    });
    let Some(nearest) = nearest.filter(|_| value > 0.0) else { return Ok(()) };
    let down = -gradient(flat, nearest, p - nearest.origin).1.normalize_or(DVec3::Y);
    for direction in [down, random.direction(), random.direction()] {
        let hit = tracer.march(&Ray { origin: p, direction }, 0.0, value).unwrap().hit;
        if let Some(hit) = hit.filter(|hit| hit.t < value - TOLERANCE * (1.0 + value)) {
            return Err(format!("{p}: the value is {value}, a surface at {}", hit.t));
        }
    }
    Ok(())
}

/// Compares values on both sides with all components and with the reference.
fn values_are_right(test: &TestScene, hierarchy: &Hierarchy, loaded: &LoadedScene<'_>) -> Result<(), String> {
    let flat = &test.flat;
    let mut random = Random::new(test.seed + 7);
    let mut tracer = Tracer::new(flat);
    let points: Vec<DVec3> = (0..24).map(|_| test.camera.position + random.point(6.0).as_vec3().as_dvec3()).collect();
    let found = loaded.values(&points, 1e30).unwrap();
    let near = loaded.values(&points, 0.5).unwrap();
    let mut evaluator = SceneEvaluator::with_hierarchy(flat, hierarchy);
    for ((p, gpu), near) in points.iter().zip(&found).zip(&near) {
        let cpu = evaluator.distance(*p, f64::INFINITY);
        let least = least_field(flat, *p);
        let room = TOLERANCE * (1.0 + least.abs());
        let is_near = |a: f64, b: f64| (a - b).abs() <= room || (a > 1e29 && b > 1e29);
        if cpu.value < least - 1e-9 || (cpu.value < 0.0) != (least < 0.0) || (least < 0.0 && cpu.value != least) {
            return Err(format!("{p}: the CPU says {}, the least field is {least}", cpu.value));
        }
        if !is_near(gpu.value, cpu.value) || (least.abs() > room && (gpu.value < 0.0) != (least < 0.0)) {
            return Err(format!("{p}: the GPU says {gpu:?}, the CPU {cpu:?}"));
        }
        for value in [cpu.value, gpu.value] {
            is_safe(flat, &mut tracer, *p, value.min(100.0), &mut random)?;
        }
        let bound = evaluator.distance(*p, 0.5).value;
        for bound in [bound, near.value] {
            let is_right = if cpu.value < 0.5 - room { is_near(bound, cpu.value) } else { bound >= 0.5 - room };
            if !is_right || bound > cpu.value + room || near.evaluations > gpu.evaluations {
                return Err(format!("{p}: within 0.5 m it is {bound}, of {}", cpu.value));
            }
        }
    }
    Ok(())
}

fn probe_rays(test: &TestScene, count: usize) -> Vec<ProbeRay> {
    let mut random = Random::new(test.seed + 11);
    let position = test.camera.position;
    let components = &test.flat.components;
    let ray = |i: usize| {
        let origin = position + random.point(6.0).as_vec3().as_dvec3();
        // Aim half of them at the middle of a component, so that enough rays hit.
        let component = components.get(random.index(components.len().max(1)));
        let aimed = component.filter(|component| i.is_multiple_of(2) && component.bounds.is_finite());
        let direction = match aimed {
            Some(component) => (component.origin + component.bounds.center() - origin).normalize_or(DVec3::X),
            None => random.direction(),
        };
        ProbeRay { origin, direction: direction.as_vec3().as_dvec3(), limits: LIMITS, gone: GONE, normal: None }
    };
    (0..count).map(ray).collect()
}

/// The ray in the form of the CPU.
fn as_ray(ray: &ProbeRay, footprint: f64) -> Ray {
    match ray.normal {
        Some(normal) => surface_ray(ray.origin, normal, ray.direction, footprint * ray.gone),
        None => Ray { origin: ray.origin, direction: ray.direction },
    }
}

/// Compares hits on both sides with the reference. Returns the number of compared rays and of hits.
fn rays_are_right(
    test: &TestScene,
    hierarchy: &Hierarchy,
    rays: &[ProbeRay],
    found: &[ProbedHit],
) -> Result<[usize; 2], String> {
    let footprint = test.camera.footprint(ROWS.into());
    let mut tracer = Tracer::new(&test.flat);
    let mut evaluator = SceneEvaluator::with_hierarchy(&test.flat, hierarchy);
    let mut counts = [0; 2];
    for (ray, gpu) in rays.iter().zip(found) {
        let own = as_ray(ray, footprint);
        let [near, far] = ray.limits;
        let march = tracer.march(&own, near, far).unwrap();
        let reference = march.hit.map(|hit| (hit.t, hit.component));
        let cpu = evaluator.ray(&own, RayLimits { near, far }).unwrap();
        let is_same = |a: f64, b: f64| (a - b).abs() <= 1e-9 * (1.0 + a);
        let same = match (march.hit, cpu) {
            (Some(a), Some(b)) => {
                // Inside two solids at once, either hit is right.
                is_same(a.t, b.t) && (a.leaf == b.leaf || march.margin < GRAZING || is_same(a.t, near))
            }
            (a, b) => a.is_none() && b.is_none(),
        };
        if !same {
            return Err(format!("{own:?}: the CPU hits {cpu:?}, the reference {reference:?}"));
        }
        if !gpu.ended {
            return Err(format!("{own:?} has not ended"));
        }
        if march.margin < GRAZING {
            continue;
        }
        let room = |t: f64| MOST_FOOTPRINTS * footprint * (ray.gone + t);
        let agrees = match (reference, gpu.hit) {
            (Some((a, _)), Some((b, _))) => (a - b).abs() <= room(a),
            (a, b) => a.is_none() && b.is_none(),
        };
        if !agrees {
            return Err(format!("{own:?}: the GPU hits {:?}, the reference {reference:?}, {march:?}", gpu.hit));
        }
        counts[0] += 1;
        counts[1] += usize::from(reference.is_some());
    }
    Ok(counts)
}

/// The scene without the component that most rays hit, replaced by another.
fn without_a_component(test: &TestScene) -> Option<Hierarchy> {
    let mut broken = test.flat.hierarchy().clone();
    let mut tracer = Tracer::new(&test.flat);
    let mut hits = vec![0; test.flat.components.len()];
    for ray in probe_rays(test, 32) {
        let own = as_ray(&ray, 0.0);
        if let Some(hit) = tracer.march(&own, ray.limits[0], ray.limits[1]).unwrap().hit {
            hits[hit.component as usize] += 1;
        }
    }
    let leaves = broken.nodes.iter().enumerate().filter(|(_, node)| node.is_leaf());
    let (most, left_out) = leaves.map(|(at, node)| (hits[node.link as usize], at)).max()?;
    let other = broken.nodes.iter().enumerate().find(|(at, node)| node.is_leaf() && *at != left_out)?.1.link;
    broken.nodes[left_out].link = other;
    (most > 2).then_some(broken)
}

#[test]
fn both_sides_agree_with_the_reference_on_random_scenes() {
    let tests: Vec<TestScene> = (0..SCENES).map(random_scene).collect();
    let shared = shared();
    let probe = SceneProbe::new(&shared.gpu, op_set(&tests), false).unwrap();
    let (mut compared, mut caught, mut tried) = ([0; 2], 0, 0);
    let mut faults = Vec::new();
    for test in &tests {
        let hierarchy = test.flat.hierarchy();
        let loaded = probe.load(&shared.gpu, &test.flat, hierarchy, (&test.camera, ROWS));
        let mut report = |e: String| faults.push(format!("scene {}: {e}", test.seed));
        values_are_right(test, hierarchy, &loaded).unwrap_or_else(&mut report);
        let rays = probe_rays(test, 32);
        let found = loaded.rays(&rays).unwrap();
        let counts = rays_are_right(test, hierarchy, &rays, &found).unwrap_or_else(|e| {
            report(e);
            [0; 2]
        });
        compared = [0, 1].map(|i| compared[i] + counts[i]);
        // The comparison must be able to fail, on each side alone.
        if test.seed.is_multiple_of(10)
            && let Some(broken) = without_a_component(test)
        {
            let loaded = probe.load(&shared.gpu, &test.flat, &broken, (&test.camera, ROWS));
            let lost = loaded.rays(&rays).unwrap();
            tried += 2;
            caught += usize::from(rays_are_right(test, &broken, &rays, &found).is_err());
            caught += usize::from(rays_are_right(test, hierarchy, &rays, &lost).is_err());
        }
    }
    assert!(faults.is_empty(), "{}:\n{}", faults.len(), faults.join("\n"));
    let all = tests.len() * 32;
    assert!(compared[0] > all * 98 / 100, "{} of {all} rays were compared", compared[0]);
    assert!(compared[1] > all / 4, "{} of {all} rays hit something", compared[1]);
    assert!(tried >= 20, "hardly a component was left out: {tried}");
    assert_eq!(caught, tried, "a component that is left out is not missed");
}

#[test]
fn a_march_that_is_interrupted_goes_on() {
    let tests: Vec<TestScene> = (0..8).map(random_scene).collect();
    let shared = shared();
    let mut probe = SceneProbe::new(&shared.gpu, op_set(&tests), false).unwrap();
    for evaluations in [None, Some(3), Some(40)] {
        for test in &tests {
            let hierarchy = test.flat.hierarchy();
            // Enough to visit each node once.
            let most = evaluations.map(|most| [most, hierarchy.nodes.len() as u32 + 1]);
            probe.most = most;
            let loaded = probe.load(&shared.gpu, &test.flat, hierarchy, (&test.camera, ROWS));
            let rays = probe_rays(test, 32);
            let found = loaded.rays(&rays).unwrap();
            rays_are_right(test, hierarchy, &rays, &found).unwrap_or_else(|e| panic!("{most:?}, {}: {e}", test.seed));
            // Values report that they stopped early, and still do not exceed the distance.
            let points: Vec<DVec3> = rays.iter().map(|ray| ray.origin).collect();
            for (p, found) in points.iter().zip(loaded.values(&points, 1e30).unwrap()) {
                let least = SceneEvaluator::new(&test.flat).distance(*p, f64::INFINITY).value;
                let room = TOLERANCE * (1.0 + least.abs());
                assert!(found.value <= least.max(0.0) + room, "{p}: {found:?} of {least}");
                assert!(found.complete || most.is_some());
            }
        }
    }
    // A ray that cannot visit the tree even once reports it.
    probe.most = Some([100, 2]);
    let test = tests.iter().max_by_key(|test| test.flat.components.len()).expect("a scene");
    let loaded = probe.load(&shared.gpu, &test.flat, test.flat.hierarchy(), (&test.camera, ROWS));
    assert!(loaded.rays(&probe_rays(test, 32)).unwrap().iter().any(|found| !found.ended));
}

#[test]
fn rays_leave_a_surface_without_meeting_it() {
    let tests: Vec<TestScene> = (0..60).map(random_scene).collect();
    let shared = shared();
    let probe = SceneProbe::new(&shared.gpu, op_set(&tests), false).unwrap();
    let [mut left, mut stuck, mut unbiased] = [0; 3];
    for test in &tests {
        let (flat, hierarchy) = (&test.flat, test.flat.hierarchy());
        let footprint = test.camera.footprint(ROWS.into());
        let mut random = Random::new(test.seed);
        let mut tracer = Tracer::new(flat);
        let mut rays = Vec::new();
        for ray in probe_rays(test, 64) {
            let own = as_ray(&ray, footprint);
            let march = tracer.march(&own, LIMITS[0], LIMITS[1]).unwrap();
            let Some(hit) = march.hit.filter(|hit| hit.t > 0.5) else { continue };
            // As in a picture: rounded to f32 relative to the eye.
            let p = test.camera.position + (own.at(hit.t) - test.camera.position).as_vec3().as_dvec3();
            let component = &flat.components[hit.component as usize];
            let normal = gradient(flat, component, p - component.origin).1.normalize_or_zero();
            let direction = random.direction();
            let direction = if normal.dot(direction) < 0.0 { -direction } else { direction };
            // Rays that leave by the front, not along the surface.
            if normal.dot(direction) > 0.2 && normal.dot(own.direction) < -0.2 {
                let limits = [0.0, LIMITS[1]];
                rays.push(ProbeRay { origin: p, direction, limits, gone: hit.t, normal: Some(normal) });
            }
        }
        if rays.is_empty() {
            continue;
        }
        let loaded = probe.load(&shared.gpu, flat, hierarchy, (&test.camera, ROWS));
        let is_stuck =
            |ray: &ProbeRay, found: &ProbedHit| found.hit.is_some_and(|(t, _)| t < SURFACE_BIAS * footprint * ray.gone);
        let found = loaded.rays(&rays).unwrap();
        stuck += rays.iter().zip(&found).filter(|(ray, found)| is_stuck(ray, found)).count();
        rays_are_right(test, hierarchy, &rays, &found).unwrap_or_else(|e| panic!("scene {}: {e}", test.seed));
        left += rays.len();
        let bare: Vec<_> = rays.iter().map(|ray| ProbeRay { normal: None, ..*ray }).collect();
        unbiased += bare.iter().zip(loaded.rays(&bare).unwrap()).filter(|(ray, found)| is_stuck(ray, found)).count();
    }
    assert!(left > 100, "{left} rays");
    assert!(stuck * 100 <= left, "{stuck} of {left} rays meet the surface that they leave");
    assert!(unbiased * 5 > left, "without a bias only {unbiased} of {left} would");
}

#[test]
fn components_with_tapes_are_asked_by_them() {
    let test = crowds();
    assert!(test.flat.components.len() == 3, "{} components", test.flat.components.len());
    let shared = shared();
    let probe = SceneProbe::new(&shared.gpu, op_set(std::slice::from_ref(&test)), true).unwrap();
    let hierarchy = test.flat.hierarchy();
    let loaded = probe.load(&shared.gpu, &test.flat, hierarchy, (&test.camera, ROWS));
    let rays = probe_rays(&test, 256);
    let counts = rays_are_right(&test, hierarchy, &rays, &loaded.rays(&rays).unwrap()).unwrap();
    assert!(counts[1] > 10, "{counts:?}");
    // In cells without a surface, tapes give a smaller bound than the field.
    let mut random = Random::new(3);
    let mut tracer = Tracer::new(&test.flat);
    let points: Vec<DVec3> = rays.iter().map(|ray| ray.origin).collect();
    for (p, found) in points.iter().zip(loaded.values(&points, 1e30).unwrap()) {
        let least = least_field(&test.flat, *p);
        assert!((found.value < 0.0) == (least < 0.0) || least.abs() < TOLERANCE, "{p}: {found:?}, {least}");
        is_safe(&test.flat, &mut tracer, *p, found.value, &mut random).unwrap();
    }
}

#[test]
fn nothing_is_built_that_nobody_asks_for() {
    let scene = isolith::gallery::random(64, 1);
    let subject = BenchScene::new("random", &scene, None);
    subject.render(32, EvalStrategy::Auto);
    assert!(!subject.flat.has_hierarchy(), "a picture needs none");
    let ray = Ray { origin: subject.camera.position, direction: subject.camera.rotation * DVec3::NEG_Z };
    isolith::field::pick::pick(&subject.flat, &subject.meshes, &ray, 0.1, 100.0);
    assert!(subject.flat.has_hierarchy());
    // No pass of the frame contains the code but the one that only scenes with shadows have.
    let asks = |name: &str| name.starts_with("probe_") || name == "shadow.wgsl";
    let passes = FILES.iter().filter(|(name, _)| !name.contains('/') && !asks(name));
    assert!(passes.clone().count() > 8);
    for (name, text) in passes {
        assert!(!text.contains("scene/"), "{name}");
    }
}

#[test]
fn a_dragged_component_is_refitted() {
    let mut scene = isolith::gallery::random(160, 2);
    let mut flattener = Flattener::default();
    let first = flattener.flatten(&scene, 0.0).unwrap();
    let built = first.hierarchy().nodes.len();
    let mut entries = first.components[3].first as usize..;
    let id = entries.find(|entry| first.nodes[*entry].is_leaf()).map(|leaf| first.ids[leaf]).expect("a leaf");
    for step in [0.1, 0.2, 40.0, -3000.0] {
        let mut node = Node::clone(scene.node(id).unwrap());
        node.transform.translation.x += step;
        scene.replace(node).unwrap();
        let flat = flattener.flatten(&scene, 0.0).unwrap();
        let is_kept = flat.has_hierarchy();
        assert_eq!(is_kept, step.abs() < 1.0, "{step}: it is built anew only where boxes have grown too much");
        let fresh = flatten(&scene, 0.0).unwrap();
        assert_eq!(flat.hierarchy().nodes.len(), built);
        let mut random = Random::new(5);
        for _ in 0..50 {
            let p = random.point(8.0) + DVec3::X * random.pick(&[0.0, step]);
            let [ours, theirs] =
                [&*flat, &fresh].map(|flat| SceneEvaluator::new(flat).distance(p, f64::INFINITY).value);
            assert_eq!(ours, theirs, "{step}: {p}");
        }
    }
}

#[test]
fn an_empty_scene_is_nowhere() {
    let flat = FlatScene::default();
    let mut evaluator = SceneEvaluator::new(&flat);
    assert_eq!(evaluator.distance(DVec3::ZERO, f64::INFINITY).component, None);
    let ray = Ray { origin: DVec3::ZERO, direction: DVec3::X };
    assert_eq!(evaluator.ray(&ray, RayLimits { near: 0.0, far: 1e3 }), Ok(None));
    let shared = shared();
    let test = random_scene(1);
    let probe = SceneProbe::new(&shared.gpu, op_set(std::slice::from_ref(&test)), false).unwrap();
    let camera: Camera = camera_at(DVec3::ZERO);
    let loaded = probe.load(&shared.gpu, &flat, flat.hierarchy(), (&camera, ROWS));
    assert_eq!(loaded.values(&[DVec3::ONE], 1e30).unwrap()[0].component, u32::MAX);
    let found = loaded.rays(&probe_rays(&test, 4)).unwrap();
    assert!(found.iter().all(|found| found.ended && found.hit.is_none()), "{found:?}");
}
