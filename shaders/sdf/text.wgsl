// A text: its profiles extruded, as in `sdf_extrusion`; overlaps are inside.

#include "generated/params/TextParams.wgsl"
#include "sdf/profile.wgsl"

fn sdf_text(p: vec3f, q: TextParams, data: u32) -> f32 {
    let d = vec2f(sdf_profile(p.xy, q.groups, true, data), abs(p.z) - q.half_depth) + q.rounding;
    return length(max(d, vec2f(0.0))) + min(max(d.x, d.y), 0.0) - q.rounding;
}
