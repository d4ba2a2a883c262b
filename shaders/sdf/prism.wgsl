// A prism along Y over a regular polygon, rounded inward; the radius is the inner one.

#include "generated/params/PrismParams.wgsl"
#include "sdf/polygon.wgsl"

fn sdf_prism(p: vec3f, q: PrismParams) -> f32 {
    let rounding = min(q.rounding, min(q.radius, 0.5 * q.height));
    let d = vec2f(sdf_polygon(p.xz, q.sides, q.radius - rounding), abs(p.y) - 0.5 * q.height + rounding);
    return length(max(d, vec2f(0.0))) + min(max(d.x, d.y), 0.0) - rounding;
}
