// A hexagonal prism along Y; the radius is the inner one. Two sides face along X.

#include "generated/params/HexagonalPrismParams.wgsl"

fn sdf_hexagonal_prism(p: vec3f, q: HexagonalPrismParams) -> f32 {
    // Fold the plane at its mirror lines until only the side that faces X is left.
    var at = abs(p.xz);
    let mirror = vec2f(-0.5, 0.8660254);
    at -= 2.0 * max(dot(at, mirror), 0.0) * mirror;
    let half_side = 0.57735027 * q.radius;
    let beside = vec2f(at.x - q.radius, max(abs(at.y) - half_side, 0.0));
    let d = vec2f(select(beside.x, length(beside), beside.x > 0.0), abs(p.y) - 0.5 * q.height);
    return length(max(d, vec2f(0.0))) + min(max(d.x, d.y), 0.0);
}
