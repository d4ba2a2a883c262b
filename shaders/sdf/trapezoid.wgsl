// The trapezoid between the half widths `bottom` and `top`; by symmetry only for positive q.x.
//
// The nearest point is on the nearer cap or on the slanted side (idea: Quilez, "distance
// functions").

#include "sdf/detach.wgsl"

fn sdf_trapezoid(q: vec2f, bottom: f32, top: f32, height: f32) -> f32 {
    let half_height = 0.5 * height;
    let cap = vec2f(max(q.x - select(top, bottom, q.y < 0.0), 0.0), abs(q.y) - half_height);
    let slope = vec2f(bottom - top, -height);
    let from_top = q - vec2f(top, half_height);
    // Detached: to first order, a move of the nearest point along the slanted side does not change
    // the distance.
    let square = dot(slope, slope);
    let t = detach_f32(clamp(dot(from_top, slope) / max(square, 1e-30), 0.0, 1.0));
    let side = from_top - slope * t;
    // Between the ends `side` is along the normal. At the surface it is only rounding, so its
    // direction is useless there.
    let between = t > 0.0 && t < 1.0 && square > 1e-30;
    let over = dot(side, vec2f(height, slope.x) / max(length(slope), 1e-30));
    let distance = min(length(cap), select(length(side), abs(over), between));
    return select(distance, -distance, select(side.x, over, between) < 0.0 && cap.y < 0.0);
}
