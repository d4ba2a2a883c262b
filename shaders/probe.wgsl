// Not a pass: the field at given points, for the tests that compare it with the CPU evaluator.

#include "generated/value.wgsl"
#include "common/probe.wgsl"

@group(2) @binding(1) var<storage, read_write> values: array<f32>;

@compute @workgroup_size(64)
fn probe_field(@builtin(global_invocation_id) id: vec3u) {
    if id.x < probe.count {
        field_begin(subject);
        values[id.x] = field(points[id.x].xyz);
    }
}
