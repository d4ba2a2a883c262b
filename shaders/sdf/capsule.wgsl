// All points within a distance of a segment: start a.xyz, end (a.w, b.xy), radius b.z.

#include "sdf/detach.wgsl"

fn sdf_capsule(p: vec3f, a: vec4f, b: vec4f) -> f32 {
    let from_start = p - a.xyz;
    let axis = vec3f(a.w, b.xy) - a.xyz;
    // Detached: to first order, a move of the nearest point along the segment does not change the
    // distance.
    let t = detach_f32(clamp(dot(from_start, axis) / max(dot(axis, axis), 1e-30), 0.0, 1.0));
    return length(from_start - axis * t) - b.z;
}
