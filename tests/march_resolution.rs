//! Parts of a scene with rays for some of their pixels only, against the same parts with rays for all.

#![allow(clippy::print_stdout, reason = "the figures are for whoever runs this with `--nocapture`")]

use glam::DVec3;

use isolith::field::{GBuffer, HitTarget};
use isolith::geometry::Camera;
use isolith::render::{EvalStrategy, OverlaySettings, Renderer, Slot};
use isolith::scene::{
    Group, Instancer, Lattice, MarchResolution, MarchSettings, Modifier, Node, NodeId, NodeKind, Object, ParamPath,
    ParamValue, Scene, Shape, file,
};
use isolith::wgsl::Options;

use crate::copies::{scene_of, varied};
use crate::gpu::{BenchScene, shared};

/// Width and height of the pictures, in pixels.
const SIDE: u32 = 120;
const COARSE: [MarchResolution; 2] = [MarchResolution::Half, MarchResolution::Quarter];

fn object(scene: &Scene, shape: Shape) -> Node {
    Node::new("Part", NodeKind::Object(Object { shape, material: scene.materials()[0].id }))
}

/// A rough block behind bars, over a floor. Returns the block.
fn block(resolution: MarchResolution, has_others: bool) -> (BenchScene, NodeId) {
    let mut scene = Scene::new();
    let noise = Modifier::Noise { amplitude: 0.15, size: 0.8, octaves: 2, seed: 2 };
    let march = MarchSettings { resolution, ..MarchSettings::default() };
    let node = object(&scene, Shape::Box { size: [3.0; 3], rounding: 0.2 }).modified(noise).marched(march);
    let id = scene.insert(None, 0, node).expect("room");
    if has_others {
        for at in -4..=4 {
            let bar = Shape::Cylinder { radius: 0.02, height: 5.0, rounding: 0.0 };
            let bar = object(&scene, bar).at(DVec3::new(0.4 * f64::from(at), 0.0, 2.6));
            scene.insert(None, usize::MAX, bar).expect("room");
        }
        let floor = object(&scene, Shape::Plane {}).at(DVec3::Y * -1.3);
        scene.insert(None, usize::MAX, floor).expect("room");
    }
    let mut drawn = BenchScene::new("block", &scene, None);
    drawn.camera = Camera::looking_at(DVec3::new(1.5, 1.2, 6.0), DVec3::new(0.0, -0.1, 0.0), 0.8);
    (drawn, id)
}

/// Large balls and boxes on a lattice, over a floor.
fn lattice(resolution: MarchResolution) -> BenchScene {
    let lattice = Lattice::Grid { counts: [6, 1, 6], spacing: [1.5, 1.0, 1.5] };
    let mut scene = scene_of(Instancer { lattice, variation: varied(), seed: 5, ..Instancer::default() }, &[]);
    let top = Node::clone(scene.children(None).next().expect("the instancer"));
    let march = MarchSettings { resolution, ..MarchSettings::default() };
    scene.replace(top.marched(march)).expect("valid settings");
    let floor = object(&scene, Shape::Plane {}).at(DVec3::Y * -0.5);
    scene.insert(None, usize::MAX, floor).expect("room");
    let mut drawn = BenchScene::new("lattice", &scene, None);
    let eye = DVec3::new(1.0, 2.0, 6.0);
    drawn.camera = Camera::looking_at(eye, eye + DVec3::new(-0.1, -0.3, -1.0), 0.6);
    drawn
}

/// The picture, and evaluations of the field per pixel.
fn drawn(scene: &BenchScene, strategy: EvalStrategy) -> (GBuffer, f64) {
    let gpu = shared().gpu.clone();
    let options = Options { counting: true, ..Renderer::options(&gpu) };
    let mut renderer = Renderer::with_options(&gpu, options).expect("a renderer");
    renderer.set_strategy(strategy);
    let overlay = OverlaySettings::default();
    let begun = renderer.begin(Slot::Full, &scene.flat, &scene.meshes, &scene.camera, [SIDE, SIDE], overlay);
    let mut frame = begun.expect("a frame");
    renderer.advance(&mut frame, std::time::Duration::MAX).expect("a picture");
    assert_eq!(renderer.unfinished_rays(&frame).expect("counts"), []);
    let counts = renderer.pixel_counts(&frame).expect("counts").per_pixel(|one| one.evaluations);
    (renderer.read(&frame).expect("a picture"), counts)
}

/// How a picture with few rays of a part differs from that with all.
#[derive(Clone, Copy, Debug, Default)]
struct Difference {
    /// Pixels that show the part in both.
    shared: usize,
    /// Mean and greatest difference of their depths, in footprints.
    mean: f64,
    most: f64,
    /// Pixels that show the part in one of them only.
    one_only: usize,
    /// Others that differ at all.
    others: usize,
}

/// `is_part` tells whether a leaf belongs to the part.
fn difference(scene: &BenchScene, [exact, coarse]: [&GBuffer; 2], is_part: &dyn Fn(usize) -> bool) -> Difference {
    let shows = |picture: &GBuffer, at: usize| match HitTarget::from_code(picture.leaf[at]) {
        HitTarget::Leaf(leaf) => is_part(leaf),
        _ => false,
    };
    let footprint = scene.camera.footprint(f64::from(SIDE));
    let mut found = Difference::default();
    for at in 0..exact.depth.len() {
        match [exact, coarse].map(|picture| shows(picture, at)) {
            [true, true] => {
                let [a, b] = [exact, coarse].map(|picture| f64::from(picture.depth[at]));
                let off = (a - b).abs() / (footprint * a);
                found.shared += 1;
                found.mean += off;
                found.most = found.most.max(off);
            }
            [false, false] => {
                found.others += usize::from(exact.depth[at] != coarse.depth[at] || exact.color[at] != coarse.color[at]);
            }
            _ => found.one_only += 1,
        }
    }
    found.mean /= found.shared.max(1) as f64;
    found
}

/// Whether a difference is as small as promised: a part of a footprint, but where the surface bends otherwise than at the four.
fn is_small(found: &Difference) -> bool {
    found.mean < 0.1 && found.most < 1.5 && found.one_only * 1_000 <= found.shared && found.others == 0
}

/// The picture as if each pixel showed what the one of the coarse grid before it does.
fn blocky(exact: &GBuffer, spacing: u32) -> GBuffer {
    let mut blocky = exact.clone();
    for at in 0..SIDE * SIDE {
        let from = (at / SIDE / spacing * spacing * SIDE + at % SIDE / spacing * spacing) as usize;
        blocky.depth[at as usize] = exact.depth[from];
        blocky.leaf[at as usize] = exact.leaf[from];
    }
    blocky
}

#[test]
fn a_part_with_fewer_rays_is_nearly_the_same_and_leaves_others_exact() {
    for strategy in [EvalStrategy::Interpreter, EvalStrategy::Tape, EvalStrategy::StraightLine] {
        let (whole, id) = block(MarchResolution::Full, true);
        let is_part = |leaf: usize| whole.flat.ids[leaf] == id;
        let (exact, all) = drawn(&whole, strategy);
        for resolution in COARSE {
            let (scene, _) = block(resolution, true);
            let (coarse, few) = drawn(&scene, strategy);
            let found = difference(&whole, [&exact, &coarse], &is_part);
            println!("{strategy:?}, {resolution:?}: {few:.2} of {all:.2} evaluations per pixel, {found:?}");
            assert!(found.shared > 3_000 && is_small(&found), "{strategy:?}, {resolution:?}: {found:?}");
            let naive = difference(&whole, [&exact, &blocky(&exact, resolution.spacing())], &is_part);
            assert!(!is_small(&naive), "{naive:?}");
        }
    }
}

#[test]
fn fewer_rays_take_fewer_evaluations() {
    let [all, half, quarter] = [MarchResolution::Full, MarchResolution::Half, MarchResolution::Quarter]
        .map(|resolution| drawn(&block(resolution, false).0, EvalStrategy::Tape).1);
    println!("evaluations per pixel: {all:.2}, at 1/2 {half:.2}, at 1/4 {quarter:.2}");
    assert!(half < 0.65 * all && quarter < 0.65 * all, "{all}, {half}, {quarter}");
}

#[test]
fn copies_with_fewer_rays_are_nearly_the_same_copies() {
    let whole = lattice(MarchResolution::Full);
    let is_part = |leaf: usize| {
        let at = whole.flat.components.iter().rposition(|component| component.first as usize <= leaf);
        at.is_some_and(|at| whole.flat.components[at].instanced.is_some())
    };
    let (exact, all) = drawn(&whole, EvalStrategy::Tape);
    for resolution in COARSE {
        let (coarse, few) = drawn(&lattice(resolution), EvalStrategy::Tape);
        let found = difference(&whole, [&exact, &coarse], &is_part);
        println!("{resolution:?}: {few:.2} of {all:.2} evaluations per pixel, {found:?}");
        assert!(found.shared > 2_000 && is_small(&found), "{resolution:?}: {found:?}");
    }
}

#[test]
fn parts_that_rays_may_pass_have_all_rays() {
    let of = |resolution| {
        let mut scene = Scene::new();
        let mut material = isolith::scene::Material::clone(&scene.materials()[0]);
        material.geometry_opacity = 0.5;
        scene.replace_material(material).expect("a valid material");
        let march = MarchSettings { resolution, ..MarchSettings::default() };
        scene.insert(None, 0, object(&scene, Shape::Sphere { radius: 1.0 }).marched(march)).expect("room");
        BenchScene::new("veil", &scene, None).render(SIDE, EvalStrategy::Tape)
    };
    let [all, few] = [MarchResolution::Full, MarchResolution::Quarter].map(of);
    assert!(all == few);
}

#[test]
fn the_resolution_is_a_choice_in_files_and_paths() {
    let mut scene = Scene::new();
    let march = MarchSettings { resolution: MarchResolution::Half, ..MarchSettings::default() };
    let group = Node::new("Group", NodeKind::Group(Group::UNION)).marched(march);
    let id = scene.insert(None, 0, group).expect("room");
    let text = file::to_json(&scene).expect("a sound scene");
    assert!(text.contains("\"resolution\": \"half\""), "{text}");
    assert_eq!(file::parse(text.as_bytes(), "scene.json".as_ref()).expect("readable"), scene);
    let path: ParamPath = format!("node.{}.march.resolution", id.0).parse().expect("a path");
    assert_eq!(path.get(&scene), Ok(ParamValue::Choice("half")));
    let wrong = text.replace("\"half\"", "\"eighth\"");
    let error = file::parse(wrong.as_bytes(), "scene.json".as_ref()).expect_err("no such resolution").to_string();
    assert!(error.contains("eighth"), "{error}");
}
