//! How near the fields of shapes come to the distance. The table of it in `shaders/README.md` is held to what is
//! measured here; with `ISOLITH_ACCEPT_TIGHTNESS=1` it is written anew.

use std::fmt::Write as _;

use glam::DVec3;
use isolith::flat::Body;
use isolith::scene::{Shape, ShapeKind};

use super::drawn::tube_distance;
use super::outlines::menger_distance;
use super::samples::{Random, evaluate};
use super::surfaces::{Patch, brute_distance, patches};

const README: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/shaders/README.md");
const MARKS: [&str; 2] = ["<!-- tightness:begin -->", "<!-- tightness:end -->"];
/// Points outside of each shape.
const POINTS: usize = 200;

/// The distance from outside by brute force.
fn truth(shape: &Shape, surface: &[Patch], p: DVec3) -> f64 {
    match *shape {
        Shape::MengerSponge { size, iterations } => {
            menger_distance(p, DVec3::ZERO, size, iterations.round() as i32, f64::INFINITY)
        }
        Shape::Julia { .. } | Shape::Kleinian { .. } => ray_distance(shape, p),
        Shape::Tube { .. } => tube_distance(shape, p),
        _ => brute_distance(surface, p),
    }
}

/// The distance along the best of many rays, which is turned ever less from there on. Not less than the distance.
fn ray_distance(shape: &Shape, p: DVec3) -> f64 {
    let body = Body::new(shape);
    let field = |p: DVec3| evaluate(&body, p.to_array());
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

/// The mean and the least of field over distance, at random points outside of the default shape within its size.
fn tightness(kind: ShapeKind) -> [f64; 2] {
    let shape = kind.default_shape();
    let (surface, body) = (patches(&shape), Body::new(&shape));
    let bounds = shape.bounds();
    let reach = if bounds.is_finite() { 1.2 * bounds.half().max_element() } else { 1.0 };
    let mut random = Random::new(17 + kind as u64);
    let (mut sum, mut least, mut count) = (0.0, f64::INFINITY, 0);
    while count < POINTS {
        let p = random.point(reach);
        let f = evaluate(&body, p.to_array());
        if f < 1e-3 {
            continue;
        }
        let d = truth(&shape, &surface, p);
        assert!(f <= d + 1e-6, "{kind:?} at {p}: the field is {f}, the distance {d}");
        (sum, least, count) = (sum + f / d, least.min(f / d), count + 1);
    }
    [sum / POINTS as f64, least]
}

#[test]
fn the_table_says_how_tight_fields_are() {
    let mut table = String::from("| field | mean of field / distance | least |\n|---|--:|--:|\n");
    for &kind in ShapeKind::ALL {
        let [mean, least] = tightness(kind);
        writeln!(table, "| {} | {mean:.3} | {least:.3} |", kind.label()).unwrap();
    }
    let text = std::fs::read_to_string(README).unwrap();
    let [begin, end] = MARKS.map(|mark| text.find(mark).expect("the marks of the table"));
    let (before, held) = (&text[..begin + MARKS[0].len()], &text[begin + MARKS[0].len()..end]);
    if std::env::var_os("ISOLITH_ACCEPT_TIGHTNESS").is_some() {
        std::fs::write(README, format!("{before}\n\n{table}\n{}", &text[end..])).unwrap();
    } else {
        assert!(held.trim() == table.trim(), "measured now:\n{table}");
    }
}
