// A prism along Y over a rhombus: width a.x, depth a.y, height a.z, rounding a.w inward.
//
// The inner rhombus, whose sides lie inward by the rounding, is a scaled copy of the whole.

#include "sdf/edge.wgsl"

fn sdf_rhombus(p: vec3f, a: vec4f, b: vec4f) -> f32 {
    let corner = 0.5 * a.xy;
    let inner_radius = corner.x * corner.y / max(length(corner), 1e-30);
    let rounding = min(a.w, min(inner_radius, 0.5 * a.z));
    let shrunk = corner * (1.0 - rounding / max(inner_radius, 1e-30));
    let profile = sdf_edge(abs(p.xz), vec2f(shrunk.x, 0.0), vec2f(0.0, shrunk.y));
    let d = vec2f(profile, abs(p.y) - 0.5 * a.z + rounding);
    return length(max(d, vec2f(0.0))) + min(max(d.x, d.y), 0.0) - rounding;
}
