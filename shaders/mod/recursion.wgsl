// Recursion: copies of copies. a: offset of the next copy, its scale; b, c, d: rows of the inverse
// rotation, with the number of copies in b.w and, in c.w, the flags of mirrored axes (1, 2, 4) and
// of the axes where the copy is on the lower side (8, 16, 32); e: center of the content's bounds,
// its least slope; f: half extent. Each step folds space at the mirrors, which stretches nothing,
// and transforms it to the space of the next copy.

fn mod_recursion_count(a: vec4f, b: vec4f, c: vec4f, d: vec4f, e: vec4f, f: vec4f) -> u32 {
    return u32(b.w);
}

fn mod_recursion_start(p: vec3f, a: vec4f, b: vec4f, c: vec4f, d: vec4f, e: vec4f, f: vec4f) -> f32 {
    return 3e38;
}

// Scale of the k-th copy.
fn mod_recursion_scale(k: u32, a: vec4f, b: vec4f, c: vec4f, d: vec4f, e: vec4f, f: vec4f) -> f32 {
    var scale = 1.0;
    for (var n = 0u; n < k; n += 1u) {
        scale *= a.w;
    }
    return scale;
}

// The point in the space of the k-th copy.
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

// Lower bound of the field of the k-th copy; -3e38 if unknown.
fn mod_recursion_bound(p: vec3f, k: u32, a: vec4f, b: vec4f, c: vec4f, d: vec4f, e: vec4f, f: vec4f) -> f32 {
    let q = mod_recursion_point(p, k, a, b, c, d, e, f);
    let away = length(max(abs(q - e.xyz) - f.xyz, vec3f(0.0))) * e.w;
    return select(-3e38, away * mod_recursion_scale(k, a, b, c, d, e, f), away > 0.0);
}
