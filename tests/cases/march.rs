//! Ray marching: flush cuts, thin shapes, rays with many steps.

use std::path::Path;
use std::sync::{LazyLock, Mutex, MutexGuard, PoisonError};

use glam::{DQuat, DVec3};
use isolith::field::reference::image::{ReferenceImage, render_reference};
use isolith::field::reference::tolerance::GRAZING_ANGLE;
use isolith::field::{GBuffer, Warning};
use isolith::geometry::Camera;
use isolith::render::{EvalStrategy, Renderer};
use isolith::scene::{
    Attachment, Blend, BlendKernel, Group, MaterialId, Modifier, Node, NodeId, NodeKind, Object, Operator, Scene,
    Shape, file,
};
use isolith::wgsl::{Options, SkipMode};

use crate::gpu::{BenchScene, shared};

/// The interpreter, tapes, specialized pipelines, and the window's choice among them.
const STRATEGIES: [EvalStrategy; 4] =
    [EvalStrategy::Interpreter, EvalStrategy::Tape, EvalStrategy::StraightLine, EvalStrategy::Auto];

/// A renderer with the pipelines of this device, and one with pipelines that skip by branches, as graphics cards get
/// them. Both build tapes for components of any size.
fn renderers() -> MutexGuard<'static, [Renderer; 2]> {
    static RENDERERS: LazyLock<Mutex<[Renderer; 2]>> = LazyLock::new(|| {
        let gpu = shared().gpu.clone();
        let branches = Options { skip_mode: SkipMode::Branches, ..Options::default() };
        Mutex::new([Renderer::options(&gpu), branches].map(|options| {
            let mut renderer = Renderer::with_options(&gpu, options).expect("a renderer");
            renderer.tape_cache().build_all();
            renderer
        }))
    });
    RENDERERS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Differences between a picture and the reference, in pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Found {
    /// A miss in place of a hit, or a hit in place of a miss.
    hit_or_miss: usize,
    /// Those of them whose ray passes too near an edge for f32.
    grazing: usize,
    /// Those of them whose ray passes an edge within a thousandth of a footprint.
    near: usize,
    /// Depth errors of more than a footprint.
    other_surface: usize,
    /// Normals off by more than a right angle.
    turned: usize,
}

const NOTHING: Found = Found { hit_or_miss: 0, grazing: 0, near: 0, other_surface: 0, turned: 0 };

/// See [`Found::near`].
const NEAR: f64 = 1e-3;

fn found(picture: &GBuffer, reference: &ReferenceImage, footprint: f64) -> Found {
    let mut found = NOTHING;
    for (i, right) in reference.buffers.depth.iter().enumerate() {
        let (depth, right) = (f64::from(picture.depth[i]), f64::from(*right));
        if depth.is_finite() != right.is_finite() {
            found.hit_or_miss += 1;
            let margin = f64::from(reference.margin[i]);
            found.grazing += usize::from(margin <= GRAZING_ANGLE / footprint);
            found.near += usize::from(margin <= NEAR);
        } else if right.is_finite() {
            found.other_surface += usize::from((depth - right).abs() > footprint * right);
            let [a, b] = [picture, &reference.buffers].map(|buffers| glam::Vec3::from(buffers.normal[i]));
            found.turned += usize::from(a.dot(b) < 0.0);
        }
    }
    found
}

fn case(folder: &str, name: &str) -> BenchScene {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases").join(folder);
    let scene = file::load(&folder.join(format!("{name}.json"))).unwrap_or_else(|error| panic!("{error}"));
    BenchScene::new(name, &scene, Some(folder))
}

fn reference(bench_scene: &BenchScene, size: [u32; 2]) -> ReferenceImage {
    render_reference(&bench_scene.flat, &bench_scene.meshes, &bench_scene.camera, size, &|_| ())
        .unwrap_or_else(|e| panic!("{e}"))
}

fn draw(
    renderer: &mut Renderer,
    bench_scene: &BenchScene,
    size: [u32; 2],
    strategy: EvalStrategy,
) -> (GBuffer, Vec<Warning>) {
    renderer.set_strategy(strategy);
    let picture = renderer.render(&bench_scene.flat, &bench_scene.meshes, &bench_scene.camera, size, &mut |_| true);
    picture.unwrap_or_else(|error| panic!("{}: {error}", bench_scene.name))
}

/// Draws the bench_scene with every strategy, and with branching pipelines too if `branching`. `is_allowed` must accept
/// each strategy's differences from `right`.
fn compare(bench_scene: &BenchScene, right: &ReferenceImage, branching: bool, is_allowed: impl Fn(&Found) -> bool) {
    let size = [right.buffers.width, right.buffers.height];
    let footprint = bench_scene.camera.footprint(f64::from(size[1]));
    let mut faults = Vec::new();
    for renderer in renderers().iter_mut().take(if branching { 2 } else { 1 }) {
        for strategy in STRATEGIES {
            let (picture, unfinished) = draw(renderer, bench_scene, size, strategy);
            let found = found(&picture, right, footprint);
            if !is_allowed(&found) || !unfinished.is_empty() {
                faults.push(format!("{}, {strategy:?}: {found:?}, {unfinished:?}", bench_scene.name));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Asserts that every pixel matches the reference, for all strategies and pipelines.
fn is_right(bench_scene: &BenchScene, side: u32) {
    compare(bench_scene, &reference(bench_scene, [side; 2]), true, |found| *found == NOTHING);
}

fn object(shape: Shape) -> Node {
    Node::new("Part", NodeKind::Object(Object { shape, material: MaterialId(1) }))
}

fn cuboid(size: [f64; 3]) -> Node {
    object(Shape::Box { size, rounding: 0.0 })
}

fn group(operator: Operator, radius: f64) -> Node {
    Node::new("Group", NodeKind::Group(Group::new(operator, Blend::new(BlendKernel::Quadratic, radius))))
}

/// A rotation by no simple angle.
fn turn() -> DQuat {
    DQuat::from_axis_angle(DVec3::new(0.2, 1.0, 0.4).normalize(), 0.7)
}

/// A scene of these parts below `top`.
fn scene(top: Node, parts: impl IntoIterator<Item = Node>) -> Scene {
    let mut scene = Scene::new();
    let parent: NodeId = scene.insert(None, usize::MAX, top).expect("there is room");
    for part in parts {
        scene.insert(Some(parent), usize::MAX, part).expect("there is room");
    }
    scene
}

/// A view from above and from the side.
fn seen(name: &str, scene: &Scene, target: DVec3) -> BenchScene {
    let mut bench_scene = BenchScene::new(name, scene, None);
    bench_scene.camera = Camera::looking_at(target + turn() * DVec3::new(0.9, 3.1, 1.7), target, 0.75);
    bench_scene
}

#[test]
fn holes_that_end_flush_with_a_face_are_open() {
    for name in ["flush_hole_through", "flush_hole_rotated", "difference_identical_box", "gate_blind_pockets"] {
        is_right(&case("numerics", name), 128);
    }
}

/// The reference would tell the two faces apart by their rounding to f32 in the arrays. The right picture is the one
/// with a protruding cutter.
fn is_open(name: &str, target: DVec3, made: impl Fn(f64) -> Scene) {
    const OUT: f64 = 1e-3;
    let (flush, open) = (seen(name, &made(0.0), target), seen(name, &made(OUT), target));
    let right = reference(&open, [96; 2]);
    let hits = right.buffers.depth.iter().filter(|depth| depth.is_finite()).count();
    assert!(hits > 500, "{name}: {hits} pixels show anything");
    // f32 numbers of the size of the largest leaf limit the sharpness of edges: to 0.0005 footprints for a leaf of 60
    // m.
    let is_allowed =
        |found: &Found| found.hit_or_miss == found.near && found.near <= 1 && found.other_surface + found.turned == 0;
    compare(&flush, &right, true, is_allowed);
    // A skin of a millimeter over the pocket is detected.
    let closed = seen(name, &made(-OUT), target);
    let (picture, _) = draw(&mut renderers()[0], &closed, [96; 2], EvalStrategy::Interpreter);
    let found = found(&picture, &right, flush.camera.footprint(96.0));
    assert!(found.other_surface > 50, "{name}: {found:?}");
}

/// A pocket in a plate, 0.6 deep; its cutter protrudes from the upper face by `out`.
fn pocket(out: f64, cutter: impl Fn([f64; 3]) -> Node, radius: f64, top: impl Fn(Node) -> Node) -> Scene {
    let height = 0.6 + out;
    let cutter = cutter([0.8, height, 0.7]).at(DVec3::new(0.1, 0.5 - 0.6 + 0.5 * height, 0.0));
    scene(top(group(Operator::Difference, radius).rotated(turn())), [cuboid([2.0, 1.0, 1.9]), cutter])
}

#[test]
fn pockets_are_open_wherever_they_are_and_however_they_are_cut() {
    let cylinder = |[x, y, _]: [f64; 3]| object(Shape::Cylinder { radius: 0.5 * x, height: y, rounding: 0.0 });
    let as_it_is = |top: Node| top;
    is_open("a box", DVec3::ZERO, |out| pocket(out, cuboid, 0.0, as_it_is));
    is_open("a cylinder", DVec3::ZERO, |out| pocket(out, cylinder, 0.0, as_it_is));
    let far = DVec3::new(1e6, -3e5, 7e5);
    is_open("far off", far, |out| pocket(out, cuboid, 0.0, |top| top.at(far)));
    is_open("stretched", DVec3::ZERO, |out| pocket(out, cylinder, 0.0, |top| top.scaled(DVec3::new(1.0, 0.8, 1.2))));
    is_open("twisted", DVec3::ZERO, |out| pocket(out, cuboid, 0.0, |top| top.modified(Modifier::Twist { angle: 0.3 })));
    // A cutter a hundred times as large as the plate: nothing remains above its upper face.
    is_open("by something large", DVec3::ZERO, |out| {
        let cutter = cuboid([60.0, 60.0 + out, 0.7]).at(DVec3::new(29.7, 0.5 - 30.0 + 0.5 * out, 0.0));
        scene(group(Operator::Difference, 0.0).rotated(turn()), [cuboid([2.0, 1.0, 1.9]), cutter])
    });
    // A negative child, and the intersection with the uncut part.
    is_open("negative", DVec3::ZERO, |out| {
        let cutter = cuboid([0.8, 0.6 + out, 0.7]).at(DVec3::new(0.1, 0.2 + 0.5 * out, 0.0)).subtracted();
        scene(group(Operator::Union, 0.0).rotated(turn()), [cuboid([2.0, 1.0, 1.9]), cutter])
    });
}

/// A block of 100 km with a pocket, seen from 20 m above it: in its middle, and where numbers are relative to a point
/// near the eye. What is rounded there is far less than the block.
#[test]
fn pockets_in_a_large_face_are_open_near_and_far() {
    const SIZE: [u32; 2] = [48; 2];
    let pocket = |x: f64, far: f64, size: f64, out: f64| {
        let height = 0.3 * size + out;
        let at = DVec3::new(x, 500.0 - 0.3 * size + 0.5 * height, -far);
        let pocket = cuboid([size, height, size]).at(at).rotated(DQuat::from_rotation_y(0.4 + far));
        scene(group(Operator::Difference, 0.0).rotated(turn()), [cuboid([1e5, 1e3, 1e5]), pocket])
    };
    let mut faults = Vec::new();
    for (x, far, size, fov) in
        [(0.0, 25.0, 4.0, 0.3), (0.0, 200.0, 40.0, 0.04), (0.0, 2_000.0, 900.0, 0.01), (3e4, 200.0, 40.0, 0.04)]
    {
        let shown = |out: f64| {
            let mut bench_scene = BenchScene::new("a large face", &pocket(x, far, size, out), None);
            let [eye, target] = [DVec3::new(x, 520.0, 0.0), DVec3::new(x, 500.0, -far)].map(|p| turn() * p);
            bench_scene.camera = Camera::looking_at(eye, target, fov);
            bench_scene
        };
        // A millimeter would be visible at such an angle.
        let (flush, open) = (shown(0.0), shown(1e-4));
        let right = reference(&open, SIZE);
        let (closed, _) = draw(&mut renderers()[0], &shown(-0.1), SIZE, EvalStrategy::Interpreter);
        let footprint = open.camera.footprint(f64::from(SIZE[1]));
        let told = found(&closed, &right, footprint).other_surface;
        assert!(told > 75, "{far}: {told} pixels show the pocket");
        for strategy in STRATEGIES {
            let (picture, _) = draw(&mut renderers()[0], &flush, SIZE, strategy);
            let found = found(&picture, &right, footprint);
            // Relative to a point near the eye, an edge moves by up to 1/64 footprint: about one pixel of a hundred.
            let is_right = found == Found { other_surface: found.other_surface, ..NOTHING };
            if !is_right || found.other_surface > if x == 0.0 { 0 } else { 4 } {
                faults.push(format!("at {x}, {far} m, {strategy:?}: {found:?}"));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn what_is_taken_from_itself_is_nothing() {
    let ball = || object(Shape::Sphere { radius: 0.7 });
    let tube = || object(Shape::Torus { major_radius: 0.6, minor_radius: 0.2 }).rotated(turn());
    for part in [ball as fn() -> Node, tube as fn() -> Node, || cuboid([1.0, 0.9, 0.8]).rotated(turn())] {
        for operator in [Operator::Difference, Operator::Xor] {
            is_right(&seen("nothing", &scene(group(operator, 0.0), [part(), part()]), DVec3::ZERO), 64);
        }
    }
    // Two touching boxes have an empty intersection.
    let [left, right] = [-0.5, 0.5].map(|x| cuboid([1.0; 3]).at(DVec3::X * x));
    let touching = scene(group(Operator::Intersection, 0.0).rotated(turn()), [left, right]);
    is_right(&seen("touching", &touching, DVec3::ZERO), 64);
}

#[test]
fn what_has_no_thickness_is_nothing() {
    let mut bench_scene = case("numerics", "zero_sizes");
    is_right(&bench_scene, 128);
    let shell = object(Shape::Sphere { radius: 0.7 });
    let shell = |thickness| {
        let onion = Modifier::Onion { thickness, walls: 1, spacing: 0.2 };
        seen("shell", &scene(group(Operator::Union, 0.0), [shell.clone().modified(onion)]), DVec3::ZERO)
    };
    bench_scene = shell(0.0);
    is_right(&bench_scene, 64);
    // A thin shell exists.
    is_right(&shell(1e-4), 64);
}

/// The picture's size must not decide whether a shape is visible.
#[test]
fn thin_sheets_are_seen_in_small_pictures_too() {
    let bench_scene = case("thin-sheet", "sheet");
    for (size, hits) in [([64, 48], Some(676)), ([320, 240], None), ([9, 7], None)] {
        let right = reference(&bench_scene, size);
        let seen = right.buffers.depth.iter().filter(|depth| depth.is_finite()).count();
        assert!(hits.is_none_or(|hits| seen == hits) && seen > 0, "{seen} hits");
        compare(&bench_scene, &right, true, |found| *found == NOTHING);
    }
}

/// A single shape, rotated by `degrees`, seen from `distance`.
fn alone(shape: Shape, degrees: f64, distance: f64) -> BenchScene {
    let axis = DVec3::new(0.9, 0.1, 0.3).normalize();
    let node = object(shape).rotated(DQuat::from_axis_angle(axis, degrees.to_radians()));
    let mut bench_scene = BenchScene::new("alone", &scene(group(Operator::Union, 0.0), [node]), None);
    bench_scene.camera = Camera::looking_at(DVec3::Z * distance, DVec3::ZERO, 0.7);
    bench_scene
}

#[test]
fn thin_things_are_seen_from_the_side_that_is_entered() {
    is_right(&case("numerics", "sheet_02mm_auto"), 256);
    for degrees in [0.0, 30.0, 60.0, 80.0, 87.0] {
        // At 20 um, from 10 m and at 3 degrees, f32 loses some pixels.
        for thickness in [1e-3, 1e-4, 2e-5].into_iter().take(if degrees < 80.0 { 3 } else { 2 }) {
            is_right(&alone(Shape::Box { size: [4.0, 4.0, thickness], rounding: 0.0 }, degrees, 10.0), 48);
        }
    }
    is_right(&alone(Shape::Box { size: [100.0, 100.0, 1e-3], rounding: 0.0 }, 20.0, 400.0), 96);
    is_right(&alone(Shape::Cylinder { radius: 60.0, height: 1e-3, rounding: 0.0 }, 60.0, 400.0), 96);
    for radius in [0.001, 0.01, 0.1] {
        is_right(&alone(Shape::Cylinder { radius, height: 8.0, rounding: 0.0 }, 20.0, 10.0), 192);
    }
}

#[test]
fn what_is_pressed_flat_keeps_its_pixels() {
    let bench_scene = case("numerics", "scale_torus_y_1e_4");
    // Its edges are as sharp as f32 permits.
    let is_allowed = |found: &Found| {
        found.hit_or_miss == found.grazing && found.grazing <= 4 && found.other_surface + found.turned == 0
    };
    compare(&bench_scene, &reference(&bench_scene, [256; 2]), true, is_allowed);
}

/// A turn is 1.5 cm high and a pixel 1 cm wide: the rounding of its angle decides where a ray hits, but the hit enters
/// the solid.
#[test]
fn what_is_twisted_a_hundred_times_faces_the_eye() {
    let bench_scene = case("numerics", "twist_100_turns");
    // As measured; in none of these pixels is the reference certain within a thousandth of a footprint.
    let is_allowed =
        |found: &Found| found.hit_or_miss <= found.near.min(3) && found.other_surface <= 13 && found.turned == 0;
    compare(&bench_scene, &reference(&bench_scene, [256; 2]), false, is_allowed);
}

/// A wall faces the eye. A surface entered from inside, at the near plane, has the normal of the field there.
#[test]
fn an_eye_in_a_solid_sees_what_the_reference_sees() {
    let mut bench_scene = alone(Shape::Sphere { radius: 1.0 }, 0.0, 0.4);
    is_right(&bench_scene, 32);
    bench_scene.camera.near = 0.3;
    is_right(&bench_scene, 32);
}

/// With an odd number of rows, the middle row looks along the upper face: the field there is 0 and never negative, so
/// rays see what is behind. Each of these rays takes some 80 000 steps.
#[test]
fn rays_along_a_face_pass_it() {
    is_right(&case("numerics", "along_face_1000m_odd"), 255);
    is_right(&case("numerics", "along_face_1000m_odd"), 64);
}

/// A heightmap with one white pixel: its steepness sets the step length everywhere.
fn one_white_pixel() -> BenchScene {
    let image = Attachment::drawn("white.png", [256, 256], |x, y| if (x, y) == (160, 104) { 255 } else { 0 });
    let land = object(Shape::Heightmap { image, size: [20.0, 0.5, 20.0], height: 15.0 });
    let mut bench_scene = BenchScene::new("one white pixel", &scene(group(Operator::Union, 0.0), [land]), None);
    bench_scene.camera = Camera::looking_at(DVec3::new(0.0, 1.5, 14.0), DVec3::ZERO, 0.7);
    bench_scene
}

#[test]
fn rays_that_take_many_steps_go_on_until_they_end() {
    // Its bumps are far smaller than a pixel: rays may miss chords shorter than the longest min step. Without
    // relaunches, 123 pixels showed what is behind.
    let terrain = case("numerics", "steps_terrain_soft_auto");
    let is_allowed = |found: &Found| found.hit_or_miss <= 16 && found.other_surface <= 80;
    compare(&terrain, &reference(&terrain, [48; 2]), false, is_allowed);
    let land = one_white_pixel();
    compare(&land, &reference(&land, [48; 2]), false, |found| found.hit_or_miss + found.other_surface == 0);
}

/// In a picture this high, a ray along the face of a box 100 km long advances too slowly: a warning reports that it has
/// not ended, with the node.
#[test]
fn rays_that_are_given_up_are_counted_and_reported() {
    let long = cuboid([1.0, 1.0, 1e5]).at(DVec3::new(0.0, -0.5, -5e4 - 1.0));
    let ball = object(Shape::Sphere { radius: 30.0 }).at(DVec3::Z * -2e5);
    let made = scene(group(Operator::Union, 0.0), [long, ball]);
    let mut bench_scene = BenchScene::new("long", &made, None);
    bench_scene.camera = Camera { fov_y: 0.02, ..Camera::looking_at(DVec3::Z, DVec3::ZERO, 0.02) };
    let (_, warnings) = draw(&mut renderers()[0], &bench_scene, [3, 2047], EvalStrategy::StraightLine);
    let [warning] = &warnings[..] else { panic!("{warnings:?}") };
    assert_eq!(warning.node, made.nodes()[1].id);
    assert!(warning.reason.starts_with("3 rays did not come to an end"), "{}", warning.reason);
}
