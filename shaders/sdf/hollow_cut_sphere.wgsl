// A bowl: radius a.x, height of the cut a.y, thickness a.z.

fn sdf_hollow_cut_sphere(p: vec3f, a: vec4f, b: vec4f) -> f32 {
    let radius = a.x;
    let cut = clamp(a.y, -radius, radius);
    let rim = sqrt((radius - cut) * (radius + cut));
    let q = vec2f(length(p.xz), p.y);
    // Whether the direction from the center leads through the bowl. On the axis below it always
    // does.
    let turn = q.y * rim - q.x * cut;
    if turn < 0.0 || (turn == 0.0 && q.y < 0.0) {
        return abs(length(q) - radius) - 0.5 * a.z;
    }
    return length(q - vec2f(rim, cut)) - 0.5 * a.z;
}
