// A triangle in the XZ plane: width a.x, depth a.y, shift of its tip a.z, thickness a.w.

#include "sdf/edge.wgsl"

fn sdf_triangle(p: vec3f, a: vec4f, b: vec4f) -> f32 {
    let right = vec2f(0.5, -0.5) * a.xy;
    let left = -0.5 * a.xy;
    let tip = vec2f(a.z, 0.5 * a.y);
    let edges = vec3f(sdf_edge(p.xz, left, right), sdf_edge(p.xz, right, tip), sdf_edge(p.xz, tip, left));
    if all(edges < vec3f(0.0)) {
        return abs(p.y) - 0.5 * a.w;
    }
    let aside = abs(edges);
    return length(vec2f(min(aside.x, min(aside.y, aside.z)), p.y)) - 0.5 * a.w;
}
