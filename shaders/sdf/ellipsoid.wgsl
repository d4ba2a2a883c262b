// An ellipsoid.
//
// The closest point is r² p / (t + r²) for the root t of |r p / (t + r²)| = 1. Newton's method on
// the reciprocal of that length, nearly a straight line in t, climbs to the root from the left
// (Moré and Sorensen, "Computing a trust region step", 1983). The unknown is s = t + (least r)²,
// which avoids the subtraction of two large numbers. With the normal n at this point, n·p − |r n|
// is the distance to the tangent plane of that normal: its error is only the square of the error in
// n, for zero half axes too. At the best n the gradient is n itself, so n is detached. The half
// axes are sorted first; points on the planes of symmetry are moved off them by 1e-7.

#include "generated/params/EllipsoidParams.wgsl"
#include "sdf/detach.wgsl"

fn sdf_ellipsoid(p: vec3f, q: EllipsoidParams) -> f32 {
    var r = q.radii;
    var at = abs(p);
    if r.x > r.y { r = r.yxz; at = at.yxz; }
    if r.y > r.z { r = r.xzy; at = at.xzy; }
    if r.x > r.y { r = r.yxz; at = at.yxz; }
    let scale = detach_f32(max(max(r.z, max(at.x, max(at.y, at.z))), 1e-30));
    r /= scale;
    at /= scale;
    let off = detach_vec3(max(at, vec3f(1e-7)));
    let gap = (r - r.x) * (r + r.x);
    let w = r * off;
    let least = max(max(w.x, max(w.y - gap.y, w.z - gap.z)), max(length(w) - gap.z, 1e-30));
    var s = max(least, sdf_ellipsoid_start(w.x, w.yz, gap.yz));
    s = max(s, sdf_ellipsoid_start(length(w.xy), vec2f(0.0, w.z), vec2f(0.0, gap.z - gap.y)) - gap.y);
    s = sdf_ellipsoid_step(s, least, w, gap);
    s = sdf_ellipsoid_step(s, least, w, gap);
    s = sdf_ellipsoid_step(s, least, w, gap);
    s = sdf_ellipsoid_step(s, least, w, gap);
    var n = off / (s + gap);
    n = normalize(n / max(n.x, max(n.y, n.z)));
    return (dot(n, at) - length(r * n)) * scale;
}

// One step of Newton's method.
fn sdf_ellipsoid_step(s: f32, least: f32, w: vec3f, gap: vec3f) -> f32 {
    let v = w / (s + gap);
    let square = dot(v, v);
    return max(s + (sqrt(square) - 1.0) * square / max(dot(v, v / (s + gap)), 1e-37), least);
}

// A lower bound of the root, near it where the term `w` / s is steep. Replaces the other terms by
// their tangents at 0, which gives a cubic equation, and that by its larger summand.
fn sdf_ellipsoid_start(w: f32, others: vec2f, gaps: vec2f) -> f32 {
    let term = select(vec2f(0.0), others / max(gaps, vec2f(1e-9)), gaps > vec2f(1e-9));
    let rest = 1.0 - dot(term, term);
    let fall = max(2.0 * dot(term, term / max(gaps, vec2f(1e-9))), 1e-37);
    let square = max(w * w, 1e-37);
    if rest <= 0.0 {
        return 0.999 * max(pow(square / fall, 1.0 / 3.0), -rest / fall);
    }
    return 0.999 * min(w / sqrt(2.0 * rest), pow(square / (2.0 * fall), 1.0 / 3.0));
}
