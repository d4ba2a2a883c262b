//! Every scene's picture matches the accepted one; `make golden` accepts the current pictures.

use std::path::{Path, PathBuf};

use image::{Rgba, RgbaImage};
use isolith::field::GBuffer;
use isolith::render::{EvalStrategy, TracedParts};
use isolith::scene::{MaterialId, Node, NodeKind, Object, Scene, Shape, file};

use crate::gpu::{BenchScene, scenes, shared};

/// Width and height of the pictures, in pixels.
const SIDE: u32 = 256;

/// Required similarity of two pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gate {
    /// Bit-exact. Lavapipe gives the same bits on every machine and in every version.
    Exact,
    /// Within another driver's rounding, see [`CHANNEL_TOLERANCE`] and [`PIXEL_TOLERANCE`].
    Close,
}

/// Tolerance of each channel on other drivers.
const CHANNEL_TOLERANCE: u8 = 2;
/// On other drivers: fraction of the pixels that may differ more, because edges fall on either side.
const PIXEL_TOLERANCE: f64 = 5e-4;

impl Gate {
    /// Describes the difference of the two pictures, if it is too large.
    fn check(self, actual: &RgbaImage, accepted: &RgbaImage) -> Result<(), String> {
        if actual.dimensions() != accepted.dimensions() {
            return Err(format!("the size is {:?}, not {:?}", actual.dimensions(), accepted.dimensions()));
        }
        let (tolerance, share) = match self {
            Self::Exact => (0, 0.0),
            Self::Close => (CHANNEL_TOLERANCE, PIXEL_TOLERANCE),
        };
        let off = actual.pixels().zip(accepted.pixels()).map(|(a, b)| distance(a, b));
        let (count, worst) = off.filter(|d| *d > tolerance).fold((0, 0), |(n, worst), d| (n + 1, worst.max(d)));
        if f64::from(count) > share * f64::from(actual.width() * actual.height()) {
            return Err(format!("{count} pixels differ, by at most {worst} of 255"));
        }
        Ok(())
    }
}

/// The largest difference of a channel.
fn distance(a: &Rgba<u8>, b: &Rgba<u8>) -> u8 {
    a.0.iter().zip(b.0).map(|(a, b)| a.abs_diff(b)).max().unwrap_or(0)
}

#[test]
fn every_scene_looks_as_accepted() {
    let info = shared().gpu.info.clone();
    let is_lavapipe = info.driver == "llvmpipe";
    if is_accepting() {
        assert!(is_lavapipe, "pictures are accepted on lavapipe only, and this is {}", info.name);
        for scene in scenes().chain(moved_on()) {
            let picture = image(&scene.render(SIDE, EvalStrategy::Interpreter));
            picture.save(accepted_path(&scene.name)).expect("the accepted picture can be written");
        }
    }
    let gate = if is_lavapipe { Gate::Exact } else { Gate::Close };
    compare_with_accepted("interpreted", gate, |scene, side| scene.render(side, EvalStrategy::Interpreter));
    compare(moved_on(), "interpreted", gate, |scene, side| scene.render(side, EvalStrategy::Interpreter));
}

/// The scene whose passes have pictures of their own.
const IN_PASSES: &str = "terrain";

/// The picture of [`IN_PASSES`] after a number of passes over its parts, `side` by `side` pixels.
fn after_passes(passes: u32, side: u32) -> GBuffer {
    let scene = scenes().find(|scene| scene.name == IN_PASSES).expect("it is shipped");
    let renderer = &mut shared().renderer;
    renderer.set_traced(TracedParts { passes: Some(passes), ..TracedParts::default() });
    let picture = scene.render_on(renderer, side, EvalStrategy::Interpreter);
    renderer.set_traced(TracedParts::default());
    picture
}

/// The names of its pictures, with the number of passes. After the last one it is that of the scene.
fn passes() -> [(String, u32); 3] {
    [1, 2, 3].map(|passes| (format!("{IN_PASSES}-pass-{passes}"), passes))
}

#[test]
fn pictures_after_each_pass_look_as_accepted() {
    let is_lavapipe = shared().gpu.info.driver == "llvmpipe";
    let gate = if is_lavapipe { Gate::Exact } else { Gate::Close };
    for (name, passes) in passes() {
        let picture = image(&after_passes(passes, SIDE));
        if is_accepting() {
            picture.save(accepted_path(&name)).expect("the accepted picture can be written");
        }
        let accepted = image::open(accepted_path(&name)).expect("accepted").to_rgba8();
        if let Err(fault) = gate.check(&picture, &accepted) {
            panic!("{name}: {fault}; see {}", keep(&name, &picture, &accepted).display());
        }
    }
}

/// Whether the pictures as they are drawn now are accepted.
fn is_accepting() -> bool {
    std::env::var_os("ISOLITH_ACCEPT_GOLDEN").is_some_and(|value| value == "1")
}

/// Scenes of copies that move, and the moment of their second picture, in seconds.
const MOVING: [&str; 4] = ["asteroids", "dynamics-2d", "ocean", "terrain"];
const LATER: f64 = 2.5;

/// The moving scenes at the later moment.
fn moved_on() -> impl Iterator<Item = BenchScene> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    MOVING.into_iter().map(move |name| {
        let scene = file::load(&folder.join(format!("{name}.json"))).expect("it is shipped");
        BenchScene::at(&format!("{name}-later"), &scene, LATER, Some(folder.clone()))
    })
}

#[test]
fn later_pictures_are_others() {
    for name in MOVING {
        let [first, later] = [name.to_owned(), format!("{name}-later")]
            .map(|name| image::open(accepted_path(&name)).expect("accepted").to_rgba8());
        assert!(Gate::Close.check(&first, &later).is_err(), "{name}: nothing has moved");
    }
}

/// Straight-line code may round differently from the interpreter, so the test does not compare bits.
#[test]
fn every_scene_looks_the_same_with_straight_line_code() {
    compare_with_accepted("specialized", Gate::Close, |scene, side| scene.render(side, EvalStrategy::StraightLine));
}

/// Fails if a scene's picture from `draw` differs from the accepted one. `how` names the strategy in messages and file
/// names.
pub fn compare_with_accepted(how: &str, gate: Gate, draw: impl Fn(&BenchScene, u32) -> GBuffer) {
    compare(scenes(), how, gate, draw);
}

fn compare(all: impl Iterator<Item = BenchScene>, how: &str, gate: Gate, draw: impl Fn(&BenchScene, u32) -> GBuffer) {
    let mut faults = Vec::new();
    for scene in all {
        let Ok(accepted) = image::open(accepted_path(&scene.name)) else {
            faults.push(format!("{}: no picture was accepted yet; look at it and run `make golden`", scene.name));
            continue;
        };
        let (actual, accepted) = (image(&draw(&scene, SIDE)), accepted.to_rgba8());
        if let Err(fault) = gate.check(&actual, &accepted) {
            let place = keep(&format!("{}-{how}", scene.name), &actual, &accepted);
            faults.push(format!("{}: {fault}; see {}", scene.name, place.display()));
        }
    }
    assert!(faults.is_empty(), "{how}, {gate:?}:\n{}", faults.join("\n"));
}

#[test]
fn every_accepted_picture_has_its_scene() {
    let of_scenes = scenes().chain(moved_on()).map(|scene| scene.name);
    let names: Vec<_> = of_scenes.chain(passes().map(|(name, _)| name)).map(|name| format!("{name}.png")).collect();
    for entry in std::fs::read_dir(golden_folder()).expect("the folder can be read") {
        let name = entry.expect("an entry can be read").file_name().to_string_lossy().into_owned();
        assert!(names.contains(&name), "tests/golden/{name} belongs to no scene");
    }
}

#[test]
fn both_gates_refuse_a_shift_by_one_pixel() {
    let picture = picture_of(&sample(0.5, true));
    let shifted = RgbaImage::from_fn(SIDE, SIDE, |x, y| *picture.get_pixel(x.saturating_sub(1), y));
    refused_by_both(&shifted, &picture);
}

#[test]
fn both_gates_refuse_a_radius_two_percent_off() {
    let picture = picture_of(&sample(0.5, true));
    refused_by_both(&picture_of(&sample(0.51, true)), &picture);
    refused_by_both(&picture_of(&sample(0.49, true)), &picture);
}

#[test]
fn both_gates_refuse_a_picture_without_a_small_object() {
    refused_by_both(&picture_of(&sample(0.5, false)), &picture_of(&sample(0.5, true)));
}

#[test]
fn a_picture_made_twice_is_the_same() {
    assert_eq!(Gate::Exact.check(&picture_of(&sample(0.5, true)), &picture_of(&sample(0.5, true))), Ok(()));
}

fn refused_by_both(wrong: &RgbaImage, right: &RgbaImage) {
    for gate in [Gate::Exact, Gate::Close] {
        assert!(gate.check(wrong, right).is_err(), "{gate:?} let it through");
    }
}

/// A ball, a floor, and a small ball whose width is a hundredth of the picture's.
fn sample(radius: f64, with_small: bool) -> Scene {
    let mut scene = Scene::new();
    let mut add = |name: &str, shape: Shape, at: [f64; 3]| {
        let object = Object { shape, material: MaterialId(1) };
        let node = Node::new(name, NodeKind::Object(object)).at(at.into());
        scene.insert(None, usize::MAX, node).expect("the scene has room");
    };
    add("floor", Shape::Plane {}, [0.0, -0.5, 0.0]);
    add("ball", Shape::Sphere { radius }, [0.0; 3]);
    if with_small {
        add("small ball", Shape::Sphere { radius: 0.03 }, [0.6, 0.3, 0.3]);
    }
    scene
}

/// The scene from a camera that does not depend on its content.
fn picture_of(scene: &Scene) -> RgbaImage {
    let mut bench_scene = BenchScene::new("sample", scene, None);
    let eye = glam::DVec3::new(0.5, 0.7, 2.5);
    bench_scene.camera = isolith::geometry::Camera::looking_at(eye, glam::DVec3::ZERO, 0.7);
    image(&bench_scene.render(SIDE, EvalStrategy::Interpreter))
}

fn image(buffers: &GBuffer) -> RgbaImage {
    let bytes = buffers.color.iter().flatten().copied().collect();
    RgbaImage::from_raw(buffers.width, buffers.height, bytes).expect("one color for each pixel")
}

fn accepted_path(scene: &str) -> PathBuf {
    golden_folder().join(format!("{scene}.png"))
}

fn golden_folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden")
}

/// Writes the picture and its difference from the accepted one; returns the folder.
fn keep(name: &str, actual: &RgbaImage, accepted: &RgbaImage) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("target/golden-failures");
    std::fs::create_dir_all(&folder).expect("the folder for failures can be made");
    let difference = RgbaImage::from_fn(actual.width(), actual.height(), |x, y| {
        let other = accepted.get_pixel_checked(x, y).unwrap_or(&Rgba([0; 4]));
        // Every difference is at least a quarter bright, so that it is visible.
        let d = distance(actual.get_pixel(x, y), other);
        Rgba([if d == 0 { 0 } else { d.max(64) }, 0, 0, 255])
    });
    for (kind, image) in [("actual", actual), ("difference", &difference)] {
        image.save(folder.join(format!("{name}-{kind}.png"))).expect("the failure can be written");
    }
    folder
}
