// A cylinder along Y: radius a.x, height a.y, rounding a.z inward.

fn sdf_cylinder(p: vec3f, a: vec4f, b: vec4f) -> f32 {
    let size = vec2f(a.x, 0.5 * a.y);
    let rounding = min(a.z, min(size.x, size.y));
    let d = vec2f(length(p.xz), abs(p.y)) - size + rounding;
    return length(max(d, vec2f(0.0))) + min(max(d.x, d.y), 0.0) - rounding;
}
