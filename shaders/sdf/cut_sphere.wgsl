// A sphere cut by a plane. The part above the cut stays.
//
// Outside, the nearest point is on the sphere if the direction to its center leads through the part
// that stays, else on the flat or its rim; inside, the nearer of sphere and flat is exact.

#include "generated/params/CutSphereParams.wgsl"

fn sdf_cut_sphere(p: vec3f, q: CutSphereParams) -> f32 {
    let radius = q.radius;
    let cut = clamp(q.cut, -radius, radius);
    let rim = sqrt((radius - cut) * (radius + cut));
    let at = vec2f(length(p.xz), p.y);
    let far = length(at);
    let over = far - radius;
    let under = cut - at.y;
    if over <= 0.0 && under <= 0.0 {
        return max(over, under);
    }
    if over > 0.0 && at.y * radius >= cut * far {
        return over;
    }
    if under > 0.0 && at.x <= rim {
        return under;
    }
    return length(vec2f(at.x - rim, under));
}
