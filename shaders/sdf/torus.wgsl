// A ring around Y: major radius a.x, minor radius a.y.

fn sdf_torus(p: vec3f, a: vec4f, b: vec4f) -> f32 {
    return length(vec2f(length(p.xz) - a.x, p.y)) - a.y;
}
