// A solid heightfield over a rectangle: half width a.x, depth a.y, half length a.z, greatest height
// a.w; b.x is 1 / sqrt(1 + L²) for the steepest slope L. The height above the surface times b.x is
// nowhere more than the distance to it.

fn sdf_heightfield(p: vec3f, a: vec4f, b: vec4f, height: f32) -> f32 {
    let d = vec3f(abs(p.x) - a.x, abs(p.y - 0.5 * (a.w - a.y)) - 0.5 * (a.w + a.y), abs(p.z) - a.z);
    let outside = length(max(d, vec3f(0.0))) + min(max(d.x, max(d.y, d.z)), 0.0);
    return max((p.y - height) * b.x, outside);
}
