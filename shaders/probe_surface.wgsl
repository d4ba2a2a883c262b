// Not a pass: what surfaces are like at given points, for the tests that compare it with the CPU evaluator.

#include "generated/surface.wgsl"
#include "common/probe.wgsl"

// For each point the bits of the gradient with the distance, then the materials as they are stored.
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
