// Detached values: differentiation treats the results of these functions as constants.

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
