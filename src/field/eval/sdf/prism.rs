//! Prisms along the Y axis.

use super::planar::{edge, extruded, polygon, sector, trapezoid};
use crate::eval::Real;
use isolith_scene::shape_params::{PrismParams, RhombusParams, StarParams, TriangularPrismParams};

/// A prism over an isosceles triangle.
pub fn sdf_triangular_prism<T: Real>(p: [T; 3], q: &TriangularPrismParams) -> T {
    extruded([trapezoid([p[0].abs(), p[2]], 0.5 * q.width, 0.0, q.depth), p[1].abs() - 0.5 * q.height])
}

/// A prism over a regular polygon with rounded edges.
pub fn sdf_prism<T: Real>(p: [T; 3], q: &PrismParams) -> T {
    let (sides, radius, half_height) = (q.sides, q.radius, 0.5 * q.height);
    let rounding = q.rounding.min(radius.min(half_height));
    let profile = polygon([p[0], p[2]], sides, radius - rounding);
    extruded([profile, p[1].abs() - (half_height - rounding)]) - rounding
}

/// A prism over a rhombus with rounded edges. The distance to a smaller rhombus, minus the rounding, gives the sides
/// of the whole.
pub fn sdf_rhombus<T: Real>(p: [T; 3], q: &RhombusParams) -> T {
    let (x, z, half_height) = (0.5 * q.width, 0.5 * q.depth, 0.5 * q.height);
    let inner_radius = x * z / x.hypot(z).max(1e-30);
    let rounding = q.rounding.min(inner_radius.min(half_height));
    let shrunk = 1.0 - rounding / inner_radius.max(1e-30);
    let profile = edge([p[0].abs(), p[2].abs()], [x * shrunk, 0.0], [0.0, z * shrunk]);
    extruded([profile, p[1].abs() - (half_height - rounding)]) - rounding
}

/// A prism over a star with rounded edges, by the smaller star within. Inside, the value is a lower bound where edges
/// are rounded.
pub fn sdf_star<T: Real>(p: [T; 3], q: &StarParams) -> T {
    let (points, outer, inner, half_height) = (q.points, q.outer_radius, q.inner_radius, 0.5 * q.height);
    let notch = [inner * points.cosine, inner * points.sine];
    let side = (notch[0] - outer).hypot(notch[1]);
    let inner_radius = outer * notch[1] / side.max(1e-30);
    let rounding = q.rounding.min(inner_radius.min(half_height));
    let shrunk = 1.0 - rounding / inner_radius.max(1e-30);
    let profile = edge(sector([p[0], p[2]], points), [outer * shrunk, 0.0], notch.map(|v| v * shrunk));
    extruded([profile, p[1].abs() - (half_height - rounding)]) - rounding
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::eval::sdf_hexagonal_prism;
    use isolith_scene::PolygonSides;
    use isolith_scene::shape_params::HexagonalPrismParams;

    #[test]
    fn a_prism_of_six_sides_is_a_hexagonal_prism() {
        let (sine, cosine) = (std::f64::consts::PI / 6.0).sin_cos();
        let sides = PolygonSides { count: 6.0, cosine, sine };
        for i in 0..200 {
            let t = f64::from(i);
            let p = [(t * 1.1).sin(), (t * 1.7).sin(), (t * 2.3).sin()];
            let prism = sdf_prism(p, &PrismParams { sides, radius: 0.4, height: 0.7, rounding: 0.0 });
            let hexagonal = sdf_hexagonal_prism(p, &HexagonalPrismParams { radius: 0.4, height: 0.7 });
            assert!((prism - hexagonal).abs() < 1e-12);
        }
    }
}
