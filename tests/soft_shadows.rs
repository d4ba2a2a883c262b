//! Shadows and occlusion in pictures, against the reference and against many rays.

#![allow(clippy::print_stdout, reason = "the figures are for whoever runs this with `--nocapture`")]

use glam::{DVec2, DVec3};
use isolith::field::light::display::display_decode;
use isolith::field::light::shadow::{ShadowCone, light_extent, light_toward, shadow_by_rays};
use isolith::field::reference::image::render_reference;
use isolith::field::scene_eval::{SceneEvaluator, surface_ray};
use isolith::field::{GBuffer, flatten, gpu_lights};
use isolith::gallery;
use isolith::geometry::Camera;
use isolith::render::EvalStrategy;
use isolith::scene::{
    Attenuation, Light, LightKind, Material, MaterialId, Node, NodeKind, Object, ReflectionModel, Scene, Shading, Shape,
};

use crate::gpu::{BenchScene, shared};

/// A scene of the gallery with shadows and occlusion.
fn shaded(name: &str) -> BenchScene {
    let mut scene = gallery::all().into_iter().find(|(other, _)| *other == name).expect("it is shipped").1;
    scene.environment.shading = Shading::default();
    BenchScene::new(name, &scene, None)
}

/// The same scene without shadows and occlusion.
fn unshaded(scene: &BenchScene) -> BenchScene {
    let mut flat = scene.flat.clone();
    flat.environment.shading = Shading::off();
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

/// A ball and a box over a floor, lit by a lamp alone.
fn ball_and_box() -> BenchScene {
    let mut scene = Scene::new();
    scene.environment.ambient = [0.0; 3];
    scene.environment.sky = [0.0; 3];
    scene.environment.horizon = [0.0; 3];
    scene.environment.shading = Shading { occlusion: false, ..Shading::default() };
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
    let attenuation = Attenuation { constant: 1.0, linear: 0.0, quadratic: 0.0, range: 100.0 };
    let light = Light { color: [1.0; 3], intensity: 0.9, light: LightKind::Point { attenuation } };
    scene.insert(None, 0, Node::new("Lamp", NodeKind::Light(light)).at(DVec3::new(-0.7, 1.9, 0.5))).unwrap();
    let flat = flatten(&scene, 0.0).unwrap();
    let camera = Camera::looking_at(DVec3::new(0.4, 2.4, 3.4), DVec3::new(0.3, 0.3, 0.0), 0.75);
    BenchScene { name: "ball and box".into(), flat, meshes: Vec::new(), camera }
}

/// The visible share of the lamp in each pixel by many rays; `None` where it hardly lights.
fn true_shares(scene: &BenchScene, drawn: &GBuffer, side: u32) -> Vec<Option<f64>> {
    let BenchScene { flat, camera, .. } = scene;
    let light = gpu_lights(flat, camera)[0];
    let mut evaluator = SceneEvaluator::new(flat);
    let size = DVec2::splat(side.into());
    let share = |i: u32| {
        let (x, y) = (i % side, i / side);
        let depth = f64::from(drawn.depth[i as usize]);
        let ray = camera.ray(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5), size);
        let position = ray.direction * depth;
        let normal = DVec3::from(drawn.normal[i as usize].map(f64::from));
        let (to_light, distance) = light_toward(&light, position).filter(|_| depth < 1e9)?;
        if normal.dot(to_light) < 0.2 {
            return None;
        }
        let footprint = camera.footprint(side.into()) * depth;
        let start = surface_ray(camera.position + position, normal, to_light, footprint);
        let cone = ShadowCone::new(start.origin, to_light, distance, light_extent(&light), footprint);
        Some(shadow_by_rays(&mut evaluator, &cone, 768).unwrap())
    };
    (0..side * side).map(share).collect()
}

#[test]
fn still_pictures_converge_to_the_truth() {
    const SIDE: u32 = 28;
    const SAMPLES: u32 = 256;
    let scene = ball_and_box();
    let lit = unshaded(&scene);
    let linear = |buffers: &GBuffer| -> Vec<f64> {
        let decode = |c: &[u8; 4]| display_decode(DVec3::splat(f64::from(c[0]) / 255.0)).x;
        buffers.color.iter().map(decode).collect()
    };
    let whole = lit.render(SIDE, EvalStrategy::Interpreter);
    let truth = true_shares(&scene, &whole, SIDE);
    let whole = linear(&whole);
    let error_of = |sum: &[f64], count: f64| {
        let shares = sum.iter().zip(&whole).zip(&truth);
        let errors = shares.filter_map(|((sum, whole), truth)| Some((sum / count / whole - (*truth)?).abs()));
        let mut errors: Vec<f64> = errors.collect();
        errors.sort_by(f64::total_cmp);
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        [mean, errors[errors.len() * 99 / 100], errors.len() as f64]
    };
    let [mean, p99, _] = error_of(&linear(&scene.render(SIDE, EvalStrategy::Interpreter)), 1.0);
    println!("cones alone: mean {mean:.4}, p99 {p99:.4}");
    assert!(mean <= 0.02, "{mean}");
    let mut sum = vec![0.0; whole.len()];
    for sample in 1..=SAMPLES {
        shared().renderer.set_sample(sample);
        let one = linear(&scene.render(SIDE, EvalStrategy::Interpreter));
        sum.iter_mut().zip(&one).for_each(|(sum, one)| *sum += one);
    }
    shared().renderer.set_sample(0);
    let [mean, p99, count] = error_of(&sum, SAMPLES.into());
    let penumbra = truth.iter().flatten().filter(|share| (0.01..0.99).contains(*share)).count();
    println!("{SAMPLES} samples: mean {mean:.4}, p99 {p99:.4} of {count} pixels, {penumbra} of them in penumbras");
    assert!(p99 <= 0.02 && penumbra > 20, "p99 {p99}, {penumbra} pixels in penumbras");
}

/// Seconds of visibility and of shadows with occlusion in the best of some frames.
fn seconds(scene: &BenchScene, side: u32) -> [f64; 2] {
    let mut best = [f64::INFINITY; 2];
    let renderer = &mut shared().renderer;
    renderer.set_strategy(EvalStrategy::Auto);
    renderer.set_timing(true);
    for _ in 0..12 {
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
#[test]
fn shadows_cost_a_few_times_what_visibility_costs() {
    const SIDE: u32 = 160;
    for name in ["shadows", "random-145", "random-577"] {
        let mut ratios = Vec::new();
        let changes: [(&str, fn(&mut Shading)); 5] = [
            ("all", |_| ()),
            ("shadows", |s| s.occlusion = false),
            ("occlusion", |s| s.shadows = false),
            ("low", |s| (s.occlusion, s.shadow_quality) = (false, 1.0)),
            ("high", |s| (s.occlusion, s.shadow_quality) = (false, 3.0)),
        ];
        for (what, change) in changes {
            let mut scene = shaded(name);
            scene.flat.lights.truncate(1);
            change(&mut scene.flat.environment.shading);
            let [visibility, shadow] = seconds(&scene, SIDE);
            println!("{name} {what}: visibility {:.1} ms, shadow {:.1} ms", visibility * 1e3, shadow * 1e3);
            ratios.push(shadow / visibility);
        }
        println!("{name}: {ratios:.2?} times visibility");
        assert!(ratios.iter().all(|ratio| *ratio < 40.0), "{name}: {ratios:?}");
    }
}
