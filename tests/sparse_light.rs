//! Shadows and occlusion of every second pixel along each axis, as a window has them while something moves.

#![allow(clippy::print_stdout, reason = "the figures are for whoever runs this with `--nocapture`")]

use std::time::Duration;

use isolith::field::{GBuffer, flatten};
use isolith::gallery;
use isolith::geometry::Lens;
use isolith::render::{EvalStrategy, Film, OverlaySettings, Slot};
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

/// The picture, and the time of passes `cone`, `trace` and `surface`, and of `shadow` and `shade`; the least of several.
fn picture(scene: &BenchScene, side: u32, sparse: bool) -> (GBuffer, [Duration; 2]) {
    let renderer = &mut shared().renderer;
    renderer.set_strategy(EvalStrategy::Tape);
    renderer.set_sparse_light(sparse);
    renderer.set_timing(true);
    let mut least = [Duration::MAX; 2];
    let mut buffers = None;
    for _ in 0..3 {
        let drawn = renderer.render(&scene.flat, &scene.meshes, &scene.camera, [side, side], &mut |_| true);
        buffers = Some(drawn.unwrap_or_else(|error| panic!("{error}")).0);
        let Some(rows) = renderer.timings() else { continue };
        let of = |names: &[&str]| {
            let seconds: f64 = rows.iter().filter(|row| names.contains(&row.label)).map(|row| row.seconds).sum();
            Duration::from_secs_f64(seconds)
        };
        let now = [of(&["cone", "trace", "surface"]), of(&["shadow", "shade"])];
        least = [0, 1].map(|i| least[i].min(now[i]));
    }
    renderer.set_sparse_light(false);
    renderer.set_timing(false);
    (buffers.expect("drawn"), least)
}

fn mean_difference(a: &GBuffer, b: &GBuffer) -> f64 {
    let off = a.color.iter().zip(&b.color).map(|(a, b)| (0..3).map(|c| f64::from(a[c].abs_diff(b[c]))).sum::<f64>());
    off.sum::<f64>() / (255.0 * 3.0 * a.color.len() as f64)
}

#[test]
fn light_of_every_second_pixel_is_nearly_that_of_all_and_quicker() {
    for (name, lamps) in [("shadows", 0), ("random-145", 0), ("random-577", 0), ("random-145", 15)] {
        let scene = sunny(name, lamps);
        let (full, [primary, of_full]) = picture(&scene, 160, false);
        let (sparse, [_, of_sparse]) = picture(&scene, 160, true);
        let off = mean_difference(&full, &sparse);
        let share = |time: Duration| time.as_secs_f64() / primary.as_secs_f64();
        println!(
            "{name}, {lamps} lamps: off by {off:.4}; visibility {primary:?}, light {:.2} and {:.2} times",
            share(of_full),
            share(of_sparse)
        );
        assert!(off > 0.0 && off < 0.02, "{name}: {off}");
        // Other programs on the machine may take any time.
        let is_quicker = (0..4).any(|_| picture(&scene, 160, true).1[1] < of_full);
        assert!(of_sparse < of_full || is_quicker, "{name}: {of_sparse:?} after {of_full:?}");
        assert_eq!((&full.depth, &full.normal, &full.leaf), (&sparse.depth, &sparse.normal, &sparse.leaf));
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
