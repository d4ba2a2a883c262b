// A sphere: radius a.x.

fn sdf_sphere(p: vec3f, a: vec4f, b: vec4f) -> f32 {
    return length(p) - a.x;
}
