// An infinite cylinder along Y: radius a.x.

fn sdf_infinite_cylinder(p: vec3f, a: vec4f, b: vec4f) -> f32 {
    return length(p.xz) - a.x;
}
