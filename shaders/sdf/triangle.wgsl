// A triangle in the XZ plane, its tip off the middle by the skew.

#include "generated/params/TriangleParams.wgsl"
#include "sdf/edge.wgsl"

fn sdf_triangle(p: vec3f, q: TriangleParams) -> f32 {
    let size = vec2f(q.width, q.depth);
    let right = vec2f(0.5, -0.5) * size;
    let left = -0.5 * size;
    let tip = vec2f(q.skew, 0.5 * q.depth);
    let edges = vec3f(sdf_edge(p.xz, left, right), sdf_edge(p.xz, right, tip), sdf_edge(p.xz, tip, left));
    if all(edges < vec3f(0.0)) {
        return abs(p.y) - 0.5 * q.thickness;
    }
    let aside = abs(edges);
    return length(vec2f(min(aside.x, min(aside.y, aside.z)), p.y)) - 0.5 * q.thickness;
}
