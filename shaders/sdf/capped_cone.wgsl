// A cone along Y, cut at both ends: bottom radius a.x, top radius a.y, height a.z.
//
// In the half plane through the axis the nearest point lies on the nearer cap or on the slanted side
// (idea: Quilez, "distance functions").

#include "sdf/held.wgsl"

fn sdf_capped_cone(p: vec3f, a: vec4f, b: vec4f) -> f32 {
    let half_height = 0.5 * a.z;
    let q = vec2f(length(p.xz), p.y);
    let cap = vec2f(max(q.x - select(a.y, a.x, q.y < 0.0), 0.0), abs(q.y) - half_height);
    let slope = vec2f(a.x - a.y, -a.z);
    let from_top = q - vec2f(a.y, half_height);
    // The nearest point: where it moves along the slanted side, the distance does not follow it.
    let t = held_f32(clamp(dot(from_top, slope) / max(dot(slope, slope), 1e-30), 0.0, 1.0));
    let side = from_top - slope * t;
    // Between the ends `side` is along the normal. At the surface only rounding is left of it, so its own
    // direction is worth nothing there.
    let between = t > 0.0 && t < 1.0;
    let over = dot(side, vec2f(a.z, slope.x) / max(length(slope), 1e-30));
    let distance = min(length(cap), select(length(side), abs(over), between));
    return select(distance, -distance, select(side.x, over, between) < 0.0 && cap.y < 0.0);
}
