// A box, rounded inward. Formula: Quilez, "distance functions" (rounded box).

#include "generated/params/BoxParams.wgsl"

fn sdf_box(p: vec3f, q: BoxParams) -> f32 {
    let half_size = 0.5 * q.size;
    let rounding = min(q.rounding, min(half_size.x, min(half_size.y, half_size.z)));
    let d = abs(p) - half_size + rounding;
    return length(max(d, vec3f(0.0))) + min(max(d.x, max(d.y, d.z)), 0.0) - rounding;
}
