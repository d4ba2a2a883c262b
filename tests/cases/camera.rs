//! Cameras: narrow and wide pixels, near and far limits, large scenes with small details.

mod hand;
mod large;
mod limits;
mod narrow;

use std::path::Path;

use glam::{DQuat, DVec2, DVec3};
use isolith::field::GBuffer;
use isolith::field::reference::image::render_reference;
use isolith::geometry::Camera;
use isolith::render::EvalStrategy;
use isolith::scene::{MaterialId, Node, NodeKind, Object, Scene, Shape, file};

use crate::gpu::{BenchScene, shared};
use hand::Seen;

/// Every evaluator.
const STRATEGIES: [EvalStrategy; 3] = [EvalStrategy::Interpreter, EvalStrategy::Tape, EvalStrategy::StraightLine];

/// A scene of `tests/cases`, by its path without extension, seen by its own camera.
fn case(name: &str) -> BenchScene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases").join(format!("{name}.json"));
    let scene = file::load(&path).unwrap_or_else(|error| panic!("{error}"));
    BenchScene::new(name, &scene, path.parent().map(Path::to_path_buf))
}

/// An object with the first material.
fn object(shape: Shape, at: DVec3) -> Node {
    Node::new("object", NodeKind::Object(Object { shape, material: MaterialId(1) })).at(at)
}

/// A scene with these nodes at the top level.
fn scene_of(nodes: impl IntoIterator<Item = Node>) -> Scene {
    let mut scene = Scene::new();
    for node in nodes {
        scene.insert(None, usize::MAX, node).expect("the scene has room");
    }
    scene
}

/// A picture of the bench_scene on the shared device.
fn draw(bench_scene: &BenchScene, size: [u32; 2], strategy: EvalStrategy) -> GBuffer {
    let renderer = &mut shared().renderer;
    renderer.set_strategy(strategy);
    let picture = renderer.render(&bench_scene.flat, &bench_scene.meshes, &bench_scene.camera, size, &mut |_| true);
    let (buffers, unfinished) = picture.unwrap_or_else(|error| panic!("{}: {error}", bench_scene.name));
    assert!(unfinished.is_empty(), "{}: {unfinished:?}", bench_scene.name);
    buffers
}

/// A camera that faces `target` from `distance`, rotated so that no axis of the picture is parallel to a world axis.
/// `degrees` is the angle of view of its longer side.
fn looking(target: DVec3, distance: f64, degrees: f64, [width, height]: [u32; 2]) -> Camera {
    let half = (0.5 * degrees).to_radians().tan();
    let up = if height >= width { half } else { half * f64::from(height) / f64::from(width) };
    let eye = target + DVec3::new(0.31, 0.52, 0.79).normalize() * distance;
    let mut camera = Camera::looking_at(eye, target, 2.0 * up.atan());
    camera.rotation *= DQuat::from_rotation_z(0.3);
    camera.far = 1e9;
    camera
}

/// Describes the pixels that differ from `seen` for their rays; and counts the pixels that show something.
///
/// The tolerance of depth is 0.05 footprints, plus the change of depth over 0.02 footprints to the side where the ray
/// meets the surface at an angle, plus four roundings of f32, the format of depth. Rays that pass an outline by less
/// than 0.02 footprints may be on either side of it.
fn faults(picture: &GBuffer, camera: &Camera, seen: &dyn Fn(&isolith::geometry::Ray) -> Seen) -> (Vec<String>, usize) {
    let size = DVec2::new(picture.width.into(), picture.height.into());
    let footprint = camera.footprint(size.y);
    let (mut wrong, mut hits) = (Vec::new(), 0);
    for y in 0..picture.height {
        for x in 0..picture.width {
            let ray = camera.ray(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5), size);
            let seen = seen(&ray);
            if seen.edge < 0.02 * footprint {
                continue;
            }
            let drawn = f64::from(picture.depth[picture.index(x, y)]);
            let allowed = |t: f64| t * (footprint * (0.05 + 0.02 * seen.slope) + 2.0 * f64::from(f32::EPSILON));
            let entry = seen.span.map(|[entry, exit]| [entry.max(camera.near), exit]);
            if let Some([t, exit]) = entry
                && ((t - camera.far).abs() < allowed(t) || (exit - camera.near).abs() < allowed(exit))
            {
                continue;
            }
            let entry = entry.filter(|[t, exit]| *t <= camera.far && *exit >= camera.near).map(|[t, _]| t);
            hits += usize::from(entry.is_some());
            let is_right = match entry {
                Some(t) => (drawn - t).abs() <= allowed(t),
                None => drawn.is_infinite(),
            };
            if !is_right {
                let off = entry.map_or(f64::NAN, |t| (drawn - t) / (footprint * t));
                wrong.push(format!("({x}, {y}): {drawn} instead of {entry:?}, {off:.3} footprints"));
            }
        }
    }
    (wrong, hits)
}

/// Draws the bench_scene with the strategies and compares each picture with `seen`.
fn check(
    bench_scene: &BenchScene,
    size: [u32; 2],
    strategies: &[EvalStrategy],
    seen: &dyn Fn(&isolith::geometry::Ray) -> Seen,
) -> Vec<String> {
    let pixels = (size[0] * size[1]) as usize;
    let mut all = Vec::new();
    for strategy in strategies {
        let (wrong, hits) = faults(&draw(bench_scene, size, *strategy), &bench_scene.camera, seen);
        assert!(hits > pixels / 200, "{}: only {hits} of {pixels} pixels show something", bench_scene.name);
        if let Some(first) = wrong.first() {
            let middle = &wrong[wrong.len() / 2];
            let name = &bench_scene.name;
            all.push(format!("{name}, {size:?}, {strategy:?}: {} of {hits} wrong: {first}; {middle}", wrong.len()));
        }
    }
    all
}

/// Draws a case with all strategies and compares each with the reference: only pixels whose ray passes an edge within
/// rounding may show something else or be off by more than a footprint.
fn check_by_reference(name: &str, size: [u32; 2]) -> Vec<String> {
    let bench_scene = case(name);
    let right = render_reference(&bench_scene.flat, &bench_scene.meshes, &bench_scene.camera, size, &|_| ());
    let right = right.unwrap_or_else(|error| panic!("{name}: {error}"));
    let mut all = Vec::new();
    for strategy in STRATEGIES {
        let picture = draw(&bench_scene, size, strategy);
        let shown = picture.depth.iter().filter(|d| d.is_finite()).count();
        assert!(shown > picture.depth.len() / 200, "{name}: {shown} pixels show something");
        let accuracy = isolith::field::Accuracy::against(&picture, &bench_scene.flat, &right);
        if accuracy.wrong > 0 || !accuracy.faults().is_empty() {
            all.push(format!("{name}, {strategy:?}: {accuracy:?}"));
        }
    }
    all
}
