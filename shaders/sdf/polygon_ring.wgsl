// A ring around Y with a polygon as its section: sides a.xyz, major radius a.w, minor radius b.x.
//
// Where the polygon extends beyond the axis, the one on the other side counts too.

#include "sdf/polygon.wgsl"

fn sdf_polygon_ring(p: vec3f, a: vec4f, b: vec4f) -> f32 {
    let around = length(p.xz);
    let near = sdf_polygon(vec2f(around - a.w, p.y), a.xyz, b.x);
    return min(near, sdf_polygon(vec2f(-around - a.w, p.y), a.xyz, b.x));
}
