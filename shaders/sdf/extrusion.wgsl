// A profile extruded along Z, rounded inward.

#include "generated/params/ExtrusionParams.wgsl"
#include "sdf/profile.wgsl"

fn sdf_extrusion(p: vec3f, q: ExtrusionParams, data: u32) -> f32 {
    let d = vec2f(sdf_profile(p.xy, q.groups, false, data), abs(p.z) - q.half_depth) + q.rounding;
    return length(max(d, vec2f(0.0))) + min(max(d.x, d.y), 0.0) - q.rounding;
}
