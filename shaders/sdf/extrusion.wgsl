// A profile extruded along Z: a.x groups, a.y whether overlaps are inside, half depth a.z, rounding
// a.w inward.

#include "sdf/profile.wgsl"

fn sdf_extrusion(p: vec3f, a: vec4f, b: vec4f, data: u32) -> f32 {
    let d = vec2f(sdf_profile(p.xy, u32(a.x), a.y != 0.0, data), abs(p.z) - a.z) + a.w;
    return length(max(d, vec2f(0.0))) + min(max(d.x, d.y), 0.0) - a.w;
}
