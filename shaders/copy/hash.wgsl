// Random numbers of copies. Counterpart of `src/field/copies/hash.rs`, with the same bits.

// Three random words (pcg3d: Jarzynski and Olano, "Hash Functions for GPU Rendering", 2020).
fn copy_hash(seed: u32, cell: vec3i, channel: u32) -> vec3u {
    var v = bitcast<vec3u>(cell);
    v.x += seed * 0x9e3779b9u;
    v.y += channel * 0x85ebca6bu;
    v.z ^= seed + (channel << 16u);
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v ^= v >> vec3u(16u);
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return v;
}

// Three numbers from 0 to below 1.
fn copy_randoms(seed: u32, cell: vec3i, channel: u32) -> vec3f {
    return vec3f(copy_hash(seed, cell, channel) >> vec3u(8u)) * (1.0 / 16777216.0);
}
