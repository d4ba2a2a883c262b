// Hills: a heightfield of layers of noise. `data` is the first row, see
// `src/field/prepare/heightfield.rs`.

#include "generated/params/TerrainParams.wgsl"
#include "sdf/heightfield.wgsl"

fn sdf_terrain(p: vec3f, q: TerrainParams, data: u32) -> f32 {
    var height = 0.0;
    for (var layer = 0u; layer < q.layers; layer += 1u) {
        let row = scene_row(data + 1u + layer);
        height += sdf_terrain_noise(p.xz * row.x, q.seed, u32(row.z)) * row.y;
    }
    return sdf_heightfield(p, height, q.half, q.depth, q.top, q.slope);
}

// Smooth noise between -1 and 1: random numbers at whole coordinates, interpolated by t² (3 - 2 t)
// (value noise, Perlin, "An image synthesizer", 1985). Its slope is at most 3.
fn sdf_terrain_noise(p: vec2f, seed: u32, salt: u32) -> f32 {
    let corner = floor(p);
    let t = p - corner;
    let s = t * t * (3.0 - 2.0 * t);
    let i = vec2u(vec2i(corner));
    let low = mix(sdf_terrain_lattice(i, seed, salt), sdf_terrain_lattice(i + vec2u(1u, 0u), seed, salt), s.x);
    let high = mix(sdf_terrain_lattice(i + vec2u(0u, 1u), seed, salt), sdf_terrain_lattice(i + vec2u(1u), seed, salt), s.x);
    return mix(low, high, s.y);
}

// A random number between -1 and 1 (mixing as in Wellons, "Prospecting for hash functions", 2018).
fn sdf_terrain_lattice(i: vec2u, seed: u32, salt: u32) -> f32 {
    var h = (i.x * 0x9e3779b9u) ^ (i.y * 0x85ebca6bu);
    h ^= seed * 0xc2b2ae35u + salt * 0x27d4eb2fu;
    h = (h ^ (h >> 16u)) * 0x7feb352du;
    h = (h ^ (h >> 15u)) * 0x846ca68bu;
    h ^= h >> 16u;
    return f32(h >> 8u) * (2.0 / 16777215.0) - 1.0;
}
