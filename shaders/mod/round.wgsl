// Round: moves the surface outward by a.x.

fn mod_round_value(f: f32, p: vec3f, a: vec4f) -> f32 {
    return f - a.x;
}
