// Displacement by the heights of an image. `data` is the row of its first height, see
// `sdf_heights`.
//
// Tiles are mirrored at their borders. The spline treats heights beyond a border as equal to those
// before it, so it is smooth there.

#include "generated/params/DisplacementParams.wgsl"
#include "sdf/heights.wgsl"

// Position of the point in the image, in tiles. The image is upright as seen from the positive side
// of the axis.
fn displacement_place(p: vec3f, q: DisplacementParams) -> vec2f {
    let upright = select(vec2f(p.x, -p.y), vec2f(-p.z, -p.y), q.axis == 0u);
    let tiles = select(upright, p.xz, q.axis == 1u) * q.tiles + 0.5;
    return abs(tiles - 2.0 * round(tiles * 0.5));
}

fn mod_displacement_value(f: f32, p: vec3f, q: DisplacementParams, data: u32) -> f32 {
    let height = sdf_heights(displacement_place(p, q) * q.cells, q.cells, data);
    // No height moves the surface beyond these two limits, so the field stays between them.
    return clamp((f - height) * q.slope, f - q.greatest, f - q.least);
}
