//! Copies below a pixel: what they cost, how their detail falls with distance, and how little they flicker.

#![allow(clippy::print_stdout, reason = "the figures are for whoever runs this with `--nocapture`")]

use std::ops::ControlFlow;
use std::time::Duration;

use glam::{DVec2, DVec3};

use isolith::field::copies::{CopyCone, copies_along};
use isolith::field::{GBuffer, RayLimits};
use isolith::geometry::{Camera, Lens, Ray};
use isolith::render::{EvalStrategy, Film, OverlaySettings, Renderer, Slot};
use isolith::scene::{DynamicKind, Instancer, Lattice, Variation};
use isolith::wgsl::Options;

use crate::copies::{scene_of, varied};
use crate::gpu::{BenchScene, shared};

/// Width and height of the pictures, in pixels.
const SIDE: u32 = 64;
/// Angle of view from top to bottom, in radians.
const VIEW: f64 = 0.8;
/// How far the camera of a flight moves in a frame, in meters.
const FLIGHT_STEP: f64 = 0.02;

/// Small copies without end that move with the wind, from above, and larger ones in all directions.
fn endless() -> Vec<BenchScene> {
    let meadow = Lattice::Grid { counts: [0, 1, 0], spacing: [0.5; 3] };
    let variation = Variation { scale_min: [0.2; 3], scale_max: [0.4; 3], ..varied() };
    let meadow = Instancer { lattice: meadow, variation, probability: 0.9, seed: 5, ..Instancer::default() };
    let space = Lattice::Grid { counts: [0; 3], spacing: [9.0; 3] };
    let space = Instancer { lattice: space, variation: varied(), probability: 0.2, seed: 5, ..Instancer::default() };
    let of =
        |name, copies: Instancer, dynamics: &[DynamicKind]| BenchScene::new(name, &scene_of(copies, dynamics), None);
    vec![
        of("meadow", meadow, &[DynamicKind::Wind, DynamicKind::FractionalBrownianMotion]),
        of("space", space, &[DynamicKind::Orbit, DynamicKind::Spin]),
    ]
}

fn camera(frame: u32) -> Camera {
    let eye = DVec3::new(0.3, 20.0, 6.0 - FLIGHT_STEP * f64::from(frame));
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

/// Radii of copies in pixels, at which ranges end.
const RANGES: [f64; 6] = [0.0, 0.125, 0.25, 0.5, 1.0, 2.0];

fn range_of(depth: f32, radius: f64) -> usize {
    let footprint = 2.0 * (0.5 * VIEW).tan() / f64::from(SIDE);
    let size = radius / (f64::from(depth) * footprint);
    RANGES.iter().rposition(|least| size >= *least).unwrap_or(0)
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

#[test]
fn figures_of_copies_by_their_size() {
    let mut renderer = counting();
    for mut scene in endless() {
        let radius = if scene.name == "meadow" { 0.2 } else { 0.55 };
        let size = [SIDE, SIDE];
        let mut pictures: Vec<[GBuffer; 2]> = Vec::new();
        for frame in 0..2 {
            scene.camera = camera(frame);
            pictures.push([1, 4].map(|samples| {
                let film = Film { samples, is_transparent: false, lens: Lens::default() };
                let start = std::time::Instant::now();
                let drawn = renderer.render_samples(film, &scene.flat, &[], &scene.camera, size, &mut |_| true);
                let drawn = drawn.expect("a picture").0;
                println!("{} {samples}: {:?}", scene.name, start.elapsed());
                drawn
            }));
        }
        let begun = renderer.begin(Slot::Full, &scene.flat, &[], &scene.camera, size, OverlaySettings::default());
        let mut frame = begun.expect("a frame");
        renderer.advance(&mut frame, Duration::MAX).expect("a picture");
        let counts = renderer.pixel_counts(&frame).expect("counts");
        let picture = renderer.read(&frame).expect("a picture");
        let mut sums = [[0.0; 8]; 8];
        for at in 0..(SIDE * SIDE) as usize {
            let depth = picture.depth[at];
            let row = if depth.is_finite() { 1 + range_of(depth, radius) } else { 0 };
            let (x, y) = (at as u32 % SIDE, at as u32 / SIDE);
            sums[row][0] += 1.0;
            sums[row][1] += counts.with_cones(x, y, |one| one.evaluations);
            let work = walked(&scene, x, y);
            for (sum, more) in sums[row][4..].iter_mut().zip(work) {
                *sum += more;
            }
            for way in 0..2 {
                let colors = [0, 1].map(|frame| pictures[frame][way].color[at]);
                let differs = (0..3).map(|c| f64::from(colors[0][c].abs_diff(colors[1][c]))).sum::<f64>() / 3.0;
                sums[row][2 + way] += differs;
            }
        }
        println!(
            "{}: radius, pixels, evaluations, difference at 1 and 4 samples, cells, copies, moved, met",
            scene.name
        );
        for (row, sum) in sums.iter().enumerate().filter(|(_, sum)| sum[0] > 0.0) {
            let each: Vec<f64> = sum[1..].iter().map(|all| all / sum[0]).collect();
            println!("  {:?} px: {} {each:.2?}", row.checked_sub(1).map(|row| RANGES[row]), sum[0]);
        }
    }
}
