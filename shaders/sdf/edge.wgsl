// Distance to a segment in the plane, negative on its left.

#include "sdf/detach.wgsl"

fn sdf_edge(q: vec2f, start: vec2f, end: vec2f) -> f32 {
    let axis = end - start;
    let from_start = q - start;
    // Detached: to first order, a move of the nearest point along the segment does not change the
    // distance.
    let square = dot(axis, axis);
    let t = detach_f32(clamp(dot(from_start, axis) / max(square, 1e-30), 0.0, 1.0));
    let side = from_start - axis * t;
    let over = dot(side, vec2f(axis.y, -axis.x) / max(length(axis), 1e-30));
    // Between the ends `side` is along the normal; on the segment it is only rounding. A shorter
    // segment counts as a point.
    let distance = select(length(side), abs(over), t > 0.0 && t < 1.0 && square > 1e-30);
    return select(distance, -distance, over < 0.0);
}
