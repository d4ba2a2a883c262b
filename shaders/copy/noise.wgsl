// Smooth noise for masks and dynamics. Counterpart of `src/field/copies/noise.rs`.

#include "copy/hash.wgsl"

// A coordinate as a whole number and a fraction from 0 to below 1.
struct NoiseCoordinate {
    whole: i32,
    fraction: f32,
}

fn noise_moved(at: NoiseCoordinate, by: f32) -> NoiseCoordinate {
    let sum = at.fraction + by;
    let whole = floor(sum);
    return NoiseCoordinate(at.whole + i32(whole), sum - whole);
}

// The weight of the next lattice point, and its slope (Perlin, "Improving noise", 2002).
fn noise_fade(t: f32) -> vec2f {
    return vec2f(t * t * t * (t * (t * 6.0 - 15.0) + 10.0), 30.0 * t * t * (t * (t - 2.0) + 1.0));
}

// Noise between -1 and 1 over one coordinate.
fn copy_noise_1(key: u32, at: NoiseCoordinate) -> f32 {
    let a = copy_randoms(key, vec3i(at.whole, 0, 0), 0u).x;
    let b = copy_randoms(key, vec3i(at.whole + 1, 0, 0), 0u).x;
    return 2.0 * mix(a, b, noise_fade(at.fraction).x) - 1.0;
}

// Noise between 0 and 1 over two coordinates.
fn copy_noise_2(key: u32, s: NoiseCoordinate, t: NoiseCoordinate) -> f32 {
    let a = copy_randoms(key, vec3i(s.whole, 1, t.whole), 0u).x;
    let b = copy_randoms(key, vec3i(s.whole + 1, 1, t.whole), 0u).x;
    let c = copy_randoms(key, vec3i(s.whole, 1, t.whole + 1), 0u).x;
    let d = copy_randoms(key, vec3i(s.whole + 1, 1, t.whole + 1), 0u).x;
    let x = noise_fade(s.fraction).x;
    return mix(mix(a, b, x), mix(c, d, x), noise_fade(t.fraction).x);
}

// The curl of three noises over three coordinates whose values at lattice points go up and down
// with `phase`, in turns.
fn copy_curl(key: u32, whole: vec3i, fraction: vec3f, phase: f32) -> vec3f {
    let x = noise_fade(fraction.x);
    let y = noise_fade(fraction.y);
    let z = noise_fade(fraction.z);
    // Slopes of the three noises along X, Y and Z.
    var along_x = vec3f(0.0);
    var along_y = vec3f(0.0);
    var along_z = vec3f(0.0);
    for (var corner = 0; corner < 8; corner += 1) {
        let step = vec3i(corner & 1, (corner >> 1u) & 1, corner >> 2u);
        let turns = copy_randoms(key, whole + step, 2u) + phase;
        let values = sin(6.2831853 * fract(turns));
        let a = select(vec2f(1.0 - x.x, -x.y), x, step.x == 1);
        let b = select(vec2f(1.0 - y.x, -y.y), y, step.y == 1);
        let c = select(vec2f(1.0 - z.x, -z.y), z, step.z == 1);
        along_x += values * (a.y * b.x * c.x);
        along_y += values * (a.x * b.y * c.x);
        along_z += values * (a.x * b.x * c.y);
    }
    return vec3f(along_y.z - along_z.y, along_z.x - along_x.z, along_x.y - along_y.x);
}
