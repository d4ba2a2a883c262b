// Pass `farthest`: the farthest depth in each tile after the meshes are drawn. Only where there are meshes.

#include "common/view.wgsl"
#include "common/work.wgsl"

@group(2) @binding(0) var depth_target: texture_2d<f32>;
@group(2) @binding(1) var farthest_target: texture_storage_2d<r32float, write>;

var<workgroup> greatest: atomic<u32>;

@compute @workgroup_size(8, 8)
fn farthest(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    if view_contains(id.xy) {
        atomicMax(&greatest, bitcast<u32>(textureLoad(depth_target, id.xy, 0).x));
    }
    workgroupBarrier();
    if lane == 0u {
        textureStore(farthest_target, group.xy, vec4f(bitcast<f32>(atomicLoad(&greatest))));
    }
}
