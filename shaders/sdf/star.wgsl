// A prism along Y over a star: points a.xyz (see `sdf/polygon`), outer radius a.w, inner radius
// b.x, height b.y, rounding b.z inward, which shrinks the star by a factor.

#include "sdf/edge.wgsl"
#include "sdf/polygon.wgsl"

fn sdf_star(p: vec3f, a: vec4f, b: vec4f) -> f32 {
    let tip = vec2f(a.w, 0.0);
    let notch = b.x * a.yz;
    let inner_radius = a.w * notch.y / max(length(notch - tip), 1e-30);
    let rounding = min(b.z, min(inner_radius, 0.5 * b.y));
    let shrunk = 1.0 - rounding / max(inner_radius, 1e-30);
    let profile = sdf_edge(sdf_polygon_sector(p.xz, a.xyz), tip * shrunk, notch * shrunk);
    let d = vec2f(profile, abs(p.y) - 0.5 * b.y + rounding);
    return length(max(d, vec2f(0.0))) + min(max(d.x, d.y), 0.0) - rounding;
}
