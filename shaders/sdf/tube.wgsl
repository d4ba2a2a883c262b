// A tube: spheres along arcs. `data` is its first row, see `src/field/prepare/tube.rs`.
//
// The field is the least of |p - c| - r over its spheres. Around the nearest sphere, a change of
// the sphere changes the field only by its square. So the gradient is that of the sphere alone, and
// the search for it is detached.

#include "generated/params/TubeParams.wgsl"
#include "sdf/detach.wgsl"

const TUBE_GROUP: u32 = 8u;

fn sdf_tube(p: vec3f, q: TubeParams, data: u32) -> f32 {
    let ball = detach_vec4(sdf_tube_nearest(p, q.pieces, q.groups, data + 1u));
    return length(p - ball.xyz) - ball.w;
}

// Center and radius of the nearest sphere.
fn sdf_tube_nearest(p: vec3f, pieces: u32, groups: u32, data: u32) -> vec4f {
    // No group is farther away than the far side of its bounding sphere.
    var least = 1e37;
    for (var group = 0u; group < groups; group += 1u) {
        let around = scene_row(data + group);
        least = min(least, distance(p, around.xyz) + around.w);
    }
    least = least * 1.00001 + 1e-30;
    var nearest = vec4f(0.0);
    for (var group = 0u; group < groups; group += 1u) {
        let around = scene_row(data + group);
        let first = group * TUBE_GROUP;
        let reached = distance(p, around.xyz) - around.w <= least;
        let end = select(first, min(first + TUBE_GROUP, pieces), reached);
        for (var piece = first; piece < end; piece += 1u) {
            let row = data + groups + 3u * piece;
            let ball = sdf_tube_ball(p, scene_row(row), scene_row(row + 1u), scene_row(row + 2u));
            let f = distance(p, ball.xyz) - ball.w;
            nearest = select(nearest, ball, f <= least);
            least = min(least, f);
        }
    }
    return nearest;
}

// The sphere of a piece nearest to p: the one at its start, or the best elsewhere.
//
// The point of the circle nearest to p is the foot. At the distance s along the circle from there,
// the distance to p is sqrt(D² + m χ²), with χ the chord. If the radius also grows by k s, the
// least of distance minus radius is at χ² = 2 k² D² / (B + sqrt(B² - m² κ² k² D²)) with
// B = m (m - k²), a quadratic equation in χ².
fn sdf_tube_ball(p: vec3f, middle: vec4f, tangent: vec4f, bend: vec4f) -> vec4f {
    let w = p - middle.xyz;
    let square = dot(bend.xyz, bend.xyz);
    let x = dot(w, tangent.xyz);
    let u = 1.0 - dot(w, bend.xyz);
    let m = sqrt(u * u + square * x * x);
    let behind = select(1.0, -1.0, x < 0.0) * (m - u) / max(square * abs(x), 1e-30);
    let foot = clamp(select(behind, x / max(m + u, 1e-30), u >= 0.0), -1e12, 1e12);
    let growth = bend.w;
    let k = growth * growth;
    let far = max(dot(w, w) - 4.0 * m * foot * foot / (1.0 + square * foot * foot), 0.0);
    let b = m * (m - k);
    let root = b * b - m * m * square * k * far;
    let chord = 2.0 * k * far / max(b + sqrt(max(root, 0.0)), 1e-30);
    let toward = select(1.0, -1.0, growth < 0.0);
    let shift = toward * 0.5 * sqrt(chord / max(1.0 - 0.25 * square * chord, 1e-12));
    let below = 1.0 - square * foot * shift;
    let found = b > 0.0 && root >= 0.0 && below > 0.0;
    let shifted = select(toward * 1e12, (foot + shift) / max(below, 1e-30), found);
    let lambda = clamp(select(shifted, foot, growth == 0.0), -middle.w, middle.w);
    let best = sdf_tube_at(lambda, middle, tangent, bend, square);
    let start = sdf_tube_at(-middle.w, middle, tangent, bend, square);
    return select(best, start, distance(p, start.xyz) - start.w < distance(p, best.xyz) - best.w);
}

// The sphere at a place of a piece.
fn sdf_tube_at(lambda: f32, middle: vec4f, tangent: vec4f, bend: vec4f, square: f32) -> vec4f {
    let share = 2.0 * lambda / (1.0 + square * lambda * lambda);
    let center = middle.xyz + (tangent.xyz + bend.xyz * lambda) * share;
    return vec4f(center, tangent.w + bend.w * 2.0 * lambda * sdf_tube_turn(square * lambda * lambda));
}

// atan(x) / x from x², within 2e-8 (Abramowitz and Stegun, "Handbook of mathematical functions",
// 4.4.49): a driver's own function may be less exact.
fn sdf_tube_turn(square: f32) -> f32 {
    let is_large = square > 1.0;
    let s = select(square, 1.0 / max(square, 1.0), is_large);
    let low = 1.0 + s * (-0.33333145 + s * (0.19993551 + s * (-0.14208899 + s * 0.10656264)));
    let turn = low + s * s * s * s * s * (-0.07528964 + s * (0.042909614 + s * (-0.016165737 + s * 0.0028662257)));
    // Beyond 1: atan(x) = π/2 - atan(1/x).
    return select(turn, (1.5707963 - sqrt(s) * turn) * sqrt(s), is_large);
}
