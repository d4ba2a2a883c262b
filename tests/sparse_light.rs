//! Shadows and occlusion of some pixels, as a window has them while something moves.

#![allow(clippy::print_stdout, reason = "the figures are for whoever runs this with `--nocapture`")]

use std::time::Duration;

use isolith::field::{GBuffer, flatten};
use isolith::gallery;
use isolith::geometry::Lens;
use isolith::render::{EvalStrategy, Film, OverlaySettings, Renderer, Slot};
use isolith::scene::{LightKind, NodeKind, Scene, Shadowing};

use crate::gpu::{BenchScene, shared};

/// A scene with occlusion and a sun of 4 degrees, and with so many lamps around it.
fn sunny(name: &str, lamps: u32) -> BenchScene {
    let mut scene = gallery::all().into_iter().find(|(known, _)| *known == name).expect("it is shipped").1;
    scene.environment.shadowing = Shadowing::default();
    let lights: Vec<_> = scene.nodes().iter().filter(|node| matches!(node.kind, NodeKind::Light(_))).cloned().collect();
    lights.iter().for_each(|node| drop(scene.remove(node.id).expect("it is there")));
    let sun = isolith::scene::Light { light: LightKind::Sun { strength: 3.0, angle: 4.0 }, ..Default::default() };
    let turn = glam::DQuat::from_rotation_y(0.7) * glam::DQuat::from_rotation_x(-0.8);
    let node = isolith::scene::Node::new("Sun", NodeKind::Light(sun)).rotated(turn);
    scene.insert(None, usize::MAX, node).expect("valid");
    for i in 0..lamps {
        let falloff = isolith::scene::Falloff::InverseSquare {};
        let lamp = LightKind::Point { power: 40.0, radius: 0.1, falloff };
        let light = isolith::scene::Light { light: lamp, ..Default::default() };
        let (sine, cosine) = (f64::from(i) * std::f64::consts::TAU / f64::from(lamps)).sin_cos();
        let node = isolith::scene::Node::new("Lamp", NodeKind::Light(light)).at([6.0 * cosine, 5.0, 6.0 * sine].into());
        scene.insert(None, usize::MAX, node).expect("valid");
    }
    of(name, &scene)
}

fn of(name: &str, scene: &Scene) -> BenchScene {
    let flat = flatten(scene, 0.0).expect("within the limits");
    let camera = flat.default_camera(&[], 1.0);
    BenchScene { name: name.into(), flat, meshes: Vec::new(), camera }
}

/// The picture, and the seconds of visibility, of `shadow` and of `shade`; the least of several.
fn picture(scene: &BenchScene, side: u32, sparse: bool, strategy: EvalStrategy) -> (GBuffer, [f64; 3]) {
    let renderer = &mut shared().renderer;
    renderer.set_strategy(strategy);
    renderer.set_sparse_light(sparse);
    renderer.set_timing(true);
    let mut least = [f64::INFINITY; 3];
    let mut buffers = None;
    for _ in 0..3 {
        let drawn = renderer.render(&scene.flat, &scene.meshes, &scene.camera, [side, side], &mut |_| true);
        buffers = Some(drawn.unwrap_or_else(|error| panic!("{error}")).0);
        let Some(rows) = renderer.timings() else { continue };
        let of = |names: &[&str]| -> f64 {
            rows.iter().filter(|row| names.contains(&row.label)).map(|row| row.seconds).sum()
        };
        let now = [of(&["cone", "trace", "surface"]), of(&["shadow"]), of(&["shade"])];
        least = [0, 1, 2].map(|i| least[i].min(now[i]));
        while renderer.is_preparing() {
            renderer.prewarm_pipelines(&scene.flat, &scene.camera, Duration::from_secs(1)).expect("pipelines");
            std::thread::sleep(Duration::from_millis(5));
        }
    }
    renderer.set_sparse_light(false);
    renderer.set_timing(false);
    (buffers.expect("drawn"), least)
}

/// Evaluations of fields per pixel: by rays and cones for visibility, without normals, and for shadows and occlusion.
fn evaluations(renderer: &mut Renderer, scene: &BenchScene, side: u32, sparse: bool) -> [f64; 2] {
    renderer.set_sparse_light(sparse);
    let marks = OverlaySettings::default();
    let begun = renderer.begin(Slot::Full, &scene.flat, &scene.meshes, &scene.camera, [side; 2], marks);
    let mut frame = begun.expect("a frame");
    renderer.advance(&mut frame, Duration::MAX).expect("a picture");
    let counts = renderer.pixel_counts(&frame).expect("counts");
    let places = (0..side).flat_map(|y| (0..side).map(move |x| (x, y)));
    let seen: f64 = places.map(|(x, y)| counts.with_cones(x, y, |one| one.evaluations)).sum();
    [seen, frame.shadow_evaluations() as f64].map(|count| count / f64::from(side * side))
}

fn mean_difference(a: &GBuffer, b: &GBuffer) -> f64 {
    let off = a.color.iter().zip(&b.color).map(|(a, b)| (0..3).map(|c| f64::from(a[c].abs_diff(b[c]))).sum::<f64>());
    off.sum::<f64>() / (255.0 * 3.0 * a.color.len() as f64)
}

/// Gates are differences and counts; times are for whoever reads them.
#[test]
fn light_of_few_pixels_is_nearly_that_of_all_for_less_work() {
    const SIDE: u32 = 160;
    let gpu = shared().gpu.clone();
    let mut counting = Renderer::counting(&gpu).expect("a renderer");
    for (name, lamps, most) in
        [("shadows", 0, 0.2), ("random-145", 0, 0.2), ("random-577", 0, 0.2), ("random-145", 15, 0.1)]
    {
        let scene = sunny(name, lamps);
        let (full, [primary, shadow, shade]) = picture(&scene, SIDE, false, EvalStrategy::Tape);
        let (sparse, [_, few_shadows, few_shade]) = picture(&scene, SIDE, true, EvalStrategy::Tape);
        let off = mean_difference(&full, &sparse);
        println!(
            "{name}, {lamps} lamps: off by {off:.4}; visibility {:.2} ms, of it {:.2} for shadows and {:.2} for shading, \
             of few pixels {:.2} and {:.2}",
            primary * 1e3,
            shadow / primary,
            shade / primary,
            few_shadows / primary,
            few_shade / primary
        );
        let [seen, all] = evaluations(&mut counting, &scene, SIDE, false);
        let [_, few] = evaluations(&mut counting, &scene, SIDE, true);
        println!(
            "{name}, {lamps} lamps: evaluations per pixel {seen:.2} for visibility, {all:.2} for light, of few {few:.2}"
        );
        assert!(off > 0.0 && off < 0.02, "{name}: {off}");
        assert!(all > 1.0 && few < most * all, "{name}: {few} of {all} evaluations");
        assert_eq!((&full.depth, &full.normal, &full.leaf), (&sparse.depth, &sparse.normal, &sparse.leaf));
    }
}

/// In evaluations, which no other program on the machine changes.
#[test]
fn the_finest_shadows_cost_at_most_twice_the_coarsest() {
    let gpu = shared().gpu.clone();
    let mut counting = Renderer::counting(&gpu).expect("a renderer");
    for name in ["shadows", "random-145", "random-577"] {
        let mut scene = sunny(name, 0);
        scene.flat.environment.shadowing.occlusion = false;
        let [low, high] = [1.0, 3.0].map(|quality| {
            scene.flat.environment.shadowing.shadow_quality = quality;
            evaluations(&mut counting, &scene, 96, true)[1]
        });
        println!("{name}: evaluations per pixel {low:.3} and {high:.3}, {:.2} times", high / low);
        assert!(low > 0.0 && high >= low && high <= 2.0 * low, "{name}: {low} and {high}");
    }
}

/// What each part of light costs, for the table in `benches`: it takes a minute.
#[test]
fn parts_of_light_are_measured() {
    if std::env::var_os("ISOLITH_MEASURE_LIGHT").is_none() {
        return;
    }
    let gpu = shared().gpu.clone();
    let mut counting = Renderer::counting(&gpu).expect("a renderer");
    for name in ["shadows", "random-145", "random-577"] {
        for (what, shadows, occlusion) in
            [("neither", false, false), ("sun", true, false), ("occlusion", false, true), ("both", true, true)]
        {
            let mut scene = sunny(name, 0);
            let shadowing = &mut scene.flat.environment.shadowing;
            (shadowing.shadows, shadowing.occlusion) = (shadows, occlusion);
            for sparse in [false, true] {
                let [_, light] = evaluations(&mut counting, &scene, 160, sparse);
                for strategy in [EvalStrategy::Tape, EvalStrategy::Auto] {
                    let [visibility, shadow, shade] = picture(&scene, 160, sparse, strategy).1;
                    println!(
                        "{name}, {what}, sparse {sparse}, {strategy:?}: visibility {:.2} ms, shadow {:.2}, shade {:.2} \
                         times that, {light:.2} evaluations",
                        visibility * 1e3,
                        shadow / visibility,
                        shade / visibility
                    );
                }
            }
        }
    }
}

#[test]
fn samples_have_the_light_of_every_pixel() {
    let scene = sunny("shadows", 0);
    let still = |sparse: bool| {
        let renderer = &mut crate::gpu::shared().renderer;
        renderer.set_strategy(EvalStrategy::Tape);
        renderer.set_sparse_light(sparse);
        let film = Film { samples: 2, is_transparent: false, lens: Lens::default() };
        let drawn = renderer.render_samples(film, &scene.flat, &[], &scene.camera, [48, 48], &mut |_| true);
        renderer.set_sparse_light(false);
        drawn.unwrap_or_else(|error| panic!("{error}")).0.radiance
    };
    assert!(still(true) == still(false));
    // As a window draws: a picture while something moves, then its samples.
    let mut shared = shared();
    let renderer = &mut shared.renderer;
    renderer.set_strategy(EvalStrategy::Tape);
    renderer.set_sparse_light(true);
    let marks = OverlaySettings::default();
    let mut frame = renderer.begin(Slot::Full, &scene.flat, &[], &scene.camera, [48, 48], marks).expect("a frame");
    renderer.advance(&mut frame, Duration::MAX).expect("a picture");
    renderer.accumulate(&mut frame, false);
    renderer.advance(&mut frame, Duration::MAX).expect("a sample");
    renderer.next_sample(&mut frame).expect("another");
    renderer.advance(&mut frame, Duration::MAX).expect("a sample");
    renderer.set_sparse_light(false);
    let shown = renderer.read_radiance(&frame).expect("the light");
    drop(shared);
    assert!(shown == still(false));
}
