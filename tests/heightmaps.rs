//! Heightmaps with cliffs: a cliff slows only what is near it, and the field stays below the distance.

#![allow(clippy::print_stdout, reason = "the figures are for whoever runs this with `--nocapture`")]

use glam::DVec3;

use isolith::field::{FlatScene, LEAF_ROWS, eval::field, flatten};
use isolith::geometry::Camera;
use isolith::render::EvalStrategy;
use isolith::scene::{Attachment, Blend, Group, MaterialId, Node, NodeKind, Object, Operator, Scene, Shape, ShapeKind};

use crate::copies_pictures::faults;
use crate::gpu::BenchScene;
use crate::march_settings::drawn;

/// Side of the images, in pixels.
const PIXELS: u32 = 96;

fn land(shade: impl Fn(u32, u32) -> u8) -> Node {
    let image = Attachment::drawn("land.png", [PIXELS; 2], shade);
    let shape = Shape::Heightmap { image, size: [40.0, 1.0, 40.0], height: 6.0 };
    Node::new("Land", NodeKind::Object(Object { shape, material: MaterialId(1) }))
}

fn scene_of(node: Node) -> Scene {
    let mut scene = Scene::new();
    scene.insert(None, 0, node).expect("room");
    scene
}

/// Soft hills.
fn hills(x: u32, y: u32) -> u8 {
    let [x, y] = [x, y].map(|v| f64::from(v) * 0.13);
    (60.0 + 30.0 * (x.sin() + (1.3 * y + 0.5 * x).cos())) as u8
}

/// The images: one cliff of a single pixel, a wall, noise, level ground.
fn images() -> Vec<(&'static str, Node)> {
    let white = |x: u32, y: u32| if (x, y) == (70, 20) { 255 } else { hills(x, y) };
    let wall = |x: u32, y: u32| if x > 60 { 200 } else { hills(x, y) / 2 };
    let noise = |x: u32, y: u32| (x.wrapping_mul(2_654_435_761) ^ y.wrapping_mul(40_503)).rotate_left(7) as u8;
    vec![("white pixel", land(white)), ("wall", land(wall)), ("noise", land(noise)), ("level", land(|_, _| 90))]
}

/// The rows of the first leaf of the scene, of which the last number tells the side of a cell.
fn last_parameter(flat: &mut FlatScene) -> &mut f32 {
    let leaf = flat.nodes.iter().find(|node| node.is_leaf() && node.code & 0xffff == ShapeKind::Heightmap as u32);
    let row = leaf.expect("a heightmap").params as usize + LEAF_ROWS + 1;
    &mut flat.params[row][3]
}

/// Points of a ball, evenly.
fn in_ball(i: u32) -> DVec3 {
    let [u, v, w] = [0.754_877, 0.569_840, 0.438_579].map(|by: f64| (f64::from(i) * by).fract());
    let (height, around) = (2.0 * u - 1.0, std::f64::consts::TAU * v);
    let wide = (1.0 - height * height).sqrt();
    DVec3::new(wide * around.cos(), height, wide * around.sin()) * w.cbrt()
}

/// Balls around points, as large as the field there says, in which the other side of the surface begins.
fn broken_balls(flat: &FlatScene) -> usize {
    let component = &flat.components[0];
    let at = |p: DVec3| field(flat, component, p - component.origin);
    let points = (0..4_000).map(|i| in_ball(i) * DVec3::new(24.0, 8.0, 24.0) + DVec3::Y * 2.0);
    points
        .filter(|p| {
            let f = at(*p);
            (0..60).any(|i| at(*p + in_ball(i) * f.abs() * 0.999).signum() != f.signum())
        })
        .count()
}

#[test]
fn the_field_of_a_heightmap_is_nowhere_more_than_the_distance() {
    for (name, node) in images() {
        let mut flat = flatten(&scene_of(node), 0.0).expect("within the limits");
        assert!(*last_parameter(&mut flat) > 0.0, "{name}");
        assert_eq!(broken_balls(&flat), 0, "{name}");
    }
    // Cells around which everything is said to be level.
    let mut flat = flatten(&scene_of(images().remove(2).1), 0.0).expect("within the limits");
    let component = &flat.components[0];
    let end = (component.params + component.param_rows) as usize;
    let heights = end - (PIXELS * PIXELS) as usize;
    flat.params[heights..end].iter_mut().for_each(|row| row[3] = 16_777_215.0);
    assert!(broken_balls(&flat) > 0, "the test sees nothing");
}

/// A view over the land.
fn seen(name: &str, node: Node) -> BenchScene {
    let mut scene = BenchScene::new(name, &scene_of(node), None);
    scene.camera = Camera::looking_at(DVec3::new(-12.0, 7.0, 17.0), DVec3::new(0.0, 2.0, -2.0), 0.9);
    scene
}

#[test]
fn one_cliff_does_not_slow_everything() {
    for (name, node) in images() {
        let after = seen(name, node);
        let mut before = BenchScene { flat: after.flat.clone(), name: after.name.clone(), meshes: Vec::new(), ..after };
        *last_parameter(&mut before.flat) = 0.0;
        let [(slow, depths), (quick, same)] = [&before, &after].map(drawn);
        println!("{name}: {slow:.1} evaluations per pixel before, {quick:.1}");
        let off = depths.iter().zip(&same).filter(|(a, b)| (*a - *b).abs() > 1e-3 * **a).count();
        assert!(off < depths.len() / 100, "{name}: {off} depths differ");
        assert!(quick < 1.1 * slow, "{name}: {quick} of {slow}");
        if name == "white pixel" {
            assert!(quick * 3.0 < slow, "{name}: {quick} of {slow}");
        }
    }
}

#[test]
fn pictures_of_cliffs_are_as_exact_as_promised() {
    let scenes = images().into_iter().take(2).map(|(name, node)| seen(name, node));
    let faults: Vec<_> = scenes.flat_map(|scene| faults(&scene, &scene)).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// In a blend the field must not be steeper than 1: there it is the one by the steepest slope of all.
#[test]
fn heightmaps_in_blends_keep_the_even_field() {
    let with = |radius: f64, operator: Operator| {
        let mut scene = Scene::new();
        let group = Group::new(operator, Blend { radius, ..Blend::HARD });
        let group = scene.insert(None, 0, Node::new("Group", NodeKind::Group(group))).expect("room");
        let ball = Object { shape: Shape::Sphere { radius: 3.0 }, material: MaterialId(1) };
        scene.insert(Some(group), 0, images().remove(0).1).expect("room");
        scene.insert(Some(group), 1, Node::new("Ball", NodeKind::Object(ball)).at(DVec3::Y * 3.0)).expect("room");
        *last_parameter(&mut flatten(&scene, 0.0).expect("within the limits"))
    };
    assert!(with(0.0, Operator::Difference) > 0.0);
    assert_eq!([with(0.5, Operator::Difference), with(0.3, Operator::Union)], [0.0; 2]);
}

/// All evaluators agree about the picture.
#[test]
fn every_evaluator_draws_the_same_land() {
    let scene = seen("white pixel", images().remove(0).1);
    let [a, b, c] = [EvalStrategy::Interpreter, EvalStrategy::Tape, EvalStrategy::StraightLine]
        .map(|strategy| scene.render(64, strategy).depth);
    for other in [b, c] {
        let off = a.iter().zip(&other).filter(|(a, b)| (*a - *b).abs() > 1e-3 * **a).count();
        assert!(off < 8, "{off} depths differ");
    }
}
