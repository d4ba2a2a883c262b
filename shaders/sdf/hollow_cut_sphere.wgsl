// A bowl.

#include "generated/params/HollowCutSphereParams.wgsl"

fn sdf_hollow_cut_sphere(p: vec3f, q: HollowCutSphereParams) -> f32 {
    let radius = q.radius;
    let cut = clamp(q.cut, -radius, radius);
    let rim = sqrt((radius - cut) * (radius + cut));
    let at = vec2f(length(p.xz), p.y);
    // Whether the direction from the center leads through the bowl. On the axis below it always
    // does.
    let turn = at.y * rim - at.x * cut;
    if turn < 0.0 || (turn == 0.0 && at.y < 0.0) {
        return abs(length(at) - radius) - 0.5 * q.thickness;
    }
    return length(at - vec2f(rim, cut)) - 0.5 * q.thickness;
}
