//! Shadows and occlusion of copies in pictures, against the reference.

#![allow(clippy::print_stdout, reason = "the figures are for whoever runs this with `--nocapture`")]

use glam::{DMat3, DQuat, DVec3};

use isolith::field::light::shadow::{ShadowCone, ShadowProof, shadow_by_rays, shadow_share};
use isolith::field::reference::image::render_reference;
use isolith::field::scene_eval::SceneEvaluator;
use isolith::field::{GBuffer, NO_LEAF};
use isolith::geometry::Camera;
use isolith::render::EvalStrategy;
use isolith::scene::{
    DynamicKind, Environment, Falloff, Instancer, Lattice, Light, LightKind, Node, NodeKind, Object, Scene, Shadowing,
    Shape, Snap, Variation, file,
};

use crate::copies::{scene_of, varied};
use crate::gpu::BenchScene;

/// Side of the pictures, in pixels.
const SIDE: u32 = 56;

/// Turns -Z, where lights point to, to this direction.
fn toward(direction: DVec3) -> DQuat {
    Camera::looking_at(DVec3::ZERO, direction, 1.0).rotation
}

fn sun(angle: f64) -> Node {
    let light = Light::new(LightKind::Sun { strength: 2.5, angle });
    Node::new("Sun", NodeKind::Light(light)).rotated(toward(DVec3::new(0.6, -1.0, 0.35)))
}

fn lamp(radius: f64) -> Node {
    let falloff = Falloff::Attenuation { constant: 1.0, linear: 0.0, quadratic: 0.0, range: 100.0 };
    let light = Light::new(LightKind::Point { power: 30.0, radius, falloff });
    Node::new("Lamp", NodeKind::Light(light)).at(DVec3::new(-1.5, 3.6, 1.0))
}

fn panel() -> Node {
    let light = Light::new(LightKind::Rectangle { power: 180.0, width: 2.0, height: 1.2 });
    Node::new("Panel", NodeKind::Light(light))
        .at(DVec3::new(-1.5, 4.0, 2.0))
        .rotated(toward(DVec3::new(1.2, -4.0, -2.0)))
}

/// Copies over a ground, under a light or occluded.
fn stage(scene: Scene, ground: Option<Shape>, light: Option<Node>) -> BenchScene {
    let mut scene = scene;
    let material = scene.materials()[0].id;
    let ambient = [if light.is_some() { 0.1 } else { 1.0 }; 3];
    scene.environment = Environment::sky([0.5; 3], [0.5; 3], ambient);
    scene.environment.shadowing =
        Shadowing { shadows: light.is_some(), occlusion: light.is_none(), ..Shadowing::default() };
    let objects = ground.map(|shape| Node::new("Ground", NodeKind::Object(Object { shape, material })));
    for node in objects.map(|node| node.at(DVec3::Y * -0.3)).into_iter().chain(light) {
        scene.insert(None, usize::MAX, node).expect("a valid node");
    }
    let mut staged = BenchScene::new("copies", &scene, None);
    staged.camera = Camera::looking_at(DVec3::new(0.8, 4.6, 6.4), DVec3::new(0.2, 0.2, 0.0), 0.75);
    staged
}

fn of(lattice: Lattice) -> Instancer {
    Instancer { lattice, variation: varied(), probability: 0.8, seed: 3, ..Instancer::default() }
}

fn grid() -> Lattice {
    Lattice::Grid { counts: [5, 2, 5], spacing: [1.3, 1.4, 1.3] }
}

/// Copies whose sizes along their axes differ.
fn uneven() -> Instancer {
    let variation = Variation { scale_min: [0.4, 0.8, 0.4], scale_max: [1.4, 1.9, 0.8], uniform: false, ..varied() };
    Instancer { variation, ..of(Lattice::Grid { counts: [5, 1, 5], spacing: [1.2; 3] }) }
}

/// Copies on a list of places.
fn scattered() -> Scene {
    let rings = of(Lattice::Polar { count: 8, rings: 4, radius: 0.9, spacing: 0.8 });
    scene_of(Instancer { snap: Snap::Off, ..rings }, &[])
}

/// The scenes: name, copies, ground, light; without a light there is occlusion.
fn stages() -> Vec<(&'static str, BenchScene)> {
    let endless = || of(Lattice::Grid { counts: [0, 1, 0], spacing: [1.4, 1.0, 1.4] });
    let space = || of(Lattice::Grid { counts: [0; 3], spacing: [2.4; 3] });
    // So many cells, each with so much to do, that no dispatch comes to an end.
    let dense = || {
        let small = Variation { scale_min: [0.25; 3], scale_max: [0.4; 3], ..varied() };
        let lattice = Lattice::Grid { counts: [0, 3, 0], spacing: [0.35; 3] };
        scene_of(Instancer { variation: small, ..of(lattice) }, &[DynamicKind::FractionalBrownianMotion])
    };
    let plane = || Some(Shape::Plane {});
    let copies = |instancer| scene_of(instancer, &[]);
    vec![
        ("hard sun", stage(copies(of(grid())), plane(), Some(sun(0.0)))),
        ("soft sun", stage(copies(of(grid())), plane(), Some(sun(4.0)))),
        ("lamp", stage(copies(of(grid())), plane(), Some(lamp(0.15)))),
        ("panel", stage(copies(of(grid())), plane(), Some(panel()))),
        ("occlusion", stage(copies(of(grid())), plane(), None)),
        ("endless, sun", stage(copies(endless()), plane(), Some(sun(2.0)))),
        ("endless, occlusion", stage(copies(endless()), plane(), None)),
        ("endless along three axes, sun", stage(copies(space()), None, Some(sun(1.0)))),
        ("many cells, panel", stage(dense(), plane(), Some(panel()))),
        ("many cells, occlusion", stage(dense(), plane(), None)),
        ("list, sun", stage(scattered(), plane(), Some(sun(2.0)))),
        ("list, occlusion", stage(scattered(), plane(), None)),
        ("uneven, sun", stage(copies(uneven()), plane(), Some(sun(2.0)))),
        ("uneven, occlusion", stage(copies(uneven()), plane(), None)),
    ]
}

/// Mean difference of the colors where both pictures show the same surface, and the share of such pixels that differ by
/// more than 12 of 255.
fn differences(a: &GBuffer, b: &GBuffer) -> [f64; 2] {
    let same = |i: &usize| a.leaf[*i] == b.leaf[*i] && (a.depth[*i] - b.depth[*i]).abs() < 1e-3 * b.depth[*i];
    let both: Vec<usize> = (0..a.color.len()).filter(same).collect();
    assert!(both.len() > a.color.len() / 3, "{} pixels show the same", both.len());
    let most = |i: &usize| (0..3).map(|c| a.color[*i][c].abs_diff(b.color[*i][c])).max().unwrap_or(0);
    let sum: u32 = both.iter().map(|i| u32::from(most(i))).sum();
    let far = both.iter().filter(|i| most(i) > 12).count();
    [f64::from(sum) / both.len() as f64, far as f64 / both.len() as f64]
}

fn reference_of(scene: &BenchScene) -> GBuffer {
    render_reference(&scene.flat, &scene.meshes, &scene.camera, [SIDE; 2], &|_| ()).expect("an end").buffers
}

/// Allowed mean difference of colors, and share of pixels far off.
const MOST_MEAN: f64 = 0.3;
const MOST_FAR: f64 = 0.005;

/// What is wrong about a picture.
fn faults(name: &str, scene: &BenchScene, reference: &GBuffer) -> Vec<String> {
    let strategies = [EvalStrategy::Interpreter, EvalStrategy::Tape];
    let found = strategies.map(|strategy| {
        let [mean, far] = differences(&scene.render(SIDE, strategy), reference);
        println!("{name} {strategy:?}: mean {mean:.2} of 255, {far:.4} far off");
        (mean > MOST_MEAN || far > MOST_FAR).then(|| format!("{name} {strategy:?}: mean {mean:.2}, {far:.4} far off"))
    });
    found.into_iter().flatten().collect()
}

#[test]
fn copies_cast_the_shadows_of_the_reference() {
    let mut all = Vec::new();
    for (name, scene) in stages() {
        let reference = reference_of(&scene);
        all.extend(faults(name, &scene, &reference));
        // Without shadows it is another picture.
        let mut flat = scene.flat.clone();
        flat.environment.shadowing = Shadowing::off();
        let without = BenchScene { name: name.into(), flat, meshes: scene.meshes.clone(), camera: scene.camera };
        let [mean, _] = differences(&without.render(SIDE, EvalStrategy::Tape), &reference);
        if mean < 6.0 * MOST_MEAN {
            all.push(format!("{name}: without shadows it looks the same: mean {mean:.2}"));
        }
    }
    assert!(all.is_empty(), "{}", all.join("\n"));
}

/// The same scene whose copies are not in the way of light. They are out of view as well, so that only the ground
/// counts.
#[test]
fn a_picture_without_the_shadows_of_copies_is_refused() {
    for light in [Some(sun(2.0)), None] {
        let (whole, ground) = (
            stage(
                scene_of(of(Lattice::Grid { counts: [5, 1, 5], spacing: [1.3; 3] }), &[]),
                Some(Shape::Plane {}),
                light.clone(),
            ),
            {
                let mut scene = Scene::new();
                scene.environment = Environment::default();
                stage(scene, Some(Shape::Plane {}), light)
            },
        );
        let mut reference = reference_of(&whole);
        let drawn = ground.render(SIDE, EvalStrategy::Tape);
        let is_ground = |i: &usize| (reference.depth[*i] - drawn.depth[*i]).abs() < 1e-3 * drawn.depth[*i];
        let shown: Vec<usize> = (0..drawn.depth.len()).filter(is_ground).collect();
        for i in 0..reference.leaf.len() {
            reference.leaf[i] = if shown.contains(&i) { drawn.leaf[i] } else { NO_LEAF };
        }
        let [mean, far] = differences(&drawn, &reference);
        assert!(mean > 10.0 * MOST_MEAN && far > 10.0 * MOST_FAR, "mean {mean}, {far} far off");
    }
}

#[test]
fn meshes_and_copies_cast_shadows_on_each_other() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let mut scene = file::load(&folder.join("mesh-and-fields.json")).expect("it is shipped");
    scene.environment.shadowing = Shadowing { occlusion: false, ..Shadowing::default() };
    let material = scene.materials()[0].id;
    let copies = Instancer { probability: 0.9, ..of(Lattice::Grid { counts: [9, 1, 9], spacing: [0.6; 3] }) };
    let node = Node::new("Copies", NodeKind::Instancer(Box::new(copies))).at(DVec3::Y * 2.6);
    let top = scene.insert(None, usize::MAX, node).expect("a valid node");
    let ball = Node::new("Ball", NodeKind::Object(Object { shape: Shape::Sphere { radius: 0.14 }, material }));
    scene.insert(Some(top), 0, ball).expect("a valid node");
    let scene = BenchScene::new("mesh-and-fields", &scene, Some(folder));
    let reference = reference_of(&scene);
    let wrong = faults("meshes and copies", &scene, &reference);
    assert!(wrong.is_empty(), "{wrong:?}");
    // The copies darken meshes.
    let mut flat = scene.flat.clone();
    flat.environment.shadowing = Shadowing::off();
    let without = BenchScene { name: "none".into(), flat, meshes: scene.meshes.clone(), camera: scene.camera };
    let (with, without) = (scene.render(SIDE, EvalStrategy::Tape), without.render(SIDE, EvalStrategy::Tape));
    let of_mesh = |i: &usize| with.leaf[*i] != NO_LEAF && with.leaf[*i] & isolith::field::MESH_BIT != 0;
    let darker = (0..with.leaf.len()).filter(of_mesh);
    let darker = darker.filter(|i| with.color[*i][1].saturating_add(12) < without.color[*i][1]).count();
    assert!(darker > 30, "{darker} pixels of meshes are darker");
}

/// What a cone proves about copies of uneven size is true.
#[test]
fn proofs_hold_among_copies_of_uneven_size() {
    let scene = stage(scene_of(uneven(), &[]), Some(Shape::Plane {}), Some(sun(2.0)));
    let mut evaluator = SceneEvaluator::new(&scene.flat);
    let (mut proven, mut dark) = (0, 0);
    for i in 0..1_500_u32 {
        let [a, b] = [0.618_034, 0.414_214].map(|by| (f64::from(i) * by).fract());
        let origin = DVec3::new(7.0 * a - 3.5, -0.299, 7.0 * b - 3.5);
        let turn = DMat3::from_rotation_y(f64::from(i));
        let direction = turn * DVec3::new(0.5, 1.0, 0.0).normalize();
        let extent = [0.02, 0.08, 0.3][i as usize % 3];
        let cone = ShadowCone::new(origin, direction, f64::INFINITY, extent, 1e-3);
        let found = shadow_share(&mut evaluator, &cone);
        if found.proof == ShadowProof::None {
            continue;
        }
        proven += 1;
        let seen = shadow_by_rays(&mut evaluator, &cone, 40).expect("an end");
        dark += u32::from(found.proof == ShadowProof::Dark);
        let meant = if found.proof == ShadowProof::Dark { 0.0 } else { 1.0 };
        assert_eq!(seen, meant, "{i}: {found:?} at {origin} toward {direction}");
    }
    println!("{proven} of 1500 cones prove something, {dark} that it is dark");
    assert!(proven > 300 && dark > 20, "{proven}, {dark}");
}
