// A pyramid over a square.
//
// Computed in the sector of the face toward +X, where |z| < x, by symmetry. Outside: the nearer of
// face and square, each in its own plane. Inside: the nearer of the planes.

#include "generated/params/PyramidParams.wgsl"
#include "sdf/trapezoid.wgsl"

fn sdf_pyramid(p: vec3f, q: PyramidParams) -> f32 {
    let half_width = 0.5 * q.width;
    let x = max(abs(p.x), abs(p.z));
    let z = min(abs(p.x), abs(p.z));
    let from_edge = vec2f(x - half_width, p.y + 0.5 * q.height);
    let slope = length(vec2f(half_width, q.height));
    let up = select(vec2f(0.0, 1.0), vec2f(-half_width, q.height) / max(slope, 1e-30), slope > 0.0);
    let over = dot(from_edge, vec2f(up.y, -up.x));
    if over < 0.0 && from_edge.y > 0.0 {
        return max(over, -from_edge.y);
    }
    let beside = max(sdf_trapezoid(vec2f(z, dot(from_edge, up) - 0.5 * slope), half_width, 0.0, slope), 0.0);
    let to_face = select(abs(over), length(vec2f(over, beside)), beside > 0.0);
    let beyond = vec2f(max(from_edge.x, 0.0), max(z - half_width, 0.0));
    // At the base itself the field increases downward.
    let below = select(from_edge.y, -from_edge.y, from_edge.y <= 0.0);
    let to_base = select(below, length(vec3f(beyond, from_edge.y)), beyond.x > 0.0);
    return min(to_face, to_base);
}
