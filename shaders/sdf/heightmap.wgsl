// A heightfield from an image: b.y columns and b.z lines of heights; see `sdf_heightfield` for the
// rest. `data` is the first row, and the heights follow it: see `src/field/prepare/heightfield.rs`.
// Beyond the border, the height of the border applies.
//
// The fourth number of the heights holds 1 / sqrt(1 + L²) for the steepest slope L within 4, 16 and
// 64 cells, as three bytes: one cliff slows only what is near it. b.w is the side of a cell; 0 where
// the field must not be steeper than 1, as in blends.

#include "sdf/heightfield.wgsl"
#include "sdf/heights.wgsl"

fn sdf_heightmap(p: vec3f, a: vec4f, b: vec4f, data: u32) -> f32 {
    let half = a.xz;
    let place = (clamp(p.xz, -half, half) / max(half, vec2f(1e-9)) * 0.5 + 0.5) * b.yz;
    let gap = p.y - sdf_heights(place, b.yz, data + 1u);
    let size = abs(gap);
    let near = min(vec3f(4.0, 16.0, 64.0) * b.w, sdf_heightmap_scales(place, b.yz, data + 1u) * size);
    let least = max(max(size * b.x, near.x), max(near.y, near.z));
    return sdf_heightfield_above(p, a, select(least, -least, gap < 0.0));
}

// The scales of the cell at a place.
fn sdf_heightmap_scales(place: vec2f, size: vec2f, first: u32) -> vec3f {
    let cell = min(floor(place), size - 1.0);
    let all = scene_row(first + u32(cell.y * size.x + cell.x)).w;
    let high = floor(all / 65536.0);
    let rest = all - 65536.0 * high;
    let middle = floor(rest / 256.0);
    return vec3f(high, middle, rest - 256.0 * middle) / 255.0;
}
