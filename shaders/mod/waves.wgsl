// A displacement by waves. a: amplitude, radians per meter, phase, 1 / largest slope.

fn mod_waves_value(f: f32, p: vec3f, a: vec4f) -> f32 {
    let q = sin(p * a.y + a.z);
    let displaced = f + a.x * q.x * q.y * q.z;
    // Nothing moves the surface by more than the amplitude: farther away it is nearly as far as without.
    return clamp(displaced * a.w, f - a.x, f + a.x);
}
