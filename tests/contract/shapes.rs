//! The contract of every shape.

use glam::DVec3;
use isolith::field::PreparedShape;
use isolith::field::eval::{Dual, Real};
use isolith::scene::{Corners, Shape, ShapeKind};

use super::drawn::tube_distance;
use super::rules::{gradient_is_right, steps_are_safe};
use super::samples::{Random, evaluate, extreme, many, ordinary, size, special_points};
use super::surfaces::{brute_distance, inside, patches};

fn distance(shape: &Shape, p: DVec3) -> f64 {
    evaluate(&PreparedShape::new(shape), p.to_array())
}

fn with_gradient(shape: &Shape, p: DVec3) -> (f64, DVec3) {
    let coordinates = DVec3::AXES.map(|axis| Dual::coordinate(axis, 0.0, p));
    let Dual { v, d } = evaluate(&PreparedShape::new(shape), coordinates);
    (v, d)
}

/// Whether the field must equal the distance. It may be just a bound inside of self-intersecting tubes and rounded
/// notches, everywhere for terrains, heightmaps, oceans and models, and for extrusions and texts with a rounding.
fn is_exact_at(shape: &Shape, f: f64) -> bool {
    let meets_itself = match *shape {
        Shape::Terrain { .. } | Shape::Ocean { .. } | Shape::Heightmap { .. } | Shape::MeshField { .. } => {
            return false;
        }
        Shape::Extrusion { rounding, .. } | Shape::Text { rounding, .. } => return rounding == 0.0,
        Shape::Torus { major_radius, minor_radius } | Shape::Link { major_radius, minor_radius, .. } => {
            minor_radius > major_radius
        }
        Shape::PolygonRing { major_radius, minor_radius, .. } => 2.0 * minor_radius > major_radius,
        Shape::Star { rounding, .. } => rounding > 0.0,
        Shape::CappedTorus { .. } | Shape::HollowCutSphere { .. } | Shape::Tube { .. } => true,
        _ => false,
    };
    f >= 0.0 || !meets_itself
}

/// Returns the violation by the value `f` at `p`, if any.
fn check_distance(shape: &Shape, surface: &[super::surfaces::Patch], p: DVec3, f: f64) -> Result<(), String> {
    let is_inside = inside(shape, p);
    let d = match shape {
        Shape::Tube { .. } if !is_inside => tube_distance(shape, p),
        // Check the sign only, because a search over all balls takes minutes.
        // `every_ball_of_the_fields_radius_is_on_one_side` checks the depth.
        Shape::Tube { .. } => f.abs(),
        _ => brute_distance(surface, p),
    };
    let tolerance = 1e-6 * (1.0 + d);
    let fail = |what: &str| Err(format!("{shape:?} at {p}: {what}; the field is {f}, the distance {d}"));
    if f.abs() > tolerance && is_inside != (f < 0.0) {
        return fail("wrong sign");
    }
    if f.abs() > d + tolerance {
        return fail("no safe step");
    }
    // Where the rims of sheets change from tubes to balls, the search ends early, a few hundred-thousandths too far
    // away.
    let seams = if matches!(shape, Shape::Triangle { .. } | Shape::Quad { .. }) { 6e-5 } else { 0.0 };
    if is_exact_at(shape, f) && f.abs() < d - tolerance - seams {
        return fail("not the distance");
    }
    Ok(())
}

#[test]
fn distances_are_those_of_a_sampled_surface() {
    for &kind in ShapeKind::ALL {
        let mut random = Random::new(7 + kind as u64);
        for shape in ordinary(kind, 9) {
            let surface = patches(&shape);
            if surface.is_empty() {
                // A fractal, see `tightness`.
                continue;
            }
            let reach = 0.3 + size(&shape).min(2.5);
            for i in 0..24 {
                // Some points lie on planes of symmetry, where the nearest point is not unique.
                let mut p = random.point(reach);
                if i % 4 == 3 {
                    p[random.index(3)] = 0.0;
                }
                check_distance(&shape, &surface, p, distance(&shape, p)).unwrap();
            }
        }
    }
}

#[test]
fn a_wrong_distance_is_caught() {
    for &kind in ShapeKind::ALL {
        let shape = kind.default_shape();
        let surface = patches(&shape);
        if surface.is_empty() {
            continue;
        }
        let mut random = Random::new(3);
        let points: Vec<DVec3> = (0..12).map(|_| random.point(1.2)).collect();
        let any_caught = |wrong: &dyn Fn(f64) -> f64| {
            points.iter().any(|p| check_distance(&shape, &surface, *p, wrong(distance(&shape, *p))).is_err())
        };
        assert!(!any_caught(&|f| f), "{kind:?}");
        if is_exact_at(&shape, 1.0) {
            assert!(any_caught(&|f| f * 1.001), "{kind:?}");
            assert!(any_caught(&|f| f * 0.999), "{kind:?}");
            assert!(any_caught(&|f| f - 1e-4), "{kind:?}");
        }
        assert!(any_caught(&|f| -f), "{kind:?}");
    }
}

/// No step of the field's length crosses the surface.
#[test]
fn every_ball_of_the_fields_radius_is_on_one_side() {
    for &kind in ShapeKind::ALL {
        let mut random = Random::new(13 + kind as u64);
        for shape in ordinary(kind, 9) {
            let reach = 0.2 + 0.7 * size(&shape).min(2.5);
            for _ in 0..many(60) {
                let p = random.point(reach);
                let f = distance(&shape, p);
                if f.abs() < 1e-6 {
                    continue;
                }
                assert_eq!(inside(&shape, p), f < 0.0, "{shape:?} at {p}: {f}");
                for _ in 0..40 {
                    let q = p + random.direction() * (f.abs() * (1.0 - 1e-6) * random.range(0.5, 1.0));
                    assert_eq!(inside(&shape, q), f < 0.0, "{shape:?} at {p}: {f}, but at {q}");
                }
            }
        }
    }
}

#[test]
fn steps_are_safe_for_every_shape() {
    for &kind in ShapeKind::ALL {
        for shape in ordinary(kind, 30) {
            let reach = 0.1 + size(&shape);
            steps_are_safe(&|p| distance(&shape, p), DVec3::ZERO, reach, 2_000, 1e-12 * reach)
                .unwrap_or_else(|e| panic!("{shape:?}: {e}"));
        }
        for shape in extreme(kind, 60) {
            let reach = 1e-9 + size(&shape);
            for half in [1e-6 * reach, 1e-3 * reach, reach, 1e3 * reach] {
                steps_are_safe(&|p| distance(&shape, p), DVec3::ZERO, half, 200, 1e-12 * (reach + half))
                    .unwrap_or_else(|e| panic!("{shape:?}: {e}"));
            }
        }
    }
}

#[test]
fn every_value_and_gradient_is_finite() {
    for &kind in ShapeKind::ALL {
        for shape in ordinary(kind, many(10)).into_iter().chain(extreme(kind, many(100))) {
            for p in special_points(&shape) {
                let (f, gradient) = with_gradient(&shape, p);
                assert!(f.is_finite() && gradient.is_finite(), "{shape:?} at {p}: {f}, {gradient}");
                assert_eq!(f, distance(&shape, p), "{shape:?} at {p}");
            }
        }
    }
}

#[test]
fn gradients_are_those_of_central_differences() {
    for &kind in ShapeKind::ALL {
        let mut random = Random::new(11);
        for shape in ordinary(kind, 12) {
            let reach = 0.3 + size(&shape);
            let points: Vec<DVec3> = (0..100).map(|_| random.point(reach)).collect();
            gradient_is_right(&|p| with_gradient(&shape, p), points.into_iter(), 1e-5)
                .unwrap_or_else(|e| panic!("{shape:?}: {e}"));
        }
    }
}

#[test]
fn on_the_surface_of_a_sharp_shape_the_gradient_is_the_faces_normal() {
    let cube = Shape::Box { size: [1.0; 3], rounding: 0.0 };
    assert_eq!(with_gradient(&cube, DVec3::new(0.5, 0.1, 0.2)), (0.0, DVec3::X));
    let cylinder = Shape::Cylinder { radius: 0.5, height: 1.0, rounding: 0.0 };
    assert_eq!(with_gradient(&cylinder, DVec3::new(0.1, 0.5, 0.0)), (0.0, DVec3::Y));
    let prism = Shape::HexagonalPrism { radius: 0.5, height: 1.0 };
    assert_eq!(with_gradient(&prism, DVec3::new(0.5, 0.0, 0.1)).1, DVec3::X);
}

#[test]
fn bounds_enclose_every_shape() {
    for &kind in ShapeKind::ALL {
        let mut random = Random::new(5);
        for shape in ordinary(kind, 20) {
            let bounds = shape.bounds();
            let reach = 1.0 + 2.0 * size(&shape);
            for _ in 0..many(500) {
                let p = random.point(reach);
                let f = distance(&shape, p);
                assert!(bounds.contains(p) || f > 0.0, "{shape:?} at {p}: {f}");
                // An exact field is at least the distance to the bounds.
                assert!(bounds.contains(p) || f >= bounds.distance(p) - 1e-9 * reach, "{shape:?} at {p}: {f}");
            }
        }
    }
}

#[test]
fn a_shape_that_absorbs_a_scale_is_the_scaled_shape() {
    let mut random = Random::new(9);
    for &kind in ShapeKind::ALL {
        for shape in ordinary(kind, 10) {
            let (a, b) = (random.range(0.3, 3.0), random.range(0.3, 3.0));
            for scale in [DVec3::splat(a), DVec3::new(a, b, a), DVec3::new(a, b, 0.7)] {
                let Some(scaled) = shape.absorb_scale(scale) else { continue };
                for _ in 0..50 {
                    let p = random.point(2.0 + 2.0 * size(&shape));
                    let f = distance(&scaled, p);
                    if f.abs() > 1e-9 {
                        assert_eq!(f < 0.0, distance(&shape, p / scale) < 0.0, "{shape:?} by {scale} at {p}: {f}");
                    }
                }
            }
        }
    }
}

/// In a profile 1e9 m long, details at one end stay closed: all of them are within the rounding of the whole.
#[test]
fn details_of_a_huge_profile_are_closed() {
    let corners = Corners::new([[1.0, 1.0], [0.001, 1e-9], [1e9, 1e-30], [1.0, 1e-30], [1.0, 0.001]]);
    for smooth in [false, true] {
        let shape = Shape::Extrusion { corners: corners.clone(), smooth, depth: 0.001, rounding: 0.0 };
        for (x, y) in [(-977.95, 0.855), (-580.74, 0.47684), (-30.0, 0.001), (-2.0, 0.99)] {
            let f = distance(&shape, DVec3::new(x, y, 0.0));
            assert!((f + x).abs() < 1.5, "{smooth}: {f} at {x}, {y}");
        }
    }
}
