// A cone along Y, cut at both ends: bottom radius a.x, top radius a.y, height a.z.

#include "sdf/trapezoid.wgsl"

fn sdf_capped_cone(p: vec3f, a: vec4f, b: vec4f) -> f32 {
    return sdf_trapezoid(vec2f(length(p.xz), p.y), a.x, a.y, a.z);
}
