// A link of a chain in the XZ plane, its straight part along X.

#include "generated/params/LinkParams.wgsl"

fn sdf_link(p: vec3f, q: LinkParams) -> f32 {
    let bend = max(abs(p.x) - 0.5 * q.length, 0.0);
    return length(vec2f(length(vec2f(bend, p.z)) - q.major_radius, p.y)) - q.minor_radius;
}
