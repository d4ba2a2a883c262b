// Pass `farthest`: the farthest depth in each quad after the meshes are drawn. Only where there are meshes.

#include "common/view.wgsl"
#include "common/quads.wgsl"

@group(2) @binding(0) var depth_target: texture_2d<f32>;
@group(2) @binding(1) var farthest_target: texture_storage_2d<r32float, write>;

@compute @workgroup_size(8, 8)
fn farthest(@builtin(global_invocation_id) id: vec3u) {
    var greatest = 0.0;
    for (var i = 0u; i < QUAD * QUAD; i += 1u) {
        let pixel = id.xy * QUAD + quad_place(i);
        greatest = max(greatest, select(0.0, textureLoad(depth_target, pixel, 0).x, view_contains(pixel)));
    }
    if view_contains(id.xy * QUAD) {
        textureStore(farthest_target, id.xy, vec4f(greatest));
    }
}
