// A prism along Y over a rhombus, rounded inward.
//
// The inner rhombus, whose sides lie inward by the rounding, is a scaled copy of the whole.

#include "generated/params/RhombusParams.wgsl"
#include "sdf/edge.wgsl"

fn sdf_rhombus(p: vec3f, q: RhombusParams) -> f32 {
    let corner = 0.5 * vec2f(q.width, q.depth);
    let inner_radius = corner.x * corner.y / max(length(corner), 1e-30);
    let rounding = min(q.rounding, min(inner_radius, 0.5 * q.height));
    let shrunk = corner * (1.0 - rounding / max(inner_radius, 1e-30));
    let profile = sdf_edge(abs(p.xz), vec2f(shrunk.x, 0.0), vec2f(0.0, shrunk.y));
    let d = vec2f(profile, abs(p.y) - 0.5 * q.height + rounding);
    return length(max(d, vec2f(0.0))) + min(max(d.x, d.y), 0.0) - rounding;
}
