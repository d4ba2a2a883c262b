// Not a pass: surfaces at given points, for the tests that compare them with the CPU evaluator.

#include "generated/surface.wgsl"
#include "common/probe.wgsl"

// Per point the bits of gradient and distance, then the encoded mixture.
@group(2) @binding(1) var<storage, read_write> surfaces: array<vec4u>;

@compute @workgroup_size(64)
fn probe_surface(@builtin(global_invocation_id) id: vec3u) {
    if id.x < probe.count {
        surface_begin(subject);
        let found = surface(points[id.x].xyz);
        surfaces[2u * id.x] = bitcast<vec4u>(vec4f(found.gradient, found.distance));
        surfaces[2u * id.x + 1u] = mixture_encoded(found.materials);
    }
}
