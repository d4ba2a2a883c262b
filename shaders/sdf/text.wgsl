// A text: its profiles extruded, as in `sdf_extrusion`. A function of its own, since each shape has
// its own gradient.

#include "sdf/profile.wgsl"

fn sdf_text(p: vec3f, a: vec4f, b: vec4f, data: u32) -> f32 {
    let d = vec2f(sdf_profile(p.xy, u32(a.x), a.y != 0.0, data), abs(p.z) - a.z) + a.w;
    return length(max(d, vec2f(0.0))) + min(max(d.x, d.y), 0.0) - a.w;
}
