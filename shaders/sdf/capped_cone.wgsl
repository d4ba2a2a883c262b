// A cone along Y, cut at both ends: bottom radius a.x, top radius a.y, height a.z.
//
// In the half plane through the axis the nearest point lies on the nearer cap or on the slanted side
// (idea: Quilez, "distance functions").

fn sdf_capped_cone(p: vec3f, a: vec4f, b: vec4f) -> f32 {
    let half_height = 0.5 * a.z;
    let q = vec2f(length(p.xz), p.y);
    let cap = vec2f(max(q.x - select(a.y, a.x, q.y < 0.0), 0.0), abs(q.y) - half_height);
    let slope = vec2f(a.x - a.y, -a.z);
    let from_top = q - vec2f(a.y, half_height);
    let t = clamp(dot(from_top, slope) / max(dot(slope, slope), 1e-30), 0.0, 1.0);
    let side = from_top - slope * t;
    let distance = min(length(cap), length(side));
    return select(distance, -distance, side.x < 0.0 && cap.y < 0.0);
}
