//! CPU time between a drag and the GPU, at ten thousand nodes. The target is less than a millisecond in all, without
//! building a pipeline.

mod ten_thousand;

use std::hint::black_box;
use std::time::Duration;

use criterion::{Criterion, criterion_group, criterion_main};
use isolith::field::{FlatScene, Flattener, flatten};
use isolith::gallery;
use isolith::render::{Gpu, OverlaySettings, Renderer, Slot};

/// Size of the viewport in pixels.
const SIZE: [u32; 2] = [1280, 720];

fn stations(c: &mut Criterion) {
    let (mut document, dragged) = ten_thousand::document();
    c.bench_function("flatten 10 000 nodes", |b| b.iter(|| black_box(flatten(document.scene(), 0.0))));
    c.bench_function("snapshot of 10 000 nodes", |b| {
        b.iter(|| {
            // The first edit of a gesture copies the node table, because the undo history still holds the old one.
            document.begin_gesture();
            ten_thousand::drag(&mut document, dragged, 0.31);
            document.end_gesture();
            document.undo()
        });
    });
}

fn drag(c: &mut Criterion) {
    let (mut document, dragged) = ten_thousand::document();
    let gpu = Gpu::headless().unwrap_or_else(|error| panic!("{error}"));
    let mut renderer = Renderer::new(&gpu).expect("a renderer on a device that answers");
    let mut flattener = Flattener::default();
    let mut shown = flattener.flatten(document.scene(), 0.0).expect("within the limits");
    let camera = shown.default_camera(&[], 16.0 / 9.0);
    ten_thousand::warm(&mut renderer, &shown, &camera, SIZE);
    let mut begin = |flat: &FlatScene| {
        renderer.begin(Slot::Full, flat, &[], &camera, SIZE, OverlaySettings::default()).expect("a frame");
        renderer.pipelines().built()
    };
    let built = begin(&shown);
    document.begin_gesture();
    let mut radius = 0.3;
    c.bench_function("drag at 10 000 nodes: edit, flatten, upload, plan", |b| {
        b.iter(|| {
            radius = if radius > 0.5 { 0.3 } else { radius + 0.001 };
            ten_thousand::drag(&mut document, dragged, radius);
            // Keep the displayed arrays alive during the measurement, as the editor does.
            let flat = flattener.flatten(document.scene(), 0.0).expect("within the limits");
            assert_eq!(begin(&flat), built, "a drag built a pipeline");
            shown = flat;
        });
    });
    document.end_gesture();
    drop(shown);
}

/// Lighting and overlay only, on top of existing hits.
fn light(c: &mut Criterion) {
    let gpu = Gpu::headless().unwrap_or_else(|error| panic!("{error}"));
    let mut renderer = Renderer::new(&gpu).expect("a renderer on a device that answers");
    let (_, scene) = gallery::all().into_iter().find(|(name, _)| *name == "random-145").expect("a shipped scene");
    let flat = flatten(&scene, 0.0).expect("within the limits");
    let camera = flat.default_camera(&[], 16.0 / 9.0);
    let mut draw = |overlay: &OverlaySettings, light_only: bool| {
        let mut frame = renderer.begin(Slot::Full, &flat, &[], &camera, SIZE, overlay.clone()).expect("a frame");
        if light_only {
            frame.skip_to_shading();
        }
        renderer.advance(&mut frame, Duration::MAX).expect("a picture");
    };
    draw(&OverlaySettings::default(), false);
    let outline = scene.nodes().iter().take(40).map(|node| node.id).collect();
    for (name, overlay) in [
        ("light", OverlaySettings::default()),
        ("light and grid", OverlaySettings { grid: true, ..Default::default() }),
        ("light and outline", OverlaySettings { outline, ..Default::default() }),
    ] {
        c.bench_function(name, |b| b.iter(|| draw(&overlay, true)));
    }
}

criterion_group!(benches, stations, drag, light);
criterion_main!(benches);
