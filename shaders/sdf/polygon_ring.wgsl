// A ring around Y with a polygon as its section.
//
// Where the polygon extends beyond the axis, the one on the other side counts too.

#include "generated/params/PolygonRingParams.wgsl"
#include "sdf/polygon.wgsl"

fn sdf_polygon_ring(p: vec3f, q: PolygonRingParams) -> f32 {
    let around = length(p.xz);
    let near = sdf_polygon(vec2f(around - q.major_radius, p.y), q.sides, q.minor_radius);
    return min(near, sdf_polygon(vec2f(-around - q.major_radius, p.y), q.sides, q.minor_radius));
}
