// Recursion: copies of copies. Each step folds space at the mirrors, which stretches nothing, and
// transforms it to the space of the next copy.

#include "generated/params/RecursionParams.wgsl"

fn mod_recursion_count(q: RecursionParams) -> u32 {
    return q.count;
}

fn mod_recursion_start(p: vec3f, q: RecursionParams) -> f32 {
    return 3e38;
}

// Scale of the k-th copy.
fn mod_recursion_scale(k: u32, q: RecursionParams) -> f32 {
    var scale = 1.0;
    for (var n = 0u; n < k; n += 1u) {
        scale *= q.scale;
    }
    return scale;
}

// The point in the space of the k-th copy.
fn mod_recursion_point(p: vec3f, k: u32, q: RecursionParams) -> vec3f {
    let flags = q.mirrored;
    let mirrored = vec3u(flags & 1u, flags & 2u, flags & 4u) != vec3u(0u);
    let side = select(vec3f(1.0), vec3f(-1.0), vec3u(flags & 8u, flags & 16u, flags & 32u) != vec3u(0u));
    var at = p;
    for (var n = 0u; n < k; n += 1u) {
        let folded = select(at, abs(at) * side, mirrored) - q.offset;
        at = vec3f(dot(q.inverse_x, folded), dot(q.inverse_y, folded), dot(q.inverse_z, folded)) / q.scale;
    }
    return at;
}

// Lower bound of the field of the k-th copy; -3e38 if unknown.
fn mod_recursion_bound(p: vec3f, k: u32, q: RecursionParams) -> f32 {
    let at = mod_recursion_point(p, k, q);
    let away = length(max(abs(at - q.center) - q.half, vec3f(0.0))) * q.slope;
    return select(-3e38, away * mod_recursion_scale(k, q), away > 0.0);
}
