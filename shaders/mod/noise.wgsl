// Displacement by layers of value noise.

#include "generated/params/NoiseParams.wgsl"

// A random number between -1 and 1 for a corner of the grid (O'Neill, "PCG", 2014, one step of its
// mixing).
fn noise_corner(x: i32, y: i32, z: i32, seed: u32) -> f32 {
    var h = u32(x) * 0x8da6b343u ^ u32(y) * 0xd8163841u ^ u32(z) * 0xcb1ab31fu ^ seed * 0x9e3779b9u;
    h = (h ^ (h >> 15u)) * 0x2c1b3c6du;
    h = (h ^ (h >> 12u)) * 0x297a2d39u;
    h = h ^ (h >> 15u);
    return f32(h >> 8u) * (2.0 / 16777215.0) - 1.0;
}

fn detach_noise_cell(p: vec3f) -> vec3f {
    return floor(p);
}

// Value noise between -1 and 1 with weights 3u² - 2u³ (Perlin, "An Image Synthesizer", 1985).
fn noise_value(p: vec3f, seed: u32) -> f32 {
    let cell = detach_noise_cell(p);
    let x = i32(cell.x);
    let y = i32(cell.y);
    let z = i32(cell.z);
    let u = p - cell;
    let w = u * u * (3.0 - 2.0 * u);
    let low = mix(
        mix(noise_corner(x, y, z, seed), noise_corner(x + 1, y, z, seed), w.x),
        mix(noise_corner(x, y + 1, z, seed), noise_corner(x + 1, y + 1, z, seed), w.x),
        w.y,
    );
    let high = mix(
        mix(noise_corner(x, y, z + 1, seed), noise_corner(x + 1, y, z + 1, seed), w.x),
        mix(noise_corner(x, y + 1, z + 1, seed), noise_corner(x + 1, y + 1, z + 1, seed), w.x),
        w.y,
    );
    return mix(low, high, w.z);
}

fn mod_noise_value(f: f32, p: vec3f, q: NoiseParams) -> f32 {
    var moved = f;
    var amplitude = q.amplitude;
    var frequency = q.frequency;
    for (var layer = 0u; layer < q.layers; layer += 1u) {
        moved += amplitude * noise_value(p * frequency, q.seed + layer);
        amplitude *= 0.5;
        frequency *= 2.0;
    }
    return clamp(moved * q.slope, f - q.reach, f + q.reach);
}
