// A cylinder along Y, rounded inward.

#include "generated/params/CylinderParams.wgsl"

fn sdf_cylinder(p: vec3f, q: CylinderParams) -> f32 {
    let size = vec2f(q.radius, 0.5 * q.height);
    let rounding = min(q.rounding, min(size.x, size.y));
    let d = vec2f(length(p.xz), abs(p.y)) - size + rounding;
    return length(max(d, vec2f(0.0))) + min(max(d.x, d.y), 0.0) - rounding;
}
