// A hexagonal prism along Y: inner radius a.x, height a.y. Two sides face along X.

fn sdf_hexagonal_prism(p: vec3f, a: vec4f, b: vec4f) -> f32 {
    // Fold the plane at its mirror lines until only the side that faces X is left.
    var q = abs(p.xz);
    let mirror = vec2f(-0.5, 0.8660254);
    q -= 2.0 * max(dot(q, mirror), 0.0) * mirror;
    let half_side = 0.57735027 * a.x;
    let beside = vec2f(q.x - a.x, max(abs(q.y) - half_side, 0.0));
    let d = vec2f(select(beside.x, length(beside), beside.x > 0.0), abs(p.y) - 0.5 * a.y);
    return length(max(d, vec2f(0.0))) + min(max(d.x, d.y), 0.0);
}
