// The twelve edges of a box, as bars.
//
// Computed in the octant of positive coordinates, by symmetry. `inner` is the depth of the point
// within the bars' width along each axis; bars that reach the middle have no inner side. A point is
// in the solid where it is deep along two axes.

#include "generated/params/BoxFrameParams.wgsl"

fn sdf_box_frame(p: vec3f, q: BoxFrameParams) -> f32 {
    let outer = abs(p) - 0.5 * q.size;
    let inner = select(outer + q.thickness, vec3f(1e18), 0.5 * q.size <= vec3f(q.thickness));
    // Distance, along each axis, to the width of a bar; 0 within it.
    let side = max(max(outer, -inner), vec3f(0.0));
    let along = max(outer, vec3f(0.0));
    let outside = min(length(vec3f(along.x, side.yz)), min(length(vec3f(side.x, along.y, side.z)), length(vec3f(side.xy, along.z))));
    if outside > 0.0 {
        return outside;
    }
    // The nearest exit is an outer face, or the hollow along the two shallowest axes.
    let least = min(inner.x, min(inner.y, inner.z));
    let middle = max(min(inner.x, inner.y), min(max(inner.x, inner.y), inner.z));
    return max(max(outer.x, max(outer.y, outer.z)), -length(max(vec2f(least, middle), vec2f(0.0))));
}
