// Displacement by the heights of an image. a: tiles per meter along its width and along its length,
// its columns and lines; b: 1 / largest slope, least and greatest height, the axis of projection
// (0, 1, 2). `data` is the row of its first height, see `sdf_heights`.
//
// Tiles are mirrored at their borders. The spline treats heights beyond a border as equal to those
// before it, so it is smooth there.

#include "sdf/heights.wgsl"

// Position of the point in the image, in tiles. The image is upright as seen from the positive side
// of the axis.
fn displacement_place(p: vec3f, a: vec4f, axis: f32) -> vec2f {
    let upright = select(vec2f(p.x, -p.y), vec2f(-p.z, -p.y), axis == 0.0);
    let tiles = select(upright, p.xz, axis == 1.0) * a.xy + 0.5;
    return abs(tiles - 2.0 * round(tiles * 0.5));
}

fn mod_displacement_value(f: f32, p: vec3f, a: vec4f, b: vec4f, data: u32) -> f32 {
    let height = sdf_heights(displacement_place(p, a, b.w) * a.zw, a.zw, data);
    // No height moves the surface beyond these two limits, so the field stays between them.
    return clamp((f - height) * b.x, f - b.z, f - b.y);
}
