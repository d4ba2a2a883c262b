// A prism along Y over a star, rounded inward: the rounding shrinks the star by a factor.

#include "generated/params/StarParams.wgsl"
#include "sdf/edge.wgsl"
#include "sdf/polygon.wgsl"

fn sdf_star(p: vec3f, q: StarParams) -> f32 {
    let tip = vec2f(q.outer_radius, 0.0);
    let notch = q.inner_radius * vec2f(q.points.cosine, q.points.sine);
    let inner_radius = q.outer_radius * notch.y / max(length(notch - tip), 1e-30);
    let rounding = min(q.rounding, min(inner_radius, 0.5 * q.height));
    let shrunk = 1.0 - rounding / max(inner_radius, 1e-30);
    let profile = sdf_edge(sdf_polygon_sector(p.xz, q.points), tip * shrunk, notch * shrunk);
    let d = vec2f(profile, abs(p.y) - 0.5 * q.height + rounding);
    return length(max(d, vec2f(0.0))) + min(max(d.x, d.y), 0.0) - rounding;
}
