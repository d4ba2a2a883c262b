// A cone along Y, cut at both ends.

#include "generated/params/CappedConeParams.wgsl"
#include "sdf/trapezoid.wgsl"

fn sdf_capped_cone(p: vec3f, q: CappedConeParams) -> f32 {
    return sdf_trapezoid(vec2f(length(p.xz), p.y), q.bottom_radius, q.top_radius, q.height);
}
