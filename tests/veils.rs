//! What rays pass: blended and cut-out materials of fields, against the reference and against what the opacity says.

#![allow(clippy::print_stdout, reason = "the figures are for whoever runs this with `--nocapture`")]

use std::collections::HashSet;

use glam::{DQuat, DVec2, DVec3};
use isolith::field::debug_view::ViewMode;
use isolith::field::light::arriving::{Arriving, SeenPoint};
use isolith::field::pick::pick;
use isolith::field::reference::image::render_reference;
use isolith::field::scene_eval::SceneEvaluator;
use isolith::field::{FlatScene, GBuffer, NO_LEAF, flatten, gpu_lights};
use isolith::geometry::{Camera, Lens};
use isolith::render::{EvalStrategy, Film};
use isolith::scene::{
    Environment, Material, MaterialId, Node, NodeKind, Object, OpacityTexture, Scene, Shadowing, Shape, ShapeKind,
    Textures,
};
use isolith::wgsl::{Evaluator, OpSet, Options, Veil, assemble};

use crate::gpu::{BenchScene, scenes, shared};

const SIDE: u32 = 48;

/// A glowing material without reflection: its picture is its color.
fn glow(id: u64, color: [f64; 3], geometry_opacity: f64) -> Material {
    Material {
        base_color: [0.0; 3],
        specular_weight: 0.0,
        emission_luminance: 1.0,
        emission_color: color,
        geometry_opacity,
        ..Material::new(MaterialId(id), "Glow", color)
    }
}

fn object(shape: Shape, material: u64) -> Node {
    Node::new("Object", NodeKind::Object(Object { shape, material: MaterialId(material) }))
}

fn slab(half: [f64; 3]) -> Shape {
    let [x, y, z] = half;
    Shape::Box { size: [2.0 * x, 2.0 * y, 2.0 * z], rounding: 0.0 }
}

/// A scene of these objects in black surroundings, without lights.
fn scene(materials: Vec<Material>, objects: Vec<Node>) -> Scene {
    let mut scene = Scene::new();
    scene.environment = Environment::sky([0.0; 3], [0.0; 3], [0.0; 3]);
    scene.environment.shadowing = Shadowing::off();
    for material in materials {
        scene.insert_material(material).expect("valid");
    }
    for node in objects {
        scene.insert(None, usize::MAX, node).expect("valid");
    }
    scene
}

fn camera() -> Camera {
    Camera::looking_at(DVec3::new(0.0, 0.0, 4.0), DVec3::ZERO, 45.0_f64.to_radians())
}

fn shown(scene: &Scene) -> BenchScene {
    let mut shown = BenchScene::new("veils", scene, None);
    shown.camera = camera();
    shown
}

/// The mean light of the pixels in the middle after these samples.
fn middle(shown: &BenchScene, samples: u32) -> DVec3 {
    let renderer = &mut shared().renderer;
    renderer.set_strategy(EvalStrategy::Auto);
    let film = Film { samples, is_transparent: false, lens: Lens::default() };
    let still = renderer.render_samples(film, &shown.flat, &shown.meshes, &shown.camera, [SIDE, SIDE], &mut |_| true);
    let (buffers, warnings) = still.unwrap_or_else(|error| panic!("{error}"));
    assert!(warnings.is_empty(), "{warnings:?}");
    let inside = |i: &usize| [i % SIDE as usize, i / SIDE as usize].iter().all(|at| (20..28).contains(at));
    let picked: Vec<DVec3> = (0..buffers.radiance.len())
        .filter(inside)
        .map(|i| DVec3::from_slice(&buffers.radiance[i].map(f64::from)[..3]))
        .collect();
    picked.iter().sum::<DVec3>() / picked.len() as f64
}

#[test]
fn a_still_converges_to_the_blended_picture() {
    for opacity in [0.25, 0.6] {
        let materials = vec![glow(2, [1.0, 0.0, 0.0], opacity), glow(3, [0.0, 1.0, 0.0], 1.0)];
        let pane = object(slab([1.0, 1.0, 0.05]), 2);
        let wall = object(slab([3.0, 3.0, 0.1]), 3).at(DVec3::new(0.0, 0.0, -1.0));
        let shown = shown(&scene(materials, vec![pane, wall]));
        // It enters the pane and leaves it: two surfaces.
        let behind = (1.0 - opacity) * (1.0 - opacity);
        let found = middle(&shown, 64);
        assert!((found - DVec3::new(1.0 - behind, behind, 0.0)).length() < 0.01, "{opacity}: {found}");
        // Over 64 pixels, a single sample is as right in the mean as chance allows.
        let once = middle(&shown, 1);
        assert!((once.y - behind).abs() < 0.2 && once.y > 0.0 && once.y < 1.0, "{opacity}: {once}");
    }
}

#[test]
fn a_ray_in_a_solid_finds_what_is_in_it_and_behind_it() {
    // With so many neighbors of one kind, small components are joined, but not what lies in one that rays pass.
    let materials = vec![glow(2, [1.0, 0.0, 0.0], 0.0), glow(3, [0.0, 1.0, 0.0], 1.0), glow(4, [0.0, 0.0, 1.0], 1.0)];
    let ball = |radius: f64| Shape::Sphere { radius };
    let mut all = vec![
        object(ball(1.0), 2),
        object(ball(0.12), 3).at(DVec3::new(0.0, 0.0, 0.1)),
        object(slab([3.0, 3.0, 0.1]), 4).at(DVec3::new(0.0, 0.0, -2.0)),
    ];
    all.extend((0..80).map(|i| object(ball(0.05), 4).at(DVec3::new(f64::from(i) * 0.2 - 8.0, 3.5, -1.0))));
    let shown = shown(&scene(materials, all));
    let buffers = shown.render(SIDE, EvalStrategy::Tape);
    let place = |x: f64| (SIDE as f64 * (0.5 + x)) as usize + (SIDE as usize / 2) * SIDE as usize;
    assert!(
        (f64::from(buffers.depth[place(0.0)]) - 3.78).abs() < 0.01,
        "the ball within: {}",
        buffers.depth[place(0.0)]
    );
    let beside = f64::from(buffers.depth[place(0.1)]);
    assert!(beside > 5.9, "the wall behind: {beside}");
}

/// A lattice of bars by a texture, cut out.
fn lattice(id: u64) -> Material {
    let mut textures = Textures::triplanar();
    if let Textures::Triplanar { opacity, size, sharpness, .. } = &mut textures {
        *opacity = OpacityTexture::Checker { first: 1.0, second: 0.0, scale: 1.0 };
        (*size, *sharpness) = (1.0, 32.0);
    }
    Material { textures, opacity_threshold: 0.5, ..glow(id, [1.0, 0.0, 0.0], 1.0) }
}

#[test]
fn holes_are_holes_for_eyes_numbers_and_picking() {
    let pane = object(slab([1.4, 1.4, 0.02]), 2);
    let scene = scene(vec![lattice(2)], vec![pane]);
    let shown = shown(&scene);
    let buffers = shown.render(SIDE, EvalStrategy::Interpreter);
    let hits = buffers.leaf.iter().filter(|leaf| **leaf != NO_LEAF).count();
    let whole = (0.7 * f64::from(SIDE) * 0.7 * f64::from(SIDE)) as usize;
    assert!(hits > whole / 3 && hits < 2 * whole, "{hits} of {whole}");
    let numbers = numbers(&shown);
    assert_eq!(numbers.leaf, buffers.leaf, "a hole is one in any sample");
    let size = DVec2::splat(SIDE.into());
    let mut wrong = 0;
    for (i, leaf) in buffers.leaf.iter().enumerate() {
        let at = DVec2::new((i % SIDE as usize) as f64, (i / SIDE as usize) as f64) + 0.5;
        let picked = pick(&shown.flat, &shown.meshes, &shown.camera.ray(at, size), 0.01, 100.0);
        wrong += u32::from(picked.is_some() != (*leaf != NO_LEAF));
    }
    assert!(wrong < 60, "{wrong} pixels at the edges of holes differ");
}

/// The picture of depths: numbers show the first surface that has any opacity.
fn numbers(shown: &BenchScene) -> GBuffer {
    let renderer = &mut shared().renderer;
    renderer.set_strategy(EvalStrategy::Interpreter);
    let size = [SIDE, SIDE];
    let (flat, meshes) = (&shown.flat, &shown.meshes);
    renderer.render_as(ViewMode::Distance, flat, meshes, &shown.camera, size, &mut |_| true).expect("a picture").0
}

#[test]
fn numbers_show_the_first_surface_with_any_opacity() {
    let materials = vec![glow(2, [1.0, 0.0, 0.0], 0.05), glow(3, [0.0, 1.0, 0.0], 1.0)];
    let pane = object(slab([1.0, 1.0, 0.05]), 2);
    let wall = object(slab([3.0, 3.0, 0.1]), 3).at(DVec3::new(0.0, 0.0, -1.0));
    let shown = shown(&scene(materials, vec![pane, wall]));
    let middle = (SIDE / 2 * SIDE + SIDE / 2) as usize;
    assert!((f64::from(numbers(&shown).depth[middle]) - 3.95).abs() < 0.01);
    let depths: HashSet<u32> = shown.render(SIDE, EvalStrategy::Tape).depth.iter().map(|d| (d * 4.0) as u32).collect();
    assert!(depths.len() > 1, "most samples show the wall: {depths:?}");
}

/// Pixels that differ in what they show, and the mean difference of the others in levels of 255.
fn compare(scene: &BenchScene, side: u32, strategy: EvalStrategy) -> (usize, f64) {
    let drawn = scene.render(side, strategy);
    let true_image =
        render_reference(&scene.flat, &scene.meshes, &scene.camera, [side, side], &|_| {}).expect("rays end").buffers;
    let is_same = |i: &usize| {
        let (a, b) = (drawn.depth[*i], true_image.depth[*i]);
        drawn.leaf[*i] == true_image.leaf[*i] && (a == b || (a - b).abs() < 1e-3 * b)
    };
    let (same, other): (Vec<usize>, Vec<usize>) = (0..drawn.depth.len()).partition(is_same);
    let difference =
        |i: &usize| (0..3).map(|c| f64::from(drawn.color[*i][c].abs_diff(true_image.color[*i][c]))).sum::<f64>();
    (other.len(), same.iter().map(difference).sum::<f64>() / (3 * same.len()) as f64)
}

#[test]
fn the_device_shows_what_the_reference_shows() {
    let scene = scenes().find(|scene| scene.name == "transparency").expect("it is shipped");
    for strategy in [EvalStrategy::Interpreter, EvalStrategy::Tape] {
        let (other, difference) = compare(&scene, 64, strategy);
        println!("{strategy:?}: {other} of 4096 pixels show something else, the rest differs by {difference}");
        // Edges of holes and outlines.
        assert!(other < 40, "{strategy:?}: {other} pixels");
        assert!(difference < 0.5, "{strategy:?}: {difference}");
    }
}

#[test]
fn an_opaque_scene_needs_nothing_new() {
    let evaluator = Evaluator::Interpreter(OpSet::all());
    let text = |veil| assemble("trace.wgsl", &evaluator, Options { veil, ..Options::default() }).expect("it is there");
    assert!(!text(Veil::None).contains("veil") && !text(Veil::None).contains("march_side"));
    let veiled = |opacity: f64| {
        let scene = scene(vec![glow(2, [1.0; 3], opacity)], vec![object(Shape::Sphere { radius: 1.0 }, 2)]);
        flatten(&scene, 0.0).expect("within the limits").veiled()
    };
    assert_eq!((veiled(1.0), veiled(0.5)), (Vec::new(), vec![true]));
}

/// A white wall behind a pane beside the middle, in the light of a sun.
fn behind_pane(opacity: f64, turn: f64) -> Scene {
    let white = Material { specular_weight: 0.0, ..Material::new(MaterialId(2), "White", [0.8; 3]) };
    let glass = Material { geometry_opacity: opacity, ..Material::new(MaterialId(3), "Glass", [0.8; 3]) };
    let wall = object(slab([3.0, 3.0, 0.1]), 2).at(DVec3::new(0.0, 0.0, -1.0));
    // Beside what the eye sees of the middle.
    let pane = object(slab([0.6, 0.6, 0.05]), 3).at(DVec3::new(2.0, 0.0, 1.0));
    let mut scene = scene(vec![white, glass], vec![wall, pane]);
    scene.environment.shadowing = Shadowing { occlusion: false, ..Shadowing::default() };
    let sun = isolith::scene::LightKind::Sun { strength: 2.0, angle: 0.5 };
    let light = isolith::scene::Light { light: sun, ..isolith::scene::Light::default() };
    let node = Node::new("Sun", NodeKind::Light(light)).rotated(DQuat::from_rotation_y(turn));
    scene.insert(None, usize::MAX, node).expect("valid");
    scene
}

/// The turn of a sun that shines through the pane onto the middle; the other way it shines past it.
const THROUGH: f64 = std::f64::consts::FRAC_PI_4;

#[test]
fn light_passes_as_the_opacity_says() {
    for samples in [1, 4] {
        let lit = |opacity: f64, turn: f64| middle(&shown(&behind_pane(opacity, turn)), samples).x;
        let whole = lit(0.5, -THROUGH);
        assert!(whole > 0.1, "{whole}");
        for opacity in [0.25, 0.75, 1.0] {
            let share = lit(opacity, THROUGH) / whole;
            assert!((share - (1.0 - opacity)).abs() < 0.03, "{opacity}, {samples} samples: {share}");
        }
    }
}

/// The reference follows a ray where its cone proves nothing, as the device does.
#[test]
fn rays_of_samples_pass_what_cones_pass() {
    for (opacity, turn, expected) in [(0.25, THROUGH, 0.75), (1.0, THROUGH, 0.0), (0.25, -THROUGH, 1.0)] {
        let shown = shown(&behind_pane(opacity, turn));
        let lights = gpu_lights(&shown.flat, &shown.camera, [SIDE; 2]);
        let eye = shown.camera.position;
        for sample in 0..4 {
            let position = DVec3::new(0.0, 0.0, -0.9) - eye;
            let point = SeenPoint { eye, position, normal: DVec3::Z, footprint: 1e-3, pixel: [24; 2], sample };
            let arriving = Arriving::at(&mut SceneEvaluator::new(&shown.flat), &[], &lights, &point).expect("rays end");
            let share = arriving.shadow_share(0);
            assert!((share - expected).abs() < 1e-9, "{opacity}, sample {sample}: {share}");
        }
    }
}

#[test]
fn copies_may_be_passed() {
    let veils = |flat: &FlatScene| flat.veiled().iter().filter(|veiled| **veiled).count();
    let ball = ShapeKind::Sphere.default_shape();
    let mut scene = scene(vec![lattice(2), glow(3, [0.0, 1.0, 0.0], 0.4)], Vec::new());
    let instancer = isolith::scene::Instancer::default();
    let parent =
        scene.insert(None, usize::MAX, Node::new("Copies", NodeKind::Instancer(Box::new(instancer)))).expect("valid");
    for material in [2, 3] {
        scene.insert(Some(parent), usize::MAX, object(ball.clone(), material)).expect("valid");
    }
    let mut shown = shown(&scene);
    shown.camera.position = DVec3::new(0.3, 1.5, 7.0);
    assert_eq!(veils(&shown.flat), 2);
    let (other, difference) = compare(&shown, SIDE, EvalStrategy::Interpreter);
    let hits = numbers(&shown).leaf.iter().filter(|leaf| **leaf != NO_LEAF).count();
    println!("{other} pixels, {difference}, {hits} hits");
    assert!(hits > 200, "{hits}");
    assert!(other < 60 && difference < 1.0, "{other} pixels, {difference}");
}
