// A vesica along Y, an arc revolved about its chord.
//
// The arc's center may be very far away. The function therefore computes the distance to it minus
// its radius as the difference of their squares over their sum, all times `k`, the ratio of the
// half axes.

#include "generated/params/VesicaParams.wgsl"

fn sdf_vesica(p: vec3f, q: VesicaParams) -> f32 {
    let half_height = 0.5 * q.height;
    let scale = max(half_height, 1e-9);
    let k = min(0.5 * q.width, half_height) / scale;
    // k times the distance of the arc's center from the axis, in half heights.
    let away = 0.5 * (1.0 - k) * (1.0 + k);
    let at = vec2f(length(p.xz), abs(p.y));
    let u = at / scale;
    if half_height < 1e-9 || (u.y >= 1.0 && (u.y - 1.0) * away >= k * u.x) {
        return length(at - vec2f(0.0, half_height));
    }
    let excess = ((u.x - k) * (u.x + k) + u.y * u.y) * k + (u.x - k) * (2.0 * away);
    let sum = length(vec2f(u.x * k + away, u.y * k)) + 0.5 * (1.0 + k * k);
    return excess * half_height / sum;
}
