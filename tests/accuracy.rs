//! Compares every scene's picture with the reference, ray for ray.

use isolith::field::Accuracy;
use isolith::field::reference::accuracy::{MAX_WRONG_SHARE, verdicts};
use isolith::field::reference::image::render_reference;
use isolith::render::{EvalStrategy, OverlaySettings, Renderer, Slot};
use isolith::scene::{MaterialId, Node, NodeKind, Object, Scene, Shape};
use isolith::wgsl::{Options, Quality};

use crate::gpu::{BenchScene, scenes, shared};

/// Width and height of the pictures, in pixels.
const SIDE: u32 = 256;

/// Every evaluator: the command line draws with the interpreter and tapes, the window with pipelines too.
const STRATEGIES: [EvalStrategy; 3] = [EvalStrategy::Interpreter, EvalStrategy::Tape, EvalStrategy::StraightLine];

/// Scenes known to be drawn incorrectly, with the most wrong pixels allowed per strategy of [`STRATEGIES`]. The list
/// only shrinks: an entry that is no longer needed, or that allows more than is measured, fails the test.
const KNOWN: [(&str, [usize; 3]); 0] = [];

/// Errors of the renderer's picture of `drawn`, per strategy, measured against the reference of `meant`.
fn measure(drawn: &BenchScene, meant: &BenchScene, side: u32) -> [Accuracy; 3] {
    let reference = render_reference(&meant.flat, &meant.meshes, &meant.camera, [side, side], &|_| ());
    let reference = reference.unwrap_or_else(|error| panic!("{}: {error}", meant.name));
    STRATEGIES.map(|strategy| Accuracy::against(&drawn.render(side, strategy), &drawn.flat, &reference))
}

#[test]
fn every_scene_is_as_exact_as_promised() {
    let mut faults = Vec::new();
    for scene in scenes() {
        let all = measure(&scene, &scene, SIDE);
        let wrong = all.map(|found| found.wrong);
        match KNOWN.iter().find(|(name, _)| *name == scene.name) {
            Some((_, known)) if *known != wrong => {
                faults.push(format!("{}: {wrong:?} pixels are wrong, known are {known:?}", scene.name));
            }
            Some(_) => {}
            None => {
                for (strategy, found) in STRATEGIES.iter().zip(all) {
                    let of_scene = |fault: &String| format!("{}, {strategy:?}: {fault} ({found:?})", scene.name);
                    faults.extend(found.faults().iter().map(of_scene));
                }
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// A ball in front of the background.
fn ball(radius: f64, lifted: f64) -> BenchScene {
    let mut scene = Scene::new();
    let object = Object { shape: Shape::Sphere { radius }, material: MaterialId(1) };
    let node = Node::new("ball", NodeKind::Object(object)).at([0.0, lifted, 0.0].into());
    scene.insert(None, 0, node).expect("the scene has room");
    let mut bench_scene = BenchScene::new("ball", &scene, None);
    let eye = glam::DVec3::new(0.3, 0.4, 3.0);
    bench_scene.camera = isolith::geometry::Camera::looking_at(eye, glam::DVec3::ZERO, 0.7);
    bench_scene
}

#[test]
fn a_ball_is_exact_and_a_slightly_different_one_is_refused() {
    const SMALL: u32 = 64;
    let right = ball(0.8, 0.0);
    assert!(measure(&right, &right, SMALL).iter().all(|found| found.faults().is_empty()));
    for wrong in [ball(0.802, 0.0), ball(0.798, 0.0), ball(0.8, 0.003)] {
        assert!(measure(&wrong, &right, SMALL).iter().all(|found| !found.faults().is_empty()));
    }
}

/// Ellipsoids in front of the background: an egg, a needle, and a disc seen nearly edge-on.
fn ellipsoids() -> BenchScene {
    let mut scene = Scene::new();
    for (radii, at) in [([0.7, 0.45, 0.5], 0.0), ([0.03, 0.9, 0.03], -1.0), ([0.8, 0.02, 0.8], 1.7)] {
        let object = Object { shape: Shape::Ellipsoid { radii }, material: MaterialId(1) };
        let node = Node::new("ellipsoid", NodeKind::Object(object)).at([at, 0.0, 0.0].into());
        scene.insert(None, usize::MAX, node.rotated(glam::DQuat::from_rotation_z(0.2))).expect("the scene has room");
    }
    let mut bench_scene = BenchScene::new("ellipsoids", &scene, None);
    let eye = glam::DVec3::new(0.3, 0.4, 6.0);
    bench_scene.camera = isolith::geometry::Camera::looking_at(eye, glam::DVec3::X * 0.4, 0.55);
    bench_scene
}

/// The thesis drew its ellipsoid with few steps and with many, and both were wrong along the outline. Here a ray has no
/// step count to choose: it ends at a sign change or when nothing remains ahead. The quality only sets the distance
/// below which a ray takes a straight line for granted. With the fewest steps and with the most, each pixel is right,
/// except for a few along the outline of coarse pictures and for pixels that rounding decides, which differs between
/// processors.
#[test]
fn outlines_of_ellipsoids_are_right_by_few_and_by_many_steps() {
    let shipped = scenes().find(|scene| scene.name == "ellipsoid-and-plane").expect("it is shipped");
    // Toward the plane's horizon, rays take many steps, all at a grazing angle.
    for (bench_scene, most) in [(ellipsoids(), 3.0), (shipped, 40.0)] {
        let reference =
            render_reference(&bench_scene.flat, &bench_scene.meshes, &bench_scene.camera, [SIDE, SIDE], &|_| ())
                .expect("an end");
        let gpu = shared().gpu.clone();
        let taken = Quality::ALL.map(|quality| {
            let options = Options { quality, counting: true, ..Renderer::options(&gpu) };
            let mut renderer = Renderer::with_options(&gpu, options).expect("a renderer");
            renderer.set_strategy(EvalStrategy::Interpreter);
            let overlay = OverlaySettings::default();
            let mut frame = renderer
                .begin(Slot::Full, &bench_scene.flat, &bench_scene.meshes, &bench_scene.camera, [SIDE, SIDE], overlay)
                .expect("a frame");
            renderer.advance(&mut frame, std::time::Duration::MAX).expect("a picture");
            assert_eq!(renderer.unfinished_rays(&frame).expect("counts"), []);
            let picture = renderer.read(&frame).expect("a picture");
            let steps = renderer.pixel_counts(&frame).expect("counts").steps();
            let verdicts = verdicts(&picture, &bench_scene.flat, &reference);
            let other = (0..verdicts.len()).filter(|i| verdicts[*i].is_wrong());
            // Coarse pictures guarantee outlines to a tenth of a pixel only.
            let is_near = |i: &usize| quality == Quality::Draft && reference.margin[*i] <= 0.1;
            let (near, wrong): (Vec<_>, Vec<_>) = other.partition(is_near);
            let fits = wrong.len() as f64 <= MAX_WRONG_SHARE * reference.margin.len() as f64 && near.len() < 40;
            assert!(fits, "{}, {quality:?}: {wrong:?} are wrong, {near:?} near", bench_scene.name);
            assert!(steps.mean < most, "{}, {quality:?}: {steps:?}", bench_scene.name);
            steps.mean
        });
        assert!(taken.is_sorted(), "{}: {taken:?}", bench_scene.name);
    }
}
