//! What copies cost: against one copy that fills the same pixels, against the scheme of the paper, and in playback.

#![allow(clippy::print_stdout, reason = "the figures are for whoever runs this with `--nocapture`")]

use std::collections::HashMap;
use std::time::{Duration, Instant};

use glam::{DVec2, DVec3};

use isolith::field::copies::{Copy, FlatInstancer, Placement, copy_of_cell, copy_of_place, world_from_copy};
use isolith::field::eval::field;
use isolith::field::{Component, FlatScene};
use isolith::geometry::{Camera, Ray};
use isolith::jobs::Task;
use isolith::render::{EvalStrategy, OverlaySettings, Renderer, Slot};
use isolith::scene::{Instancer, Lattice, Scene, Variation};
use isolith::session::PreparedScene;
use isolith::wgsl::Options;

use crate::copies::scene_of;
use crate::gpu::{BenchScene, scenes, shared};

/// A renderer that counts, by tapes.
fn counting() -> Renderer {
    let gpu = shared().gpu.clone();
    let options = Options { counting: true, ..Renderer::options(&gpu) };
    let mut renderer = Renderer::with_options(&gpu, options).expect("a renderer");
    renderer.set_strategy(EvalStrategy::Tape);
    renderer
}

/// Evaluations of fields for each pixel that shows one, cones included, and the number of these pixels.
fn evaluations(renderer: &mut Renderer, scene: &BenchScene, size: [u32; 2]) -> (f64, usize) {
    let overlay = OverlaySettings::default();
    let begun = renderer.begin(Slot::Full, &scene.flat, &scene.meshes, &scene.camera, size, overlay);
    let mut frame = begun.expect("a frame");
    renderer.advance(&mut frame, Duration::MAX).expect("a picture");
    let counts = renderer.pixel_counts(&frame).expect("counts");
    let picture = renderer.read(&frame).expect("a picture");
    let places = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
    let shown = places.zip(&picture.depth).filter(|(_, depth)| depth.is_finite());
    let each: Vec<f64> = shown.map(|((x, y), _)| counts.with_cones(x, y, |one| one.evaluations)).collect();
    (each.iter().sum::<f64>() / each.len().max(1) as f64, each.len())
}

/// A field of copies that hides all of the picture, and one copy that does: the same types.
#[test]
fn a_field_of_copies_costs_at_most_twice_what_one_copy_costs() {
    let of = |counts, variation| {
        let lattice = Lattice::Grid { counts, spacing: [0.6, 1.0, 0.6] };
        scene_of(Instancer { lattice, variation, seed: 5, ..Instancer::default() }, &[])
    };
    let turned =
        Variation { rotation_max: [0.0, 360.0, 0.0], scale_min: [0.8; 3], scale_max: [1.2; 3], ..Variation::default() };
    let mut renderer = counting();
    let (mut many, mut one) =
        (BenchScene::new("many", &of([0, 1, 0], turned), None), BenchScene::new("one", &of([1; 3], turned), None));
    let eye = DVec3::new(0.0, 7.0, 5.0);
    many.camera = Camera::looking_at(eye, eye + DVec3::new(0.1, -1.0, -0.7), 0.8);
    // So near that it fills the picture.
    let content = one.flat.content(&one.meshes);
    one.camera = Camera::looking_at(content.center() + DVec3::new(0.1, 0.9, 0.6), content.center(), 0.35);
    let [(many, many_pixels), (one, one_pixels)] =
        [&many, &one].map(|scene| evaluations(&mut renderer, scene, [96; 2]));
    println!(
        "evaluations per pixel: {many:.2} of {many_pixels} pixels of many copies, {one:.2} of {one_pixels} of one"
    );
    assert!(many_pixels > 5_000 && one_pixels > 5_000, "{many_pixels}, {one_pixels}");
    assert!(many <= 2.0 * one, "{many} against {one}");
}

/// The side of squares, and the places in each of them.
type Squares = (f64, HashMap<[i64; 2], Vec<usize>>);

/// The paper's scheme: one march through everything. At each step all components are evaluated, and of each instancer
/// the copies of the point's own cell and its neighbors, as many as the picture needs, wherever the ray is.
struct OneMarch<'a> {
    flat: &'a FlatScene,
    /// For lists, the places by their square.
    squares: Vec<Squares>,
    evaluations: u64,
}

/// Steps of a ray at most, and how near a surface it ends.
const MOST_STEPS: usize = 2_000;
const NEAR: f64 = 1e-3;

impl<'a> OneMarch<'a> {
    fn new(flat: &'a FlatScene) -> Self {
        let square = |instancer: &FlatInstancer| match &instancer.placement {
            Placement::Lattice(_) => (1.0, HashMap::new()),
            Placement::List(list) => {
                let side = 2.0 * instancer.reach.max_element().max(1e-3);
                let mut squares: HashMap<[i64; 2], Vec<usize>> = HashMap::new();
                for (at, place) in list.places.iter().enumerate() {
                    let of = [place.position.x, place.position.z].map(|v| (v / side).floor() as i64);
                    squares.entry(of).or_default().push(at);
                }
                (side, squares)
            }
        };
        Self { flat, squares: flat.instancers.iter().map(square).collect(), evaluations: 0 }
    }

    /// The copies around a point of an instancer's space, and how far the point may go before others count.
    fn around(&self, at: usize, point: DVec3) -> (Vec<Copy>, f64) {
        let instancer = &self.flat.instancers[at];
        match &instancer.placement {
            Placement::Lattice(lattice) => {
                let home = lattice.nearest(point);
                // As many neighbors as copies may reach into, and one more to go on.
                let count = [0, 1, 2].map(|axis| {
                    if lattice.is_long(axis) {
                        (instancer.reach[axis] / lattice.spacing[axis] + 0.5).ceil() as i32
                    } else {
                        0
                    }
                });
                let range = |axis: usize| {
                    let [low, high] = [home[axis] - count[axis], home[axis] + count[axis]];
                    low.max(lattice.low[axis])..=high.min(lattice.high[axis])
                };
                let cells = range(2).flat_map(|z| range(1).flat_map(move |y| range(0).map(move |x| [x, y, z])));
                let cells: Vec<_> = cells.collect();
                let free = (0..3)
                    .filter(|axis| lattice.is_long(*axis))
                    .map(|axis| (f64::from(count[axis]) + 0.5) * lattice.spacing[axis] - instancer.reach[axis]);
                let free = free.fold(f64::INFINITY, f64::min).max(0.05 * lattice.spacing.min_element());
                (cells.into_iter().filter_map(|cell| copy_of_cell(instancer, cell)).collect(), free)
            }
            Placement::List(_) => {
                let (side, squares) = &self.squares[at];
                let home = [point.x, point.z].map(|v| (v / side).floor() as i64);
                let near = (-1..=1).flat_map(|x| (-1..=1).map(move |z| [home[0] + x, home[1] + z]));
                let places = near.filter_map(|square| squares.get(&square)).flatten();
                (places.filter_map(|place| copy_of_place(instancer, *place)).collect(), 0.5 * side)
            }
        }
    }

    fn field_of_copy(&mut self, instancer: usize, copy: &Copy, point: DVec3) -> f64 {
        let is_type = |component: &&Component| {
            component.instanced.is_some_and(|of| of.instancer as usize == instancer && of.kind == copy.kind)
        };
        let Some(component) = self.flat.components.iter().find(is_type) else { return f64::INFINITY };
        self.evaluations += 1;
        let of = &self.flat.instancers[instancer];
        let local = world_from_copy(of, copy).inverse().transform_point3(point);
        field(self.flat, component, local - component.origin) * copy.scale.min_element() * of.least_scale()
    }

    fn march(&mut self, ray: &Ray, near: f64, far: f64) -> bool {
        let mut t = near;
        for _ in 0..MOST_STEPS {
            let point = ray.at(t);
            let mut step = f64::INFINITY;
            for component in self.flat.components.iter().filter(|component| component.instanced.is_none()) {
                self.evaluations += 1;
                step = step.min(field(self.flat, component, point - component.origin));
            }
            for at in 0..self.flat.instancers.len() {
                let of = &self.flat.instancers[at];
                let (copies, free) = self.around(at, of.world_from_local.inverse().transform_point3(point));
                step = step.min(free * of.least_scale());
                for copy in &copies {
                    step = step.min(self.field_of_copy(at, copy, point));
                }
            }
            if step < NEAR * t.max(1.0) {
                return true;
            }
            t += step;
            if t > far {
                return false;
            }
        }
        true
    }
}

/// The shipped scenes with copies: evaluations per pixel of the scheme of the paper and of the renderer, in one run.
#[test]
fn the_scheme_of_the_paper_takes_many_times_as_many_evaluations() {
    const SIZE: [u32; 2] = [32, 18];
    let mut renderer = counting();
    for scene in scenes().filter(|scene| !scene.flat.instancers.is_empty() && scene.name != "stanford") {
        let mut march = OneMarch::new(&scene.flat);
        let size = DVec2::new(SIZE[0].into(), SIZE[1].into());
        let mut hits = 0;
        for i in 0..SIZE[0] * SIZE[1] {
            let pixel = DVec2::new(f64::from(i % SIZE[0]) + 0.5, f64::from(i / SIZE[0]) + 0.5);
            let ray = scene.camera.ray(pixel, size);
            hits += u32::from(march.march(&ray, scene.camera.near, scene.camera.far.min(2e3)));
        }
        let theirs = march.evaluations as f64 / f64::from(SIZE[0] * SIZE[1]);
        let overlay = OverlaySettings::default();
        // Larger tiles of cones would not pay at so few pixels.
        let ours_size = SIZE.map(|side| 8 * side);
        let begun = renderer.begin(Slot::Full, &scene.flat, &scene.meshes, &scene.camera, ours_size, overlay);
        let mut frame = begun.expect("a frame");
        renderer.advance(&mut frame, Duration::MAX).expect("a picture");
        let ours = renderer.pixel_counts(&frame).expect("counts").per_pixel(|one| one.evaluations);
        println!(
            "{}: {theirs:.0} evaluations per pixel by the paper's scheme ({hits} hits), {ours:.1} here: {:.0} times",
            scene.name,
            theirs / ours
        );
        assert!(theirs > 10.0 * ours, "{}: {theirs} against {ours}", scene.name);
    }
}

/// Most frames of the playback that is measured, and its size, with `ISOLITH_MEASURE_COPIES=all`; a few small ones else.
fn playback_size() -> (u32, [u32; 2]) {
    let is_whole = std::env::var("ISOLITH_MEASURE_COPIES").is_ok_and(|value| value == "all");
    if is_whole { (40, [640, 360]) } else { (3, [96, 54]) }
}

/// After this long the playback ends, but not before it has shown so many frames.
const PLAYBACK_TIME: Duration = Duration::from_secs(150);
const PLAYBACK_LEAST: u32 = 3;

/// Playback of the terrain: how long frames take, and what they spend it on.
#[test]
fn playback_of_the_terrain_builds_no_pipeline() {
    let scene: Scene = isolith::gallery::all().into_iter().find(|(name, _)| *name == "terrain").expect("shipped").1;
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let task = Task::new("Preparing");
    let prepared = PreparedScene::of(&scene, 0.0, Some(folder), &task).expect("within the limits");
    let mut prepared = prepared.expect("nobody cancels");
    let camera = prepared.flat.default_camera(&[], 16.0 / 9.0);
    let (count, size) = playback_size();
    let mut shared = shared();
    shared.renderer.set_strategy(EvalStrategy::Auto);
    let mut built = None;
    let mut all: Vec<[f64; 3]> = Vec::new();
    let begun_at = Instant::now();
    for frame in 0..count {
        if frame >= PLAYBACK_LEAST && begun_at.elapsed() > PLAYBACK_TIME {
            break;
        }
        let mut times = [0.0; 3];
        let start = Instant::now();
        let time = f64::from(frame) / 24.0;
        assert!(prepared.advance(&scene, time, &task).expect("within the limits"), "nobody cancels");
        times[0] = start.elapsed().as_secs_f64();
        let (flat, renderer) = (prepared.flat.clone(), &mut shared.renderer);
        let overlay = OverlaySettings::default();
        let begun = renderer.begin(Slot::Full, &flat, &vec![None; flat.meshes.len()], &camera, size, overlay);
        let mut drawn = begun.expect("a frame");
        times[1] = start.elapsed().as_secs_f64() - times[0];
        renderer.advance(&mut drawn, Duration::MAX).expect("a picture");
        times[2] = start.elapsed().as_secs_f64() - times[0] - times[1];
        // The first frame asks for them; some are built beside.
        while frame == 0 && renderer.is_preparing() {
            std::thread::sleep(Duration::from_millis(20));
            renderer.estimate(&flat, &camera, size).expect("an estimate");
        }
        let now = renderer.pipelines().built();
        assert_eq!(*built.get_or_insert(now), now, "frame {frame} built a pipeline");
        if frame > 0 {
            all.push(times);
        }
    }
    let figure = |part: &dyn Fn(&[f64; 3]) -> f64| {
        let mut sorted: Vec<f64> = all.iter().map(part).collect();
        sorted.sort_by(f64::total_cmp);
        [sorted[sorted.len() / 2], sorted[(sorted.len() - 1) * 99 / 100]].map(|seconds| 1e3 * seconds)
    };
    println!(
        "terrain at {size:?}, {} frames, median and p99 in ms: all {:.1?}, flattening {:.1?}, planning and upload {:.1?}, drawing {:.1?}",
        all.len(),
        figure(&|times| times.iter().sum()),
        figure(&|times| times[0]),
        figure(&|times| times[1]),
        figure(&|times| times[2])
    );
}
