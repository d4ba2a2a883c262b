//! Pipelines that skip by branches are correct. Graphics cards get them. Here lavapipe runs them, slowly, because it
//! executes both sides of each branch. Interpreter and tapes have the same source on every device.

use std::sync::{LazyLock, Mutex, PoisonError};
use std::time::Duration;

use glam::{DQuat, DVec3};
use isolith::field::reference::accuracy::{Verdict, verdicts};
use isolith::field::reference::image::render_reference;
use isolith::field::{FlatScene, GBuffer};
use isolith::geometry::{Aabb, Camera};
use isolith::render::{EvalStrategy, OverlaySettings, Renderer, Slot};
use isolith::scene::{Node, NodeKind, ParamValue, Scene, ShapeKind};
use isolith::wgsl::{Evaluator, Options, SkipMode, Structure, assemble};

use crate::contract::samples::Random;
use crate::contract::trees::{Recipe, tree};
use crate::golden::{Gate, compare_with_accepted};
use crate::gpu::{BenchScene, shared};

/// Number of random trees, and of trees that share a structure: compiling a structure takes half a second.
const TREES: u64 = 200;
const TREES_OF_A_STRUCTURE: u64 = 10;
/// Number of structures whose sources are compared.
const COUNTED_STRUCTURES: u64 = 20;
/// Width and height of their pictures, in pixels.
const SIDE: u32 = 24;

/// Draws with pipelines that skip by branches, once all of them are compiled.
fn draw(bench_scene: &BenchScene, side: u32, method: EvalStrategy) -> GBuffer {
    static RENDERER: LazyLock<Mutex<Renderer>> = LazyLock::new(|| {
        let gpu = shared().gpu.clone();
        let options = Options { skip_mode: SkipMode::Branches, ..Options::default() };
        Mutex::new(Renderer::with_options(&gpu, options).expect("a renderer"))
    });
    let renderer = &mut *RENDERER.lock().unwrap_or_else(PoisonError::into_inner);
    renderer.set_strategy(method);
    let BenchScene { flat, meshes, camera, name } = bench_scene;
    loop {
        let frame = renderer.begin(Slot::Full, flat, meshes, camera, [side; 2], OverlaySettings::default());
        frame.unwrap_or_else(|error| panic!("{name}: {error}"));
        if !renderer.is_preparing() {
            break;
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    assert_eq!(renderer.pipelines_failed(), 0, "{name}");
    let picture = renderer.render(flat, meshes, camera, [side; 2], &mut |_| true);
    let (buffers, unfinished) = picture.unwrap_or_else(|error| panic!("{name}: {error}"));
    assert!(unfinished.is_empty(), "{name}: {unfinished:?}");
    buffers
}

#[test]
fn every_scene_looks_as_accepted_by_branching_kernels() {
    compare_with_accepted("branching", Gate::Close, |scene, side| draw(scene, side, EvalStrategy::Auto));
}

/// A random tree of any shapes; trees of one structure differ in their parameters only.
fn random_tree(seed: u64) -> BenchScene {
    let of_structure = 5000 + seed / TREES_OF_A_STRUCTURE;
    let recipe = Recipe { blends: true, stretching: of_structure.is_multiple_of(2), kinds: ShapeKind::ALL };
    let mut scene = tree(of_structure, recipe);
    vary(&mut scene, &mut Random::new(seed));
    let mut bench_scene = BenchScene::new(&format!("tree {seed}"), &scene, None);
    bench_scene.camera = around(&bench_scene.flat);
    bench_scene
}

/// A camera whose picture is filled by the bounded components.
fn around(flat: &FlatScene) -> Camera {
    let bounded = flat.components.iter().filter(|component| component.bounds.is_finite());
    let bounds = bounded.fold(Aabb::EMPTY, |all, component| all.union(&component.bounds.translated(component.origin)));
    let (center, reach) =
        if bounds.is_empty() { (DVec3::ZERO, 1.0) } else { (bounds.center(), bounds.half().max_element()) };
    Camera::looking_at(center + DVec3::new(1.1, 0.9, 1.4) * (1.5 * reach), center, 0.7)
}

/// Slightly moves, turns and scales every node, and changes sizes and blends.
fn vary(scene: &mut Scene, random: &mut Random) {
    let nodes: Vec<Node> = scene.nodes().iter().map(|node| Node::clone(node)).collect();
    for mut node in nodes {
        node.transform.translation += random.point(0.2);
        node.transform.rotation *= DQuat::from_axis_angle(random.direction(), random.range(0.0, 0.5));
        node.transform.scale *= random.range(0.9, 1.1);
        match &mut node.kind {
            NodeKind::Group(group) => group.blend.radius *= random.range(0.5, 1.5),
            NodeKind::Object(object) => {
                let params = object.shape.kind().params();
                for (i, value) in object.shape.values().into_iter().enumerate() {
                    if let (ParamValue::Scalar(size), "m") = (value, params[i].limits.unit) {
                        object.shape.set_value(i, ParamValue::Scalar(size * random.range(0.8, 1.1)));
                    }
                }
            }
            _ => {}
        }
        scene.replace(node).expect("it keeps the rules");
    }
}

/// Number of wrong pixels against the reference of `meant`, and of pixels that show anything.
fn wrong(picture: &GBuffer, drawn: &BenchScene, meant: &BenchScene) -> [usize; 2] {
    let reference = render_reference(&meant.flat, &meant.meshes, &meant.camera, [SIDE; 2], &|_| ());
    let reference = reference.unwrap_or_else(|error| panic!("{}: {error}", meant.name));
    let wrong = verdicts(picture, &drawn.flat, &reference).into_iter().filter(|verdict: &Verdict| verdict.is_wrong());
    [wrong.count(), reference.buffers.depth.iter().filter(|depth| depth.is_finite()).count()]
}

#[test]
fn random_trees_are_right_by_branching_kernels() {
    let (mut faults, mut all_wrong, mut hits, mut shown) = (Vec::new(), 0, 0, 0);
    for seed in 0..TREES {
        let tree = random_tree(seed);
        let [wrong, seen] = wrong(&draw(&tree, SIDE, EvalStrategy::StraightLine), &tree, &tree);
        hits += seen;
        all_wrong += wrong;
        shown += usize::from(seen > 20);
        if wrong > 0 {
            faults.push(format!("{}: {wrong} of {seen} pixels", tree.name));
        }
    }
    assert!(hits > 10_000 && shown > 60, "{hits} pixels of {shown} trees show anything");
    // As for all scenes, at most 0.01 % of the pixels.
    assert!(all_wrong * 10_000 <= hits, "{hits} pixels are seen, wrong are:\n{}", faults.join("\n"));
}

#[test]
fn another_tree_is_refused() {
    let (drawn, meant) = (random_tree(0), random_tree(TREES_OF_A_STRUCTURE));
    let [wrong, _] = wrong(&draw(&drawn, SIDE, EvalStrategy::StraightLine), &drawn, &meant);
    assert!(wrong > 20, "{wrong}");
}

/// Without branches in these pipelines, the tests above would prove nothing.
#[test]
fn kernels_for_cards_have_branches_that_others_have_not() {
    let branches = |pass: &str, skip_mode: SkipMode| {
        let of = |structure: u64| {
            let flat = random_tree(structure * TREES_OF_A_STRUCTURE).flat;
            let structures: Vec<_> = flat.components.iter().filter_map(|c| Structure::of(&flat, c)).collect();
            structures.into_iter().map(move |structure| {
                let options = Options { skip_mode, ..Options::default() };
                let text = assemble(pass, &Evaluator::StraightLine(structure), options).expect("a source");
                ["if placed_bounds(", "if share"].map(|branch| text.matches(branch).count()).iter().sum::<usize>()
            })
        };
        (0..COUNTED_STRUCTURES).flat_map(of).sum::<usize>()
    };
    for (pass, least) in [("trace.wgsl", 5), ("surface.wgsl", 50)] {
        assert_eq!(branches(pass, SkipMode::Selects), 0, "{pass}");
        let found = branches(pass, SkipMode::Branches);
        assert!(found > least, "{pass}: {found}");
    }
}
