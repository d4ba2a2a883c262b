// Not a pass: how far a kernel proves the field positive, for the test that looks whether it is.

#include "common/ahead.wgsl"
#include "generated/value.wgsl"
#include "common/probe.wgsl"

// For each two points on a ray the field at the second, and how far it is proven beyond it.
@group(2) @binding(1) var<storage, read_write> values: array<f32>;

@compute @workgroup_size(64)
fn probe_ahead(@builtin(global_invocation_id) id: vec3u) {
    let at = 2u * id.x;
    field_begin(subject);
    if at + 1u < probe.count {
        let gone = distance(points[at].xyz, points[at + 1u].xyz);
        let rounding = 1e-6 * (1.0 + gone);
        var f = 0.0;
        for (var i = 0u; i < 2u; i += 1u) {
            ahead_begin(select(-1.0, gone, i == 1u), 4.0 * gone, rounding);
            f = field(points[at + i].xyz);
        }
        values[at] = f;
        values[at + 1u] = ahead_free(f);
    }
}
