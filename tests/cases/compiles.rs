//! Choice of evaluators, and how long compiling keeps a picture waiting.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use isolith::flat::flatten;
use isolith::flat::reference::image::render_reference;
use isolith::render::EvalStrategy;
use isolith::render::wgsl::tapes_are_cheaper;
use isolith::scene::{ShapeKind, file};

use crate::gpu::{BenchScene, scenes};

fn case(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases/numerics").join(name)
}

/// Every component of the scene, and whether the window draws it by tapes at first.
fn listed(flat: &isolith::flat::FlatScene) -> Vec<bool> {
    let leaves = flat.nodes.iter().filter(|node| node.is_leaf());
    let kinds: BTreeSet<ShapeKind> = leaves.map(|node| ShapeKind::ALL[(node.code & 0xffff) as usize]).collect();
    flat.components.iter().map(|component| tapes_are_cheaper(flat, component, &kinds, None)).collect()
}

/// By straight-line code these 60 blended tubes take nine times as long as by tapes.
#[test]
fn a_blend_of_many_dear_leaves_is_drawn_by_tapes() {
    let scene = file::load(&case("auto_is_slow_60_tube.json")).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(listed(&flatten(&scene, 0.0).expect("within the limits")), [true]);
}

/// Groups of eight leaves take a fifth of the time by straight-line code.
#[test]
fn small_groups_are_drawn_by_straight_line_code() {
    for name in ["random-37", "random-145", "random-577"] {
        let scene = scenes().find(|scene| scene.name == name).expect("an example");
        assert!(listed(&scene.flat).iter().all(|is_listed| !is_listed), "{name}");
    }
}

/// A hundred groups, each the second child of the one before: what a walk puts aside is compiled into its pipeline.
#[test]
fn deep_nests_are_drawn_right_and_put_little_aside() {
    let scene = file::load(&case("deep_nest_100_alternating.json")).unwrap_or_else(|error| panic!("{error}"));
    let bench_scene = BenchScene::new("deep nest", &scene, None);
    assert!(
        bench_scene.flat.components.iter().all(|component| component.stack <= 8),
        "{:?}",
        bench_scene.flat.components[0]
    );
    const SIDE: u32 = 64;
    let meant = render_reference(&bench_scene.flat, &bench_scene.meshes, &bench_scene.camera, [SIDE, SIDE], &|_| {})
        .expect("traced");
    // Tapes tell less of the field away from the surface, so rays pass skins that are a fraction of a pixel thick here.
    for (strategy, most) in [(EvalStrategy::Interpreter, 0), (EvalStrategy::StraightLine, 0), (EvalStrategy::Tape, 8)] {
        let drawn = bench_scene.render(SIDE, strategy);
        let differ = |i: &usize| {
            let (a, b) = (drawn.depth[*i], meant.buffers.depth[*i]);
            a.is_finite() != b.is_finite() || a.is_finite() && (a - b).abs() > 1e-3 * b
        };
        let wrong = (0..drawn.depth.len()).filter(differ).count();
        assert!(wrong <= most, "{strategy:?}: {wrong}");
    }
}

/// The whole program with a driver that has compiled nothing yet. Took 45 s at 100 levels, nearly all of it compiling.
#[test]
#[cfg(unix)]
fn nothing_waits_long_for_compiling() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    for name in ["deep_nest_100_alternating.json", "auto_is_slow_60_tube.json"] {
        let started = Instant::now();
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_isolith"))
            .args(["render", "-o", "picture.png", "--size", "48x48"])
            .arg(case(name))
            .current_dir(folder.path())
            .env("MESA_SHADER_CACHE_DISABLE", "true")
            .env("XDG_RUNTIME_DIR", folder.path())
            .output()
            .expect("the program starts");
        assert!(output.status.success(), "{name}: {}", String::from_utf8_lossy(&output.stderr));
        // 2 to 4 s on two quiet cores; other tests run at the same time.
        assert!(started.elapsed() < Duration::from_secs(20), "{name}: {:?}", started.elapsed());
    }
}
