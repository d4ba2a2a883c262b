// Pass `hiz`: the farthest depth of each subtile after the mesh pass. Runs only in scenes with
// meshes.

#include "common/view.wgsl"
#include "common/subtiles.wgsl"

@group(2) @binding(0) var depth_target: texture_2d<f32>;
@group(2) @binding(1) var hiz_target: texture_storage_2d<r32float, write>;

@compute @workgroup_size(8, 8)
fn hiz(@builtin(global_invocation_id) id: vec3u) {
    var greatest = 0.0;
    for (var i = 0u; i < SUBTILE * SUBTILE; i += 1u) {
        let pixel = id.xy * SUBTILE + subtile_place(i);
        greatest = max(greatest, select(0.0, textureLoad(depth_target, pixel, 0).x, view_contains(pixel)));
    }
    if view_contains(id.xy * SUBTILE) {
        textureStore(hiz_target, id.xy, vec4f(greatest));
    }
}
