// A prism along Y over a regular polygon: sides a.xyz, inner radius a.w, height b.x, rounding b.y inward.

#include "sdf/polygon.wgsl"

fn sdf_prism(p: vec3f, a: vec4f, b: vec4f) -> f32 {
    let rounding = min(b.y, min(a.w, 0.5 * b.x));
    let d = vec2f(sdf_polygon(p.xz, a.xyz, a.w - rounding), abs(p.y) - 0.5 * b.x + rounding);
    return length(max(d, vec2f(0.0))) + min(max(d.x, d.y), 0.0) - rounding;
}
