// Not a pass: the scene evaluator at given points and along given rays, for the tests that compare it with the CPU's.

#include "scene/value.wgsl"
#include "scene/march.wgsl"

struct SceneQueries {
    count: u32,
    // 1: rays leave a surface, whose normal follows their direction.
    leaves_surface: u32,
    padding_0: u32,
    padding_1: u32,
}

@group(2) @binding(0) var<uniform> queries: SceneQueries;
// Points: xyz and `within`. Rays: start and path length from the eye to it; direction and far
// limit; normal and near limit.
@group(2) @binding(1) var<storage, read> inputs: array<vec4f>;
// Points: value, component, whether complete, evaluations, visits. Rays: the march, evaluations, visits.
@group(2) @binding(2) var<storage, read_write> outputs: array<u32>;

@compute @workgroup_size(64)
fn probe_scene_value(@builtin(global_invocation_id) id: vec3u) {
    if id.x < queries.count {
        let found = scene_value(inputs[id.x].xyz, inputs[id.x].w);
        let at = 5u * id.x;
        outputs[at] = bitcast<u32>(found.value);
        outputs[at + 1u] = found.component;
        outputs[at + 2u] = select(0u, 1u, found.complete);
        outputs[at + 3u] = scene_evaluations;
        outputs[at + 4u] = scene_visits;
    }
}

// Continues a march, or begins it where the word of `ended` is 2.
@compute @workgroup_size(64)
fn probe_scene_ray(@builtin(global_invocation_id) id: vec3u) {
    if id.x < queries.count {
        let start = inputs[3u * id.x];
        let along = inputs[3u * id.x + 1u];
        let normal = inputs[3u * id.x + 2u];
        var ray = Ray(start.xyz, start.w, along.xyz);
        if queries.leaves_surface == 1u {
            ray = scene_surface_ray(start.xyz, normal.xyz, along.xyz, start.w);
        }
        let at = 10u * id.x;
        var begun = scene_march_begin(along.w);
        if outputs[at + 7u] != 2u {
            begun.t = bitcast<f32>(outputs[at]);
            begun.component = outputs[at + 1u];
            begun.visit.entry = bitcast<f32>(outputs[at + 2u]);
            begun.visit.exit = bitcast<f32>(outputs[at + 3u]);
            begun.visit.component = outputs[at + 4u];
            begun.resume = bitcast<f32>(outputs[at + 5u]);
            begun.unbounded = outputs[at + 6u];
            begun.ended = outputs[at + 7u] == 1u;
        }
        let march = scene_march(ray, normal.w, begun);
        outputs[at] = bitcast<u32>(march.t);
        outputs[at + 1u] = march.component;
        outputs[at + 2u] = bitcast<u32>(march.visit.entry);
        outputs[at + 3u] = bitcast<u32>(march.visit.exit);
        outputs[at + 4u] = march.visit.component;
        outputs[at + 5u] = bitcast<u32>(march.resume);
        outputs[at + 6u] = march.unbounded;
        outputs[at + 7u] = select(0u, 1u, march.ended);
        outputs[at + 8u] += scene_evaluations;
        outputs[at + 9u] += scene_visits;
    }
}
