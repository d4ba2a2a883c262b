//! Choice of evaluators, and the time that a picture waits for compiling.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use isolith::field::flatten;
use isolith::field::reference::image::render_reference;
use isolith::geometry::Camera;
use isolith::render::{EvalStrategy, Gpu, OverlaySettings, Renderer, Slot, coarse_size};
use isolith::scene::{
    Blend, BlendKernel, Group, MaterialId, Node, NodeKind, Object, Operator, Scene, Shape, ShapeKind, file,
};
use isolith::wgsl::tapes_are_cheaper;

use crate::gpu::{BenchScene, scenes};

fn case(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases/numerics").join(name)
}

/// For every component of the scene, whether the window first draws it by tapes.
fn listed(flat: &isolith::field::FlatScene) -> Vec<bool> {
    let leaves = flat.nodes.iter().filter(|node| node.is_leaf());
    let kinds: BTreeSet<ShapeKind> = leaves.map(|node| ShapeKind::ALL[(node.code & 0xffff) as usize]).collect();
    flat.components.iter().map(|component| tapes_are_cheaper(flat, component, &kinds, None)).collect()
}

/// Straight-line code takes nine times as long as tapes for these 60 blended tubes.
#[test]
fn a_blend_of_many_dear_leaves_is_drawn_by_tapes() {
    let scene = file::load(&case("auto_is_slow_60_tube.json")).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(listed(&flatten(&scene, 0.0).expect("within the limits")), [true]);
}

/// Straight-line code takes a fifth of the time for groups of eight leaves.
#[test]
fn small_groups_are_drawn_by_straight_line_code() {
    for name in ["random-37", "random-145", "random-577"] {
        let scene = scenes().find(|scene| scene.name == name).expect("an example");
        assert!(listed(&scene.flat).iter().all(|is_listed| !is_listed), "{name}");
    }
}

/// A hundred groups, each the second child of the one before: an interpreter pipeline has its stack size compiled in.
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
    // Tapes have looser bounds away from the surface, so rays here pass skins a fraction of a pixel thick.
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

/// The whole program with a driver that has compiled nothing yet. It took 45 s at 100 levels, nearly all of it
/// compiling.
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
        // 2 to 4 s on two idle cores; other tests run at the same time.
        assert!(started.elapsed() < Duration::from_secs(20), "{name}: {:?}", started.elapsed());
    }
}

/// Nested groups with alternating operators, each the second child of the one before; each contains a ball.
fn nested(groups: usize) -> Scene {
    let mut scene = Scene::new();
    let mut parent = None;
    for level in 0..groups {
        let operator = [Operator::Union, Operator::Intersection, Operator::Difference][level % 3];
        let group = Group::new(operator, Blend::new(BlendKernel::Quadratic, 0.02));
        let mut add = |node: Node| scene.insert(parent, usize::MAX, node).expect("room");
        let ball = Object { shape: Shape::Sphere { radius: 0.5 }, material: MaterialId(1) };
        let angle = level as f64;
        let at = glam::DVec3::new(0.3 * angle.cos(), 0.3 * angle.sin(), 0.01 * angle);
        if level > 0 {
            add(Node::new("", NodeKind::Object(ball.clone())).at(at));
        }
        let inner = add(Node::new("", NodeKind::Group(group)));
        scene.insert(Some(inner), usize::MAX, Node::new("", NodeKind::Object(ball)).at(at)).expect("room");
        parent = Some(inner);
    }
    scene
}

/// Size of the window's picture, in pixels.
const WINDOW: [u32; 2] = [641, 401];
/// The window's limit for an immediate picture: see `app::canvas`.
const AT_ONCE: Duration = Duration::from_millis(60);
const WORTH_WAITING: [Duration; 2] = [Duration::from_millis(1500), Duration::from_millis(300)];

/// Draws as the window does after it opens a scene, on a newly opened device. Returns the times to the first coarse
/// picture and to the full one.
fn first_pictures(scene: &Scene) -> [Duration; 2] {
    let flat = flatten(scene, 0.0).expect("within the limits");
    let camera: Camera = flat.default_camera(&[], f64::from(WINDOW[0]) / f64::from(WINDOW[1]));
    let gpu = Gpu::headless().unwrap_or_else(|error| panic!("{error}"));
    let mut renderer = Renderer::new(&gpu).expect("a renderer");
    let started = Instant::now();
    let mut full = renderer.estimate(&flat, &camera, WINDOW).expect("an estimate");
    let draw = |renderer: &mut Renderer, slot, size| {
        let frame = renderer.begin(slot, &flat, &[], &camera, size, OverlaySettings::default());
        renderer.advance(&mut frame.expect("a frame"), Duration::MAX).expect("a picture");
        started.elapsed()
    };
    let coarse = draw(&mut renderer, Slot::Preview, coarse_size(WINDOW, full, AT_ONCE));
    loop {
        renderer.pipelines().collect();
        let waits = full > WORTH_WAITING[0] && renderer.pipelines_building() > 0;
        if !(waits || full > WORTH_WAITING[1] && renderer.tape_cache().building() > 0) {
            break;
        }
        std::thread::sleep(Duration::from_millis(10));
        full = renderer.estimate(&flat, &camera, WINDOW).expect("an estimate");
    }
    [coarse, draw(&mut renderer, Slot::Full, WINDOW)]
}

/// Time limits of the first coarse and full picture with a driver that has compiled nothing yet: 2 and 10 s on an idle
/// machine, where both together take 1.2 s of processor time. Other tests run at the same time and made it five times
/// as long. It was 16 s for 40 nested groups and 250 s for 100.
const FIRST: [Duration; 2] = [Duration::from_secs(10), Duration::from_secs(50)];

/// With `MESA_SHADER_CACHE_DISABLE=true` it shows the times of a cold driver.
#[test]
#[expect(clippy::print_stdout, reason = "a test has no other way to say how long something took")]
fn the_first_pictures_of_nested_groups_wait_for_no_compiler() {
    let case = file::load(&case("deep_nest_100_alternating.json")).unwrap_or_else(|error| panic!("{error}"));
    for (name, scene) in [("40 nested", nested(40)), ("100 nested", nested(100)), ("the case", case)] {
        let [coarse, full] = first_pictures(&scene);
        println!("{name}: coarse after {:.2} s, full after {:.2} s", coarse.as_secs_f64(), full.as_secs_f64());
        assert!(coarse < FIRST[0] && full < FIRST[1], "{name}: {coarse:?}, {full:?}");
    }
}
