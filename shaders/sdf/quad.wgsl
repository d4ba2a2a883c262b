// A parallelogram in the XZ plane.
//
// A half turn maps it to itself, so the function computes only the half toward +Z.

#include "generated/params/QuadParams.wgsl"
#include "sdf/edge.wgsl"

fn sdf_quad(p: vec3f, q: QuadParams) -> f32 {
    let at = select(p.xz, -p.xz, p.z < 0.0);
    let size = 0.5 * vec3f(q.width, q.depth, q.skew);
    let right = vec2f(size.z + size.x, size.y);
    let left = vec2f(size.z - size.x, size.y);
    let edges = vec3f(sdf_edge(at, right, left), sdf_edge(at, -left, right), sdf_edge(at, left, -right));
    if all(edges < vec3f(0.0)) {
        return abs(p.y) - 0.5 * q.thickness;
    }
    let aside = abs(edges);
    return length(vec2f(min(aside.x, min(aside.y, aside.z)), p.y)) - 0.5 * q.thickness;
}
