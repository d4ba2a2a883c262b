//! Pictures of copies against the reference, ray for ray.

#![allow(clippy::print_stdout, reason = "the figures are for whoever runs this with `--nocapture`")]

use glam::DVec3;

use isolith::field::Accuracy;
use isolith::field::reference::accuracy::verdicts;
use isolith::field::reference::image::render_reference;
use isolith::geometry::Camera;
use isolith::render::{EvalStrategy, OverlaySettings, Renderer, Slot};
use isolith::scene::{
    DynamicKind, Instancer, Lattice, Material, MaterialVariation, Modifier, Node, NodeKind, Scene, Variation,
};
use isolith::wgsl::Options;

use crate::copies::{limited, scene_of, varied};
use crate::gpu::{BenchScene, shared};

/// Width and height of the pictures, in pixels.
const SIDE: u32 = 96;

/// Lattices without end along one, two and three axes.
pub fn unlimited() -> Vec<(&'static str, Scene, DVec3)> {
    let of = |counts, spacing, probability| {
        let lattice = Lattice::Grid { counts, spacing };
        scene_of(Instancer { lattice, variation: varied(), probability, seed: 5, ..Instancer::default() }, &[])
    };
    vec![
        ("row", of([0, 1, 1], [1.5; 3], 0.9), DVec3::new(-4.0, 1.5, 3.0)),
        ("plane", of([0, 1, 0], [1.5, 1.0, 1.5], 0.7), DVec3::new(1.0, 3.0, 6.0)),
        ("space", of([0; 3], [3.0; 3], 0.5), DVec3::new(1.3, 1.7, 1.6)),
        ("far away", of([0, 1, 0], [1.5, 1.0, 1.5], 0.7), DVec3::new(60_000.0, 3.0, -40_000.0)),
    ]
}

/// What is wrong about the pictures of a scene by every evaluator.
pub fn faults(drawn: &BenchScene, meant: &BenchScene) -> Vec<String> {
    let reference = render_reference(&meant.flat, &meant.meshes, &meant.camera, [SIDE, SIDE], &|_| ());
    let reference = reference.unwrap_or_else(|error| panic!("{}: {error}", meant.name));
    let hits = reference.buffers.depth.iter().filter(|depth| depth.is_finite()).count();
    assert!(hits > 100, "{}: only {hits} pixels show a copy", meant.name);
    let strategies = [EvalStrategy::Interpreter, EvalStrategy::Tape, EvalStrategy::StraightLine];
    let all = strategies.map(|strategy| {
        let picture = drawn.render(SIDE, strategy);
        let found = Accuracy::against(&picture, &drawn.flat, &reference);
        let wrong: Vec<_> = (0..picture.depth.len())
            .zip(verdicts(&picture, &drawn.flat, &reference))
            .filter(|(_, verdict)| verdict.is_wrong())
            .map(|(i, _)| (i as u32 % SIDE, i as u32 / SIDE, picture.depth[i], reference.buffers.depth[i]))
            .take(4)
            .collect();
        let of_scene = |fault: String| format!("{}, {strategy:?}: {fault} ({found:?}; {wrong:?})", drawn.name);
        found.faults().into_iter().map(of_scene).collect::<Vec<_>>()
    });
    all.concat()
}

#[test]
fn pictures_of_copies_are_as_exact_as_promised() {
    let scenes = limited().into_iter().map(|(name, scene)| BenchScene::new(name, &scene, None));
    let faults: Vec<_> = scenes.flat_map(|scene| faults(&scene, &scene)).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn pictures_of_copies_without_end_are_as_exact_as_promised() {
    let scenes = unlimited().into_iter().map(|(name, scene, eye)| {
        let mut drawn = BenchScene::new(name, &scene, None);
        drawn.camera = Camera::looking_at(eye, eye + DVec3::new(0.3, -0.25, -1.0), 0.8);
        drawn
    });
    let faults: Vec<_> = scenes.flat_map(|scene| faults(&scene, &scene)).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Rays that skim over so many places of a list that no dispatch comes to an end.
fn skimmed() -> BenchScene {
    let lattice = Lattice::Polar { count: 6, rings: 250, radius: 1.0, spacing: 0.1 };
    let variation = Variation { scale_min: [0.08; 3], scale_max: [0.2; 3], ..varied() };
    let instancer = Instancer { lattice, variation, seed: 5, ..Instancer::default() };
    let scene = scene_of(instancer, &[DynamicKind::FractionalBrownianMotion]);
    let mut drawn = BenchScene::new("skimmed", &scene, None);
    let eye = DVec3::new(-24.0, 0.5, 0.0);
    drawn.camera = Camera::looking_at(eye, eye + DVec3::new(1.0, -0.01, 0.02), 0.12);
    drawn
}

#[test]
fn walks_through_long_lists_go_on_where_they_were_left() {
    let scene = skimmed();
    assert_eq!(faults(&scene, &scene), [""; 0]);
}

#[test]
fn a_picture_of_other_copies_is_refused() {
    let of = |seed| {
        let lattice = Lattice::Grid { counts: [4; 3], spacing: [1.5; 3] };
        let scene = scene_of(Instancer { lattice, variation: varied(), seed, ..Instancer::default() }, &[]);
        BenchScene::new("copies", &scene, None)
    };
    let (mut drawn, meant) = (of(1), of(2));
    drawn.camera = meant.camera;
    assert_eq!(faults(&meant, &meant), [""; 0]);
    assert!(!faults(&drawn, &meant).is_empty());
}

/// The first type of a scene, twisted.
fn twisted() -> BenchScene {
    let lattice = Lattice::Grid { counts: [3, 1, 3], spacing: [1.5; 3] };
    let mut scene = scene_of(Instancer { lattice, variation: varied(), seed: 2, ..Instancer::default() }, &[]);
    let top = scene.children(None).next().expect("the instancer").id;
    let node = Node::clone(scene.children(Some(top)).next().expect("a type"));
    scene.replace(node.modified(Modifier::Twist { angle: 90.0 })).expect("a valid node");
    BenchScene::new("twisted", &scene, None)
}

#[test]
fn types_may_have_modifiers() {
    let scene = twisted();
    assert!(scene.flat.components.iter().any(|component| component.is_modified()));
    assert_eq!(faults(&scene, &scene), [""; 0]);
}

/// A scene whose copies differ in color by `by`.
fn colored(by: MaterialVariation, picks: bool) -> BenchScene {
    let lattice = Lattice::Grid { counts: [6, 1, 6], spacing: [1.3; 3] };
    let instancer = Instancer { lattice, variation: varied(), seed: 2, material: by, ..Instancer::default() };
    let mut scene = scene_of(instancer.clone(), &[]);
    let [mut own, mut other] = [0.9, 0.1].map(|red| {
        let mut material = Material::clone(&scene.materials()[0]);
        material.base_color = [red, 0.4, 0.2];
        material
    });
    other.id = scene.next_material_id();
    own.name = "Own".into();
    let palette = if picks { vec![own.id, other.id] } else { Vec::new() };
    scene.replace_material(own).expect("a valid material");
    scene.insert_material(other).expect("room for a material");
    let mut top = Node::clone(scene.children(None).next().expect("the instancer"));
    top.kind = NodeKind::Instancer(Box::new(Instancer { palette, ..instancer }));
    scene.replace(top).expect("a valid node");
    BenchScene::new("colored", &scene, None)
}

/// Share of the pixels with the same surface in both whose colors differ by more than rounding.
fn differing_colors(drawn: &BenchScene, meant: &BenchScene) -> f64 {
    let reference = render_reference(&meant.flat, &meant.meshes, &meant.camera, [SIDE, SIDE], &|_| ());
    let reference = reference.expect("an end").buffers;
    let picture = drawn.render(SIDE, EvalStrategy::Tape);
    let same = |i: &usize| {
        let [a, b] = [picture.depth[*i], reference.depth[*i]];
        a.is_finite() && b.is_finite() && (a - b).abs() < 1e-4 * b && picture.leaf[*i] == reference.leaf[*i]
    };
    let both: Vec<usize> = (0..picture.depth.len()).filter(same).collect();
    assert!(both.len() > 200, "{} pixels", both.len());
    let differs = |i: &&usize| (0..3).any(|c| picture.color[**i][c].abs_diff(reference.color[**i][c]) > 2);
    both.iter().filter(differs).count() as f64 / both.len() as f64
}

#[test]
fn copies_have_colors_of_their_own() {
    let by = MaterialVariation { hue: 0.4, saturation: 0.5, value: 0.6, roughness: 0.3, emission: 0.0 };
    for picks in [false, true] {
        let varied = colored(by, picks);
        let found = differing_colors(&varied, &varied);
        assert!(found < 0.01, "{found} of the pixels differ");
    }
    let [some, none] = [by, MaterialVariation::default()].map(|by| colored(by, false));
    assert!(differing_colors(&some, &none) > 0.5 && differing_colors(&colored(by, true), &some) > 0.2);
}

/// One view of ever more copies: a ray looks at those it meets, however many there are.
#[test]
fn work_does_not_grow_with_the_number_of_copies() {
    let gpu = shared().gpu.clone();
    let options = Options { counting: true, ..Renderer::options(&gpu) };
    let mut renderer = Renderer::with_options(&gpu, options).expect("a renderer");
    renderer.set_strategy(EvalStrategy::Tape);
    let mut means = Vec::new();
    for side in [10, 100, 1_000, 1_000_000] {
        let lattice = Lattice::Grid { counts: [side, 1, side], spacing: [1.5; 3] };
        let scene = scene_of(Instancer { lattice, variation: varied(), seed: 5, ..Instancer::default() }, &[]);
        let scene = BenchScene::new("copies", &scene, None);
        let camera = Camera::looking_at(DVec3::new(0.0, 4.0, 8.0), DVec3::ZERO, 0.8);
        let overlay = OverlaySettings::default();
        let begun = renderer.begin(Slot::Full, &scene.flat, &scene.meshes, &camera, [SIDE, SIDE], overlay);
        let mut frame = begun.expect("a frame");
        renderer.advance(&mut frame, std::time::Duration::MAX).expect("a picture");
        assert_eq!(renderer.unfinished_rays(&frame).expect("counts"), []);
        means.push(renderer.pixel_counts(&frame).expect("counts").steps().mean);
    }
    println!("evaluations per pixel of 10^2, 10^4, 10^6, 10^12 copies: {means:.2?}");
    // The first has room for more copies in view.
    assert!(means[1..].iter().all(|mean| *mean < 1.2 * means[1]) && means[1] < 40.0, "{means:?}");
}
