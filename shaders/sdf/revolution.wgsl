// A profile revolved around the Y axis.

#include "generated/params/RevolutionParams.wgsl"
#include "sdf/profile.wgsl"

fn sdf_revolution(p: vec3f, q: RevolutionParams, data: u32) -> f32 {
    return sdf_profile(vec2f(length(p.xz), p.y), q.groups, false, data);
}
