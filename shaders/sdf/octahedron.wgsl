// A regular octahedron; the radius is that of its corners.
//
// In the positive octant: the nearest point is the foot on the face's plane if it lies within the
// face, else on the nearest edge (idea: Quilez, "octahedron distance").

#include "generated/params/OctahedronParams.wgsl"
#include "sdf/detach.wgsl"

fn sdf_octahedron(p: vec3f, q: OctahedronParams) -> f32 {
    let at = abs(p);
    let excess = at.x + at.y + at.z - q.radius;
    let least = min(at.x, min(at.y, at.z));
    if 3.0 * least >= excess {
        return excess * 0.57735027;
    }
    // The foot lies beyond the face along the least coordinate: take the edge spanned by the two
    // others.
    var edge = at.yz;
    if at.y == least {
        edge = at.xz;
    } else if at.z == least {
        edge = at.xy;
    }
    // Detached: to first order, a move of the nearest point along the edge does not change the
    // distance.
    let t = detach_f32(clamp(0.5 * (edge.y - edge.x + q.radius), 0.0, q.radius));
    return length(vec3f(least, edge.x - q.radius + t, edge.y - t));
}
