//! Changes the kind of a shape in place: the new shape fills the bounds of the old one.

use glam::DVec3;

use isolith_geometry::Aabb;
use isolith_scene::{Degrees, ParamValue, Shape, ShapeKind, Sides};

/// A shape of the given kind with about the bounds of `from`. An unbounded shape gives no size:
/// the result has the kind's defaults.
pub fn changed(from: &Shape, kind: ShapeKind) -> Shape {
    let bounds = from.bounds();
    if from.kind() == kind || !bounds.is_finite() {
        return if from.kind() == kind { from.clone() } else { kind.default_shape() };
    }
    let half = bounds.half().max(DVec3::splat(1e-3));
    filling(kind, &Aabb::from_center_half(bounds.center(), half))
}

/// A shape of the given kind that fills finite bounds, as far as its kind allows.
pub fn filling(kind: ShapeKind, bounds: &Aabb) -> Shape {
    let room = Room::new(bounds, bounds.half());
    let other = || if kind.has_data() { room.drawn(kind) } else { kind.default_shape() };
    tidied(room.simple(kind).or_else(|| room.cut(kind)).unwrap_or_else(other))
}

/// The bounds of a shape and derived sizes of other shapes.
struct Room {
    center: DVec3,
    half: DVec3,
    /// Mean half size.
    mean: f64,
    /// Half size across the Y axis.
    side: f64,
    /// Half size of shapes that stand along Y; for flat bounds closer to their width than to their height.
    upright: f64,
}

impl Room {
    fn new(bounds: &Aabb, half: DVec3) -> Self {
        let side = (half.x + half.z) * 0.5;
        let mean = (half.x + half.y + half.z) / 3.0;
        Self { center: bounds.center(), half, mean, side, upright: side.min(half.y.max(0.6 * side)) }
    }

    /// Balls, boxes, rings, cylinders.
    fn simple(&self, kind: ShapeKind) -> Option<Shape> {
        let Self { half, mean, side, upright, .. } = *self;
        let minor_radius = half.y.min(side * 0.4);
        let major_radius = side - minor_radius;
        Some(match kind {
            ShapeKind::Sphere => Shape::Sphere { radius: mean },
            ShapeKind::Ellipsoid => Shape::Ellipsoid { radii: half.to_array() },
            ShapeKind::Box => Shape::Box { size: (half * 2.0).to_array(), rounding: 0.0 },
            ShapeKind::BoxFrame => {
                Shape::BoxFrame { size: (half * 2.0).to_array(), thickness: 0.2 * half.min_element() }
            }
            ShapeKind::Torus => Shape::Torus { major_radius, minor_radius },
            ShapeKind::CappedTorus => Shape::CappedTorus { major_radius, minor_radius, half_angle: Degrees(120.0) },
            ShapeKind::Link => {
                let minor_radius = half.y.min(half.z * 0.3);
                let length = 2.0 * (half.x - half.z).max(0.0);
                Shape::Link { length, major_radius: half.z - minor_radius, minor_radius }
            }
            ShapeKind::PolygonRing => Shape::PolygonRing { sides: Sides(6.0), major_radius, minor_radius },
            ShapeKind::Cylinder => Shape::Cylinder { radius: side, height: 2.0 * half.y, rounding: 0.0 },
            ShapeKind::CappedCone => {
                Shape::CappedCone { bottom_radius: side, top_radius: 0.4 * side, height: 2.0 * half.y }
            }
            ShapeKind::RoundCone => {
                let bottom_radius = upright;
                let top_radius = 0.5 * bottom_radius;
                let height = (2.0 * half.y - bottom_radius - top_radius).max(0.0);
                Shape::RoundCone { bottom_radius, top_radius, height }
            }
            ShapeKind::Capsule => {
                let (center, reach) = (self.center, DVec3::Y * (half.y - upright).max(0.0));
                Shape::Capsule { start: (center - reach).to_array(), end: (center + reach).to_array(), radius: upright }
            }
            ShapeKind::MengerSponge => Shape::MengerSponge { size: 2.0 * mean, iterations: 3.0 },
            ShapeKind::Mandelbulb | ShapeKind::Julia | ShapeKind::Kleinian => {
                let mut shape = kind.default_shape();
                shape.set_value(0, ParamValue::Scalar(1.2 * mean));
                shape
            }
            ShapeKind::InfiniteCylinder => Shape::InfiniteCylinder { radius: side },
            ShapeKind::HexagonalPrism => Shape::HexagonalPrism { radius: side, height: 2.0 * half.y },
            ShapeKind::Octahedron => Shape::Octahedron { radius: mean },
            _ => return None,
        })
    }

    /// Prisms, parts of balls, sheets.
    fn cut(&self, kind: ShapeKind) -> Option<Shape> {
        let Self { half, mean, side, upright, .. } = *self;
        let [width, height, depth] = (half * 2.0).to_array();
        Some(match kind {
            ShapeKind::TriangularPrism => Shape::TriangularPrism { width, depth, height },
            ShapeKind::Prism => Shape::Prism { sides: Sides(5.0), radius: side, height, rounding: 0.0 },
            ShapeKind::Pyramid => Shape::Pyramid { width: 2.0 * side, height },
            ShapeKind::Rhombus => Shape::Rhombus { width, depth, height, rounding: 0.0 },
            ShapeKind::Star => {
                Shape::Star { points: Sides(5.0), outer_radius: side, inner_radius: 0.45 * side, height, rounding: 0.0 }
            }
            ShapeKind::CutSphere => Shape::CutSphere { radius: mean, cut: -0.2 * mean },
            ShapeKind::HollowCutSphere => {
                Shape::HollowCutSphere { radius: 0.92 * mean, cut: 0.3 * mean, thickness: 0.16 * mean }
            }
            ShapeKind::DeathStar => Shape::DeathStar { radius: mean, cut_radius: 0.75 * mean, distance: 1.15 * mean },
            ShapeKind::SolidAngle => Shape::SolidAngle { radius: 1.5 * mean, half_angle: Degrees(40.0) },
            ShapeKind::Vesica => Shape::Vesica { height: 2.0 * half.y.max(side), width: 2.0 * upright },
            ShapeKind::Triangle => Shape::Triangle { width, depth, skew: 0.0, thickness: 0.1 * side },
            ShapeKind::Quad => Shape::Quad { width, depth, skew: 0.0, thickness: 0.1 * side },
            _ => return None,
        })
    }

    /// Shapes with points and heightfields: the defaults, scaled.
    fn drawn(&self, kind: ShapeKind) -> Shape {
        let shape = kind.default_shape();
        let factor = self.half.length() / shape.bounds().half().length();
        shape.with_lengths_times(factor)
    }
}

/// Rounds every number to a micrometer, for tidy values in the inspector.
pub fn tidied(mut shape: Shape) -> Shape {
    use ParamValue::{List, Scalar, Vector};
    let tidy = |v: f64| (v * 1e6).round() / 1e6;
    for (index, value) in shape.values().into_iter().enumerate() {
        let value = match value {
            Scalar(v) => Scalar(tidy(v)),
            Vector(v) => Vector(v.map(tidy)),
            List(mut list) => {
                list.rows.iter_mut().flatten().for_each(|v| *v = tidy(*v));
                List(list)
            }
            other => other,
        };
        shape.set_value(index, value);
    }
    shape
}

#[cfg(test)]
mod tests {
    use super::*;
    use isolith_scene::{MaterialId, Node, NodeKind, Object, check};

    #[test]
    fn every_change_keeps_about_the_size_and_every_value_is_allowed() {
        for &from in ShapeKind::ALL {
            for &to in ShapeKind::ALL {
                let old = from.default_shape();
                let new = changed(&old, to);
                assert_eq!(new.kind(), to);
                let object = Object { shape: new.clone(), material: MaterialId(1) };
                let checked = check::node(&Node::new("x", NodeKind::Object(object)));
                assert_eq!(checked, Ok(()), "{from:?} to {to:?}");
                // A model has a size of its own.
                let has_own_size = [from, to].contains(&ShapeKind::MeshField);
                if old.bounds().is_finite() && new.bounds().is_finite() && !has_own_size {
                    let ratio = new.bounds().half().length() / old.bounds().half().length();
                    assert!((0.4..=1.6).contains(&ratio), "{from:?} to {to:?}: {ratio}");
                }
            }
        }
    }

    #[test]
    fn a_box_becomes_the_ball_inside_it_and_comes_back() {
        let cube = Shape::Box { size: [2.0; 3], rounding: 0.1 };
        assert_eq!(changed(&cube, ShapeKind::Sphere), Shape::Sphere { radius: 1.0 });
        assert_eq!(
            changed(&Shape::Sphere { radius: 1.0 }, ShapeKind::Box),
            Shape::Box { size: [2.0; 3], rounding: 0.0 }
        );
        assert_eq!(changed(&cube, ShapeKind::Box), cube, "the same kind changes nothing");
    }
}
