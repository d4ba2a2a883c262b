// A ring around Y: major radius a.x, minor radius a.y.

fn sdf_torus(p: vec3f, a: vec4f, b: vec4f) -> f32 {
    return length(vec2f(length(p.xz) - a.x, p.y)) - a.y;
}

// As far as this around a point the field is convex: away from the axis the distance to it is, and the field grows with that
// outside of the ring's own circle.
fn sdf_torus_convex(p: vec3f, a: vec4f, b: vec4f) -> f32 {
    return length(p.xz) - a.x;
}
