//! Accuracy of every scene's picture, cost of a drag, and a comparison with another library, as tables. The program
//! prints them and writes them into `benches/README.md` between their marks. Arguments select tables by name.

#[path = "../tests/gpu.rs"]
mod gpu;
mod peer;
mod ten_thousand;

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;
use std::time::{Duration, Instant};

use isolith::bench::{Baseline, Bench, BenchScene, ReferenceCache};
use isolith::field::reference::image::render_reference;
use isolith::field::{Accuracy, Flattener};
use isolith::mesh::MeshLibrary;
use isolith::render::{EvalStrategy, OverlaySettings, Slot};
use isolith::wgsl::Quality;

/// Width and height of the measured pictures, in pixels.
const SIDE: u32 = 256;
/// Number of samples of a time; the table shows their median.
const REPEATS: usize = 101;

fn main() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/README.md");
    let mut text = std::fs::read_to_string(&path).expect("benches/README.md is part of the source");
    let chosen: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).collect();
    for mark in ["accuracy", "drag", "peer"] {
        if !chosen.is_empty() && chosen.iter().all(|name| name != mark) {
            continue;
        }
        let table = match mark {
            "accuracy" => accuracy(),
            "drag" => drag(),
            _ => peer(),
        };
        writeln!(std::io::stdout(), "{table}").expect("standard output takes text");
        text = replaced(&text, mark, &table);
    }
    std::fs::write(&path, text).expect("benches/README.md can be written");
}

/// Returns `text` with the table between the marks of this name replaced.
fn replaced(text: &str, mark: &str, table: &str) -> String {
    let [begin, end] = ["begin", "end"].map(|side| format!("<!-- {mark}:{side} -->"));
    let start = text.find(&begin).expect("the mark that begins a table") + begin.len();
    let stop = text.find(&end).expect("the mark that ends a table");
    format!("{}\n\n{}\n{}", &text[..start], table, &text[stop..])
}

fn accuracy() -> String {
    let info = gpu::shared().gpu.info.clone();
    let mut out = format!("On {} ({}), {SIDE}x{SIDE} pixels.\n\n", info.name, info.driver_info);
    out += "| scene | strategy | wrong | of them hit or miss | node | depth | grazing % | depth p50 | p99 | max | normal p50 | p99 | |\n";
    out += "|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|---|\n";
    for scene in gpu::scenes() {
        let reference = render_reference(&scene.flat, &scene.meshes, &scene.camera, [SIDE, SIDE], &|_| ());
        let reference = reference.unwrap_or_else(|error| panic!("{}: {error}", scene.name));
        for strategy in [EvalStrategy::Interpreter, EvalStrategy::Tape, EvalStrategy::StraightLine] {
            let a = Accuracy::against(&scene.render(SIDE, strategy), &scene.flat, &reference);
            let verdict = if a.faults().is_empty() { "" } else { "beyond the limit" };
            writeln!(
                out,
                "| {} | {strategy:?} | {} | {} | {} | {} | {:.4} | {:.5} | {:.5} | {:.4} | {:.4} | {:.3} | {verdict} |",
                scene.name,
                a.wrong,
                a.hit_miss_differs,
                a.node_differs,
                a.depth_differs,
                100.0 * a.grazing_share(),
                a.depth_p50,
                a.depth_p99,
                a.depth_max,
                a.normal_p50,
                a.normal_p99,
            )
            .expect("strings take all");
        }
    }
    out
}

/// Width and height of the pictures for the comparison with the peer, in pixels.
const PEER_SIDE: u32 = 512;
/// Voxels along the peer's columns: doubling them halves its error.
const PEER_DEPTHS: [u32; 2] = [512, 2048];
/// Number of times the peer draws; the fastest counts.
const PEER_REPEATS: usize = 2;

/// The peer beside the editor's own strategy, in one run: CPU times of all threads.
fn peer() -> String {
    let mut out = String::from("| scene | by | voxels | CPU ms | build ms | depth p99 | normal p50 | ratio |\n");
    out += "|---|---|--:|--:|--:|--:|--:|--:|\n";
    let bench = Bench::new(gpu::shared().gpu.clone());
    let scenes = [("3 blended", isolith::gallery::random(3, 5)), ("random-37", isolith::gallery::random(32, 5))];
    let more = [("random-145", isolith::gallery::random(128, 5)), ("random-577", isolith::gallery::random(512, 5))];
    for (name, scene) in scenes.into_iter().chain(more) {
        let bench_scene =
            BenchScene::new(name, scene, &mut MeshLibrary::new(None)).unwrap_or_else(|error| panic!("{error}"));
        let reference = ReferenceCache::default().of(&bench_scene, PEER_SIDE).unwrap_or_else(|error| panic!("{error}"));
        let row = bench.measure(&bench_scene, Baseline::Auto, Quality::Default, PEER_SIDE, &reference);
        let row = row.unwrap_or_else(|error| panic!("{name}: {error}"));
        writeln!(
            out,
            "| {name} | isolith | – | {:.0} | – | {:.5} | {:.4} | 1 |",
            row.cpu_ms, row.depth_p99, row.normal_p50
        )
        .expect("strings take all");
        let peer = peer::Peer::new(&bench_scene.flat, &bench_scene.camera).expect("a scene that the peer can express");
        for depth in PEER_DEPTHS {
            let tiles = [&peer::DEFAULT_TILES, &peer::TUNED_TILES];
            let pictures =
                tiles.iter().flat_map(|tiles| (0..PEER_REPEATS).map(|_| peer.render(PEER_SIDE, depth, *tiles)));
            let best = pictures.min_by_key(|picture| picture.cpu).expect("it draws more than once");
            let error = Accuracy::of_depths(&best.buffers(PEER_SIDE), &reference);
            let (ms, build) = (best.cpu.as_secs_f64() * 1e3, peer.build.as_secs_f64() * 1e3);
            writeln!(
                out,
                "| {name} | fidget | {depth} | {ms:.0} | {build:.1} | {:.5} | {:.4} | {:.1} |",
                error.depth_p99,
                error.normal_p50,
                ms / row.cpu_ms
            )
            .expect("strings take all");
        }
    }
    out
}

fn drag() -> String {
    let (mut document, dragged) = ten_thousand::document();
    let renderer = &mut gpu::shared().renderer;
    let mut flattener = Flattener::default();
    let mut shown = flattener.flatten(document.scene(), 0.0).expect("within the limits");
    let camera = shown.default_camera(&[], 16.0 / 9.0);
    let size = [1280, 720];
    renderer.set_strategy(EvalStrategy::Auto);
    ten_thousand::warm(renderer, &shown, &camera, size);
    let built = renderer.pipelines().built();
    let mut rows: [(&str, Vec<Duration>); 4] =
        [("edit", vec![]), ("flatten", vec![]), ("upload and plan", vec![]), ("all", vec![])];
    document.begin_gesture();
    for i in 0..REPEATS {
        let start = Instant::now();
        ten_thousand::drag(&mut document, dragged, 0.3 + 0.001 * i as f64);
        let edited = Instant::now();
        // Keep the displayed arrays alive during the measurement, as the editor does.
        let flat = flattener.flatten(document.scene(), 0.0).expect("within the limits");
        let flattened = Instant::now();
        renderer.begin(Slot::Full, &flat, &[], &camera, size, OverlaySettings::default()).expect("a frame");
        let begun = Instant::now();
        shown = flat;
        let times = [edited - start, flattened - edited, begun - flattened, begun - start];
        rows.iter_mut().zip(times).for_each(|((_, all), time)| all.push(time));
    }
    document.end_gesture();
    drop(shown);
    let mut out = format!("{} nodes, {REPEATS} frames.\n\n", document.scene().nodes().len());
    out += "| station | median ms |\n|---|--:|\n";
    for (name, mut times) in rows {
        times.sort();
        writeln!(out, "| {name} | {:.3} |", times[REPEATS / 2].as_secs_f64() * 1e3).expect("strings take all");
    }
    writeln!(out, "\nPipelines built by the drag: {}.", renderer.pipelines().built() - built)
        .expect("strings take all");
    out
}
