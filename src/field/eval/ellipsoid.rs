//! The ellipsoid. Its distance is the root of an equation without a closed form.

use super::Real;
use isolith_scene::shape_params::EllipsoidParams;

/// The limit on steps of Newton's method. Four are enough for f32 (the GPU's count). After eight the error over
/// random half axes, including thin and zero ones, is the rounding of f64.
const STEPS: usize = 8;
/// A residual at which another step changes nothing: the error of the value is the square of this error.
const CONVERGED: f64 = 1e-12;
/// The offset of points on the planes of symmetry away from them, relative to the size.
const OFF: f64 = 1e-12;

/// A ball stretched along its axes.
///
/// The closest point is r² p / (t + r²) for the root t of |r p / (t + r²)| = 1. The reciprocal of that length is
/// nearly linear in t, and Newton's method on it climbs to the root from the left (Moré and Sorensen, "Computing a
/// trust region step", 1983). The unknown is s = t + (least r)², which avoids the subtraction of two large numbers.
/// With the normal n at that point, n·p − |r n| is the distance to the tangent plane of that normal: its error is
/// only the square of the error in n, for zero half axes too. At the best n its gradient is n itself, so n takes no
/// part in differentiation.
pub fn sdf_ellipsoid<T: Real>(p: [T; 3], params: &EllipsoidParams) -> T {
    // Sorted, so that the least half axis comes first.
    let mut r = params.radii;
    let mut q = p.map(T::abs);
    for (i, j) in [(0, 1), (1, 2), (0, 1)] {
        if r[i] > r[j] {
            r.swap(i, j);
            q.swap(i, j);
        }
    }
    let at = q.map(T::value);
    let scale = r[2].max(greatest(at)).max(1e-30);
    let r = r.map(|v| v / scale);
    let n = normal(at.map(|v| (v / scale).max(OFF)), r);
    let support = length([r[0] * n[0], r[1] * n[1], r[2] * n[2]]);
    q[0] * n[0] + q[1] * n[1] + q[2] * n[2] - support * scale
}

/// The unit normal at the point nearest to `p`; `r` ascending, both at most 1, `p` positive.
fn normal(p: [f64; 3], r: [f64; 3]) -> [f64; 3] {
    let gap = r.map(|v| (v - r[0]) * (v + r[0]));
    let w: [f64; 3] = std::array::from_fn(|i| r[i] * p[i]);
    let least = w[0].max(w[1] - gap[1]).max(w[2] - gap[2]).max(length(w) - gap[2]).max(1e-30);
    let mut s = least
        .max(start(w[0], [w[1], w[2]], [gap[1], gap[2]]))
        .max(start(w[0].hypot(w[1]), [0.0, w[2]], [0.0, gap[2] - gap[1]]) - gap[1]);
    for _ in 0..STEPS {
        let v: [f64; 3] = std::array::from_fn(|i| w[i] / (s + gap[i]));
        let square = dot(v, v);
        if (square - 1.0).abs() < CONVERGED {
            break;
        }
        let fall = dot(v, std::array::from_fn(|i| v[i] / (s + gap[i])));
        s = (s + (square.sqrt() - 1.0) * square / fall.max(1e-300)).max(least);
    }
    let n: [f64; 3] = std::array::from_fn(|i| p[i] / (s + gap[i]));
    // Divide by the greatest first: the squares of the quotients could overflow.
    let most = greatest(n);
    let n = n.map(|v| v / most);
    n.map(|v| v / length(n))
}

/// A lower bound of the root, near it where the term `w` / s is steep: tangents at 0 replace the other terms, which
/// gives a cubic equation, and its larger summand replaces that.
fn start(w: f64, others: [f64; 2], gaps: [f64; 2]) -> f64 {
    let (mut rest, mut fall) = (1.0, 0.0);
    for (other, gap) in others.into_iter().zip(gaps) {
        if gap > 1e-9 {
            let term = other / gap;
            rest -= term * term;
            fall += 2.0 * term * term / gap;
        }
    }
    let fall = fall.max(1e-300);
    if rest <= 0.0 {
        return 0.999 * (w * w / fall).cbrt().max(-rest / fall);
    }
    0.999 * (w / (2.0 * rest).sqrt()).min((w * w / (2.0 * fall)).cbrt())
}

fn greatest(v: [f64; 3]) -> f64 {
    v[0].max(v[1]).max(v[2])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn length(v: [f64; 3]) -> f64 {
    dot(v, v).sqrt()
}
