// An infinite cone that opens downward from its tip.

#include "generated/params/ConeParams.wgsl"

fn sdf_cone(p: vec3f, q: ConeParams) -> f32 {
    let at = vec2f(length(p.xz), p.y);
    if dot(at, vec2f(q.half_angle.sine, -q.half_angle.cosine)) > 0.0 {
        return dot(at, vec2f(q.half_angle.cosine, q.half_angle.sine));
    }
    return length(at);
}
