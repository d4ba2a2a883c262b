//! A second, independent definition of each shape: the points inside, and the surface as patches over the unit square.
//! The patches give the distance by brute force.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec3;
use isolith::scene::Shape;

use super::{drawn, profiles};

/// A piece of a surface over (u, v) in the unit square; `None` at points inside the shape, which are not part of its
/// surface.
pub type Patch = Box<dyn Fn(f64, f64) -> Option<DVec3>>;

/// Whether the point is inside, by definition of the shape.
pub fn inside(shape: &Shape, p: DVec3) -> bool {
    let around_y = p.x.hypot(p.z);
    match *shape {
        Shape::Sphere { radius } => p.length() < radius,
        Shape::Ellipsoid { radii } => {
            DVec3::from(radii).min_element() > 0.0 && (p / DVec3::from(radii)).length_squared() < 1.0
        }
        Shape::Box { size, rounding } => {
            let half = DVec3::from(size) * 0.5;
            let rounding = rounding.min(half.min_element());
            let core = half - rounding;
            p.abs().cmplt(half).all() && (rounding == 0.0 || p.distance(p.clamp(-core, core)) < rounding)
        }
        Shape::BoxFrame { size, thickness } => bars(size.into(), thickness).iter().any(|b| b.holds(p)),
        Shape::Torus { major_radius, minor_radius } => (around_y - major_radius).hypot(p.y) < minor_radius,
        Shape::Cylinder { radius, height, rounding } => {
            let rounding = rounding.min(radius).min(height * 0.5);
            let (x, y) = (radius - rounding, height * 0.5 - rounding);
            let sharp = around_y < radius && p.y.abs() < height * 0.5;
            sharp && (rounding == 0.0 || (around_y - around_y.clamp(-x, x)).hypot(p.y - p.y.clamp(-y, y)) < rounding)
        }
        Shape::CappedCone { bottom_radius, top_radius, height } => {
            let t = p.y / height + 0.5;
            p.y.abs() < height * 0.5 && around_y < bottom_radius + (top_radius - bottom_radius) * t
        }
        Shape::RoundCone { bottom_radius, top_radius, height } => {
            let ends = [DVec3::Y * (-0.5 * height), DVec3::Y * (0.5 * height)];
            ball_between(ends, [bottom_radius, top_radius], p) < 0.0
        }
        Shape::Capsule { start, end, radius } => ball_between([start.into(), end.into()], [radius; 2], p) < 0.0,
        Shape::Plane {} => p.y < 0.0,
        Shape::HexagonalPrism { radius, height } => {
            let side = |k: f64| (p.x * (k * PI / 3.0).cos() + p.z * (k * PI / 3.0).sin()) < radius;
            p.y.abs() < height * 0.5 && (0..6).all(|k| side(f64::from(k)))
        }
        Shape::Octahedron { radius } => p.abs().element_sum() < radius,
        _ if shape.kind().has_data() => drawn::inside(shape, p),
        _ => profiles::inside(shape, p),
    }
}

/// The surface as patches.
pub fn patches(shape: &Shape) -> Vec<Patch> {
    match *shape {
        Shape::Sphere { radius } => vec![ball(DVec3::ZERO, DVec3::splat(radius), shape.clone())],
        Shape::Ellipsoid { radii } => vec![ball(DVec3::ZERO, radii.into(), shape.clone())],
        Shape::Box { size, rounding } => {
            let half = DVec3::from(size) * 0.5;
            let rounding = rounding.min(half.min_element());
            let core = half - rounding;
            let round = move |p: DVec3| {
                let inner = p.clamp(-core, core);
                inner + (p - inner).normalize_or_zero() * rounding
            };
            rectangles(Bar { low: -half, high: half }).into_iter().map(|f| mapped(f, round)).collect()
        }
        Shape::BoxFrame { size, thickness } => {
            let bars = bars(size.into(), thickness);
            let faces = bars.iter().flat_map(|b| rectangles(*b)).collect::<Vec<_>>();
            faces.into_iter().map(|f| outside_only(f, shape.clone())).collect()
        }
        Shape::Torus { major_radius, minor_radius } => vec![outside_only(
            Box::new(move |u, v| {
                let (s, c) = (TAU * v).sin_cos();
                Some(turned(major_radius + minor_radius * c, minor_radius * s, u))
            }),
            shape.clone(),
        )],
        Shape::Cylinder { radius, height, rounding } => {
            let rounding = rounding.min(radius).min(height * 0.5);
            let (x, y) = (radius - rounding, height * 0.5 - rounding);
            let round = move |p: DVec3| {
                let r = p.x.hypot(p.z);
                let inner = DVec3::new(p.x, 0.0, p.z) * (r.min(x) / r.max(1e-300)) + DVec3::Y * p.y.clamp(-y, y);
                inner + (p - inner).normalize_or_zero() * rounding
            };
            frustum(radius, radius, height).into_iter().map(|f| mapped(f, round)).collect()
        }
        Shape::CappedCone { bottom_radius, top_radius, height } => frustum(bottom_radius, top_radius, height),
        Shape::RoundCone { bottom_radius, top_radius, height } => round_cone(bottom_radius, top_radius, height),
        Shape::Capsule { start, end, radius } => {
            let (start, end) = (DVec3::from(start), DVec3::from(end));
            let (a, b) = (end - start).try_normalize().unwrap_or(DVec3::Y).any_orthonormal_pair();
            let side: Patch =
                Box::new(move |u, v| Some(start.lerp(end, v) + (a * (TAU * u).cos() + b * (TAU * u).sin()) * radius));
            vec![ball(start, DVec3::splat(radius), shape.clone()), ball(end, DVec3::splat(radius), shape.clone()), side]
        }
        Shape::Plane {} => vec![Box::new(|u, v| Some(DVec3::new(64.0 * u - 32.0, 0.0, 64.0 * v - 32.0)))],
        Shape::HexagonalPrism { radius, height } => hexagonal_prism(radius, height * 0.5),
        Shape::Octahedron { radius } => (0..8)
            .map(|i| {
                let sign = |bit: i32| if i & bit == 0 { radius } else { -radius };
                let corners = [DVec3::X * sign(1), DVec3::Y * sign(2), DVec3::Z * sign(4)];
                triangle(corners)
            })
            .collect(),
        _ if shape.kind().has_data() => drawn::patches(shape),
        _ => profiles::patches(shape),
    }
}

/// The distance from `p` to the nearest point of the patches: evaluates a grid on each patch, then refines the best few
/// points in ever smaller neighborhoods.
pub fn brute_distance(patches: &[Patch], p: DVec3) -> f64 {
    let measure = |patch: &Patch, [u, v]: [f64; 2]| patch(u, v).map_or(f64::INFINITY, |s| s.distance(p));
    let grid = (40.0 / (patches.len() as f64).sqrt()).clamp(6.0, 20.0) as usize;
    let mut starts: Vec<(f64, &Patch, [f64; 2])> = Vec::new();
    for patch in patches {
        // Use cell centers: at the border of a patch, many (u, v) can be one point.
        let middle = |k: usize| (k as f64 + 0.5) / grid as f64;
        let cells = (0..grid * grid).map(|k| [middle(k % grid), middle(k / grid)]);
        let mut best = cells.map(|uv| (measure(patch, uv), patch, uv)).collect::<Vec<_>>();
        best.select_nth_unstable_by(2, |a, b| a.0.total_cmp(&b.0));
        starts.extend_from_slice(&best[..3]);
    }
    starts.sort_by(|a, b| a.0.total_cmp(&b.0));
    // Patches without extent give the same point many times.
    starts.dedup_by(|a, b| (a.0 - b.0).abs() < 1e-12);
    let refined = starts.iter().take(24).map(|(_, patch, uv)| refine(&|uv| measure(patch, uv), *uv, 0.5 / grid as f64));
    refined.fold(f64::INFINITY, f64::min)
}

/// The minimum near `uv`. Restarts the search from its last result, because one search ends early in a narrow valley
/// across the parameters.
fn refine(measure: &dyn Fn([f64; 2]) -> f64, mut uv: [f64; 2], step: f64) -> f64 {
    let mut least = f64::INFINITY;
    for _ in 0..6 {
        let before = least;
        (least, uv) = refine_once(measure, uv, step);
        if before - least < 1e-9 {
            break;
        }
    }
    least
}

/// A pattern search: moves by `step` in sixteen directions, doubled after an improvement and halved without one.
fn refine_once(measure: &dyn Fn([f64; 2]) -> f64, mut uv: [f64; 2], longest: f64) -> (f64, [f64; 2]) {
    const MOVES: [[f64; 2]; 16] = [
        [1.0, 0.0],
        [-1.0, 0.0],
        [0.0, 1.0],
        [0.0, -1.0],
        [1.0, 1.0],
        [-1.0, -1.0],
        [1.0, -1.0],
        [-1.0, 1.0],
        [1.0, 0.3],
        [-1.0, -0.3],
        [1.0, -0.3],
        [-1.0, 0.3],
        [0.3, 1.0],
        [-0.3, -1.0],
        [0.3, -1.0],
        [-0.3, 1.0],
    ];
    let (mut least, mut step) = (measure(uv), longest);
    while step > 2e-8 {
        let moved = MOVES.iter().map(|m| [0, 1].map(|i| (uv[i] + m[i] * step).clamp(0.0, 1.0)));
        match moved.map(|next| (measure(next), next)).find(|(d, _)| *d < least) {
            Some((d, next)) => (least, uv, step) = (d, next, longest.min(2.0 * step)),
            None => step *= 0.5,
        }
    }
    (least, uv)
}

/// A cuboid.
#[derive(Clone, Copy)]
struct Bar {
    low: DVec3,
    high: DVec3,
}

impl Bar {
    fn holds(&self, p: DVec3) -> bool {
        p.cmpgt(self.low).all() && p.cmplt(self.high).all()
    }
}

/// The bars of a frame: along each axis, at the four corners of the other two axes.
fn bars(size: DVec3, thickness: f64) -> Vec<Bar> {
    let half = size * 0.5;
    let span = |axis: usize, upper: bool| {
        let width = thickness.min(size[axis]);
        // If two opposite bars meet, they fill the whole width without a gap.
        if thickness >= half[axis] {
            (-half[axis], half[axis])
        } else if upper {
            (half[axis] - width, half[axis])
        } else {
            (-half[axis], width - half[axis])
        }
    };
    let mut bars = Vec::new();
    for axis in 0..3 {
        for corner in 0..4 {
            let (mut low, mut high) = (-half, half);
            for (bit, other) in [(1, (axis + 1) % 3), (2, (axis + 2) % 3)] {
                (low[other], high[other]) = span(other, corner & bit != 0);
            }
            bars.push(Bar { low, high });
        }
    }
    bars
}

fn rectangles(bar: Bar) -> Vec<Patch> {
    let mut faces: Vec<Patch> = Vec::new();
    for axis in 0..3 {
        for end in [bar.low, bar.high] {
            faces.push(Box::new(move |u, v| {
                let mut p = DVec3::ZERO;
                p[axis] = end[axis];
                for (other, w) in [((axis + 1) % 3, u), ((axis + 2) % 3, v)] {
                    p[other] = bar.low[other] + (bar.high[other] - bar.low[other]) * w;
                }
                Some(p)
            }));
        }
    }
    faces
}

/// The two caps and the side of a frustum.
fn frustum(bottom: f64, top: f64, height: f64) -> Vec<Patch> {
    let half = height * 0.5;
    let ring = |from: [f64; 2], to: [f64; 2]| -> Patch {
        Box::new(move |u, v| Some(turned(from[0] + (to[0] - from[0]) * v, from[1] + (to[1] - from[1]) * v, u)))
    };
    vec![ring([0.0, -half], [bottom, -half]), ring([bottom, -half], [top, half]), ring([top, half], [0.0, half])]
}

/// Two balls, and the side tangent to both.
fn round_cone(bottom: f64, top: f64, height: f64) -> Vec<Patch> {
    let shape = Shape::RoundCone { bottom_radius: bottom, top_radius: top, height };
    let half = 0.5 * height;
    let mut patches = vec![
        ball(DVec3::Y * -half, DVec3::splat(bottom), shape.clone()),
        ball(DVec3::Y * half, DVec3::splat(top), shape),
    ];
    if (bottom - top).abs() < height {
        let tilt = ((bottom - top) / height).asin();
        let touch = move |r: f64, y: f64| (r * tilt.cos(), y + r * tilt.sin());
        let (low, high) = (touch(bottom, -half), touch(top, half));
        patches.push(Box::new(move |u, v| Some(turned(low.0 + (high.0 - low.0) * v, low.1 + (high.1 - low.1) * v, u))));
    }
    patches
}

fn hexagonal_prism(radius: f64, half: f64) -> Vec<Patch> {
    let corner = move |k: f64, y: f64| {
        let (s, c) = ((k + 0.5) * PI / 3.0).sin_cos();
        DVec3::new(c, 0.0, s) * (radius / (PI / 6.0).cos()) + DVec3::Y * y
    };
    let mut patches: Vec<Patch> = Vec::new();
    for k in 0..6 {
        let k = f64::from(k);
        patches.push(Box::new(move |u, v| {
            Some(corner(k, half * (2.0 * v - 1.0)).lerp(corner(k + 1.0, half * (2.0 * v - 1.0)), u))
        }));
        for y in [-half, half] {
            patches.push(triangle([DVec3::Y * y, corner(k, y), corner(k + 1.0, y)]));
        }
    }
    patches
}

pub fn triangle([a, b, c]: [DVec3; 3]) -> Patch {
    Box::new(move |u, v| Some(a.lerp(b, u).lerp(a.lerp(c, u), v)))
}

/// A ball with one radius per axis, without the parts inside `shape`.
pub fn ball(center: DVec3, radii: DVec3, shape: Shape) -> Patch {
    outside_only(sphere(center, radii), shape)
}

/// A ball with one radius per axis.
pub fn sphere(center: DVec3, radii: DVec3) -> Patch {
    Box::new(move |u, v| {
        let (s, c) = (PI * v - FRAC_PI_2).sin_cos();
        Some(center + turned(c, s, u) * radii)
    })
}

/// The point (radius, y), rotated about the Y axis by the fraction `u` of a full turn.
pub fn turned(radius: f64, y: f64, u: f64) -> DVec3 {
    let (s, c) = (TAU * u).sin_cos();
    DVec3::new(radius * c, y, radius * s)
}

/// The patch without the parts inside the shape.
pub fn outside_only(patch: Patch, shape: Shape) -> Patch {
    outside_of(patch, move |p| inside(&shape, p))
}

/// The patch without points whose small neighborhood is inside too, so that rounding does not tear holes.
pub fn outside_of(patch: Patch, holds: impl Fn(DVec3) -> bool + 'static) -> Patch {
    let e = 1e-7;
    let deep = move |p: DVec3| holds(p) && DVec3::AXES.iter().all(|a| holds(p + *a * e) && holds(p - *a * e));
    Box::new(move |u, v| patch(u, v).filter(|p| !deep(*p)))
}

pub fn mapped(patch: Patch, map: impl Fn(DVec3) -> DVec3 + 'static) -> Patch {
    Box::new(move |u, v| patch(u, v).map(&map))
}

/// The minimum of distance minus radius over the balls between two balls: a convex function of the position between
/// them, minimized by ternary search.
fn ball_between(centers: [DVec3; 2], radii: [f64; 2], p: DVec3) -> f64 {
    let at = |t: f64| p.distance(centers[0].lerp(centers[1], t)) - (radii[0] + (radii[1] - radii[0]) * t);
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..50 {
        let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if at(a) < at(b) { high = b } else { low = a }
    }
    at(0.5 * (low + high)).min(at(0.0)).min(at(1.0))
}
