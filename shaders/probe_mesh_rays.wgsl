// Not a pass: rays against the meshes of a scene, for the test that compares them with the CPU's.

#include "scene/mesh_rays.wgsl"

struct MeshRayQueries {
    count: u32,
    padding_0: u32,
    padding_1: u32,
    padding_2: u32,
}

@group(2) @binding(0) var<uniform> queries: MeshRayQueries;
// Origin and near limit; direction and far limit.
@group(2) @binding(1) var<storage, read> inputs: array<vec4f>;
// Distance, mesh, triangle; whether something is in the way; visited nodes.
@group(2) @binding(2) var<storage, read_write> outputs: array<u32>;

@compute @workgroup_size(64)
fn probe_mesh_rays(@builtin(global_invocation_id) id: vec3u) {
    if id.x < queries.count {
        let start = inputs[2u * id.x];
        let along = inputs[2u * id.x + 1u];
        let ray = Ray(start.xyz, 0.0, along.xyz);
        let hit = mesh_rays_hit(ray, start.w, along.w);
        let at = 5u * id.x;
        outputs[at] = bitcast<u32>(hit.t);
        outputs[at + 1u] = hit.mesh;
        outputs[at + 2u] = hit.triangle;
        outputs[at + 4u] = select(0xffffffffu, mesh_visits, hit.complete);
        outputs[at + 3u] = select(0u, 1u, mesh_rays_blocked(ray, start.w, along.w));
    }
}
