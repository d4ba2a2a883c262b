// A parallelogram in the XZ plane: width a.x, depth a.y, skew a.z, thickness a.w.
//
// A half turn maps it to itself, so the function computes only the half toward +Z.

#include "sdf/edge.wgsl"

fn sdf_quad(p: vec3f, a: vec4f, b: vec4f) -> f32 {
    let q = select(p.xz, -p.xz, p.z < 0.0);
    let size = 0.5 * a.xyz;
    let right = vec2f(size.z + size.x, size.y);
    let left = vec2f(size.z - size.x, size.y);
    let edges = vec3f(sdf_edge(q, right, left), sdf_edge(q, -left, right), sdf_edge(q, left, -right));
    if all(edges < vec3f(0.0)) {
        return abs(p.y) - 0.5 * a.w;
    }
    let aside = abs(edges);
    return length(vec2f(min(aside.x, min(aside.y, aside.z)), p.y)) - 0.5 * a.w;
}
