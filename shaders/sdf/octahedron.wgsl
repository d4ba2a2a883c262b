// A regular octahedron: center to corner a.x.
//
// In the positive octant: the nearest point is the foot on the face's plane if it lies within the
// face, else on the nearest edge (idea: Quilez, "octahedron distance").

#include "sdf/detach.wgsl"

fn sdf_octahedron(p: vec3f, a: vec4f, b: vec4f) -> f32 {
    let q = abs(p);
    let excess = q.x + q.y + q.z - a.x;
    let least = min(q.x, min(q.y, q.z));
    if 3.0 * least >= excess {
        return excess * 0.57735027;
    }
    // The foot lies beyond the face along the least coordinate: take the edge spanned by the two
    // others.
    var edge = q.yz;
    if q.y == least {
        edge = q.xz;
    } else if q.z == least {
        edge = q.xy;
    }
    // Detached: to first order, a move of the nearest point along the edge does not change the
    // distance.
    let t = detach_f32(clamp(0.5 * (edge.y - edge.x + a.x), 0.0, a.x));
    return length(vec3f(least, edge.x - a.x + t, edge.y - t));
}
