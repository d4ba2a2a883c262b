// Copies of copies. a: offset of the next copy, its scale; b, c, d: rows of the rotation back from it, with the
// number of copies and the flags of mirrored axes (1, 2, 4) and of those where the copy stands on the lower side (8, 16, 32); e: middle of the content's bounds, its least slope; f: half extent.
// Each step folds space at the mirrors, which stretches nothing, and turns it into the next copy's own.

fn mod_recursion_count(a: vec4f, b: vec4f, c: vec4f, d: vec4f, e: vec4f, f: vec4f) -> u32 {
    return u32(b.w);
}

fn mod_recursion_start(p: vec3f, a: vec4f, b: vec4f, c: vec4f, d: vec4f, e: vec4f, f: vec4f) -> f32 {
    return 3e38;
}

// The size of the k-th copy.
fn mod_recursion_scale(k: u32, a: vec4f, b: vec4f, c: vec4f, d: vec4f, e: vec4f, f: vec4f) -> f32 {
    var scale = 1.0;
    for (var n = 0u; n < k; n += 1u) {
        scale *= a.w;
    }
    return scale;
}

// Where the point stands in the k-th copy.
fn mod_recursion_point(p: vec3f, k: u32, a: vec4f, b: vec4f, c: vec4f, d: vec4f, e: vec4f, f: vec4f) -> vec3f {
    let flags = u32(c.w);
    let mirrored = vec3u(flags & 1u, flags & 2u, flags & 4u) != vec3u(0u);
    let side = select(vec3f(1.0), vec3f(-1.0), vec3u(flags & 8u, flags & 16u, flags & 32u) != vec3u(0u));
    var q = p;
    for (var n = 0u; n < k; n += 1u) {
        let folded = select(q, abs(q) * side, mirrored) - a.xyz;
        q = vec3f(dot(b.xyz, folded), dot(c.xyz, folded), dot(d.xyz, folded)) / a.w;
    }
    return q;
}

// The least that the k-th copy can be; -3e38 where nothing is known.
fn mod_recursion_bound(p: vec3f, k: u32, a: vec4f, b: vec4f, c: vec4f, d: vec4f, e: vec4f, f: vec4f) -> f32 {
    let q = mod_recursion_point(p, k, a, b, c, d, e, f);
    let away = length(max(abs(q - e.xyz) - f.xyz, vec3f(0.0))) * e.w;
    return select(-3e38, away * mod_recursion_scale(k, a, b, c, d, e, f), away > 0.0);
}
