//! Numerical stress: compares the pictures of `isolith bench --stress` with the allowed errors and with the known
//! faults.

use isolith::bench::{Allowed, Metrics, cases};
use isolith::field::reference::image::{ReferenceImage, render_reference};
use isolith::geometry::Camera;
use isolith::render::{EvalStrategy, Renderer};
use isolith::scene::{MaterialId, ModifierKind, Node, NodeKind, Object, Operator, Scene, Shape, ShapeKind};

use crate::gpu::{BenchScene, shared};

/// The file of the known faults, by the worst strategy: wrong pixels, pixels on which strategies disagree, and the
/// depth's error at the 99th percentile in footprints, none above the measurement on lavapipe. The reasons are in the
/// file and in `benches/README.md`. The list gains no cases, and no count of wrong pixels grows.
const KNOWN: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/stress/known.txt");

/// A line of [`KNOWN`].
struct Known<'a> {
    node: &'a str,
    circumstance: &'a str,
    wrong: usize,
    differ: usize,
    depth: f64,
}

/// The lines of [`KNOWN`] without comments.
fn known_cases(text: &str) -> Vec<Known<'_>> {
    let read = |line| {
        let fields: Vec<&str> = str::split(line, '|').map(str::trim).collect();
        let [node, circumstance, wrong, differ, depth] = fields[..] else { panic!("{line}: not five fields") };
        let count = |text: &str| text.parse().unwrap_or_else(|error| panic!("{line}: {error}"));
        let depth = depth.parse().unwrap_or_else(|error| panic!("{line}: {error}"));
        Known { node, circumstance, wrong: count(wrong), differ: count(differ), depth }
    };
    text.lines().filter(|line| !line.is_empty() && !line.starts_with('#')).map(read).collect()
}

/// The command line draws with the interpreter and tapes, the window with pipelines.
const STRATEGIES: [EvalStrategy; 3] = [EvalStrategy::Interpreter, EvalStrategy::Tape, EvalStrategy::StraightLine];

/// The line of a case in [`KNOWN`].
fn line(metrics: &Metrics) -> String {
    let Metrics { node, circumstance, wrong, differ, depth_p99, .. } = metrics;
    format!("{node} | {circumstance} | {wrong} | {differ} | {:.4}", (depth_p99 * 1e4).ceil() * 1e-4)
}

#[test]
fn what_is_difficult_is_drawn_as_it_is() {
    let gpu = shared().gpu.clone();
    let mut renderer = Renderer::new(&gpu).expect("a renderer");
    renderer.tape_cache().build_all();
    let text = std::fs::read_to_string(KNOWN).expect("the list is part of the source");
    let known = known_cases(&text);
    let (mut faults, mut lines, mut met, mut drawn) = (Vec::new(), Vec::new(), 0, 0);
    for case in cases() {
        let metrics = case.measure(&mut renderer, &STRATEGIES);
        let metrics = metrics.unwrap_or_else(|error| panic!("{}, {}: {error}", case.name(), case.circumstance));
        let Some(mut metrics) = metrics else { continue };
        drawn += 1;
        if !metrics.faults().is_empty() {
            lines.push(line(&metrics));
        }
        let is_it = |known: &&Known<'_>| (known.node, known.circumstance) == (&*metrics.node, &*metrics.circumstance);
        if let Some(known) = known.iter().find(is_it) {
            met += 1;
            if metrics.faults().is_empty() {
                faults.push(format!("{}, {}: is right now", metrics.node, metrics.circumstance));
            }
            let wrong = known.wrong as f64 / metrics.pixels as f64;
            metrics.allowed = Allowed { wrong, depth: known.depth, differ: known.differ };
        }
        faults.extend(metrics.faults());
    }
    assert!(faults.is_empty(), "{}\nAll that is beyond what is allowed:\n{}", faults.join("\n"), lines.join("\n"));
    assert_eq!(met, known.len());
    // The other cases have no surface in view.
    assert!(drawn > 1_200, "{drawn} cases were drawn");
}

#[test]
fn every_shape_operator_and_modifier_is_stressed() {
    let names: Vec<String> = cases().iter().map(|case| case.name()).collect();
    let labels = ShapeKind::ALL.iter().map(|kind| kind.label());
    let labels = labels.chain(Operator::ALL.iter().map(|operator| operator.label()));
    for label in labels.chain(ModifierKind::ALL.iter().map(|kind| kind.label())) {
        let count = names.iter().filter(|name| name.split(',').next() == Some(label)).count();
        assert!(count >= 8, "{label}: {count} cases");
    }
}

/// A ball in front of the background.
fn ball(radius: f64) -> BenchScene {
    let mut scene = Scene::new();
    let object = Object { shape: Shape::Sphere { radius }, material: MaterialId(1) };
    scene.insert(None, 0, Node::new("Ball", NodeKind::Object(object))).unwrap();
    let mut bench_scene = BenchScene::new("ball", &scene, None);
    bench_scene.camera = Camera::looking_at(glam::DVec3::new(0.3, 0.4, 3.0), glam::DVec3::ZERO, 0.5);
    bench_scene
}

#[test]
fn another_radius_and_what_is_no_number_are_refused() {
    const SIDE: u32 = 40;
    let right = ball(0.5);
    let reference: ReferenceImage = render_reference(&right.flat, &[], &right.camera, [SIDE, SIDE], &|_| ()).unwrap();
    let faults = |buffers: &_| Metrics::of(buffers, &right.flat, &reference).faults();
    let picture = right.render(SIDE, EvalStrategy::Interpreter);
    assert!(faults(&picture).is_empty(), "{:?}", faults(&picture));
    for radius in [0.49, 0.51] {
        assert!(!faults(&ball(radius).render(SIDE, EvalStrategy::Interpreter)).is_empty(), "{radius}");
    }
    let hit = picture.depth.iter().position(|depth| depth.is_finite()).unwrap();
    for pixel in [0, hit] {
        let mut broken = picture.clone();
        broken.depth[pixel] = f32::NAN;
        assert!(!faults(&broken).is_empty());
        let mut broken = picture.clone();
        broken.normal[pixel][1] = f32::NAN;
        assert!(!faults(&broken).is_empty());
    }
}
