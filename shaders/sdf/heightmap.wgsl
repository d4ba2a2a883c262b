// A heightfield from an image. `data` is the first row, and the heights follow it: see
// `src/field/prepare/heightfield.rs`. Beyond the border, the height of the border applies.

#include "generated/params/HeightmapParams.wgsl"
#include "sdf/heightfield.wgsl"
#include "sdf/heights.wgsl"

fn sdf_heightmap(p: vec3f, q: HeightmapParams, data: u32) -> f32 {
    let place = (clamp(p.xz, -q.half, q.half) / max(q.half, vec2f(1e-9)) * 0.5 + 0.5) * q.cells;
    let height = sdf_heights(place, q.cells, data + 1u);
    return sdf_heightfield(p, height, q.half, q.depth, q.top, q.slope);
}
