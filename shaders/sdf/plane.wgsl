// The half space below the XZ plane.

fn sdf_plane(p: vec3f) -> f32 {
    return p.y;
}
