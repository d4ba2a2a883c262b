// A profile revolved around the Y axis: a.x groups, a.y whether overlaps are inside.

#include "sdf/profile.wgsl"

fn sdf_revolution(p: vec3f, a: vec4f, b: vec4f, data: u32) -> f32 {
    return sdf_profile(vec2f(length(p.xz), p.y), u32(a.x), a.y != 0.0, data);
}
