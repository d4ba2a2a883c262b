// All points within a distance of a segment.

#include "generated/params/CapsuleParams.wgsl"
#include "sdf/detach.wgsl"

fn sdf_capsule(p: vec3f, q: CapsuleParams) -> f32 {
    let from_start = p - q.start;
    let axis = q.end - q.start;
    // Detached: to first order, a move of the nearest point along the segment does not change the
    // distance.
    let t = detach_f32(clamp(dot(from_start, axis) / max(dot(axis, axis), 1e-30), 0.0, 1.0));
    return length(from_start - axis * t) - q.radius;
}
