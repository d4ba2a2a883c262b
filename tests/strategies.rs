//! All strategies draw the same picture: hit or miss is equal for each pixel, and depths agree to the tolerance of
//! refinement.

use std::sync::LazyLock;
use std::time::Duration;

use glam::DVec3;
use isolith::field::reference::image::render_reference;
use isolith::field::{GBuffer, flatten, has_tape};
use isolith::gallery;
use isolith::render::{EvalStrategy, OverlaySettings, Renderer, Slot};
use isolith::scene::{
    Blend, BlendKernel, Group, MaterialId, ModifierKind, Node, NodeKind, Object, Operator, Scene, ShapeKind,
};
use isolith::wgsl::shape_loops;

use crate::contract::modifiers::{modified, modified_crowds, samples};
use crate::contract::trees::{Recipe, tree};
use crate::gpu::{BenchScene, scenes, shared};

/// Width and height of the pictures, in pixels.
const SIDE: u32 = 48;
/// Largest difference of two depths, in pixel footprints, of all but the most extreme pixels. Refinement stops at a
/// thousandth; for pipelines with large oversteps at four thousandths; at grazing angles at three hundredths of a step.
const MAX_DEPTH: f64 = 0.05;
/// Fraction of the pixels that may differ more: where a ray meets two surfaces within a footprint of each other,
/// strategies may find either.
const MAX_SHARE: f64 = 2e-3;
/// Number of random trees, and of trees that share a palette of shapes.
const TREES: u64 = 220;
const TREES_OF_A_KIND: u64 = 20;

/// Describes how two pictures differ; `None` if they agree. A pixel whose ray passes an edge within rounding may show
/// either side.
fn difference(bench_scene: &BenchScene, side: u32, a: &GBuffer, b: &GBuffer) -> Option<String> {
    let BenchScene { flat, meshes, camera, .. } = bench_scene;
    let footprint = camera.footprint(f64::from(side));
    let pairs = || a.depth.iter().zip(&b.depth).map(|(a, b)| (f64::from(*a), f64::from(*b)));
    let is_other = |(a, b): (f64, f64)| a.is_finite() != b.is_finite();
    let mut others: Vec<usize> = pairs().enumerate().filter(|(_, pair)| is_other(*pair)).map(|(i, _)| i).collect();
    if !others.is_empty() {
        let reference = render_reference(flat, meshes, camera, [side; 2], &|_| ()).expect("the reference");
        others.retain(|i| !reference.is_undecided(*i));
    }
    let error = |(a, b): (f64, f64)| (a - b).abs() / (footprint * a);
    let far = pairs().filter(|(a, b)| a.is_finite() && b.is_finite()).filter(|pair| error(*pair) > MAX_DEPTH).count();
    let is_equal = others.is_empty() && far as f64 <= MAX_SHARE * a.depth.len() as f64;
    (!is_equal).then(|| format!("{} pixels differ in hit or miss, {far} in depth", others.len()))
}

/// Compares the interpreter's picture with those of the others.
fn compare(bench_scene: &BenchScene, side: u32, strategies: &[EvalStrategy]) -> Vec<String> {
    let reference = bench_scene.render(side, EvalStrategy::Interpreter);
    let of = |strategy: &EvalStrategy| {
        let found = difference(bench_scene, side, &reference, &bench_scene.render(side, *strategy))?;
        Some(format!("{}, {strategy:?}: {found}", bench_scene.name))
    };
    strategies.iter().filter_map(of).collect()
}

#[test]
fn every_scene_is_the_same_by_every_method() {
    let both = [EvalStrategy::Tape, EvalStrategy::StraightLine];
    let faults: Vec<String> = scenes().flat_map(|scene| compare(&scene, 2 * SIDE, &both)).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn crowds_are_the_same_with_tapes() {
    let all =
        [("crowd", gallery::crowd(120, true, 1)), ("boxes", gallery::boxes(60, 2)), ("spheres", gallery::spheres(3))];
    let bench_scene = |(name, scene)| compare(&BenchScene::new(name, &scene, None), SIDE, &[EvalStrategy::Tape]);
    let faults: Vec<String> = all.into_iter().flat_map(bench_scene).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Palettes for some of the trees each: a few shapes without loops and one with. Together they contain all shapes.
///
/// An interpreter pipeline takes seconds to compile. It serves all scenes whose shapes are a slightly smaller subset of
/// its own.
fn palettes() -> &'static [Vec<ShapeKind>] {
    static PALETTES: LazyLock<Vec<Vec<ShapeKind>>> = LazyLock::new(|| {
        let (looping, plain): (Vec<_>, Vec<_>) = ShapeKind::ALL.iter().partition(|kind| shape_loops(**kind)[0] > 0);
        let count = (TREES / TREES_OF_A_KIND) as usize;
        let each = plain.len().div_ceil(count);
        assert!(looping.len() <= count);
        let palette = |i: usize| {
            let plain = plain.iter().cycle().skip(i * each).take(each);
            plain.chain(looping.iter().cycle().skip(i).take(1)).copied().collect()
        };
        (0..count).map(palette).collect()
    });
    &PALETTES
}

/// These shapes, nested to the usual depth of trees, with every operator and every blend.
fn sheet(kinds: &[ShapeKind]) -> Scene {
    let mut scene = Scene::new();
    let mut parent = None;
    for (i, operator) in Operator::ALL.into_iter().enumerate() {
        let blend = Blend::new(BlendKernel::ALL[i % BlendKernel::ALL.len()], 0.1);
        let group = Node::new("Group", NodeKind::Group(Group::new(operator, blend)));
        parent = Some(scene.insert(parent, usize::MAX, group).unwrap());
        let object = Object { shape: kinds[i % kinds.len()].default_shape(), material: MaterialId(1) };
        scene.insert(parent, usize::MAX, Node::new("Part", NodeKind::Object(object))).unwrap();
    }
    scene
}

#[test]
fn random_trees_are_the_same_by_every_method() {
    let mut faults = Vec::new();
    for seed in 0..TREES {
        let kinds = &palettes()[(seed / TREES_OF_A_KIND) as usize];
        if seed % TREES_OF_A_KIND == 0 {
            for kinds in [&kinds[..kinds.len() - 1], kinds] {
                BenchScene::new("sheet", &sheet(kinds), None).render(1, EvalStrategy::Interpreter);
            }
        }
        let scene = tree(1000 + seed, Recipe { blends: true, stretching: seed % 2 == 0, kinds });
        let bench_scene = BenchScene::new(&format!("tree {seed}"), &scene, None);
        // Each structure needs compiling, so test every fourth only.
        let strategies: &[EvalStrategy] =
            if seed % 4 == 0 { &[EvalStrategy::Tape, EvalStrategy::StraightLine] } else { &[EvalStrategy::Tape] };
        faults.extend(compare(&bench_scene, SIDE, strategies));
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Many structures share pipelines through their templates, one for each kind of blend.
#[test]
fn many_structures_share_pipelines_and_are_the_same() {
    let bench_scene = BenchScene::new("random", &gallery::random(384, 5), None);
    let reference = bench_scene.render(SIDE, EvalStrategy::Interpreter);
    let gpu = shared().gpu.clone();
    let mut renderer = Renderer::new(&gpu).expect("a renderer");
    let BenchScene { flat, meshes, camera, .. } = &bench_scene;
    let begin = |renderer: &mut Renderer| {
        renderer.begin(Slot::Full, flat, meshes, camera, [SIDE, SIDE], OverlaySettings::default()).expect("a frame")
    };
    let mut frame = begin(&mut renderer);
    while renderer.is_preparing() {
        std::thread::sleep(Duration::from_millis(20));
        frame = begin(&mut renderer);
    }
    let structures = flat.components.len();
    assert!(structures >= 48 && renderer.pipelines().built() < 16, "{} pipelines", renderer.pipelines().built());
    renderer.advance(&mut frame, Duration::MAX).expect("a picture");
    let picture = renderer.read(&frame).expect("buffers");
    assert_eq!(difference(&bench_scene, SIDE, &reference, &picture), None);
}

#[test]
fn what_is_modified_is_the_same_by_every_method() {
    let mut faults = Vec::new();
    for &kind in ModifierKind::ALL {
        for modifier in samples(kind, 1) {
            let scene = modified(std::slice::from_ref(&modifier));
            if flatten(&scene, 0.0).is_ok() {
                let bench_scene = BenchScene::new(&format!("{modifier:?}"), &scene, None);
                faults.extend(compare(&bench_scene, SIDE, &[EvalStrategy::StraightLine]));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// The content of a modifier has its own tapes, in its own space.
#[test]
fn large_blends_below_modifiers_are_the_same_with_tapes() {
    let mut all = Scene::new();
    for (i, crowd) in modified_crowds().iter().enumerate() {
        let root = Node::clone(&crowd.nodes()[0]).at(DVec3::new(4.0 * (i % 4) as f64, 4.0 * (i / 4) as f64, 0.0));
        let parent = all.insert(None, usize::MAX, root).unwrap();
        for leaf in &crowd.nodes()[1..] {
            all.insert(Some(parent), usize::MAX, Node::clone(leaf)).unwrap();
        }
    }
    let bench_scene = BenchScene::new("modified crowds", &all, None);
    assert!(
        bench_scene.flat.components.iter().filter(|c| c.is_modified() && has_tape(&bench_scene.flat, c)).count() >= 8
    );
    assert_eq!(compare(&bench_scene, 2 * SIDE, &[EvalStrategy::Tape]), Vec::<String>::new());
}

#[test]
fn a_different_picture_is_refused() {
    let bench_scene = BenchScene::new("crowd", &gallery::crowd(20, true, 1), None);
    let picture = bench_scene.render(SIDE, EvalStrategy::Interpreter);
    let footprint = bench_scene.camera.footprint(f64::from(SIDE));
    assert_eq!(difference(&bench_scene, SIDE, &picture, &picture), None);
    let mut missing = picture.clone();
    let hit = missing.depth.iter().position(|d| d.is_finite()).expect("something is seen");
    missing.depth[hit] = f32::INFINITY;
    assert!(difference(&bench_scene, SIDE, &picture, &missing).is_some());
    let mut farther = picture.clone();
    farther.depth.iter_mut().for_each(|d| *d *= 1.0 + 0.1 * footprint as f32);
    assert!(difference(&bench_scene, SIDE, &picture, &farther).is_some());
}
