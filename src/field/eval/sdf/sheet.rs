//! Flat pieces of the XZ plane with a thickness.

use super::planar::{edge, length2};
use crate::eval::Real;
use isolith_scene::shape_params::{QuadParams, TriangleParams};

/// All points within half a thickness of a convex piece of the plane, from the distances to its edges.
fn sheet<T: Real, const N: usize>(edges: [T; N], height: T, thickness: f64) -> T {
    let over = edges.iter().all(|e| e.value() < 0.0);
    let aside = edges.into_iter().map(T::abs).reduce(T::min).expect("it has edges");
    let distance = if over { height.abs() } else { length2([aside, height]) };
    distance - 0.5 * thickness
}

/// A triangle.
pub fn sdf_triangle<T: Real>(p: [T; 3], q: &TriangleParams) -> T {
    let (x, z) = (0.5 * q.width, 0.5 * q.depth);
    let (left, right, tip) = ([-x, -z], [x, -z], [q.skew, z]);
    let at = [p[0], p[2]];
    sheet([edge(at, left, right), edge(at, right, tip), edge(at, tip, left)], p[1], q.thickness)
}

/// A parallelogram. A half turn maps it onto itself, so the function evaluates only the half toward +Z.
pub fn sdf_quad<T: Real>(p: [T; 3], q: &QuadParams) -> T {
    let (x, z, skew) = (0.5 * q.width, 0.5 * q.depth, 0.5 * q.skew);
    let at = if p[2].value() < 0.0 { [-p[0], -p[2]] } else { [p[0], p[2]] };
    let (right, left) = ([x + skew, z], [skew - x, z]);
    let edges = [edge(at, right, left), edge(at, [x - skew, -z], right), edge(at, left, [-x - skew, -z])];
    sheet(edges, p[1], q.thickness)
}
