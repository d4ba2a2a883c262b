//! Shapes that repeat themselves, ever smaller.

use super::planar::length3;
use crate::flat::twin::Real;

/// Most iterations: the hard limit of the parameter.
const MOST: usize = 8;

/// A Menger sponge (Menger, "Dimensionstheorie", 1928): a cube without bars that fill the middle thirds of its cells
/// along each axis. The field is the greatest of the distance to the cube and of how deep the point is in the bars of
/// each size, so it is a lower bound of the distance with a slope of at most 1.
pub fn sdf_menger_sponge<T: Real>(p: [T; 3], q: &[f64; 8]) -> T {
    let d = p.map(|c| c.abs() - 0.5 * q[0]);
    let most = d[0].max(d[1].max(d[2]));
    let mut field = if most.value() > 0.0 { length3(d.map(T::positive)) } else { most };
    let mut side = q[0];
    for step in 0..MOST {
        if step as f64 + 0.5 > q[1] {
            break;
        }
        // From the middle of the cell. The point is as deep in the bars as the second least coordinate says.
        let [x, y, z] = p.map(|c| (c - side * (c.value() / side.max(1e-30)).round()).abs());
        let second = x.min(y).max(x.max(y).min(z));
        field = field.max(-second + side / 6.0);
        side /= 3.0;
    }
    field
}
