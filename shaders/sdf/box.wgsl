// A box: size a.xyz, rounding a.w inward. Formula: Quilez, "distance functions" (rounded box).

fn sdf_box(p: vec3f, a: vec4f, b: vec4f) -> f32 {
    let half_size = 0.5 * a.xyz;
    let rounding = min(a.w, min(half_size.x, min(half_size.y, half_size.z)));
    let d = abs(p) - half_size + rounding;
    return length(max(d, vec3f(0.0))) + min(max(d.x, max(d.y, d.z)), 0.0) - rounding;
}
