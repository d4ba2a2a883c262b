//! A tube: balls along arcs. `crate::prepare::tube` defines its payload rows.

use glam::DVec3;

use super::Real;
use super::sdf::{Data, length3};
use isolith_scene::shape_params::TubeParams;

/// A round tube along a smooth curve. Exact outside; inside, a lower bound where it meets itself.
///
/// The field is the minimum of |p − c| − r over its balls. Moving the ball away from the nearest one changes the
/// value only by the square of the move, so the gradient is that of the nearest ball.
pub fn sdf_tube<T: Real>(p: [T; 3], q: &TubeParams, rows: Data<'_>) -> T {
    let at = DVec3::from_array(p.map(T::value));
    let (pieces, first) = (q.pieces as usize, 1 + q.groups as usize);
    let (mut least, mut nearest) = (f64::INFINITY, (DVec3::ZERO, 0.0));
    for piece in 0..pieces {
        let row = |i: usize| rows.row(first + 3 * piece + i);
        for (center, radius) in balls(at, row(0), row(1), row(2)) {
            let f = at.distance(center) - radius;
            if f < least {
                (least, nearest) = (f, (center, radius));
            }
        }
    }
    let (center, radius) = nearest;
    length3([p[0] - center.x, p[1] - center.y, p[2] - center.z]) - radius
}

/// The balls of a piece that can be the nearest: the one at its start, and the best elsewhere.
///
/// The foot is the point of the circle nearest to p. At arc length s from the foot the distance is √(D² + m χ²), with
/// χ the chord. Where the radius grows by k s as well, the minimum of distance minus radius is at χ² = 2 k² D² / (B +
/// √(B² − m² κ² k² D²)) with B = m (m − k²): a quadratic equation in χ².
fn balls(p: DVec3, first: [f64; 4], second: [f64; 4], third: [f64; 4]) -> [(DVec3, f64); 2] {
    let [middle, tangent, bend] = [first, second, third].map(|row| DVec3::from_slice(&row));
    let (reach, radius, growth) = (first[3], second[3], third[3]);
    let w = p - middle;
    let square = bend.length_squared();
    let (x, u) = (w.dot(tangent), 1.0 - w.dot(bend));
    let m = u.hypot(square.sqrt() * x);
    let side = if x < 0.0 { -1.0 } else { 1.0 };
    let foot = if u >= 0.0 { x / (m + u).max(1e-30) } else { side * (m - u) / (square * x.abs()).max(1e-30) };
    let foot = foot.clamp(-1e12, 1e12);
    let mut lambda = foot;
    if growth != 0.0 {
        let k = growth * growth;
        let far = (w.length_squared() - 4.0 * m * foot * foot / (1.0 + square * foot * foot)).max(0.0);
        let b = m * (m - k);
        let root = b * b - m * m * square * k * far;
        let end = 1e12_f64.copysign(growth);
        lambda = end;
        if b > 0.0 && root >= 0.0 {
            let chord = 2.0 * k * far / (b + root.sqrt());
            let shift = 0.5 * (chord / (1.0 - 0.25 * square * chord).max(1e-12)).sqrt().copysign(growth);
            let below = 1.0 - square * foot * shift;
            lambda = if below > 0.0 { (foot + shift) / below } else { end };
        }
    }
    let ball = |lambda: f64| {
        let share = 2.0 * lambda / (1.0 + square * lambda * lambda);
        let slope = square.sqrt() * lambda;
        let turned = if slope.abs() < 1e-4 { 1.0 - slope * slope / 3.0 } else { slope.atan() / slope };
        (middle + (tangent + bend * lambda) * share, radius + growth * 2.0 * lambda * turned)
    };
    [ball(-reach), ball(lambda.clamp(-reach, reach))]
}
