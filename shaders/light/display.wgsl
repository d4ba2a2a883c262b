// Linear light to the colors of a screen. Counterpart of `src/field/light/display.rs`.

// Encodes linear light as sRGB (IEC 61966-2-1), clamped to 0..1.
fn display_encode(linear: vec3f) -> vec3f {
    let c = clamp(linear, vec3f(0.0), vec3f(1.0));
    return select(1.055 * pow(c, vec3f(1.0 / 2.4)) - 0.055, 12.92 * c, c <= vec3f(0.0031308));
}
