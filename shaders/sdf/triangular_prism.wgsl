// A prism along Y over an isosceles triangle: width a.x along X, depth a.y along Z, height a.z.

#include "sdf/trapezoid.wgsl"

fn sdf_triangular_prism(p: vec3f, a: vec4f, b: vec4f) -> f32 {
    let d = vec2f(sdf_trapezoid(vec2f(abs(p.x), p.z), 0.5 * a.x, 0.0, a.y), abs(p.y) - 0.5 * a.z);
    return length(max(d, vec2f(0.0))) + min(max(d.x, d.y), 0.0);
}
