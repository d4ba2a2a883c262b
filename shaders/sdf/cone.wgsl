// An infinite cone that opens downward from its tip: sine and cosine of its half angle a.xy.

fn sdf_cone(p: vec3f, a: vec4f, b: vec4f) -> f32 {
    let q = vec2f(length(p.xz), p.y);
    if dot(q, vec2f(a.x, -a.y)) > 0.0 {
        return dot(q, a.yx);
    }
    return length(q);
}
