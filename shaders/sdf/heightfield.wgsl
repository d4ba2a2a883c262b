// A solid heightfield over a rectangle, from its greatest height `top` down to `depth` below 0.
// `slope` is 1 / sqrt(1 + L²) for the steepest slope L: the height above the surface times it is
// nowhere more than the distance to it.

fn sdf_heightfield(p: vec3f, height: f32, half: vec2f, depth: f32, top: f32, slope: f32) -> f32 {
    let d = vec3f(abs(p.x) - half.x, abs(p.y - 0.5 * (top - depth)) - 0.5 * (top + depth), abs(p.z) - half.y);
    let outside = length(max(d, vec3f(0.0))) + min(max(d.x, max(d.y, d.z)), 0.0);
    return max((p.y - height) * slope, outside);
}
