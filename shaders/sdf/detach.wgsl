// Constant for differentiation: what follows these values follows the point through other values only.

fn detach_f32(v: f32) -> f32 {
    return v;
}

fn detach_vec2(v: vec2f) -> vec2f {
    return v;
}

fn detach_vec3(v: vec3f) -> vec3f {
    return v;
}

fn detach_vec4(v: vec4f) -> vec4f {
    return v;
}
