// An arc of a torus around Y, centered on X.
//
// In the plane of the ring, the nearest point of the arc has the same direction from the center, or
// is an end (idea: Quilez, "distance functions").

#include "generated/params/CappedTorusParams.wgsl"

fn sdf_capped_torus(p: vec3f, q: CappedTorusParams) -> f32 {
    let z = abs(p.z);
    let ring = length(vec2f(length(p.xz) - q.major_radius, p.y));
    let end = length(vec3f(p.x - q.major_radius * q.half_angle.cosine, z - q.major_radius * q.half_angle.sine, p.y));
    return select(end, ring, p.x * q.half_angle.sine - z * q.half_angle.cosine > 0.0) - q.minor_radius;
}
