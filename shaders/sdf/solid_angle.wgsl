// The part of a sphere within an angle around Y.

#include "generated/params/SolidAngleParams.wgsl"

fn sdf_solid_angle(p: vec3f, q: SolidAngleParams) -> f32 {
    let at = vec2f(length(p.xz), p.y);
    let side = vec2f(q.half_angle.sine, q.half_angle.cosine);
    let along = dot(at, side);
    let across = dot(at, vec2f(side.y, -side.x));
    let far = length(at);
    var to_side = abs(across);
    if along <= 0.0 {
        to_side = far;
    } else if along >= q.radius {
        to_side = length(at - q.radius * side);
    }
    if across >= 0.0 {
        return to_side;
    }
    return max(far - q.radius, -to_side);
}
