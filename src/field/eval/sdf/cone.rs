//! Shapes that narrow to a tip or are infinite.

use super::planar::{length2, length3, trapezoid};
use crate::eval::Real;
use isolith_scene::SineCosine;
use isolith_scene::shape_params::{ConeParams, InfiniteCylinderParams, PyramidParams};

/// An infinite cone that opens downward from its tip.
pub fn sdf_cone<T: Real>(p: [T; 3], q: &ConeParams) -> T {
    let SineCosine { sine, cosine } = q.half_angle;
    let at = [length2([p[0], p[2]]), p[1]];
    let along = at[0] * sine - at[1] * cosine;
    if along.value() > 0.0 { at[0] * cosine + at[1] * sine } else { length2(at) }
}

/// An infinite cylinder.
pub fn sdf_infinite_cylinder<T: Real>(p: [T; 3], q: &InfiniteCylinderParams) -> T {
    length2([p[0], p[2]]) - q.radius
}

/// A pyramid over a square.
///
/// Symmetry maps the point into the sector of the face toward +X, where |z| < x. Outside, the distance is that of the
/// nearer of face and square, each in its own plane; inside, that of the nearer plane.
pub fn sdf_pyramid<T: Real>(p: [T; 3], q: &PyramidParams) -> T {
    let (half, height) = (0.5 * q.width, q.height);
    let (x, z) = (p[0].abs(), p[2].abs());
    let (x, z, y) = (x.max(z), x.min(z), p[1] + 0.5 * height);
    let slope = half.hypot(height);
    let up = if slope > 0.0 { [-half / slope, height / slope] } else { [0.0, 1.0] };
    let from_edge = x - half;
    let over = from_edge * up[1] - y * up[0];
    if over.value() < 0.0 && y.value() > 0.0 {
        return over.max(-y);
    }
    let along = from_edge * up[0] + y * up[1];
    let beside = trapezoid([z, along - 0.5 * slope], half, 0.0, slope);
    let to_face = if beside.value() > 0.0 { length2([over, beside]) } else { over.abs() };
    let beyond = [from_edge.positive(), (z - half).positive()];
    // On the base itself the field increases downward.
    let below = if y.value() <= 0.0 { -y } else { y };
    let to_base = if beyond[0].value() > 0.0 { length3([beyond[0], beyond[1], y]) } else { below };
    to_face.min(to_base)
}
