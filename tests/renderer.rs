//! Guarantees of the renderer besides its pictures: it can be stopped, survives the loss of its device, and uploads
//! changed data only.

use std::time::{Duration, Instant};

use glam::DVec3;
use isolith::document::{Document, Edit};
use isolith::field::debug_view::{DepthRange, ViewMode};
use isolith::field::{FlatScene, Flattener, GBuffer, flatten};
use isolith::gallery;
use isolith::geometry::Camera;
use isolith::render::{EvalStrategy, Gpu, OverlaySettings, RenderError, Renderer, Slot, coarse_size};
use isolith::scene::{MaterialId, Node, NodeKind, Object, Shape};

use crate::gpu::{BenchScene, shared};

const SIDE: u32 = 96;

fn bench_scene() -> BenchScene {
    let (name, scene) = gallery::all().into_iter().find(|(name, _)| *name == "pawn").expect("the pawn is shipped");
    BenchScene::new(name, &scene, None)
}

fn draw(renderer: &mut Renderer, bench_scene: &BenchScene) -> Result<GBuffer, RenderError> {
    let BenchScene { flat, meshes, camera, .. } = bench_scene;
    renderer.render(flat, meshes, camera, [SIDE, SIDE], &mut |_| true).map(|(buffers, _)| buffers)
}

fn own_renderer() -> (Gpu, Renderer) {
    let gpu = Gpu::headless().unwrap_or_else(|error| panic!("{error}"));
    let mut renderer = Renderer::new(&gpu).unwrap_or_else(|error| panic!("{error}"));
    renderer.set_strategy(EvalStrategy::Interpreter);
    (gpu, renderer)
}

#[test]
fn a_device_lost_in_the_middle_of_a_frame_is_an_error_and_the_next_one_draws_the_same() {
    let bench_scene = bench_scene();
    let (_, mut renderer) = own_renderer();
    let whole = draw(&mut renderer, &bench_scene).expect("a picture");
    for batches in 0..3 {
        let (gpu, mut renderer) = own_renderer();
        let BenchScene { flat, meshes, camera, .. } = &bench_scene;
        let none = OverlaySettings::default();
        let mut frame = renderer.begin(Slot::Full, flat, meshes, camera, [SIDE, SIDE], none).expect("a frame");
        for _ in 0..batches {
            if !frame.is_done() {
                renderer.advance(&mut frame, Duration::ZERO).expect("a batch");
            }
        }
        gpu.device.destroy();
        let error = draw(&mut renderer, &bench_scene).expect_err("the device is gone");
        assert!(matches!(error, RenderError::Gpu(_)), "{error}");
        assert!(gpu.is_lost());
        let (_, mut renderer) = own_renderer();
        assert!(draw(&mut renderer, &bench_scene).expect("a picture") == whole, "after {batches} batches");
    }
}

/// Frames of a script after each of which the device is destroyed once: `ISOLITH_DEVICE_LOSSES`, or a few.
fn losses() -> usize {
    std::env::var("ISOLITH_DEVICE_LOSSES").ok().and_then(|text| text.parse().ok()).unwrap_or(3)
}

#[test]
fn a_device_destroyed_at_each_frame_of_a_script_costs_that_frame_and_no_more() {
    const SMALL: [u32; 2] = [48, 48];
    let BenchScene { flat, meshes, .. } = &bench_scene();
    // A camera that runs around the pawn.
    let camera = |frame: usize| {
        let (sin, cos) = (frame as f64 * 0.37).sin_cos();
        Camera::looking_at(DVec3::new(3.0 * sin, 1.6, 3.0 * cos), DVec3::new(0.0, 0.4, 0.0), 0.6)
    };
    let draw = |renderer: &mut Renderer, frame: usize| {
        renderer.render(flat, meshes, &camera(frame), SMALL, &mut |_| true).map(|(buffers, _)| buffers)
    };
    let (_, mut undisturbed) = own_renderer();
    for frame in 0..losses() {
        let whole = draw(&mut undisturbed, frame).expect("a picture");
        let (gpu, mut renderer) = own_renderer();
        let none = OverlaySettings::default();
        let mut begun = renderer.begin(Slot::Full, flat, meshes, &camera(frame), SMALL, none).expect("a frame");
        for _ in 0..frame % 5 {
            if !begun.is_done() {
                renderer.advance(&mut begun, Duration::ZERO).expect("a batch");
            }
        }
        gpu.device.destroy();
        assert!(draw(&mut renderer, frame).is_err() && gpu.is_lost(), "frame {frame}");
        let (_, mut next) = own_renderer();
        assert!(draw(&mut next, frame).expect("a picture") == whole, "frame {frame}");
    }
}

#[test]
fn a_frame_can_be_canceled_between_dispatches() {
    let bench_scene = bench_scene();
    let renderer = &mut shared().renderer;
    let mut asked = 0;
    let result =
        renderer.render(&bench_scene.flat, &bench_scene.meshes, &bench_scene.camera, [SIDE, SIDE], &mut |share| {
            assert!((0.0..=1.0).contains(&share));
            asked += 1;
            false
        });
    assert!(matches!(result, Err(RenderError::Canceled)));
    assert_eq!(asked, 1);
}

#[test]
fn what_has_not_changed_is_not_uploaded() {
    let bench_scene = bench_scene();
    let (_, mut renderer) = own_renderer();
    draw(&mut renderer, &bench_scene).expect("a picture");
    let (uploaded, built) = (renderer.uploaded(), renderer.pipelines().built());
    assert!(uploaded > 0);
    draw(&mut renderer, &bench_scene).expect("a picture");
    assert_eq!(renderer.uploaded(), uploaded);
    assert_eq!(renderer.pipelines().built(), built);
}

#[test]
fn a_picture_larger_than_the_device_allows_is_refused_with_the_limit() {
    let bench_scene = bench_scene();
    let renderer = &mut shared().renderer;
    for size in [[0, 10], [10, 1 << 20]] {
        let result = renderer.render(&bench_scene.flat, &bench_scene.meshes, &bench_scene.camera, size, &mut |_| true);
        assert!(matches!(result, Err(RenderError::Size(..))), "{size:?}");
    }
}

/// Width and height of the timed pictures, in pixels. Like most windows neither a power of two nor a divisor of one:
/// lavapipe compiles a pipeline once more for such targets.
const TIMED_SIDE: u32 = 300;
/// Time limit of a picture at full resolution; the window shows a coarse one if a full one would take longer.
const AT_ONCE: Duration = Duration::from_millis(60);

/// Prints times with `--nocapture`; the test does not judge them, because other processes share the machine.
#[expect(clippy::print_stdout, reason = "a test has no other way to say how long something took")]
fn note(text: &str) {
    println!("{text}");
}

/// Starts and draws a picture as the window does after an edit. Returns the time and the size of the picture.
fn answer(renderer: &mut Renderer, flat: &FlatScene, camera: &Camera) -> (Duration, [u32; 2]) {
    let start = Instant::now();
    let full = renderer.estimate(flat, camera, [TIMED_SIDE; 2]).expect("an estimate");
    let size = coarse_size([TIMED_SIDE; 2], full, AT_ONCE);
    let mut frame =
        renderer.begin(Slot::Preview, flat, &[], camera, size, OverlaySettings::default()).expect("a frame");
    renderer.advance(&mut frame, Duration::MAX).expect("a picture");
    (start.elapsed(), size)
}

/// Fraction of the pixels that may differ in depth between two kinds of pipelines, as in `strategies`.
const MAX_SHARE: f64 = 2e-3;

/// Whether two pictures show the same: hit or miss everywhere, and depth except for a few pixels at edges.
fn is_same(a: &GBuffer, b: &GBuffer) -> bool {
    let pairs = || a.depth.iter().zip(&b.depth);
    let far = pairs().filter(|(a, b)| a.is_finite() && (*a - *b).abs() > 1e-3 * **a).count();
    pairs().all(|(a, b)| a.is_finite() == b.is_finite()) && far as f64 <= MAX_SHARE * a.depth.len() as f64
}

/// Width and height of the pictures that the interpreter draws as well, in pixels.
const SMALL_SIDE: u32 = 60;

fn picture(renderer: &mut Renderer, flat: &FlatScene, camera: &Camera) -> GBuffer {
    renderer.render(flat, &[], camera, [SMALL_SIDE; 2], &mut |_| true).expect("a picture").0
}

fn wait_for_pipelines(renderer: &mut Renderer, flat: &FlatScene, camera: &Camera) {
    loop {
        renderer.estimate(flat, camera, [SIDE, SIDE]).expect("an estimate");
        if !renderer.is_preparing() {
            return;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
}

#[test]
fn the_picture_after_a_change_of_structure_is_right_and_waits_for_no_pipeline() {
    let (_, mut plain) = own_renderer();
    let mut renderer = Renderer::new(plain.gpu()).expect("a renderer");
    let mut document = Document::new(gallery::random(512, 5));
    let mut flattener = Flattener::default();
    let flat = flattener.flatten(document.scene(), 0.0).expect("within the limits");
    let camera = flat.default_camera(&[], 1.0);
    wait_for_pipelines(&mut renderer, &flat, &camera);
    answer(&mut renderer, &flat, &camera);
    let group = |document: &Document, at: usize| {
        let groups = document.scene().nodes().iter().filter(|n| n.parent.is_some() && n.name.starts_with("Group"));
        groups.map(|n| n.id).nth(at).expect("64 groups")
    };
    let child = |document: &Document, at: usize, nth: usize| {
        let parent = Some(group(document, at));
        let children = document.scene().nodes().iter().filter(|n| n.parent == parent);
        children.map(|n| n.id).nth(nth).expect("eight children")
    };
    let object = Object { shape: Shape::Sphere { radius: 0.3 }, material: MaterialId(1) };
    let ball = Node::new("ball", NodeKind::Object(object));
    let edits = [
        ("add", Edit::Insert { parent: Some(group(&document, 40)), position: 3, node: ball }),
        ("delete", Edit::Remove(vec![child(&document, 50, 2)])),
        ("delete a group", Edit::Remove(vec![group(&document, 10)])),
        ("reorder", Edit::Move { ids: vec![child(&document, 60, 7)], parent: Some(group(&document, 60)), position: 0 }),
    ];
    for (name, edit) in edits {
        let start = Instant::now();
        document.apply(edit).expect("an edit");
        let flat = flattener.flatten(document.scene(), 0.0).expect("within the limits");
        let edited = start.elapsed();
        let (drawn, size) = answer(&mut renderer, &flat, &camera);
        let ms = |took: Duration| took.as_secs_f64() * 1e3;
        note(&format!("577 nodes, {name}: flat after {:.1} ms, {size:?} pixels {:.1} ms later", ms(edited), ms(drawn)));
        let (next, right) = (picture(&mut renderer, &flat, &camera), picture(&mut plain, &flat, &camera));
        assert!(is_same(&next, &right), "{name}");
        wait_for_pipelines(&mut renderer, &flat, &camera);
        assert!(is_same(&picture(&mut renderer, &flat, &camera), &right), "{name}, once pipelines are there");
    }
}

#[test]
fn tapes_are_made_beside_the_frames_and_a_picture_never_follows_old_ones() {
    let (_, mut plain) = own_renderer();
    let mut renderer = Renderer::new(plain.gpu()).expect("a renderer");
    let mut document = Document::new(gallery::crowd(200, true, 3));
    let mut flattener = Flattener::default();
    let mut flat = flattener.flatten(document.scene(), 0.0).expect("within the limits");
    let camera = flat.default_camera(&[], 1.0);
    // Build the interpreter first, to keep it out of the time.
    let few = flatten(&gallery::crowd(8, true, 3), 0.0).expect("within the limits");
    wait_for_pipelines(&mut renderer, &few, &camera);
    let start = Instant::now();
    renderer.estimate(&flat, &camera, [SIDE, SIDE]).expect("an estimate");
    note(&format!("200 blended leaves: first answer after {:.1} ms", start.elapsed().as_secs_f64() * 1e3));
    assert!(renderer.tape_cache().building() > 0, "tapes of this size are not waited for");
    // Without pipelines this would be millions of dispatches, but that alone is not a reason to refuse it.
    let huge = renderer.estimate(&flat, &camera, [8_192; 2]).expect("an estimate");
    assert!(huge > Duration::from_secs(100_000), "{huge:?}");
    let refused = renderer.begin(Slot::Full, &flat, &[], &camera, [8_192; 2], OverlaySettings::default());
    let Err(RenderError::TooManyDispatches(8_192, 8_192, node)) = refused else { panic!("it is not refused") };
    assert!(flat.ids.contains(&node));
    assert!(is_same(&picture(&mut renderer, &flat, &camera), &picture(&mut plain, &flat, &camera)));
    wait_for_pipelines(&mut renderer, &flat, &camera);
    let huge = renderer.estimate(&flat, &camera, [8_192; 2]).expect("an estimate");
    assert!(huge < Duration::from_secs(1_000), "{huge:?}");
    let uploaded = renderer.uploaded();
    picture(&mut renderer, &flat, &camera);
    assert!(renderer.uploaded() > uploaded + 20_000, "the tapes are on the device now");
    for step in 0..2 {
        let leaf = document.scene().nodes().iter().filter(|n| matches!(n.kind, NodeKind::Object(_))).nth(80 * step);
        let mut node = Node::clone(leaf.expect("two hundred leaves"));
        node.transform.translation.y += 0.3;
        document.apply(Edit::Replace(node)).expect("an edit");
        let start = Instant::now();
        flat = flattener.flatten(document.scene(), 0.0).expect("within the limits");
        renderer.estimate(&flat, &camera, [SIDE, SIDE]).expect("an estimate");
        note(&format!("after an edit: {:.1} ms until the frame begins", start.elapsed().as_secs_f64() * 1e3));
        let (next, right) = (picture(&mut renderer, &flat, &camera), picture(&mut plain, &flat, &camera));
        assert!(is_same(&next, &right), "edit {step}");
    }
    let uploaded = renderer.uploaded();
    wait_for_pipelines(&mut renderer, &flat, &camera);
    let last = picture(&mut renderer, &flat, &camera);
    assert!(is_same(&last, &picture(&mut plain, &flat, &camera)));
    let uploaded_once = renderer.uploaded();
    assert!(uploaded_once >= uploaded);
    assert!(picture(&mut renderer, &flat, &camera) == last);
    assert_eq!(renderer.uploaded(), uploaded_once, "what has not changed is not uploaded");
}

/// Passes of every picture. The others are for meshes, many lights, view modes and marks.
const ALWAYS: [&str; 5] = ["mesh", "cone", "trace", "surface", "shade"];

#[test]
fn each_pass_has_a_row_with_its_time() {
    let bench_scene = bench_scene();
    let (gpu, mut renderer) = own_renderer();
    let untimed = draw(&mut renderer, &bench_scene).expect("a picture");
    assert!(renderer.timings().is_none(), "nobody has asked");
    renderer.set_timing(true);
    let started = Instant::now();
    assert!(draw(&mut renderer, &bench_scene).expect("a picture") == untimed, "taking time changes nothing");
    let whole = started.elapsed().as_secs_f64();
    if !gpu.device.features().contains(wgpu::Features::TIMESTAMP_QUERY) {
        assert!(renderer.timings().is_none(), "the device has no clock");
        return;
    }
    let rows = renderer.timings().expect("the device has a clock");
    assert_eq!(rows.len(), ALWAYS.len() + 7, "{rows:?}");
    assert!(rows.iter().all(|row| (row.runs > 0) == ALWAYS.contains(&row.label)), "{rows:?}");
    let sum: f64 = rows.iter().map(|row| row.seconds).sum();
    assert!(sum > 0.0 && sum <= whole, "{sum} of {whole} s: {rows:?}");
    // Grid and view mode are passes over the finished picture.
    let BenchScene { flat, meshes, camera, .. } = &bench_scene;
    let grid = OverlaySettings { grid: true, ..OverlaySettings::default() };
    let mut frame = renderer.begin(Slot::Full, flat, meshes, camera, [SIDE, SIDE], grid).expect("a frame");
    let span = DepthRange::of(&flat.content(meshes), camera.position);
    renderer.debug_view(&mut frame, ViewMode::Normals, flat, &span).expect("a look");
    renderer.advance(&mut frame, Duration::MAX).expect("a picture");
    let rows = renderer.timings().expect("the device has a clock");
    let ran: Vec<_> = rows.iter().filter(|row| row.runs > 0).map(|row| row.label).collect();
    assert!(ran.len() == ALWAYS.len() + 2 && ran.last() == Some(&"overlay"), "{rows:?}");
    renderer.set_timing(false);
    assert!(renderer.timings().is_none());
}
