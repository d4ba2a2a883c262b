// Displacement by waves. a: amplitude, radians per meter, phase, 1 / largest slope.

fn mod_waves_value(f: f32, p: vec3f, a: vec4f) -> f32 {
    let q = sin(p * a.y + a.z);
    let displaced = f + a.x * q.x * q.y * q.z;
    // The waves move the surface by at most the amplitude, so the field changes by at most as much.
    return clamp(displaced * a.w, f - a.x, f + a.x);
}
