//! From an event of the pointer to the picture on the device, panels included.

use std::time::{Duration, Instant};

use egui::{Event, Modifiers, PointerButton, vec2};
use egui_kittest::kittest::Queryable;
use glam::{DVec2, uvec2};
use isolith::document::Document;
use isolith::editor::{Editor, Picture};
use isolith::field::pick::pick;
use isolith::render::{OverlaySettings, RenderError, Renderer, Slot, coarse_size};
use isolith::scene::file;

use crate::gpu::{BenchScene, shared};
use crate::settle::Settle;

/// The time that the viewport grants a picture at once.
const AT_ONCE: Duration = Duration::from_millis(60);
/// Side of the viewport's picture here, in pixels: a software driver draws a tenth as many as a graphics card.
const SIZE: [u32; 2] = [320, 200];
/// Most of the median, on a software driver on one core: the picture may take `AT_ONCE`, arrays and panels the rest.
const MEDIAN: Duration = Duration::from_millis(250);

/// Events of the drag.
const EVENTS: usize = 100;

/// Prints times with `--nocapture`.
#[expect(clippy::print_stdout, reason = "a test has no other way to say how long something took")]
fn note(text: &str) {
    println!("{text}");
}

/// Draws what the window would show at once, and waits for the device.
fn present(renderer: &mut Renderer, editor: &Editor) -> Result<(), RenderError> {
    let (flat, view) = (editor.flat(), editor.view());
    let meshes = flat.known_meshes(editor.meshes());
    let full = renderer.estimate(flat, &view.camera, SIZE)?;
    let size = coarse_size(SIZE, full, AT_ONCE);
    let mut frame = renderer.begin(Slot::Preview, flat, &meshes, &view.camera, size, OverlaySettings::default())?;
    renderer.advance(&mut frame, Duration::MAX)?;
    let _ = renderer.gpu().device.poll(wgpu::PollType::wait_indefinitely());
    Ok(())
}

#[test]
fn a_dragged_value_is_in_the_picture_soon() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/random-577.json");
    let scene = file::load(&path).unwrap();
    let object = scene.nodes().iter().find(|node| matches!(node.kind, isolith::scene::NodeKind::Object(_))).unwrap().id;
    let mut harness = egui_kittest::Harness::builder()
        .with_size(vec2(1280.0, 864.0))
        .with_context_setup(Editor::setup)
        .build_ui_state(
            |ui, editor: &mut Editor| editor.show(ui, &Picture::default()),
            Editor::new(Document::new(scene)),
        );
    harness.settle();
    harness.state_mut().document_mut().select(vec![object]);
    harness.run_steps(4);
    let renderer = &mut shared().renderer;
    present(renderer, harness.state()).unwrap();
    let at = harness.get_all_by_label("Position X").last().unwrap().rect().center();
    let button =
        |pressed| Event::PointerButton { pos: at, button: PointerButton::Primary, pressed, modifiers: Modifiers::NONE };
    harness.event(Event::PointerMoved(at));
    harness.event(button(true));
    harness.step();
    let before = harness.state().document().revision();
    let mut times: Vec<Duration> = (0..EVENTS)
        .map(|step| {
            let start = Instant::now();
            harness.event(Event::PointerMoved(at + vec2(4.0 + 2.0 * step as f32, 0.0)));
            harness.step();
            present(renderer, harness.state()).unwrap();
            start.elapsed()
        })
        .collect();
    assert!(harness.state().document().revision() > before + 30, "each event changes the scene");
    times.sort();
    let [median, late] = [times[EVENTS / 2], times[EVENTS * 99 / 100 - 1]];
    note(&format!("577 nodes, event to picture: median {median:?}, p99 {late:?}"));
    assert!(median <= MEDIAN, "{median:?}");
}

/// Rays of a click.
const CLICKS: u32 = 16;
/// Most of the mean time of a click.
const CLICK: Duration = Duration::from_millis(20);

/// Picking asks the f64 evaluation, at any distance and before there is a picture: decision 101 rests on these times.
#[test]
fn a_click_takes_milliseconds_without_the_picture() {
    for name in ["random-577", "character", "terrain", "city", "asteroids", "ocean", "stanford", "fractals"] {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
        let scene = file::load(&folder.join(name).with_extension("json")).expect("it is shipped");
        let scene = BenchScene::new(name, &scene, Some(folder));
        let mut worst = Duration::ZERO;
        let start = Instant::now();
        let mut hits = 0;
        for pixel in (0..CLICKS * CLICKS).map(|i| uvec2(i % CLICKS, i / CLICKS)) {
            let ray = scene.camera.ray(pixel.as_dvec2() + 0.5, DVec2::splat(CLICKS.into()));
            let before = Instant::now();
            let (near, far) = (scene.camera.near, scene.camera.far);
            hits += u32::from(pick(&scene.flat, &scene.meshes, &ray, near, far).is_some());
            worst = worst.max(before.elapsed());
        }
        let mean = start.elapsed() / (CLICKS * CLICKS);
        note(&format!("| {name} | {:.2} | {:.1} |", 1e3 * mean.as_secs_f64(), 1e3 * worst.as_secs_f64()));
        assert!(hits > CLICKS, "{name}: {hits}");
        assert!(mean < CLICK, "{name}: {mean:?}");
    }
}
