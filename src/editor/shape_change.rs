//! Changing a shape in place: the new shape fills the room of the old one.

use glam::DVec3;

use crate::scene::{ParamValue, Shape, ShapeKind};

/// A shape of the given kind that takes about the room of `from`. A shape without end gives no size:
/// then the kind's defaults.
pub fn changed(from: &Shape, kind: ShapeKind) -> Shape {
    let bounds = from.bounds();
    let half = bounds.half().max(DVec3::splat(1e-3));
    if from.kind() == kind || !bounds.is_finite() {
        return if from.kind() == kind { from.clone() } else { kind.default_shape() };
    }
    let mean = (half.x + half.y + half.z) / 3.0;
    let side = (half.x + half.z) * 0.5;
    // Of what stands along Y; something flat keeps more of its width than of its height.
    let upright = side.min(half.y.max(0.6 * side));
    let shape = match kind {
        ShapeKind::Sphere => Shape::Sphere { radius: mean },
        ShapeKind::Ellipsoid => Shape::Ellipsoid { radii: half.to_array() },
        ShapeKind::Box => Shape::Box { size: (half * 2.0).to_array(), rounding: 0.0 },
        ShapeKind::BoxFrame => Shape::BoxFrame { size: (half * 2.0).to_array(), thickness: 0.2 * half.min_element() },
        ShapeKind::Torus => {
            let minor_radius = half.y.min(side * 0.4);
            Shape::Torus { major_radius: side - minor_radius, minor_radius }
        }
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
            let radius = upright;
            let (center, reach) = (bounds.center(), DVec3::Y * (half.y - radius).max(0.0));
            Shape::Capsule { start: (center - reach).to_array(), end: (center + reach).to_array(), radius }
        }
        ShapeKind::Plane => Shape::Plane {},
        ShapeKind::HexagonalPrism => Shape::HexagonalPrism { radius: side, height: 2.0 * half.y },
        ShapeKind::Octahedron => Shape::Octahedron { radius: mean },
        ShapeKind::Tube | ShapeKind::Extrusion | ShapeKind::Revolution | ShapeKind::Terrain | ShapeKind::Ocean => {
            let shape = kind.default_shape();
            let factor = half.length() / shape.bounds().half().length();
            resized(shape, factor)
        }
    };
    rounded(shape)
}

/// The shape with all that is a length multiplied.
fn resized(mut shape: Shape, factor: f64) -> Shape {
    for (index, (value, param)) in shape.values().into_iter().zip(shape.kind().params()).enumerate() {
        if param.limits.unit != "m" {
            continue;
        }
        let value = match value {
            ParamValue::Scalar(v) => ParamValue::Scalar(v * factor),
            ParamValue::Vector(v) => ParamValue::Vector(v * factor),
            ParamValue::List(mut list) => {
                list.rows.iter_mut().flatten().for_each(|v| *v *= factor);
                ParamValue::List(list)
            }
            flag @ ParamValue::Flag(_) => flag,
        };
        shape.set_value(index, value);
    }
    shape
}

/// The shape with every number rounded to a micrometre, so that the inspector shows tidy values.
fn rounded(mut shape: Shape) -> Shape {
    use ParamValue::{Flag, List, Scalar, Vector};
    let tidy = |v: f64| (v * 1e6).round() / 1e6;
    for (index, value) in shape.values().into_iter().enumerate() {
        let value = match value {
            Scalar(v) => Scalar(tidy(v)),
            Vector(v) => Vector(v.map(tidy)),
            List(mut list) => {
                list.rows.iter_mut().flatten().for_each(|v| *v = tidy(*v));
                List(list)
            }
            Flag(v) => Flag(v),
        };
        shape.set_value(index, value);
    }
    shape
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{MaterialId, Node, NodeKind, Object, check};

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
                if old.bounds().is_finite() && new.bounds().is_finite() {
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
