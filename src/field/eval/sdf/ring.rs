//! Rings.

use super::planar::{length2, length3, polygon};
use crate::eval::Real;
use isolith_scene::SineCosine;
use isolith_scene::shape_params::{CappedTorusParams, LinkParams, PolygonRingParams};

/// An arc of a ring. Inside, the value is a lower bound where the tube meets itself.
///
/// In the plane of the ring the nearest point of the arc lies in the point's direction from the center, or is an end
/// of the arc (idea: Quilez, "distance functions").
pub fn sdf_capped_torus<T: Real>(p: [T; 3], q: &CappedTorusParams) -> T {
    let CappedTorusParams { major_radius, minor_radius, half_angle: SineCosine { sine, cosine } } = *q;
    let at = [p[0], p[2].abs()];
    let within = (at[0] * sine - at[1] * cosine).value() > 0.0;
    let to_arc = if within {
        length2([length2(at) - major_radius, p[1]])
    } else {
        length3([at[0] - major_radius * cosine, at[1] - major_radius * sine, p[1]])
    };
    to_arc - minor_radius
}

/// A link of a chain. Inside, the value is a lower bound where the tube meets itself.
pub fn sdf_link<T: Real>(p: [T; 3], q: &LinkParams) -> T {
    let bend = (p[0].abs() - 0.5 * q.length).positive();
    length2([length2([bend, p[2]]) - q.major_radius, p[1]]) - q.minor_radius
}

/// A ring with a polygonal section. Where the polygon reaches across the axis, the polygon of the other side counts
/// too, and the value inside is a lower bound.
pub fn sdf_polygon_ring<T: Real>(p: [T; 3], q: &PolygonRingParams) -> T {
    let PolygonRingParams { sides, major_radius, minor_radius } = *q;
    let around = length2([p[0], p[2]]);
    let near = polygon([around - major_radius, p[1]], sides, minor_radius);
    near.min(polygon([-around - major_radius, p[1]], sides, minor_radius))
}
