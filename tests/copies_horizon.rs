//! Copies below a pixel: what they cost by their size in the picture, and how little they flicker.

#![allow(clippy::print_stdout, reason = "the figures are for whoever runs this with `--nocapture`")]

use std::ops::ControlFlow;
use std::time::Duration;

use glam::{DVec2, DVec3};

use isolith::field::RayLimits;
use isolith::field::copies::{CopyCone, copies_along};
use isolith::geometry::{Camera, Lens, Ray};
use isolith::render::{EvalStrategy, Film, OverlaySettings, Renderer, Slot};
use isolith::scene::{DynamicKind, Instancer, Lattice, Variation};
use isolith::wgsl::Options;

use crate::copies::{scene_of, varied};
use crate::gpu::{BenchScene, shared};

/// Width and height of the pictures, in pixels.
const SIDE: u32 = 48;
/// Angle of view from top to bottom, in radians.
const VIEW: f64 = 0.8;
/// How far the camera of a flight moves in a frame, in meters.
const FLIGHT_STEP: f64 = 0.02;
/// Sizes of copies in pixels, from their middle to their border, at which ranges begin.
const RANGES: [f64; 5] = [0.0, 0.125, 0.25, 0.5, 1.0];

/// Copies without end that move, and how large most of them are: small ones on a plane, or larger ones in all directions.
fn endless() -> [(BenchScene, f64); 2] {
    let meadow = Lattice::Grid { counts: [0, 1, 0], spacing: [0.5; 3] };
    let variation = Variation { scale_min: [0.2; 3], scale_max: [0.4; 3], ..varied() };
    let meadow = Instancer { lattice: meadow, variation, probability: 0.9, seed: 5, ..Instancer::default() };
    let space = Lattice::Grid { counts: [0; 3], spacing: [9.0; 3] };
    let space = Instancer { lattice: space, variation: varied(), probability: 0.2, seed: 5, ..Instancer::default() };
    let of =
        |name, copies: Instancer, dynamics: &[DynamicKind]| BenchScene::new(name, &scene_of(copies, dynamics), None);
    [
        (of("meadow", meadow, &[DynamicKind::Wind, DynamicKind::FractionalBrownianMotion]), 0.2),
        (of("space", space, &[DynamicKind::Orbit, DynamicKind::Spin]), 0.55),
    ]
}

/// The view of a flight at this height.
fn camera(height: f64, frame: u32) -> Camera {
    let eye = DVec3::new(0.3, height, 6.0 - FLIGHT_STEP * f64::from(frame));
    Camera { far: 4_000.0, ..Camera::looking_at(eye, eye + DVec3::new(0.1, -0.3, -1.0), VIEW) }
}

/// A renderer that counts.
fn counting() -> Renderer {
    let gpu = shared().gpu.clone();
    let options = Options { counting: true, ..Renderer::options(&gpu) };
    let mut renderer = Renderer::with_options(&gpu, options).expect("a renderer");
    renderer.set_strategy(EvalStrategy::Tape);
    renderer
}

/// What a ray looks at up to the second sphere that it meets: cells, copies there, those moved, spheres met.
fn walked(scene: &BenchScene, x: u32, y: u32) -> [f64; 4] {
    let pixel = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
    let ray = scene.camera.ray(pixel, DVec2::splat(SIDE.into()));
    let instancer = &scene.flat.instancers[0];
    let from_world = instancer.world_from_local.inverse();
    let axis =
        Ray { origin: from_world.transform_point3(ray.origin), direction: from_world.transform_vector3(ray.direction) };
    let limits = RayLimits { near: scene.camera.near, far: scene.camera.far };
    let mut met = 0;
    let work = copies_along(instancer, CopyCone { axis, limits, spread: 0.0 }, &mut |_, _| {
        met += 1;
        if met == 2 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    [work.cells, work.copies, work.moved, work.met].map(|count| count as f64)
}

/// Of each range of sizes the pixels that show a copy so large, and per pixel the evaluations of fields and what rays look at, see
/// [`walked`].
fn work_by_size(renderer: &mut Renderer, scene: &BenchScene, size: f64) -> [[f64; 6]; RANGES.len()] {
    let overlay = OverlaySettings::default();
    let begun = renderer.begin(Slot::Full, &scene.flat, &[], &scene.camera, [SIDE; 2], overlay);
    let mut frame = begun.expect("a frame");
    renderer.advance(&mut frame, Duration::MAX).expect("a picture");
    let counts = renderer.pixel_counts(&frame).expect("counts");
    let picture = renderer.read(&frame).expect("a picture");
    let footprint = scene.camera.footprint(f64::from(SIDE));
    let mut sums = [[0.0; 6]; RANGES.len()];
    for at in (0..SIDE * SIDE).filter(|at| picture.depth[*at as usize].is_finite()) {
        let (x, y) = (at % SIDE, at / SIDE);
        let shown = size / (f64::from(picture.depth[at as usize]) * footprint);
        let sum = &mut sums[RANGES.iter().rposition(|least| shown >= *least).unwrap_or(0)];
        sum[0] += 1.0;
        sum[1] += counts.with_cones(x, y, |one| one.evaluations);
        for (sum, more) in sum[2..].iter_mut().zip(walked(scene, x, y)) {
            *sum += more;
        }
    }
    for sum in &mut sums {
        let pixels = sum[0];
        sum[1..].iter_mut().for_each(|all| *all /= f64::max(pixels, 1.0));
    }
    for (least, sum) in RANGES.iter().zip(&sums).filter(|(_, sum)| sum[0] > 0.0) {
        println!("{}, {least} px and more: pixels, evaluations, cells, copies, moved, met {sum:.2?}", scene.name);
    }
    sums
}

/// Scenes that are measured: all with `ISOLITH_MEASURE_COPIES=all`.
fn measured() -> impl Iterator<Item = (BenchScene, f64)> {
    let is_whole = std::env::var("ISOLITH_MEASURE_COPIES").is_ok_and(|value| value == "all");
    endless().into_iter().take(if is_whole { 2 } else { 1 })
}

/// What is below a pixel takes no more evaluations than what is above, and few of the copies on the way are moved.
#[test]
fn copies_below_a_pixel_cost_no_more_evaluations_than_large_ones() {
    let mut renderer = counting();
    for (mut scene, size) in measured() {
        scene.camera = camera(1.5, 0);
        let near = work_by_size(&mut renderer, &scene, size)[RANGES.len() - 1];
        scene.camera = camera(20.0, 0);
        let far = work_by_size(&mut renderer, &scene, size)[0];
        assert!(near[0] > 100.0 && far[0] > 100.0, "{near:?}, {far:?}");
        assert!(far[1] < 1.2 * near[1], "{far:?} against {near:?}");
        assert!(far[4] < 0.5 * far[3], "{far:?}");
    }
}

/// Mean difference of a channel between two frames of a flight, of 255.
fn flicker(renderer: &mut Renderer, scene: &mut BenchScene, samples: u32) -> f64 {
    let film = Film { samples, is_transparent: false, lens: Lens::default() };
    let frames = [0, 1].map(|frame| {
        scene.camera = camera(20.0, frame);
        let drawn = renderer.render_samples(film, &scene.flat, &[], &scene.camera, [SIDE; 2], &mut |_| true);
        drawn.expect("a picture").0
    });
    let hits = |at: &usize| frames.iter().any(|frame| frame.depth[*at].is_finite());
    let shown: Vec<usize> = (0..frames[0].depth.len()).filter(hits).collect();
    let differs = |at: &usize| {
        let colors = [0, 1].map(|frame| frames[frame].color[*at]);
        (0..3).map(|c| f64::from(colors[0][c].abs_diff(colors[1][c]))).sum::<f64>() / 3.0
    };
    shown.iter().map(differs).sum::<f64>() / shown.len() as f64
}

/// Copies that are smaller than a pixel differ from frame to frame by less than this on average, of 255: with one sample, and with
/// eight.
const FLICKER: [f64; 2] = [9.0, 5.0];

#[test]
fn samples_settle_what_is_below_a_pixel() {
    let mut renderer = counting();
    for (mut scene, _) in measured() {
        let [one, eight] = [1, 8].map(|samples| flicker(&mut renderer, &mut scene, samples));
        println!("{}: frames differ by {one:.2} of 255 with one sample, by {eight:.2} with eight", scene.name);
        assert!(one < FLICKER[0] && eight < FLICKER[1] && eight < 0.8 * one, "{one}, {eight}");
    }
}
