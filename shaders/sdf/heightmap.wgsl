// A heightfield from an image: b.y columns and b.z lines of heights; see `sdf_heightfield` for the
// rest. `data` is the first row, and the heights follow it: see `src/field/prepare/heightfield.rs`.
// Beyond the border, the height of the border applies.

#include "sdf/heightfield.wgsl"
#include "sdf/heights.wgsl"

fn sdf_heightmap(p: vec3f, a: vec4f, b: vec4f, data: u32) -> f32 {
    let half = a.xz;
    let place = (clamp(p.xz, -half, half) / max(half, vec2f(1e-9)) * 0.5 + 0.5) * b.yz;
    return sdf_heightfield(p, a, b, sdf_heights(place, b.yz, data + 1u));
}
