//! Shadows and occlusion in pictures, against the reference and against many rays.

#![allow(clippy::print_stdout, reason = "the figures are for whoever runs this with `--nocapture`")]

use std::f64::consts::PI;

use std::time::Duration;

use glam::{DQuat, DVec2, DVec3};
use isolith::field::eval::gradient;
use isolith::field::light::occlusion::occlusion_ray;
use isolith::field::light::shadow::{
    ShadowCone, ShadowProof, disc_spiral, light_extent, light_is_seen, light_toward, shadow_share,
};
use isolith::field::reference::image::render_reference;
use isolith::field::scene_eval::{RayLimits, SceneEvaluator, surface_ray};
use isolith::field::{FlatLight, GBuffer, MESH_BIT, NO_LEAF, flatten, gpu_lights};
use isolith::gallery;
use isolith::geometry::{Camera, Ray, pixel_jitter};
use isolith::render::{EvalStrategy, Frame, OverlaySettings, Renderer, Slot};
use isolith::scene::{
    Environment, EnvironmentKind, Falloff, Light, LightKind, Material, MaterialId, Node, NodeKind, Object,
    ReflectionModel, Scene, Shadowing, Shape,
};

use crate::gpu::{BenchScene, shared};

/// A scene of the gallery with shadows and occlusion.
fn shaded(name: &str) -> BenchScene {
    let mut scene = gallery::all().into_iter().find(|(other, _)| *other == name).expect("it is shipped").1;
    scene.environment.shadowing = Shadowing::default();
    BenchScene::new(name, &scene, None)
}

/// The same scene without shadows and occlusion.
fn unshaded(scene: &BenchScene) -> BenchScene {
    let mut flat = scene.flat.clone();
    flat.environment.shadowing = Shadowing::off();
    BenchScene { name: scene.name.clone(), flat, meshes: scene.meshes.clone(), camera: scene.camera }
}

/// Mean difference of the colors of two pictures, and the share of pixels that differ by more than 12 of 255.
fn differences(a: &GBuffer, b: &GBuffer) -> [f64; 2] {
    let (mut sum, mut far) = (0.0, 0.0);
    for (a, b) in a.color.iter().zip(&b.color) {
        let most = (0..3).map(|i| a[i].abs_diff(b[i])).max().unwrap_or(0);
        sum += f64::from(most);
        far += f64::from(u8::from(most > 12));
    }
    [sum, far].map(|sum| sum / a.color.len() as f64)
}

#[test]
fn pictures_have_the_shadows_of_the_reference() {
    for (name, side) in [("shadows", 72), ("random-37", 48), ("random-145", 32)] {
        let scene = shaded(name);
        let meshes = vec![None; scene.flat.meshes.len()];
        let reference = render_reference(&scene.flat, &meshes, &scene.camera, [side; 2], &|_| ()).unwrap().buffers;
        for strategy in [EvalStrategy::Interpreter, EvalStrategy::Tape] {
            let drawn = scene.render(side, strategy);
            let [mean, far] = differences(&drawn, &reference);
            println!("{name} {strategy:?}: mean {mean:.2} of 255, {far:.4} far off");
            // A pixel at an edge may show another surface.
            assert!(mean < 1.5 && far < 0.03, "{name} {strategy:?}: mean {mean}, {far} far off");
        }
        let without = unshaded(&scene);
        let [mean, _] = differences(&without.render(side, EvalStrategy::Interpreter), &reference);
        assert!(mean > 3.0, "{name}: without shadows it looks the same");
    }
}

#[test]
fn meshes_and_fields_occlude_each_other() {
    let side = 48;
    let mut scene = crate::gpu::scenes().find(|scene| scene.name == "mesh-and-fields").expect("it is shipped");
    scene.flat.environment.shadowing = Shadowing { shadows: false, ..Shadowing::default() };
    let reference = |scene: &BenchScene| {
        render_reference(&scene.flat, &scene.meshes, &scene.camera, [side; 2], &|_| ()).unwrap().buffers
    };
    let of_both = reference(&scene);
    let [mean, far] = differences(&scene.render(side, EvalStrategy::Tape), &of_both);
    println!("mean {mean:.2} of 255, {far:.4} far off");
    assert!(mean < 1.5 && far < 0.03, "mean {mean}, {far} far off");
    // Fields and meshes without occlusion are lighter, both of them; and fields are lighter without that by meshes.
    let without = reference(&unshaded(&scene));
    let darker = |a: &GBuffer, b: &GBuffer, is_mesh: bool| {
        let pixels = (0..a.leaf.len()).filter(|i| a.leaf[*i] != NO_LEAF && a.leaf[*i] == b.leaf[*i]);
        let of_kind = pixels.filter(|i| (a.leaf[*i] & MESH_BIT != 0) == is_mesh);
        of_kind.filter(|i| a.color[*i][1].saturating_add(4) < b.color[*i][1]).count()
    };
    let counts = [darker(&of_both, &without, false), darker(&of_both, &without, true)];
    assert!(counts.iter().all(|count| *count > 40), "{counts:?} pixels");
    let mut ghosts = BenchScene { name: scene.name.clone(), flat: scene.flat.clone(), ..unshaded(&scene) };
    ghosts.meshes.iter_mut().for_each(|mesh| *mesh = None);
    let alone = reference(&ghosts);
    assert!(darker(&of_both, &alone, false) > 20, "fields beside meshes");
}

#[test]
fn meshes_and_fields_cast_shadows_on_each_other() {
    let side = 64;
    let mut scene = crate::gpu::scenes().find(|scene| scene.name == "mesh-and-fields").expect("it is shipped");
    scene.flat.environment.shadowing = Shadowing { occlusion: false, ..Shadowing::default() };
    let of = |meshes| render_reference(&scene.flat, meshes, &scene.camera, [side; 2], &|_| ()).unwrap().buffers;
    let reference = of(&scene.meshes);
    let drawn = scene.render(side, EvalStrategy::Tape);
    let [mean, far] = differences(&drawn, &reference);
    println!("mean {mean:.2} of 255, {far:.4} far off");
    assert!(mean < 1.5 && far < 0.03, "mean {mean}, {far} far off");
    // The same picture without these shadows is another one: on the fields below the meshes, and on the meshes.
    let without = unshaded(&scene).render(side, EvalStrategy::Tape);
    let darker = |is_mesh: bool| {
        let pixels = (0..reference.leaf.len()).filter(|i| drawn.leaf[*i] != NO_LEAF);
        let of_kind = pixels.filter(|i| (drawn.leaf[*i] & MESH_BIT != 0) == is_mesh);
        of_kind.filter(|i| drawn.color[*i][1].saturating_add(12) < without.color[*i][1]).count()
    };
    assert!(darker(false) > 40 && darker(true) > 40, "{} and {} pixels", darker(false), darker(true));
}

/// A ball and a box over a floor, lit by a lamp alone.
fn ball_and_box() -> BenchScene {
    let mut scene = Scene::new();
    scene.environment = Environment::sky([0.0; 3], [0.0; 3], [0.0; 3]);
    scene.environment.shadowing = Shadowing { occlusion: false, ..Shadowing::default() };
    let white = Material {
        model: ReflectionModel::BlinnPhong { specular: 0.0, shininess: 1.0 },
        ..Material::new(MaterialId(9), "White", [1.0; 3])
    };
    scene.insert_material(white).unwrap();
    let mut add = |shape, at| {
        let object = Object { shape, material: MaterialId(9) };
        scene.insert(None, usize::MAX, Node::new("Object", NodeKind::Object(object)).at(at)).unwrap();
    };
    add(Shape::Plane {}, DVec3::ZERO);
    add(Shape::Sphere { radius: 0.5 }, DVec3::new(0.0, 0.8, 0.0));
    add(Shape::Box { size: DVec3::new(0.6, 0.5, 0.6).to_array(), rounding: 0.0 }, DVec3::new(0.9, 0.25, 0.3));
    let falloff = Falloff::Attenuation { constant: 1.0, linear: 0.0, quadratic: 0.0, range: 100.0 };
    let power = 0.9 * 4.0 * PI * PI;
    let light = Light::new(LightKind::Point { power, radius: 0.1, falloff });
    scene.insert(None, 0, Node::new("Lamp", NodeKind::Light(light)).at(DVec3::new(-0.7, 1.9, 0.5))).unwrap();
    let flat = flatten(&scene, 0.0).unwrap();
    let camera = Camera::looking_at(DVec3::new(0.4, 2.4, 3.4), DVec3::new(0.3, 0.3, 0.0), 0.75);
    BenchScene { name: "ball and box".into(), flat, meshes: Vec::new(), camera }
}

/// The same scene under the same light from everywhere, with occlusion and without the lamp.
fn in_white_light() -> BenchScene {
    let mut scene = ball_and_box();
    scene.flat.lights.clear();
    let mut white = Scene::new();
    let background = EnvironmentKind::Color { color: [1.0; 3] };
    let shadowing = Shadowing { shadows: false, occlusion: true, occlusion_strength: 1.0, ..Shadowing::default() };
    white.set_environment(Environment { background, shadowing }).unwrap();
    let lit = flatten(&white, 0.0).unwrap();
    (scene.flat.environment, scene.flat.environment_map) = (lit.environment, lit.environment_map);
    scene
}

/// The visible share of the environment at the place of a sample, and 1 if there is a surface.
fn true_share(scene: &BenchScene, evaluator: &mut SceneEvaluator<'_>, [x, y]: [u32; 2], index: u32) -> [f64; 2] {
    let BenchScene { flat, camera, .. } = scene;
    let place = DVec2::new(x.into(), y.into()) + 0.5 + pixel_jitter(index);
    let ray = camera.ray(place, DVec2::splat(SIDE.into()));
    let Some(hit) = evaluator.ray(&ray, RayLimits { near: camera.near, far: camera.far }).unwrap() else {
        return [0.0; 2];
    };
    let component = &flat.components[hit.component as usize];
    let point = ray.at(hit.t);
    let normal = gradient(flat, component, point - component.origin).1.normalize();
    let start = surface_ray(point, normal, normal, camera.footprint(SIDE.into()) * hit.t);
    let radius = flat.environment.shadowing.occlusion_radius;
    let mut is_free = |i: u32| {
        let direction = occlusion_ray(normal, place_of(i, index));
        let ray = Ray { origin: start.origin, direction };
        evaluator.ray(&ray, RayLimits { near: 0.0, far: radius }).unwrap().is_none()
    };
    [(0..RAYS).filter(|i| is_free(*i)).count() as f64 / f64::from(RAYS), 1.0]
}

/// The light of a white surface under the lamp alone: what arrives at the place of a sample, and what would without
/// shadows.
fn true_light(scene: &BenchScene, evaluator: &mut SceneEvaluator<'_>, [x, y]: [u32; 2], index: u32) -> [f64; 2] {
    let BenchScene { flat, camera, .. } = scene;
    let light = gpu_lights(flat, camera, [SIDE; 2])[0];
    let place = DVec2::new(x.into(), y.into()) + 0.5 + pixel_jitter(index);
    let ray = camera.ray(place, DVec2::splat(SIDE.into()));
    let Some(hit) = evaluator.ray(&ray, RayLimits { near: camera.near, far: camera.far }).unwrap() else {
        return [0.0; 2];
    };
    let component = &flat.components[hit.component as usize];
    let (point, position) = (ray.at(hit.t), ray.direction * hit.t);
    let normal = gradient(flat, component, point - component.origin).1.normalize();
    let Some((to_light, distance)) = light_toward(&light, position) else { return [0.0; 2] };
    let whole = normal.dot(to_light).max(0.0);
    if whole == 0.0 {
        return [0.0; 2];
    }
    let footprint = camera.footprint(SIDE.into()) * hit.t;
    let start = surface_ray(point, normal, to_light, footprint);
    let cone = ShadowCone::new(start.origin, to_light, distance, light_extent(&light), footprint);
    // Proofs save rays; the test of cones says that they hold.
    let found = shadow_share(evaluator, &cone);
    let seen = match found.proof {
        ShadowProof::None => {
            let seen = (0..RAYS).filter(|i| light_is_seen(evaluator, &cone, place_of(*i, index)).unwrap());
            seen.count() as f64 / f64::from(RAYS)
        }
        _ => found.share,
    };
    [whole * seen, whole]
}

/// Rays for the light at one place.
const RAYS: u32 = 24;
/// Samples of the still picture.
const SAMPLES: u32 = 256;

/// The place of a ray of one sample: all rays of all samples together cover the disc evenly.
fn place_of(ray: u32, sample: u32) -> [f64; 2] {
    disc_spiral(ray * SAMPLES + sample, RAYS * SAMPLES)
}

/// Side of the still picture.
const SIDE: u32 = 20;

/// Light of a place by the reference, and what it would be with nothing in the way.
type TrueLight = fn(&BenchScene, &mut SceneEvaluator<'_>, [u32; 2], u32) -> [f64; 2];

#[test]
fn still_shadows_converge_to_the_truth() {
    // The lamp's intensity is 0.9.
    still_converges(&ball_and_box(), true_light, 0.9, [0.002, 0.02]);
}

#[test]
fn still_occlusion_converges_to_the_truth() {
    still_converges(&in_white_light(), true_share, 1.0, [0.006, 0.02]);
}

/// Compares a still of 256 samples with the truth; `limits` of the mean error and the 99th percentile.
fn still_converges(scene: &BenchScene, true_light: TrueLight, whole: f64, limits: [f64; 2]) {
    let mut evaluator = SceneEvaluator::new(&scene.flat);
    let pixels = (0..SIDE * SIDE).map(|i| [i % SIDE, i / SIDE]);
    let truth: Vec<[f64; 2]> = pixels
        .map(|pixel| {
            let samples = (0..SAMPLES).map(|index| true_light(scene, &mut evaluator, pixel, index));
            samples.fold([0.0; 2], |sum, one| [sum[0] + one[0], sum[1] + one[1]]).map(|sum| sum / f64::from(SAMPLES))
        })
        .collect();
    let renderer = &mut shared().renderer;
    renderer.set_strategy(EvalStrategy::Interpreter);
    let none = OverlaySettings::default();
    let mut frame = renderer.begin(Slot::Full, &scene.flat, &[], &scene.camera, [SIDE; 2], none).unwrap();
    renderer.accumulate(&mut frame, false);
    let errors_after = |renderer: &mut Renderer, frame: &mut Frame| {
        while !frame.is_done() {
            renderer.advance(frame, Duration::ZERO).unwrap();
        }
        let radiance = renderer.read_radiance(frame).unwrap();
        let lit = radiance.iter().zip(&truth).filter(|(_, truth)| truth[1] > 0.2);
        let mut errors: Vec<_> =
            lit.map(|(found, truth)| (f64::from(found[0]) / whole - truth[0]).abs() / truth[1]).collect();
        errors.sort_by(f64::total_cmp);
        (errors.iter().sum::<f64>() / errors.len() as f64, errors[errors.len() * 99 / 100], errors.len())
    };
    for _ in 1..SAMPLES {
        errors_after(renderer, &mut frame);
        renderer.next_sample(&mut frame).unwrap();
    }
    let (mean, p99, count) = errors_after(renderer, &mut frame);
    let partly = truth.iter().filter(|[lit, whole]| *whole > 0.2 && (0.01..0.99).contains(&(lit / whole))).count();
    println!("{SAMPLES} samples: mean {mean:.4}, p99 {p99:.4} of {count} pixels, {partly} of them partly lit");
    assert!(mean <= limits[0] && p99 <= limits[1] && partly > 20, "mean {mean}, p99 {p99}, {partly} pixels partly lit");
}

/// Seconds of visibility and of shadows with occlusion in the best of some frames.
fn seconds(scene: &BenchScene, side: u32) -> [f64; 2] {
    let mut best = [f64::INFINITY; 2];
    let renderer = &mut shared().renderer;
    renderer.set_strategy(EvalStrategy::Auto);
    renderer.set_timing(true);
    for _ in 0..8 {
        let picture = renderer.render(&scene.flat, &scene.meshes, &scene.camera, [side, side], &mut |_| true);
        assert!(picture.unwrap().1.is_empty(), "{}: warnings", scene.name);
        let of = |labels: &[&str]| {
            let rows = renderer.timings().unwrap_or(&[]).iter();
            rows.filter(|row| labels.contains(&row.label)).map(|row| row.seconds).sum::<f64>()
        };
        let now = [of(&["cone", "trace", "surface"]), of(&["shadow"])];
        best = [best[0].min(now[0]), best[1].min(now[1])];
        while renderer.is_preparing() {
            renderer.prewarm_pipelines(&scene.flat, &scene.camera, std::time::Duration::from_secs(1)).unwrap();
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
    }
    renderer.set_timing(false);
    best
}

/// Figures; the gate is wide, for times scatter on a busy machine.
/// A name, and what it changes.
type Change = (&'static str, fn(&mut Shadowing));

#[test]
fn shadows_cost_a_few_times_what_visibility_costs() {
    const SIDE: u32 = 160;
    for name in ["shadows", "random-145", "random-577"] {
        let mut ratios = Vec::new();
        let changes: [Change; 5] = [
            ("all", |_| ()),
            ("shadows", |s| s.occlusion = false),
            ("occlusion", |s| s.shadows = false),
            ("low", |s| (s.occlusion, s.shadow_quality) = (false, 1.0)),
            ("high", |s| (s.occlusion, s.shadow_quality) = (false, 3.0)),
        ];
        for (what, change) in changes {
            let mut scene = shaded(name);
            scene.flat.lights.truncate(1);
            change(&mut scene.flat.environment.shadowing);
            let [visibility, shadow] = seconds(&scene, SIDE);
            println!("{name} {what}: visibility {:.1} ms, shadow {:.1} ms", visibility * 1e3, shadow * 1e3);
            ratios.push(shadow / visibility);
        }
        if name != "random-577" {
            let mut scene = shaded(name);
            let sun = scene.flat.lights[0].clone();
            let turned = |i: i32| DQuat::from_rotation_y(0.37 * f64::from(i)) * sun.direction;
            scene.flat.lights = (0..16).map(|i| FlatLight { direction: turned(i), ..sun.clone() }).collect();
            scene.flat.environment.shadowing.occlusion = false;
            let [visibility, shadow] = seconds(&scene, SIDE);
            println!("{name} 16 suns: {:.2} times visibility", shadow / visibility);
        }
        println!("{name}: {ratios:.2?} times visibility");
        assert!(ratios.iter().all(|ratio| *ratio < 60.0), "{name}: {ratios:?}");
    }
}
