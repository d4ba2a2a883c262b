// The half space below the XZ plane.

fn sdf_plane(p: vec3f, a: vec4f, b: vec4f) -> f32 {
    return p.y;
}
