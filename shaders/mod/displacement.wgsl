// A displacement by the heights of an image. a: tiles per meter along its width and along its length, its columns and
// lines; b: 1 / largest slope, least and greatest height, the axis along which it is projected (0, 1, 2). `data` is the row
// of its first height, see `sdf_heights`.
//
// Tiles are mirrored at their borders. The spline takes what is beyond a border as what is before it, so it is smooth there.

#include "sdf/heights.wgsl"

// Where the point stands in the image, in tiles. Seen from the axis's positive side the image is upright.
fn displacement_place(p: vec3f, a: vec4f, axis: f32) -> vec2f {
    let upright = select(vec2f(p.x, -p.y), vec2f(-p.z, -p.y), axis == 0.0);
    let tiles = select(upright, p.xz, axis == 1.0) * a.xy + 0.5;
    return abs(tiles - 2.0 * round(tiles * 0.5));
}

fn mod_displacement_value(f: f32, p: vec3f, a: vec4f, b: vec4f, data: u32) -> f32 {
    let height = sdf_heights(displacement_place(p, a, b.w) * a.zw, a.zw, data);
    // Farther away than the heights it is nearly as far as without.
    return clamp((f - height) * b.x, f - b.z, f - b.y);
}
