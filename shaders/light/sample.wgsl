// Points of a light for the rays of still pictures. Counterpart of `light_sample` in
// `src/field/light/shadow.rs`.

// Hash of three words (Jarzynski and Olano, "Hash Functions for GPU Rendering", 2020).
fn sample_hash(seed: vec3u) -> vec3u {
    var v = seed * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v ^= v >> vec3u(16u);
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return v;
}

// Point of the unit square: the sequence R2 (Roberts, "The Unreasonable Effectiveness of Quasirandom
// Sequences", 2018), shifted for each pixel and light.
fn sample_unit(pixel: vec2u, light: u32, sample: u32) -> vec2f {
    let shifted = sample_hash(vec3u(pixel, light)).xy + vec2u(0xc13fa9a9u, 0x91e10da5u) * sample;
    return vec2f(shifted >> vec2u(8u)) / 16777216.0;
}

// The same on the unit disc.
fn sample_disc(pixel: vec2u, light: u32, sample: u32) -> vec2f {
    let place = sample_unit(pixel, light, sample);
    let radius = sqrt(place.x);
    let angle = 6.2831853 * place.y;
    return radius * vec2f(cos(angle), sin(angle));
}
