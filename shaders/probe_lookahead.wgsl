// Not a pass: how far a pipeline proves the field positive, for the test of these proofs.

#include "common/lookahead.wgsl"
#include "generated/value.wgsl"
#include "common/probe.wgsl"

// Length of the lookahead window, in distances between the two points.
const PROBE_WINDOW: f32 = 4.0;

// For each pair of points on a ray: the field at the second, the free interval beyond it, the lower
// bound of the field in the window before the first (a trivial one in pipelines without verified
// oversteps), and the field at the first.
@group(2) @binding(1) var<storage, read_write> values: array<f32>;

@compute @workgroup_size(64)
fn probe_lookahead(@builtin(global_invocation_id) id: vec3u) {
    let at = 2u * id.x;
    field_begin(subject);
    if at + 1u < probe.count {
        let gone = distance(points[at].xyz, points[at + 1u].xyz);
        let rounding = 1e-6 * (1.0 + gone);
        var f = vec2f(0.0);
        for (var i = 0u; i < 4u; i += 1u) {
            if i < 3u {
                lookahead_begin(select(-1.0, gone, i == 1u), PROBE_WINDOW * gone, rounding);
            } else {
                lookahead_begin_behind(gone, PROBE_WINDOW * gone, rounding);
            }
            f = vec2f(f.y, field(points[at + i % 2u].xyz));
            if i == 1u {
                values[2u * at + 1u] = lookahead_free_interval(f.y);
            }
        }
        values[2u * at] = f.y;
        values[2u * at + 2u] = select(-PROBE_WINDOW * gone + f.x, lookahead_minimum, VERIFIED_OVERSTEP);
        values[2u * at + 3u] = f.x;
    }
}
