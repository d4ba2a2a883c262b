//! Like `surfaces`, for solids of revolution about the Y axis, polygons extruded along it, tubes and sheets.

use std::f64::consts::{PI, TAU};

use glam::{DQuat, DVec2, DVec3};
use isolith::scene::Shape;

use super::surfaces::{Patch, ball, mapped, outside_only, triangle, turned};

/// Whether the point is inside, by definition of the shape.
pub fn inside(shape: &Shape, p: DVec3) -> bool {
    let (around, flat) = (p.x.hypot(p.z), DVec2::new(p.x, p.z));
    match *shape {
        Shape::CappedTorus { major_radius, minor_radius, half_angle } => {
            let (s, c) = p.z.abs().atan2(p.x).min(half_angle.0.to_radians()).sin_cos();
            p.distance(DVec3::new(c, 0.0, s.copysign(p.z)) * major_radius) < minor_radius
        }
        Shape::Link { length, major_radius, minor_radius } => {
            let bend = flat - DVec2::X * p.x.clamp(-0.5 * length, 0.5 * length);
            (bend.length() - major_radius).hypot(p.y) < minor_radius
        }
        Shape::PolygonRing { sides, major_radius, minor_radius } => {
            let holds = |x: f64| {
                let side = |k: u32| 2.0 * sides.half_angle() * f64::from(k);
                (0..64).all(|k| (x - major_radius) * side(k).cos() + p.y * side(k).sin() < minor_radius)
            };
            holds(around) || holds(-around)
        }
        Shape::Cone { half_angle } => p.y < 0.0 && around < -p.y * half_angle.0.to_radians().tan(),
        Shape::InfiniteCylinder { radius } => around < radius,
        Shape::Pyramid { width, height } => {
            p.y.abs() < 0.5 * height && p.x.abs().max(p.z.abs()) < 0.5 * width * (0.5 - p.y / height)
        }
        Shape::CutSphere { radius, cut } => p.length() < radius && p.y > cut,
        Shape::HollowCutSphere { radius, cut, thickness } => {
            let (s, c) = around.atan2(-p.y).min(bowl_angle(radius, cut)).sin_cos();
            (around - radius * s).hypot(p.y + radius * c) < 0.5 * thickness
        }
        Shape::DeathStar { radius, cut_radius, distance } => {
            p.length() < radius && p.distance(DVec3::Y * distance) > cut_radius.min(radius + distance)
        }
        Shape::SolidAngle { radius, half_angle } => {
            p.length() < radius && around.atan2(p.y) < half_angle.0.to_radians()
        }
        Shape::Vesica { height, width } => {
            let (center, radius) = arc(height, width);
            width.min(height) > 0.0 && (around - center).hypot(p.y) < radius
        }
        Shape::MengerSponge { .. } | Shape::Julia { .. } | Shape::Kleinian { .. } | Shape::Mandelbulb { .. } => {
            inside_fractal(shape, p)
        }
        Shape::Triangle { thickness, .. } | Shape::Quad { thickness, .. } => {
            let near = nearest(&corners(shape, 1.0), flat);
            (near - flat).length().hypot(p.y) < 0.5 * thickness
        }
        _ => {
            let Drawn { shrunk, half, rounding } = drawn(shape);
            let core = corners(shape, shrunk);
            if rounding == 0.0 {
                return p.y.abs() < half && holds(&core, flat);
            }
            let y = half - rounding;
            (nearest(&core, flat) - flat).length().hypot(p.y - p.y.clamp(-y, y)) < rounding
        }
    }
}

fn inside_fractal(shape: &Shape, p: DVec3) -> bool {
    match *shape {
        Shape::MengerSponge { size, iterations } => {
            let is_hole = |step: i32| {
                let side = size / 3_f64.powi(step);
                let middle = |c: f64| (c - side * (c / side).round()).abs() < side / 6.0;
                p.to_array().into_iter().filter(|c| middle(*c)).count() > 1
            };
            p.abs().max_element() < 0.5 * size && !(0..iterations.round() as i32).any(is_hole)
        }
        Shape::Julia { radius, constant: [a, b, c], fourth, iterations } => {
            let constant = DQuat::from_xyzw(b, c, fourth, a);
            let escape = (1.0 + (1.0 + 4.0 * constant.length()).sqrt()) * 0.5;
            let p = p * (escape / radius);
            let mut z = DQuat::from_xyzw(p.y, p.z, 0.0, p.x);
            for _ in 0..iterations.round() as i32 {
                if z.length() >= escape {
                    return false;
                }
                z = z * z + constant;
            }
            z.length() < escape
        }
        Shape::Kleinian { radius, reach, fold, inversion, thickness, iterations } => {
            let mut z = p * (reach / radius);
            for _ in 0..iterations.round() as i32 {
                z = z.clamp(-DVec3::from(fold), fold.into()) * 2.0 - z;
                z *= (inversion / z.length_squared().max(1e-30)).max(1.0);
            }
            let around = z.x.hypot(z.z);
            let disc = (around * z.y / z.length().max(1e-30)).abs().max(around - 0.92);
            p.length() < radius && disc < thickness
        }
        Shape::Mandelbulb { radius, power, iterations } => {
            let n = power.round();
            let escape = 2_f64.powf(1.0 / (n - 1.0));
            let c = p * (escape / radius);
            let mut z = c;
            for _ in 0..iterations.round() as i32 {
                if z.length() >= escape {
                    return false;
                }
                let (from_axis, around) = (n * z.x.hypot(z.z).atan2(z.y), n * z.z.atan2(z.x));
                let direction =
                    DVec3::new(around.cos() * from_axis.sin(), from_axis.cos(), around.sin() * from_axis.sin());
                z = direction * z.length().powf(n) + c;
            }
            z.length() < escape
        }
        _ => panic!("{shape:?} is no fractal"),
    }
}

/// The distance from outside to a Menger sponge: to the nearest of its smallest cubes, without the cubes farther away
/// than the best so far.
pub fn menger_distance(p: DVec3, center: DVec3, size: f64, iterations: i32, best: f64) -> f64 {
    let to_cube = ((p - center).abs() - 0.5 * size).max(DVec3::ZERO).length();
    if iterations == 0 || to_cube >= best {
        return to_cube.min(best);
    }
    let step = |k: i32| f64::from(k % 3 - 1);
    let cells = (0..27).map(|k| DVec3::new(step(k), step(k / 3), step(k / 9)));
    let mut kept: Vec<DVec3> =
        cells.filter(|c| c.abs().element_sum() > 1.5).map(|c| center + c * (size / 3.0)).collect();
    kept.sort_by(|a, b| a.distance(p).total_cmp(&b.distance(p)));
    kept.into_iter().fold(best, |best, cell| menger_distance(p, cell, size / 3.0, iterations - 1, best))
}

/// The surface as patches; empty for fractals.
pub fn patches(shape: &Shape) -> Vec<Patch> {
    match *shape {
        Shape::MengerSponge { .. } | Shape::Julia { .. } | Shape::Kleinian { .. } | Shape::Mandelbulb { .. } => vec![],
        Shape::CappedTorus { .. } | Shape::Link { .. } => tubes(shape),
        Shape::Triangle { thickness, .. } | Shape::Quad { thickness, .. } => sheet(shape, 0.5 * thickness),
        Shape::Pyramid { width, height } => {
            let (w, y) = (0.5 * width, 0.5 * height);
            let at = |k: usize| DVec3::new([w, -w, -w, w][k % 4], -y, [w, w, -w, -w][k % 4]);
            let faces = (0..4).flat_map(|k| [DVec3::Y, DVec3::NEG_Y].map(|t| triangle([t * y, at(k), at(k + 1)])));
            faces.collect()
        }
        Shape::Prism { .. } | Shape::Rhombus { .. } | Shape::Star { .. } | Shape::TriangularPrism { .. } => {
            prism(shape)
        }
        _ => curves(shape)
            .into_iter()
            .map(|curve| {
                let patch: Patch = Box::new(move |u, v| {
                    let at = curve(v);
                    Some(turned(at.x, at.y, u))
                });
                outside_only(patch, shape.clone())
            })
            .collect(),
    }
}

type Curve = Box<dyn Fn(f64) -> DVec2>;

/// The profiles of the solids of revolution, over 0 to 1: distance from the axis, height. Pieces may lie inside.
fn curves(shape: &Shape) -> Vec<Curve> {
    // An arc; angles from +Y, in radians.
    let circle = |center: DVec2, radius: f64, from: f64, to: f64| -> Curve {
        Box::new(move |t| {
            let (s, c) = (from + (to - from) * t).sin_cos();
            center + radius * DVec2::new(s, c)
        })
    };
    let line = |from: DVec2, to: DVec2| -> Curve { Box::new(move |t| from.lerp(to, t)) };
    match *shape {
        Shape::PolygonRing { sides, major_radius, minor_radius } => {
            let corner = move |k: u32| {
                let angle = sides.half_angle() * f64::from(2 * k + 1);
                DVec2::X * major_radius + DVec2::from_angle(angle) * (minor_radius / sides.half_angle().cos())
            };
            (0..sides.0.round() as u32).map(|k| line(corner(k), corner(k + 1))).collect()
        }
        // Finer sampling near the tip.
        Shape::Cone { half_angle } => {
            let (s, c) = half_angle.0.to_radians().sin_cos();
            vec![Box::new(move |t| DVec2::new(s, -c) * (64.0 * t * t))]
        }
        Shape::InfiniteCylinder { radius } => vec![line(DVec2::new(radius, -32.0), DVec2::new(radius, 32.0))],
        Shape::CutSphere { radius, cut } => {
            let angle = PI - bowl_angle(radius, cut);
            let rim = DVec2::new(angle.sin(), angle.cos()) * radius;
            vec![circle(DVec2::ZERO, radius, 0.0, angle), line(DVec2::Y * rim.y, rim)]
        }
        Shape::HollowCutSphere { radius, cut, thickness } => {
            let (angle, half) = (PI - bowl_angle(radius, cut), 0.5 * thickness);
            let skin = [-half, half].map(|by| circle(DVec2::ZERO, radius + by, angle, PI));
            let rim = DVec2::new(angle.sin(), angle.cos()) * radius;
            skin.into_iter().chain([circle(rim, half, 0.0, TAU)]).collect()
        }
        Shape::DeathStar { radius, cut_radius, distance } => {
            let cut_radius = cut_radius.min(radius + distance);
            let height =
                (radius * radius - cut_radius * cut_radius + distance * distance) / (2.0 * distance).max(1e-30);
            let angle = if radius > 0.0 { (height / radius).clamp(-1.0, 1.0).acos() } else { 0.0 };
            let meets = DVec2::new(angle.sin(), angle.cos()) * radius - DVec2::Y * distance;
            // If the balls do not intersect, the whole inner one is hollow.
            let hollow = if distance + cut_radius < radius { 0.0 } else { meets.x.atan2(meets.y) };
            let mut all = vec![circle(DVec2::ZERO, radius, angle, PI)];
            if distance < radius + cut_radius {
                all.push(circle(DVec2::Y * distance, cut_radius, hollow, PI));
            }
            all
        }
        Shape::SolidAngle { radius, half_angle } => {
            let angle = half_angle.0.to_radians();
            let end = DVec2::new(angle.sin(), angle.cos()) * radius;
            vec![circle(DVec2::ZERO, radius, 0.0, angle), line(DVec2::ZERO, end)]
        }
        Shape::Vesica { height, width } if width.min(height) > 0.0 => {
            let (center, radius) = arc(height, width);
            let angle = (0.5 * height / radius).min(1.0).asin();
            vec![circle(DVec2::X * center, radius, 0.5 * PI - angle, 0.5 * PI + angle)]
        }
        Shape::Vesica { height, .. } => vec![line(DVec2::Y * (-0.5 * height), DVec2::Y * (0.5 * height))],
        _ => panic!("{shape:?} is no body of revolution"),
    }
}

/// The angle between −Y and the rim of a cut ball.
fn bowl_angle(radius: f64, cut: f64) -> f64 {
    if radius == 0.0 { 0.5 * PI } else { (-cut / radius).clamp(-1.0, 1.0).acos() }
}

/// The X coordinate of the center of a spindle's arc, and the arc's radius.
fn arc(height: f64, width: f64) -> (f64, f64) {
    let (b, a) = (0.5 * height, 0.5 * width.min(height));
    ((a * a - b * b) / (2.0 * a), (a * a + b * b) / (2.0 * a))
}

/// The tubes of rings, with their round ends.
fn tubes(shape: &Shape) -> Vec<Patch> {
    // A tube around a curve in the XZ plane; the curve returns a point and the unit direction across it.
    let tube = |radius: f64, curve: Box<dyn Fn(f64) -> (DVec2, DVec2)>| -> Patch {
        Box::new(move |u, v| {
            let (at, across) = curve(u);
            let (s, c) = (TAU * v).sin_cos();
            let flat = at + across * (radius * c);
            Some(DVec3::new(flat.x, radius * s, flat.y))
        })
    };
    let patches = match *shape {
        Shape::CappedTorus { major_radius, minor_radius, half_angle } => {
            let angle = half_angle.0.to_radians();
            let end = |sign: f64| {
                let (s, c) = (sign * angle).sin_cos();
                ball(DVec3::new(c, 0.0, s) * major_radius, DVec3::splat(minor_radius), shape.clone())
            };
            let ring = move |u: f64| {
                let across = DVec2::from_angle(angle * (2.0 * u - 1.0));
                (across * major_radius, across)
            };
            vec![end(-1.0), end(1.0), tube(minor_radius, Box::new(ring))]
        }
        Shape::Link { length, major_radius, minor_radius } => {
            let bend = |side: f64| {
                move |u: f64| {
                    let across = DVec2::from_angle(PI * (u - 0.5)) * side;
                    (across * major_radius + DVec2::X * (0.5 * length * side), across)
                }
            };
            let bar = |side: f64| move |u: f64| (DVec2::new(length * (u - 0.5), side * major_radius), DVec2::Y);
            let radius = minor_radius;
            vec![
                tube(radius, Box::new(bend(1.0))),
                tube(radius, Box::new(bend(-1.0))),
                tube(radius, Box::new(bar(1.0))),
                tube(radius, Box::new(bar(-1.0))),
            ]
        }
        _ => panic!("{shape:?} is no tube"),
    };
    patches.into_iter().map(|patch| outside_only(patch, shape.clone())).collect()
}

/// Both faces of a sheet, its rounded edges, the balls at its corners.
fn sheet(shape: &Shape, radius: f64) -> Vec<Patch> {
    let points = corners(shape, 1.0);
    let at = |k: usize| DVec3::new(points[k % points.len()].x, 0.0, points[k % points.len()].y);
    let mut patches = Vec::new();
    for k in 0..points.len() {
        for y in [-radius, radius] {
            patches.push(triangle([at(0), at(k), at(k + 1)].map(|p| p + DVec3::Y * y)));
        }
        let (from, to) = (at(k), at(k + 1));
        let across = (to - from).cross(DVec3::Y).try_normalize().unwrap_or(DVec3::X);
        patches.push(Box::new(move |u, v| {
            let (s, c) = (TAU * v).sin_cos();
            Some(from.lerp(to, u) + (across * c + DVec3::Y * s) * radius)
        }));
        patches.push(ball(from, DVec3::splat(radius), shape.clone()));
    }
    patches.into_iter().map(|patch| outside_only(patch, shape.clone())).collect()
}

/// Rounding of a prism: all points within a distance of a smaller prism.
struct Drawn {
    shrunk: f64,
    half: f64,
    rounding: f64,
}

fn drawn(shape: &Shape) -> Drawn {
    let (height, rounding) = match *shape {
        Shape::Prism { height, rounding, .. }
        | Shape::Rhombus { height, rounding, .. }
        | Shape::Star { height, rounding, .. } => (height, rounding),
        Shape::TriangularPrism { height, .. } => (height, 0.0),
        _ => panic!("{shape:?} is no prism"),
    };
    // Distance from the axis to the line through the first side.
    let outer = corners(shape, 1.0);
    let side = outer[1] - outer[0];
    let inner = if side.length() > 0.0 { outer[0].perp_dot(side).abs() / side.length() } else { 0.0 };
    let rounding = rounding.min(inner).min(0.5 * height);
    Drawn { shrunk: if rounding > 0.0 { 1.0 - rounding / inner } else { 1.0 }, half: 0.5 * height, rounding }
}

fn prism(shape: &Shape) -> Vec<Patch> {
    let Drawn { shrunk, half, rounding } = drawn(shape);
    let (outer, core) = (corners(shape, 1.0), corners(shape, shrunk));
    let mut patches: Vec<Patch> = Vec::new();
    for k in 0..outer.len() {
        let (a, b) = (outer[k], outer[(k + 1) % outer.len()]);
        let at = |p: DVec2, y: f64| DVec3::new(p.x, y, p.y);
        let (low, high) = ([at(a, -half), at(b, -half)], [at(a, half), at(b, half)]);
        patches.push(Box::new(move |u, v| Some(low[0].lerp(low[1], u).lerp(high[0].lerp(high[1], u), v))));
        for [a, b] in [low, high] {
            patches.push(triangle([DVec3::Y * a.y, a, b]));
        }
    }
    if rounding == 0.0 {
        return patches;
    }
    let y = half - rounding;
    let round = move |core: &[DVec2], p: DVec3| {
        let near = nearest(core, DVec2::new(p.x, p.z));
        let near = DVec3::new(near.x, p.y.clamp(-y, y), near.y);
        near + (p - near).normalize_or_zero() * rounding
    };
    let shared = std::rc::Rc::new(core);
    let rounded = |patch| {
        let core = shared.clone();
        mapped(patch, move |p| round(&core, p))
    };
    patches.into_iter().map(rounded).collect()
}

/// The scaled corners of the polygon in the XZ plane that defines a prism or a sheet.
fn corners(shape: &Shape, scale: f64) -> Vec<DVec2> {
    let of = |points: &[[f64; 2]]| points.iter().map(|p| DVec2::from(*p) * scale).collect();
    match *shape {
        Shape::Prism { sides, radius, .. } => {
            let corner = |k: u32| DVec2::from_angle(sides.half_angle() * f64::from(2 * k + 1));
            let far = radius / sides.half_angle().cos() * scale;
            (0..sides.0.round() as u32).map(|k| corner(k) * far).collect()
        }
        Shape::Star { points, outer_radius, inner_radius, .. } => {
            let corner = |k: u32| {
                let far = if k.is_multiple_of(2) { outer_radius } else { inner_radius };
                DVec2::from_angle(points.half_angle() * f64::from(k)) * far * scale
            };
            (0..2 * points.0.round() as u32).map(corner).collect()
        }
        Shape::Rhombus { width: w, depth: d, .. } => {
            of(&[[0.5 * w, 0.0], [0.0, 0.5 * d], [-0.5 * w, 0.0], [0.0, -0.5 * d]])
        }
        Shape::TriangularPrism { width: w, depth: d, .. } => {
            of(&[[-0.5 * w, -0.5 * d], [0.5 * w, -0.5 * d], [0.0, 0.5 * d]])
        }
        Shape::Triangle { width: w, depth: d, skew, .. } => {
            of(&[[-0.5 * w, -0.5 * d], [0.5 * w, -0.5 * d], [skew, 0.5 * d]])
        }
        Shape::Quad { width: w, depth: d, skew, .. } => {
            let [left, right] = [-w, w].map(|w| 0.5 * w);
            let by = 0.5 * skew;
            of(&[[left - by, -0.5 * d], [right - by, -0.5 * d], [right + by, 0.5 * d], [left + by, 0.5 * d]])
        }
        _ => panic!("{shape:?} is made from no polygon"),
    }
}

/// Whether the polygon contains the point: a ray from it crosses an odd number of sides.
fn holds(corners: &[DVec2], q: DVec2) -> bool {
    let sides = corners.iter().zip(corners.iter().cycle().skip(1));
    let crossed =
        sides.filter(|(a, b)| (a.y > q.y) != (b.y > q.y) && q.x < a.x + (q.y - a.y) / (b.y - a.y) * (b.x - a.x));
    crossed.count() % 2 == 1
}

/// The point of the polygon nearest to `q`.
fn nearest(corners: &[DVec2], q: DVec2) -> DVec2 {
    if holds(corners, q) {
        return q;
    }
    let on_side = |(a, b): (&DVec2, &DVec2)| {
        let along = (*b - *a).normalize_or_zero();
        *a + along * (q - *a).dot(along).clamp(0.0, a.distance(*b))
    };
    let sides = corners.iter().zip(corners.iter().cycle().skip(1)).map(on_side);
    sides.min_by(|a, b| a.distance(q).total_cmp(&b.distance(q))).expect("a polygon has sides")
}
