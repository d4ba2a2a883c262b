// Points of a light, and directions to the environment, for the rays of still pictures. Counterpart of `light_sample` and
// `around_sample` in `src/field/light/shadow.rs`.

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

// Digits of a number in either base; more repeat.
const SAMPLE_DIGITS: u32 = 8u;

// The digits of a number in this base, mirrored behind the point.
fn sample_mirrored(number: u32, base: u32) -> f32 {
    var left = number;
    var digit = 1.0;
    var sum = 0.0;
    for (var i = 0u; i < SAMPLE_DIGITS; i += 1u) {
        digit /= f32(base);
        sum += digit * f32(left % base);
        left /= base;
    }
    return sum;
}

// Point of the unit square for a ray to the environment: Halton's sequence with the bases 5 and 7, for the places in the
// pixel are that with 2 and 3; all rays of a pixel are of one sequence.
fn sample_around(pixel: vec2u, key: u32, ray: u32) -> vec2f {
    let shift = vec2f(sample_hash(vec3u(pixel, key)).xy >> vec2u(8u)) / 16777216.0;
    return fract(shift + vec2f(sample_mirrored(ray, 5u), sample_mirrored(ray, 7u)));
}

// The same as `sample_unit` on the unit disc.
fn sample_disc(pixel: vec2u, light: u32, sample: u32) -> vec2f {
    let place = sample_unit(pixel, light, sample);
    let radius = sqrt(place.x);
    let angle = 6.2831853 * place.y;
    return radius * vec2f(cos(angle), sin(angle));
}
