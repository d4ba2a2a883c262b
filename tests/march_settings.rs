//! Settings of the march of parts of a scene, and the pictures after each pass over the parts.

use glam::DVec3;

use isolith::document::{Document, Edit};
use isolith::field::{FlatScene, HitTarget, flatten, pick};
use isolith::geometry::{Camera, Ray};
use isolith::render::{EvalStrategy, OverlaySettings, Renderer, Slot, TracedParts};
use isolith::scene::{
    Blend, Group, Instancer, Lattice, Light, MarchSettings, Node, NodeId, NodeKind, Object, Operator, ParamPath,
    ParamValue, Part, Scene, SceneError, Shape, check, file,
};
use isolith::wgsl::Options;

use crate::copies::{scene_of, varied};
use crate::copies_pictures::faults;
use crate::gpu::{BenchScene, scenes, shared};

/// Width and height of the pictures, in pixels.
const SIDE: u32 = 96;

fn object(scene: &Scene, shape: Shape) -> Node {
    Node::new("Part", NodeKind::Object(Object { shape, material: scene.materials()[0].id }))
}

/// A lattice of copies with these settings, before a ball and over a floor.
fn scene_with(march: MarchSettings) -> BenchScene {
    let lattice = Lattice::Grid { counts: [0, 1, 0], spacing: [1.5, 1.0, 1.5] };
    let mut scene = scene_of(Instancer { lattice, variation: varied(), seed: 5, ..Instancer::default() }, &[]);
    let top = Node::clone(scene.children(None).next().expect("the instancer"));
    scene.replace(top.marched(march)).expect("valid settings");
    for node in [
        object(&scene, Shape::Sphere { radius: 2.0 }).at(DVec3::new(1.0, 0.5, -14.0)),
        object(&scene, Shape::Plane {}).at(DVec3::Y * -0.5),
    ] {
        scene.insert(None, usize::MAX, node).expect("room");
    }
    let mut drawn = BenchScene::new("cut off", &scene, None);
    let eye = DVec3::new(1.0, 3.0, 6.0);
    drawn.camera = Camera::looking_at(eye, eye + DVec3::new(0.3, -0.25, -1.0), 0.8);
    drawn
}

#[test]
fn parts_are_cut_off_by_their_distance_from_the_eye_as_the_reference_cuts_them() {
    let march = MarchSettings { near: 7.0, far: 16.0, ..MarchSettings::default() };
    let [cut, whole] = [march, MarchSettings::default()].map(scene_with);
    assert_eq!(faults(&cut, &cut), [""; 0]);
    assert!(!faults(&whole, &cut).is_empty(), "the settings change the picture");
    let depths = |scene: &BenchScene| {
        let picture = scene.render(SIDE, EvalStrategy::Tape);
        let is_copy = |leaf: u32| {
            let HitTarget::Leaf(leaf) = HitTarget::from_code(leaf) else { return None };
            let at = scene.flat.components.iter().rposition(|component| component.first as usize <= leaf)?;
            scene.flat.components[at].instanced
        };
        let all = picture.depth.iter().zip(&picture.leaf);
        let depths = all.filter(|(_, leaf)| is_copy(**leaf).is_some()).map(|(depth, _)| *depth);
        depths.fold([f32::INFINITY, 0.0], |[least, most], depth| [least.min(depth), most.max(depth)])
    };
    let ([least, most], [first, last]) = (depths(&cut), depths(&whole));
    assert!((6.999..=16.001).contains(&least) && most <= 16.001, "{least} to {most}");
    assert!(first < 6.0 && last > 40.0, "{first} to {last}");
}

#[test]
fn what_is_cut_off_is_not_picked_and_casts_its_shadow() {
    let mut scene = Scene::new();
    let ball = object(&scene, Shape::Sphere { radius: 1.0 });
    let id =
        scene.insert(None, 0, ball.marched(MarchSettings { near: 10.0, ..MarchSettings::default() })).expect("room");
    let flat = flatten(&scene, 0.0).expect("within the limits");
    let picked = |from: f64| {
        let ray = Ray { origin: DVec3::Z * from, direction: DVec3::NEG_Z };
        pick::pick(&flat, &[], &ray, 1e-3, 1e3)
    };
    assert_eq!([picked(5.0), picked(20.0)], [None, Some(id)]);
    // Rays that do not come from an eye know no such limits.
    let mut evaluator = isolith::field::scene_eval::SceneEvaluator::new(&flat);
    let ray = Ray { origin: DVec3::Z * 5.0, direction: DVec3::NEG_Z };
    let limits = isolith::field::RayLimits { near: 1e-3, far: 1e3 };
    assert!(evaluator.ray(&ray, limits).expect("an end").is_some());
}

/// Evaluations of the field per pixel, and the depths.
fn drawn(scene: &BenchScene) -> (f64, Vec<f32>) {
    let gpu = shared().gpu.clone();
    let options = Options { counting: true, ..Renderer::options(&gpu) };
    let mut renderer = Renderer::with_options(&gpu, options).expect("a renderer");
    renderer.set_strategy(EvalStrategy::Tape);
    let overlay = OverlaySettings::default();
    let begun = renderer.begin(Slot::Full, &scene.flat, &scene.meshes, &scene.camera, [SIDE, SIDE], overlay);
    let mut frame = begun.expect("a frame");
    renderer.advance(&mut frame, std::time::Duration::MAX).expect("a picture");
    assert_eq!(renderer.unfinished_rays(&frame).expect("counts"), []);
    let depth = renderer.read(&frame).expect("a picture").depth;
    (renderer.pixel_counts(&frame).expect("counts").steps().mean, depth)
}

/// A twisted block, which rays close in on slowly.
fn block(march: MarchSettings) -> BenchScene {
    let mut scene = Scene::new();
    let noise = isolith::scene::Modifier::Noise { amplitude: 0.15, size: 0.4, octaves: 3, seed: 2 };
    let node = object(&scene, Shape::Box { size: [2.0; 3], rounding: 0.1 }).modified(noise).marched(march);
    scene.insert(None, 0, node).expect("room");
    BenchScene::new("block", &scene, None)
}

#[test]
fn less_precision_costs_less_and_errs_by_less_than_a_pixel() {
    let [(usual, exact), (coarse, near)] =
        [1.0, 0.02].map(|precision| drawn(&block(MarchSettings { precision, ..MarchSettings::default() })));
    let footprint = block(MarchSettings::default()).camera.footprint(f64::from(SIDE)) as f32;
    let both = exact.iter().zip(&near).filter(|(a, b)| a.is_finite() && b.is_finite());
    let off: Vec<f32> = both.map(|(a, b)| (a - b).abs() / (footprint * a)).collect();
    let mean = off.iter().sum::<f32>() / off.len() as f32;
    let others = exact.iter().zip(&near).filter(|(a, b)| a.is_finite() != b.is_finite()).count();
    assert!(coarse < 0.95 * usual, "{coarse} of {usual} evaluations");
    assert!(mean < 0.1 && mean > 0.0 && others < off.len() / 50, "{mean} footprints, {others} of {}", off.len());
}

#[test]
fn rays_that_may_take_few_steps_pass_and_are_no_failure() {
    let [(_, all), (_, few), (_, plenty)] =
        [0, 14, 60_000].map(|steps| drawn(&block(MarchSettings { steps, ..MarchSettings::default() })));
    let hits = |depths: &[f32]| depths.iter().filter(|depth| depth.is_finite()).count();
    assert!(hits(&few) < hits(&all) * 9 / 10 && hits(&few) > 0, "{} of {}", hits(&few), hits(&all));
    assert_eq!(plenty, all);
    let [(_, all), (_, few)] =
        [0, 4].map(|steps| drawn(&scene_with(MarchSettings { steps, ..MarchSettings::default() })));
    let nearer = all.iter().zip(&few).filter(|(all, few)| few > all).count();
    assert!(nearer > 50 && all.iter().zip(&few).all(|(all, few)| few >= all), "{nearer}");
}

#[test]
fn the_order_of_parts_changes_the_passes_and_no_pixel() {
    let of = |order| scene_with(MarchSettings { order, ..MarchSettings::default() });
    let [usual, last] = [of(0), of(3)];
    let passes = |scene: &BenchScene| scene.flat.component_passes(scene.camera.position);
    let copies = |scene: &BenchScene| {
        passes(scene).iter().position(|pass| scene.flat.components[pass.components[0]].instanced.is_some())
    };
    assert!(copies(&usual) < Some(2) && copies(&last) == Some(2), "{:?}, {:?}", passes(&usual), passes(&last));
    let pictures = [&usual, &last].map(|scene| scene.render(SIDE, EvalStrategy::Tape));
    assert_eq!(pictures[0].depth, pictures[1].depth);
    assert_eq!(pictures[0].color, pictures[1].color);
}

/// The depths after each number of passes, from none to all.
fn after_passes(scene: &BenchScene) -> Vec<Vec<f32>> {
    let count = scene.flat.component_passes(scene.camera.position).len() as u32;
    let renderer = &mut shared().renderer;
    let depths = (0..=count).map(|passes| {
        renderer.set_traced(TracedParts { passes: Some(passes), ..TracedParts::default() });
        scene.render_on(renderer, SIDE, EvalStrategy::Tape).depth
    });
    let all = depths.collect();
    renderer.set_traced(TracedParts::default());
    all
}

#[test]
fn each_pass_adds_nearer_hits_until_the_picture_is_whole() {
    let scene = scenes().find(|scene| scene.name == "terrain").expect("it is shipped");
    let passes = scene.flat.component_passes(scene.camera.position);
    assert_eq!(passes.len(), 4, "{passes:?}");
    let depths = after_passes(&scene);
    assert!(depths[0].iter().all(|depth| !depth.is_finite()), "nothing is rasterized");
    for pair in depths.windows(2) {
        let nearer = pair[0].iter().zip(&pair[1]).filter(|(before, after)| after < before).count();
        assert!(nearer > 0 && pair[0].iter().zip(&pair[1]).all(|(before, after)| after <= before), "{nearer}");
    }
    assert_eq!(depths.last(), Some(&scene.render(SIDE, EvalStrategy::Tape).depth));
}

fn flat_of(scene: &Scene) -> FlatScene {
    flatten(scene, 0.0).expect("within the limits")
}

#[test]
fn the_nearest_node_above_a_part_decides_and_parts_of_a_blend_cannot() {
    let [far, near] = [8.0, 3.0].map(|far| MarchSettings { far, ..MarchSettings::default() });
    let mut scene = Scene::new();
    let mut add = |parent: Option<NodeId>, node: Node| scene.insert(parent, usize::MAX, node).expect("room");
    let group = |kind: Group| Node::new("Group", NodeKind::Group(kind));
    let outer = add(None, group(Group::UNION).marched(far));
    let ball = |march| {
        let kind = Object { shape: Shape::Sphere { radius: 0.5 }, material: isolith::scene::MaterialId(1) };
        Node::new("Ball", NodeKind::Object(kind)).marched(march)
    };
    add(Some(outer), ball(MarchSettings::default()));
    add(Some(outer), ball(near).at(DVec3::X * 3.0));
    let blend = Group::new(Operator::Union, Blend { radius: 0.3, ..Blend::HARD });
    let blended = add(Some(outer), group(blend).at(DVec3::X * 6.0));
    let lost = add(Some(blended), ball(near));
    add(Some(blended), ball(MarchSettings::default()).at(DVec3::X * 0.8));
    let flat = flat_of(&scene);
    let mut ends: Vec<f64> = flat.components.iter().map(|component| component.march.far).collect();
    ends.sort_by(f64::total_cmp);
    assert_eq!(ends, [3.0, 8.0, 8.0]);
    assert!(flat.components.iter().all(|component| component.top == outer));
    let warned: Vec<NodeId> = flat.warnings.iter().map(|warning| warning.node).collect();
    assert_eq!(warned, [lost], "{:?}", flat.warnings);
}

#[test]
fn settings_are_parameters_with_limits_in_files_and_can_be_undone() {
    let mut scene = Scene::new();
    let march =
        MarchSettings { order: 2, near: 0.5, far: 40.0, precision: 0.25, steps: 99, ..MarchSettings::default() };
    let id = scene.insert(None, 0, object(&scene, Shape::Sphere { radius: 1.0 }).marched(march)).expect("room");
    let text = file::to_json(&scene).expect("a sound scene");
    assert_eq!(file::parse(text.as_bytes(), "scene.json".as_ref()).expect("readable"), scene);
    let path: ParamPath = format!("node.{}.march.far", id.0).parse().expect("a path");
    assert_eq!(path.get(&scene), Ok(ParamValue::Scalar(40.0)));
    let mut document = Document::new(scene);
    let node = Node::clone(document.scene().node(id).expect("it is there"));
    let far = |far| Node { march: MarchSettings { far, ..march }, ..node.clone() };
    assert!(document.apply(Edit::Replace(far(0.4))).is_err(), "it would end before it begins");
    document.apply(Edit::Replace(far(0.0))).expect("without a limit");
    document.undo();
    assert_eq!(path.get(document.scene()), Ok(ParamValue::Scalar(40.0)));
    let light = Node::new("Light", NodeKind::Light(Light::default()));
    assert!(!Part::of(&light).any(|part| part == Part::March));
    let fault = check::node(&light.marched(march)).expect_err("lights are not marched");
    assert!(matches!(fault.into_error("Light"), SceneError::Invalid { field, .. } if field == "march"));
    let usual = file::to_json(&Scene::new()).expect("a sound scene");
    assert!(!usual.contains("march") && text.contains("\"march\""));
}

#[test]
fn a_change_of_settings_reaches_the_arrays_of_a_drag() {
    let mut scene = Scene::new();
    let id = scene.insert(None, 0, object(&scene, Shape::Sphere { radius: 1.0 })).expect("room");
    let mut flattener = isolith::field::Flattener::default();
    flattener.flatten(&scene, 0.0).expect("within the limits");
    let mut node = Node::clone(scene.node(id).expect("it is there"));
    node.march.far = 12.0;
    scene.replace(node.clone()).expect("valid");
    assert_eq!(*flattener.flatten(&scene, 0.0).expect("within the limits"), flat_of(&scene));
    node.transform.translation.x = 2.0;
    scene.replace(node).expect("valid");
    let moved = flattener.update(&scene, 0.0).expect("a small change");
    assert_eq!(moved.components[0].march.far, 12.0);
    assert_eq!(*moved, flat_of(&scene));
}
