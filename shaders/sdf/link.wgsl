// A link of a chain in the XZ plane: straight part a.x along X, major radius a.y, minor radius a.z.

fn sdf_link(p: vec3f, a: vec4f, b: vec4f) -> f32 {
    let bend = max(abs(p.x) - 0.5 * a.x, 0.0);
    return length(vec2f(length(vec2f(bend, p.z)) - a.y, p.y)) - a.z;
}
