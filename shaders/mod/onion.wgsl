// Onion: walls at the surface and inward from it. a: half thickness, number of walls, spacing.

fn detach_onion_wall(f: f32, a: vec4f) -> f32 {
    return clamp(round(-f / a.z), 0.0, a.y - 1.0);
}

fn mod_onion_value(f: f32, p: vec3f, a: vec4f) -> f32 {
    return abs(f + detach_onion_wall(f, a) * a.z) - a.x;
}
