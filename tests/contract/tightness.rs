//! Tightness of fields, relative to the distance: of shapes, operators and modifiers. The test compares the tables in
//! `shaders/README.md` with its measurements; with `ISOLITH_ACCEPT_TIGHTNESS=1` it rewrites them.

use std::fmt::Write as _;

use glam::DVec3;
use isolith::field::eval::field;
use isolith::field::{PreparedShape, flatten};
use isolith::geometry::Aabb;
use isolith::scene::{
    Blend, BlendKernel, Group, MaterialId, ModifierKind, Node, NodeKind, Object, Operator, Scene, Shape, ShapeKind,
};

use super::drawn::tube_distance;
use super::modifiers::{modified, usual};
use super::profiles::menger_distance;
use super::samples::{Random, evaluate};
use super::surfaces::{Patch, brute_distance, patches};

const README: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/shaders/README.md");
const MARKS: [&str; 2] = ["<!-- tightness:begin -->", "<!-- tightness:end -->"];
/// Sample points outside of each shape.
const POINTS: usize = 200;
/// Sample points outside of each scene, whose distance is searched along rays.
const SCENE_POINTS: usize = 60;

/// The distance from outside, by brute force.
fn exact(shape: &Shape, surface: &[Patch], p: DVec3) -> f64 {
    match *shape {
        Shape::MengerSponge { size, iterations } => {
            menger_distance(p, DVec3::ZERO, size, iterations.round() as i32, f64::INFINITY)
        }
        Shape::Julia { .. } | Shape::Kleinian { .. } | Shape::Mandelbulb { .. } => {
            let prepared = PreparedShape::new(shape);
            ray_distance(&|p| evaluate(&prepared, p.to_array()), p)
        }
        Shape::Tube { .. } => tube_distance(shape, p),
        _ => brute_distance(surface, p),
    }
}

/// The distance along the best of many random rays, refined by ever smaller rotations. An upper bound of the distance.
fn ray_distance(field: &dyn Fn(DVec3) -> f64, p: DVec3) -> f64 {
    let mut random = Random::new(1);
    let (mut best, mut ahead) = (f64::INFINITY, DVec3::ZERO);
    for i in 0..600 {
        let turn = if i < 300 { random.direction() } else { random.direction() * 0.98_f64.powi(i - 300) };
        let direction = if i < 300 { turn } else { (ahead + turn).normalize() };
        let mut t = 0.0;
        while t < best.min(4.0) {
            let f = field(p + direction * t);
            if f < 1e-4 {
                (best, ahead) = (t, direction);
                break;
            }
            t += f;
        }
    }
    best
}

/// The mean and the minimum of field over distance at random points outside, in and around a box.
fn measure(
    field: &dyn Fn(DVec3) -> f64,
    exact: &dyn Fn(DVec3) -> f64,
    bounds: Aabb,
    seed: u64,
    points: usize,
) -> String {
    let (center, reach) =
        if bounds.is_finite() { (bounds.center(), 1.2 * bounds.half().max_element()) } else { (DVec3::ZERO, 1.0) };
    let mut random = Random::new(seed);
    let (mut sum, mut least, mut count) = (0.0, f64::INFINITY, 0);
    while count < points {
        let p = center + random.point(reach);
        let f = field(p);
        if f < 1e-3 {
            continue;
        }
        let d = exact(p);
        assert!(f <= d + 1e-6, "seed {seed} at {p}: the field is {f}, the distance {d}");
        (sum, least, count) = (sum + f / d, least.min(f / d), count + 1);
    }
    format!("{:.3} | {least:.3}", sum / points as f64)
}

/// Tightness of a shape with its default parameters.
fn of_shape(kind: ShapeKind) -> String {
    let shape = kind.default_shape();
    let (surface, prepared) = (patches(&shape), PreparedShape::new(&shape));
    let bounds = if shape.bounds().is_finite() {
        Aabb::from_center_half(DVec3::ZERO, DVec3::splat(shape.bounds().half().max_element()))
    } else {
        shape.bounds()
    };
    let field = |p: DVec3| evaluate(&prepared, p.to_array());
    measure(&field, &|p| exact(&shape, &surface, p), bounds, 17 + kind as u64, POINTS)
}

/// Tightness of a scene.
fn of_scene(scene: &Scene, seed: u64) -> String {
    let flat = flatten(scene, 0.0).unwrap();
    let bounds = flat.components.iter().map(|c| c.bounds.translated(c.origin)).reduce(|a, b| a.union(&b)).unwrap();
    let least = |p: DVec3| flat.components.iter().map(|c| field(&flat, c, p - c.origin)).fold(f64::INFINITY, f64::min);
    measure(&least, &|p| ray_distance(&least, p), bounds, seed, SCENE_POINTS)
}

/// A box and a ball that protrudes from it.
fn joined(group: Group) -> Scene {
    let mut scene = Scene::new();
    let parent = scene.insert(None, 0, Node::new("Blend", NodeKind::Group(group))).unwrap();
    let parts = [
        (Shape::Box { size: [0.9, 0.6, 0.8], rounding: 0.05 }, DVec3::ZERO),
        (Shape::Sphere { radius: 0.42 }, DVec3::new(0.1, 0.33, 0.16)),
    ];
    for (shape, at) in parts {
        let object = Object { shape, material: MaterialId(1) };
        scene.insert(Some(parent), usize::MAX, Node::new("Part", NodeKind::Object(object)).at(at)).unwrap();
    }
    scene
}

/// The tables.
fn tables() -> String {
    const HEAD: &str = "| field | mean of field / distance | least |\n|---|--:|--:|\n";
    let mut text = HEAD.to_owned();
    for &kind in ShapeKind::ALL {
        writeln!(text, "| {} | {} |", kind.label(), of_shape(kind)).unwrap();
    }
    write!(text, "\nA box and a ball that reaches out of it, by every operator, with a blend of 0.2 m:\n\n{HEAD}")
        .unwrap();
    for operator in Operator::ALL {
        let kernels = if operator.has_kernel() { BlendKernel::ALL.as_slice() } else { &BlendKernel::ALL[..1] };
        for &kernel in kernels {
            let name =
                if operator.has_kernel() { format!(", {}", kernel.label().to_lowercase()) } else { String::new() };
            let figures = of_scene(&joined(Group::new(operator, Blend::new(kernel, 0.2))), 100 + kernel as u64);
            writeln!(text, "| {}{name} | {figures} |", operator.label()).unwrap();
        }
    }
    write!(text, "\nA lopsided thing of two boxes and a ball, blended, as it is and by every modifier:\n\n{HEAD}")
        .unwrap();
    writeln!(text, "| As it is | {} |", of_scene(&modified(&[]), 200)).unwrap();
    for &kind in ModifierKind::ALL {
        let figures = of_scene(&modified(&[usual(kind)]), 201 + kind as u64);
        writeln!(text, "| {} | {figures} |", kind.label()).unwrap();
    }
    text
}

#[test]
fn the_tables_say_how_tight_fields_are() {
    let tables = tables();
    let text = std::fs::read_to_string(README).unwrap();
    let [begin, end] = MARKS.map(|mark| text.find(mark).expect("the marks of the tables"));
    let (before, held) = (&text[..begin + MARKS[0].len()], &text[begin + MARKS[0].len()..end]);
    if std::env::var_os("ISOLITH_ACCEPT_TIGHTNESS").is_some() {
        std::fs::write(README, format!("{before}\n\n{tables}\n{}", &text[end..])).unwrap();
    } else {
        assert!(held.trim() == tables.trim(), "measured now:\n{tables}");
    }
}
