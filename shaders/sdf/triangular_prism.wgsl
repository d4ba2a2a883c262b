// A prism along Y over an isosceles triangle, its width along X.

#include "generated/params/TriangularPrismParams.wgsl"
#include "sdf/trapezoid.wgsl"

fn sdf_triangular_prism(p: vec3f, q: TriangularPrismParams) -> f32 {
    let d = vec2f(sdf_trapezoid(vec2f(abs(p.x), p.z), 0.5 * q.width, 0.0, q.depth), abs(p.y) - 0.5 * q.height);
    return length(max(d, vec2f(0.0))) + min(max(d.x, d.y), 0.0);
}
